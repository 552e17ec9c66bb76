// Rational Bezier surfaces of a page: what the page holds of them, and their values anywhere (docs/theory.md, 2.4).
"use strict";

/** The numbers of a page, from its text: base 64 of 32-bit floats, deflated. */
async function inflated(text) {
  const bytes = Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Float32Array(await new Response(stream).arrayBuffer());
}

/** Gives each surface its `weights`, and by load step its columns, x, y, z first, its `marks` with their columns, and where a contact acts. */
function distribute(page, numbers) {
  let begin = 0;
  const take = (count) => numbers.subarray(begin, (begin += count));
  for (const surface of page.surfaces) {
    const count = (surface.orders[0] * surface.elements[0] + 1) * (surface.orders[1] * surface.elements[1] + 1);
    surface.weights = take(count);
    surface.states = page.steps.map(() => Object.fromEntries(surface.columns.map((name) => [name, take(count)])));
    surface.marked = page.steps.map(() => Object.fromEntries(["x", "y", "z", "status"].map((name) => [name, take(surface.marks)])));
    const placed = (surface.elements[0] * surface.parts + 1) * (surface.elements[1] * surface.parts + 1);
    surface.acting = surface.contact === null ? null : page.steps.map(() => ({ here: take(placed), largest: take(surface.columns.length) }));
  }
}

/** Bernstein polynomials of an order at s in [0, 1]. */
function bernstein(order, s) {
  const values = [1];
  for (let p = 1; p <= order; p++) {
    values.push(0);
    for (let k = p; k >= 0; k--) values[k] = (k < p ? (1 - s) * values[k] : 0) + (k > 0 ? s * values[k - 1] : 0);
  }
  return values;
}

/** Values of some columns of a state at equal parts of each element, along the first direction fastest. */
function sampled(surface, state, names, parts) {
  const [along, across] = [0, 1].map((axis) => places(surface.orders[axis], surface.elements[axis], parts));
  const row = surface.orders[0] * surface.elements[0] + 1;
  const columns = names.map((name) => state[name]);
  const values = names.map(() => new Float32Array(along.length * across.length));
  let place = 0;
  for (const v of across)
    for (const u of along) {
      let below = 0;
      const above = columns.map(() => 0);
      for (let j = 0; j < v.functions.length; j++)
        for (let i = 0; i < u.functions.length; i++) {
          const point = u.first + i + row * (v.first + j);
          const share = u.functions[i] * v.functions[j] * surface.weights[point];
          below += share;
          for (let k = 0; k < columns.length; k++) above[k] += share * columns[k][point];
        }
      for (let k = 0; k < columns.length; k++) values[k][place] = above[k] / below;
      place++;
    }
  return values;
}

/** For each place along a direction the first Bezier point of its element, and the functions there. */
function places(order, elements, parts) {
  return Array.from({ length: elements * parts + 1 }, (_, k) => {
    const element = Math.min(Math.floor(k / parts), elements - 1);
    return { first: order * element, functions: bernstein(order, k / parts - element) };
  });
}
