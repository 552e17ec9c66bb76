// The page: bodies in colours by a field, load step by load step. Parallel projection, z upwards, as the pictures of `isomortar plot`.
const page = JSON.parse(document.getElementById("page").textContent);
const element = (name) => document.getElementById(name);
const canvas = element("bodies");
const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
const camera = { azimuth: -62, elevation: 24, height: 1, middle: [0, 0, 0] };
let shown = { field: page.fields[0], step: page.steps.length - 1, low: 0, high: 1 };
let meshes = [];
const hidden = new Set();

const VERTEX = `#version 300 es
in vec3 place; in vec3 normal; in float value;
uniform mat3 turn; uniform vec3 middle; uniform vec2 scale; uniform float depth, lift, size;
out vec3 facing; out float field;
void main() {
  vec3 seen = turn * (place - middle);
  gl_Position = vec4(scale * seen.xy, -seen.z / depth - lift, 1.0);
  gl_PointSize = size; facing = turn * normal; field = value;
}`;
// Kinds: 0 one colour, 1 by the field, 2 by status. A value of NONE is that of a place where nothing is known.
const FRAGMENT = `#version 300 es
precision highp float;
in vec3 facing; in float field; out vec4 colour;
uniform int kind; uniform vec3 plain; uniform vec2 ends; uniform float least, shade; uniform sampler2D colours; uniform vec3 states[3];
void main() {
  vec3 base = plain;
  if (kind == 1 && field > -1e29 && abs(field) > least) {
    float share = (field - ends.x) / max(ends.y - ends.x, 1e-30);
    base = texture(colours, vec2(clamp(share, 0.002, 0.998), 0.5)).rgb;
    if (least > 0.0 && share < -1e-6) base = vec3(0.435, 0.463, 0.502);
  }
  if (kind == 2) {
    if (length(gl_PointCoord - 0.5) > 0.5) discard;
    base = states[int(field + 0.5)];
  }
  float light = abs(dot(normalize(facing + vec3(0.0, 0.0, 1e-9)), normalize(vec3(-0.3, 0.5, 0.8))));
  colour = vec4(base * mix(1.0, 0.45 + 0.6 * light, shade), 1.0);
}`;
const NONE = -1e30;

function program() {
  const made = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  gl.useProgram(made);
  return made;
}

/** Whether a surface is seen: of the contact whose field is shown its slave face, in the place of those of the bodies. */
function isSeen(surface) {
  if (surface.contact === null && hidden.has(surface.name)) return false;
  if (surface.contact !== null) return surface.contact === shown.field.contact;
  return shown.field.contact === null || !surface.slaveOf.includes(shown.field.contact);
}

/** Values of the field that is shown; of a contact none where its master is not opposite. */
function valuesOf(surface, places, parts) {
  const state = surface.states[shown.step];
  if (shown.field.column === "displacement") {
    const rest = sampled(surface, surface.states[0], ["x", "y", "z"], parts);
    return places[0].map((_, k) => Math.hypot(...[0, 1, 2].map((axis) => places[axis][k] - rest[axis][k])));
  }
  if (!surface.columns.includes(shown.field.column)) return null;
  const values = sampled(surface, state, [shown.field.column], parts)[0];
  if (!surface.acting) return values;
  const { here, largest } = surface.acting[shown.step];
  const most = largest[surface.columns.indexOf(shown.field.column)];
  return values.map((value, k) => (here[k] > 0 ? Math.max(-most, Math.min(most, value)) : NaN));
}

/** Points, normals, values and numbers of the corners of triangles and of element boundaries. */
function meshOf(surface) {
  const parts = surface.parts;
  const [columns, rows] = surface.elements.map((count) => count * parts + 1);
  const places = sampled(surface, surface.states[shown.step], ["x", "y", "z"], parts);
  const values = valuesOf(surface, places, parts);
  const points = new Float32Array(3 * rows * columns), normals = new Float32Array(3 * rows * columns);
  const at = (column, row) => Math.max(0, Math.min(columns - 1, column)) + columns * Math.max(0, Math.min(rows - 1, row));
  for (let row = 0; row < rows; row++)
    for (let column = 0; column < columns; column++) {
      const k = at(column, row);
      const [a, b] = [[at(column - 1, row), at(column + 1, row)], [at(column, row - 1), at(column, row + 1)]].map(([from, to]) => places.map((x) => x[to] - x[from]));
      points.set(places.map((x) => x[k]), 3 * k);
      normals.set([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]], 3 * k);
    }
  const triangles = [], lines = [];
  for (let row = 0; row < rows; row++)
    for (let column = 0; column < columns; column++) {
      if (row + 1 < rows && column + 1 < columns) triangles.push(at(column, row), at(column + 1, row), at(column, row + 1), at(column + 1, row), at(column + 1, row + 1), at(column, row + 1));
      if (column + 1 < columns && row % parts === 0) lines.push(at(column, row), at(column + 1, row));
      if (row + 1 < rows && column % parts === 0) lines.push(at(column, row), at(column, row + 1));
    }
  return { surface, points, normals, values, triangles: new Uint32Array(triangles), lines: new Uint32Array(lines) };
}

