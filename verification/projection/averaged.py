"""Averaged normals against their definition, written down anew with NumPy: feet, gaps, slips, weights, and the forces' work.

The master's elements, normals and feet are computed from its nodes by another algorithm (every element, every point), the variation of
the normals by differences.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from friction.virtual_work import PATTERNS, Surface, areas, relative, response_of
from tangents.kinks import _SCENE

from isomortar._bindings import find_climbs
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import ContactState
from isomortar.solve.timing import Ledger

#: Step of the differences.
STEP = 1e-5
#: Newton's of a foot from the middle of its element; who is not there by then has none in it.
ITERATIONS = 15
#: How uneven the master is, and how far the bowl is moved: all of it over the master, or a part of it beyond its edge.
UNEVEN = {1: 0.03, 2: 0.007}
MOVED = {"inside": (0.07, 0.03, -0.02), "over the rim": (0.45, 0.03, -0.02)}


@cache
def polynomials(order: int) -> tuple[tuple[np.polynomial.Polynomial, ...], tuple[np.polynomial.Polynomial, ...]]:
    """Nodal functions on [0, 1] and their derivatives."""
    nodes = np.linspace(0.0, 1.0, order + 1)
    zeros = [np.polynomial.Polynomial.fromroots(np.delete(nodes, j)) for j in range(order + 1)]
    functions = tuple(function / function(node) for function, node in zip(zeros, nodes, strict=True))
    return functions, tuple(function.deriv() for function in functions)


def lagrange(order: int, t: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Values and derivatives of the nodal functions at t, each of shape (points, order + 1)."""
    functions, derivatives = polynomials(order)
    return np.stack([f(t) for f in functions], axis=-1), np.stack([f(t) for f in derivatives], axis=-1)


@dataclass(frozen=True)
class Feet:
    """Element (by direction), coordinates in it on [0, 1], gap and normal of points' feet; whether there is one."""

    element: np.ndarray
    t: FloatArray
    gap: FloatArray
    normal: FloatArray
    found: np.ndarray