function marksOf(surface) {
  const { x, y, z, status } = surface.marked[shown.step];
  const points = new Float32Array(3 * surface.marks);
  for (let k = 0; k < surface.marks; k++) points.set([x[k], y[k], z[k]], 3 * k);
  return { surface, points, normals: new Float32Array(points.length), values: status, marks: true };
}

/** Hands the meshes of what is seen to the graphics. */
function build() {
  for (const mesh of meshes) mesh.buffers.forEach((buffer) => gl.deleteBuffer(buffer));
  const seen = page.surfaces.filter(isSeen);
  meshes = [...seen.map(meshOf), ...seen.filter((surface) => shown.field.column === "status" && surface.contact !== null).map(marksOf)];
  for (const mesh of meshes) {
    const values = mesh.values ? Float32Array.from(mesh.values, (value) => (Number.isFinite(value) ? value : NONE)) : new Float32Array(mesh.points.length / 3).fill(NONE);
    mesh.buffers = [mesh.points, mesh.normals, values].map((content) => filled(gl.ARRAY_BUFFER, content));
    for (const kind of ["triangles", "lines"]) if (mesh[kind]) mesh.buffers.push(filled(gl.ELEMENT_ARRAY_BUFFER, mesh[kind]));
  }
}

function filled(target, content) {
  const buffer = gl.createBuffer();
  gl.bindBuffer(target, buffer);
  gl.bufferData(target, content, gl.STATIC_DRAW);
  return buffer;
}

/** Rows: to the right, upwards, towards the eye. */
function axesOfView() {
  const [a, e] = [camera.azimuth, camera.elevation].map((angle) => (angle * Math.PI) / 180);
  const eye = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
  const right = [-Math.sin(a), Math.cos(a), 0];
  const up = [eye[1] * right[2] - eye[2] * right[1], eye[2] * right[0] - eye[0] * right[2], eye[0] * right[1] - eye[1] * right[0]];
  return [right, up, eye];
}

const scales = () => [(2 * canvas.clientHeight) / canvas.clientWidth / camera.height, 2 / camera.height];

function draw() {
  const ratio = window.devicePixelRatio || 1;
  [canvas.width, canvas.height] = [canvas.clientWidth * ratio, canvas.clientHeight * ratio];
  gl.viewport(0, 0, canvas.width, canvas.height);
  gl.clearColor(0, 0, 0, 0);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  const axes = axesOfView();
  gl.uniformMatrix3fv(where("turn"), true, axes.flat());
  gl.uniform3fv(where("middle"), camera.middle);
  gl.uniform2fv(where("scale"), scales());
  gl.uniform1f(where("depth"), 4 * page.radius);
  gl.uniform2f(where("ends"), shown.low, shown.high);
  gl.uniform1f(where("least"), shown.field.bare ? 0.002 * Math.abs(shown.high) : 0);
  gl.uniform3fv(where("states"), page.states.flatMap((state) => state.colour));
  page.planes.filter((plane) => axes[2].reduce((sum, x, k) => sum + x * plane.normal[k], 0) > 0).forEach(drawPlane);
  meshes.forEach(drawMesh);
  drawAxes(axes);
}

function drawMesh(mesh) {
  ["place", "normal", "value"].forEach((name, k) => attribute(name, mesh.buffers[k], k === 2 ? 1 : 3));
  gl.uniform1f(where("size"), 7 * (window.devicePixelRatio || 1));
  if (mesh.marks) return put(2, [0, 0, 0], 0, 0.004, () => gl.drawArrays(gl.POINTS, 0, mesh.surface.marks));
  const coloured = mesh.values !== null && shown.field.column !== "status";
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, mesh.buffers[3]);
  put(coloured ? 1 : 0, mesh.surface.colour, coloured ? 0.15 : 1, 0, () => gl.drawElements(gl.TRIANGLES, mesh.triangles.length, gl.UNSIGNED_INT, 0));
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, mesh.buffers[4]);
  put(0, [0.16, 0.18, 0.22], 0, 0.001, () => gl.drawElements(gl.LINES, mesh.lines.length, gl.UNSIGNED_INT, 0));
}

function put(kind, plain, shade, lift, call) {
  gl.uniform1i(where("kind"), kind);
  gl.uniform3fv(where("plain"), plain);
  gl.uniform1f(where("shade"), shade);
  gl.uniform1f(where("lift"), lift);
  call();
}

function drawPlane(plane) {
  const corners = new Float32Array(plane.corners.flat());
  const buffers = [filled(gl.ARRAY_BUFFER, corners), filled(gl.ARRAY_BUFFER, new Float32Array(12)), filled(gl.ARRAY_BUFFER, new Float32Array(4))];
  ["place", "normal", "value"].forEach((name, k) => attribute(name, buffers[k], k === 2 ? 1 : 3));
  put(0, page.planeColour, 0, -0.002, () => gl.drawArrays(gl.TRIANGLE_FAN, 0, 4));
  buffers.forEach((buffer) => gl.deleteBuffer(buffer));
}

function attribute(name, buffer, size) {
  const place = gl.getAttribLocation(painter, name);
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.enableVertexAttribArray(place);
  gl.vertexAttribPointer(place, size, gl.FLOAT, false, 0, 0);
}

function drawAxes(axes) {
  const [board, side, ratio] = [element("axes"), 84, window.devicePixelRatio || 1];
  board.width = board.height = side * ratio;
  const pen = board.getContext("2d");
  pen.scale(ratio, ratio);
  pen.font = "13px system-ui, sans-serif";
  pen.lineWidth = 1.5;
  ["x", "y", "z"].forEach((name, k) => {
    pen.strokeStyle = pen.fillStyle = getComputedStyle(document.body).color;
    const [right, up] = [axes[0][k], axes[1][k]];
    pen.beginPath();
    pen.moveTo(side / 2, side / 2);
    pen.lineTo(side / 2 + 26 * right, side / 2 - 26 * up);
    pen.stroke();
    pen.fillText(name, side / 2 + 35 * right - 4, side / 2 - 35 * up + 4);
  });
}

const told = (value) => (value === 0 ? "0" : Math.abs(value) >= 1e-3 && Math.abs(value) < 1e5 ? String(Number(value.toPrecision(4))) : value.toExponential(3));

/** The legend: a bar with ends that can be set, or a dot for each status. */
function showLegend() {
  const legend = element("legend");
  if (shown.field.column === "status") {
    legend.innerHTML = `<div class="kinds">${page.states.map((state) => `<span><i style="background: rgb(${state.colour.map((c) => 255 * c)})"></i>${state.name}</span>`).join("")}</div>`;
    return;
  }
  const stops = page.colours[shown.field.colours].filter((_, k) => k % 15 === 0).map((colour) => `rgb(${colour})`);
  legend.innerHTML = `<p class="unit">${shown.field.unit}</p><div class="bar" style="background: linear-gradient(to right, ${stops})"></div>
    <div class="ends"><input type="number" step="any" aria-label="low end of the colours" value="${told(shown.low)}"><input type="number" step="any" aria-label="high end of the colours" value="${told(shown.high)}"></div>`;
  const [low, high] = legend.querySelectorAll("input");
  low.onchange = high.onchange = () => {
    [shown.low, shown.high] = [Number(low.value), Number(high.value)];
    draw();
  };
}

function chooseField(number) {
  const field = page.fields[number];
  Object.assign(shown, { field, low: field.range[0], high: field.range[1] });
  gl.bindTexture(gl.TEXTURE_2D, texture);
  const content = new Uint8Array(page.colours[field.colours].flat());
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB, content.length / 3, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, content);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  showLegend();
  build();
  draw();
}

function chooseStep(number) {
  shown.step = number;
  element("step").value = number;
  const { step, stage } = page.steps[number];
  element("told").textContent = step === 0 ? "0 (at rest)" : `${step} (${stage})`;
  build();
  draw();
}

/** All bodies, or those that are the slave of the contact whose field is shown, as its master sees them. */
function look(bodies, direction) {
  element("names").querySelectorAll("input").forEach((box) => (box.checked = bodies.has(box.value)));
  hide();
  const aspect = canvas.clientWidth / canvas.clientHeight;
  Object.assign(camera, direction, { middle: [0, 0, 0], height: (2.05 * page.radius) / Math.min(1, aspect) });
  draw();
}

const showAll = () => look(new Set(page.surfaces.map((surface) => surface.name)), { azimuth: -62, elevation: 24 });