class Master:
    """A face of Lagrange elements by its nodes, shape (nodes along v, nodes along u, 3)."""

    def __init__(self, order: int, nodes: FloatArray) -> None:
        self.order, self.nodes = order, nodes
        self.elements = (nodes.shape[1] - 1) // order, (nodes.shape[0] - 1) // order
        sums = np.zeros_like(nodes)
        corner = np.linspace(0.0, 1.0, order + 1)
        for e in np.ndindex(self.elements):
            for j, i in np.ndindex(order + 1, order + 1):
                _, first, second = self.at(self.nodes, e, np.array([[corner[i], corner[j]]]))
                across = np.cross(first[0], second[0])
                sums[order * e[1] + j, order * e[0] + i] += across / np.linalg.norm(across)
        self.normals = sums / np.linalg.norm(sums, axis=2, keepdims=True)

    def at(self, field: FloatArray, e: tuple[int, ...], t: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """A field of the nodes in element e at t, and its derivatives by t, each of shape (points, 3)."""
        p = self.order
        own = field[p * e[1] : p * e[1] + p + 1, p * e[0] : p * e[0] + p + 1]
        (u, du), (v, dv) = lagrange(p, t[:, 0]), lagrange(p, t[:, 1])
        value, first, second = (np.einsum("qi,qj,jik->qk", a, b, own) for a, b in ((u, v), (du, v), (u, dv)))
        return value, first, second

    def feet(self, x: FloatArray, across: FloatArray) -> Feet:
        """Feet of points on a slave with normals `across`: in every element by Newton's method, the smallest gap of all."""
        count, size = len(x), np.linalg.norm(np.ptp(self.nodes.reshape(-1, 3), axis=0))
        best = Feet(np.zeros((count, 2), int), np.zeros((count, 2)), np.full(count, np.inf), np.zeros((count, 3)), np.zeros(count, bool))
        for e in np.ndindex(self.elements):
            t, gap, last = np.full((count, 2), 0.5), np.zeros(count), np.full(count, np.inf)
            with np.errstate(all="ignore"):
                for _ in range(ITERATIONS):
                    moving = np.flatnonzero(~(last < 1e-13))
                    if not len(moving):
                        break
                    step = self.step(e, t[moving], gap[moving], x[moving])
                    t[moving] = np.clip(t[moving] + step[:, :2], -3.0, 4.0)
                    gap[moving] += step[:, 2]
                    last[moving] = np.abs(step).max(axis=1)
                normal = self.at(self.normals, e, t)[0]
                normal /= np.linalg.norm(normal, axis=1)[:, None]
                here = np.all((t >= 0.0) & (t <= 1.0), axis=1) & (last < 1e-12)
                here &= (gap <= 0.1 * size) & (gap >= -0.5 * size) & (-(normal * across).sum(axis=1) > 0.2)
                here &= np.abs(gap) < np.abs(best.gap)
            best.element[here], best.t[here], best.gap[here] = e, t[here], gap[here]
            best.normal[here], best.found[here] = normal[here], True
        return best

    def step(self, e: tuple[int, ...], t: FloatArray, gap: FloatArray, x: FloatArray) -> FloatArray:
        """Newton's step of feet in element e, shape (points, 3): coordinates, each by at most 1, and gap."""
        s, first, second = self.at(self.nodes, e, t)
        m, *slopes = self.at(self.normals, e, t)
        length = np.linalg.norm(m, axis=1)[:, None]
        normal = m / length
        turned = [(slope - (slope * normal).sum(axis=1)[:, None] * normal) / length for slope in slopes]
        matrix = np.stack([first - gap[:, None] * turned[0], second - gap[:, None] * turned[1], -normal], axis=2)
        step = np.linalg.solve(matrix, (x - s + gap[:, None] * normal)[..., None])[..., 0]
        return step / np.maximum(1.0, np.abs(step[:, :2]).max(axis=1))[:, None]

    def values(self, field: FloatArray, feet: Feet, kind: int = 0) -> FloatArray:
        """A field of the nodes at the feet, or its derivative along the first or second direction, shape (points, 3); zero without one."""
        found = np.zeros((len(feet.found), 3))
        for e in np.ndindex(self.elements):
            here = feet.found & np.all(feet.element == e, axis=1)
            found[here] = self.at(field, e, feet.t[here])[kind]
        return found


def uneven(order: int, place: str, elements: int) -> tuple[Equilibrium, FloatArray]:
    """A bowl of so many elements by direction in an uneven master."""
    problem = Scene.from_toml(_SCENE.format(order=order, elements=elements)).problem()
    contact = replace(problem.contacts[0], projection="averaged")
    equilibrium = Equilibrium(replace(problem, contacts=(contact,), settings=replace(problem.settings, method="uzawa")), Ledger())
    numbering = equilibrium.numbering
    positions = numbering.reference + UNEVEN[order] * np.random.default_rng(1).standard_normal(numbering.reference.shape)
    positions[numbering.points["slave"]] += MOVED[place]
    return equilibrium, positions


class Placed:
    """A bowl in an uneven master; slips count from somewhere near the feet, at some points from nowhere."""

    def __init__(self, order: int, place: str) -> None:
        equilibrium, self.positions = uneven(order, place, 4)
        problem, numbering, random = equilibrium.problem, equilibrium.numbering, np.random.default_rng(2)
        (contact,) = problem.contacts
        self.pair, self.order = equilibrium.pairs[0], order
        slave, master = problem.body("slave").patch, problem.body("master").patch
        self._lines = [direction.boundaries for direction in master.face_directions("w1")]
        self._net = numbering.points["master"][master.face_points("w1")].reshape(-1, order * (len(self._lines[0]) - 1) + 1)
        self.points = numbering.points["slave"][slave.face_points("w0")]
        self.functions, self.area = areas(problem)
        coordinates = [d.boundaries[:-1, None] + np.diff(d.boundaries)[:, None] * (np.polynomial.legendre.leggauss(n)[0] + 1.0) / 2.0
                       for d, n in zip(slave.face_directions("w0"), contact.quadrature, strict=True)]  # fmt: skip
        one, two = coordinates
        grid = np.stack(np.broadcast_arrays(one[None, :, None, :], two[:, None, :, None]), axis=-1).reshape(-1, 2)
        self.slopes = Surface(slave, "w0").functions(grid)[1:]
        self.now = self.master(self.positions).feet(*self.slave(self.positions)[:2])
        n, had = len(self.points), (random.uniform(size=len(self.area)) < 0.8) & self.now.found
        before = Feet(self.now.element, random.uniform(0.0, 1.0, self.now.t.shape), self.now.gap, self.now.normal, had)
        self.before = before
        self.start = ContactState(np.zeros(n), np.zeros((n, 2)), self.xi(before), had.astype(np.int32))

    def master(self, positions: FloatArray) -> Master:
        """The master's face."""
        return Master(self.order, positions[self._net])

    def slave(self, positions: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The slave's points, its normals, and its tangents, shape (points, 2, 3)."""
        first, second = (slope @ positions[self.points] for slope in self.slopes)
        across = -np.cross(first, second)  # of a face at the start of its direction
        return self.functions @ positions[self.points], across / np.linalg.norm(across, axis=1)[:, None], np.stack([first, second], axis=1)

    def xi(self, feet: Feet) -> FloatArray:
        """Coordinates of feet on the face; zero without one."""
        columns = [line[feet.element[:, a]] + feet.t[:, a] * np.diff(line)[feet.element[:, a]] for a, line in enumerate(self._lines)]
        return np.where(feet.found[:, None], np.column_stack(columns), 0.0)

    def integral(self, field: FloatArray, squared: bool = False) -> FloatArray:
        """Integrals over all points of a field times each function, or its square: shape (control points, ...)."""
        functions = self.functions**2 if squared else self.functions
        return np.einsum("q,qi,q...->i...", self.area, functions, field)


_ROUND_OFF = Bound(at_most=1e-11, reason="round-off: sums of some hundred products; the search here stops where nothing moves")
_QUADRATURE = Bound(
    at_most=1e-4,
    reason="quadrature: one Gauss point more than the orders together, on the way from foot to foot; unit normals are no polynomials",
)
_DIFFERENCES = Bound(
    at_most=1e-8, reason="discretisation: central differences of the unit normals, whose third derivatives are some hundred"
)


def bounds(order: int, place: str) -> dict[str, Bound]:  # noqa: ARG001
    """Round-off for what is integrated, differences for what is varied; that points are, or are not, beyond the edge."""
    beyond = "definition: points beyond the edge are tested, or there are none"
    there = Bound(at_least=50.0, reason=beyond) if place == "over the rim" else Bound(0.0, 0.0, beyond)
    integrated = dict.fromkeys(("xi", "weight", "square", "gap", "slip", "metric"), _ROUND_OFF) | {"climb": _QUADRATURE}
    return integrated | {"excluded": Bound(0.0, 0.0, "definition: the same points have a foot"), "beyond": there, "work": _DIFFERENCES}


@case(
    claim="Along averaged normals feet, gaps, slips and weights are what their definition says, and forces do the work of pressures along "
    "the normal and of tractions in the slave's basis.",
    tier=lambda order, place: "gate" if (order == 2) == (place == "inside") else "nightly",
    grid={"order": (1, 2), "place": tuple(MOVED)},
    bounds=bounds,
)
def averaged(order: int, place: str) -> dict[str, float]:
    """Largest differences over the largest value; points without a foot; work over the sum of forces, of all patterns of multipliers."""
    it = Placed(order, place)
    kinematics = it.pair.kinematics(it.positions, it.start)
    control, projections, now = kinematics.control, kinematics.projections, it.now
    master, (_, _, tangents) = it.master(it.positions), it.slave(it.positions)
    metric = tangents @ tangents.swapaxes(1, 2)
    dual = np.linalg.solve(metric, tangents).astype(np.float64)
    way = (master.values(master.nodes, now) - master.values(master.nodes, it.before)) * (it.before.found & now.found)[:, None]
    weight = it.integral(np.ones(len(it.area)))
    near = it.integral(now.found.astype(float)) > 0
    return {
        "xi": float(np.abs(projections.xi - it.xi(now))[now.found].max()),
        "weight": relative(control.weight, np.where(near, weight, 0.0)),
        "square": relative(control.square, it.integral(np.ones(len(it.area)), squared=True)),
        "gap": relative(control.gap, it.integral(np.where(now.found, now.gap, 0.0))),
        "slip": relative(control.slip, it.integral(np.einsum("qak,qk->qa", dual, way))),
        "metric": relative(control.metric, it.integral(metric[:, [0, 0, 1], [0, 1, 1]], squared=True)),
        "climb": relative(find_climbs(it.pair.pair.slave, it.pair.pair.master, it.positions, projections), climbs(it, master)),
        "excluded": float(np.count_nonzero((projections.found > 0) != now.found)),
        "beyond": float(np.count_nonzero(~now.found)),
        "work": work(it, dual),
    }


def climbs(it: Placed, master: Master) -> FloatArray:
    """Integrals of the unit normal over the straight way, in coordinates, between two feet in the same element; 0 without a slip."""
    (points, weights), way = np.polynomial.legendre.leggauss(16), it.now.t - it.before.t
    total = np.zeros(len(way))
    for point, weight in zip(0.5 * (points + 1.0), 0.5 * weights, strict=True):
        there = replace(it.now, t=it.before.t + point * way)
        normal = master.values(master.normals, there)
        for axis in (0, 1):
            slope = master.values(master.nodes, there, 1 + axis)
            total += weight * way[:, axis] * (normal * slope).sum(axis=1) / np.where(it.now.found, np.linalg.norm(normal, axis=1), 1.0)
    return total * (it.now.found & it.before.found)


def work(it: Placed, dual: FloatArray) -> float:
    """Largest difference of the forces' work along a random change of positions from that of pressures and tractions."""
    along = np.random.default_rng(4).standard_normal(it.positions.shape)
    now, n = it.now, len(it.points)
    kinematics = it.pair.kinematics(it.positions, it.start)

    def units(positions: FloatArray) -> FloatArray:
        master = it.master(positions)
        m = master.values(master.normals, now)
        return m / np.where(now.found, np.linalg.norm(m, axis=1), 1.0)[:, None]

    turned = (units(it.positions + STEP * along) - units(it.positions - STEP * along)) / (2.0 * STEP)
    moved = it.functions @ along[it.points] - it.master(it.positions).values(along[it._net], now)
    apart = (moved + np.where(now.found, now.gap, 0.0)[:, None] * turned) * now.found[:, None]
    by_gap, by_slip = it.integral(-(now.normal * apart).sum(axis=1)), it.integral(np.einsum("qak,qk->qa", dual, apart))
    errors = []
    for pattern in PATTERNS:
        response = response_of(pattern, n, len(it.area))
        forces = np.zeros_like(it.positions)
        it.pair.add_forces(it.positions, kinematics, response, forces)
        expected = (response.state > 0) @ (response.pressure * by_gap + (response.traction * by_slip).sum(axis=1))
        errors.append(abs(float((forces * along).sum() - expected)) / float(np.abs(forces).sum()))
    return max(errors)