function showSide() {
  const contact = shown.field.contact ?? 0;
  look(new Set(page.surfaces.filter((surface) => surface.slaveOf.includes(contact)).map((surface) => surface.name)), page.sides[contact]);
}

function hide() {
  hidden.clear();
  element("names").querySelectorAll("input:not(:checked)").forEach((box) => hidden.add(box.value));
  build();
}

/** The nearest corner of a mesh to a place on the screen that nothing hides: its value. */
function read(event) {
  const [axes, [sx, sy], box] = [axesOfView(), scales(), canvas.getBoundingClientRect()];
  const [right, up] = [((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2];
  const reach = 10 / box.height;
  let best = null;
  for (const mesh of meshes)
    for (let k = 0; !mesh.marks && k < mesh.points.length / 3; k++) {
      const arm = [0, 1, 2].map((axis) => mesh.points[3 * k + axis] - camera.middle[axis]);
      const [x, y, near] = axes.map((row) => row[0] * arm[0] + row[1] * arm[1] + row[2] * arm[2]);
      const aside = Math.hypot((sx * x - right) * (box.width / box.height), sy * y - up);
      if (aside < reach && (!best || near - aside > best.near)) best = { near: near - aside, mesh, k };
    }
  const label = element("value");
  label.hidden = !best;
  if (!best) return;
  const place = [0, 1, 2].map((axis) => told(best.mesh.points[3 * best.k + axis] + page.centre[axis])).join(", ");
  const value = best.mesh.values && shown.field.column !== "status" ? best.mesh.values[best.k] : NaN;
  label.textContent = Number.isFinite(value) ? `${shown.field.label}: ${told(value)} at ${place}` : `${best.mesh.surface.name} at ${place}`;
}

function listen() {
  const fingers = new Map();
  const apart = () => {
    const [a, b] = [...fingers.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  canvas.onpointerdown = (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, { x: event.clientX, y: event.clientY });
  };
  canvas.onpointerup = canvas.onpointercancel = (event) => fingers.delete(event.pointerId);
  canvas.onpointermove = (event) => {
    const finger = fingers.get(event.pointerId);
    if (!finger) return read(event);
    const before = fingers.size === 2 ? apart() : 0;
    const [dx, dy] = [event.clientX - finger.x, event.clientY - finger.y];
    Object.assign(finger, { x: event.clientX, y: event.clientY });
    if (fingers.size === 2) camera.height *= before / apart();
    else if (event.shiftKey) {
      const [[right, up], unit] = [axesOfView(), camera.height / canvas.clientHeight];
      camera.middle = camera.middle.map((x, k) => x - unit * (dx * right[k] - dy * up[k]));
    } else {
      camera.azimuth -= 0.4 * dx;
      camera.elevation = Math.max(-90, Math.min(90, camera.elevation + 0.4 * dy));
    }
    draw();
  };
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.height *= Math.exp(0.001 * event.deltaY);
    draw();
  }, { passive: false });
  canvas.ondblclick = element("whole").onclick = showAll;
  element("side").onclick = showSide;
  element("side").hidden = page.sides.length === 0;
  element("names").onchange = () => {
    hide();
    draw();
  };
  element("field").onchange = (event) => chooseField(Number(event.target.value));
  element("step").oninput = (event) => chooseStep(Number(event.target.value));
  let playing = null;
  element("play").onclick = () => {
    playing = playing ? clearInterval(playing) : setInterval(() => chooseStep((shown.step + 1) % page.steps.length), 200);
    element("play").textContent = playing ? "Stop" : "Play";
  };
  new ResizeObserver(draw).observe(canvas);
}

const painter = gl && program();
const where = (name) => gl.getUniformLocation(painter, name);
const texture = gl && gl.createTexture();
(async () => {
  if (!gl) {
    Object.assign(element("failed"), { hidden: false, textContent: "This browser draws no WebGL 2, which the page needs." });
    return;
  }
  distribute(page, await inflated(element("numbers").textContent));
  page.fields.forEach((field, k) => element("field").append(new Option(field.label, k)));
  for (const name of new Set(page.surfaces.filter((surface) => surface.contact === null).map((surface) => surface.name))) {
    const label = document.createElement("label");
    label.append(Object.assign(document.createElement("input"), { type: "checkbox", checked: true, value: name }), ` ${name}`);
    element("names").append(label);
  }
  element("step").max = page.steps.length - 1;
  chooseField(0);
  chooseStep(page.steps.length - 1);
  showAll();
  listen();
  document.body.dataset.ready = "yes";
})();
