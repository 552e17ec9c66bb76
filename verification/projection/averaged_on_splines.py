"""Averaged normals on splines with weights, and graded or repeated knots, against their definition, written down anew with SciPy's."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from friction.virtual_work import Surface, areas, relative

from isomortar._bindings import find_climbs
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.harness import Bound, case
from isomortar.model.entities import Body, Contact, Face, Material, Problem
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import ContactState
from isomortar.solve.timing import Ledger

#: Inner knots of both directions: elements of very different lengths, with abscissae near their bounds; the first of them a kink
#: where the mean of three knots is not the knot, by round-off, but beyond it or before. Of many, ways cross more than there are in one.
INNER = {
    "graded": ([0.02, 0.1, 0.5], [0.6, 0.9, 0.97]),
    "kinks": ([0.1, 0.3, 0.6], [0.7, 0.85]),
    "many": ([0.05, 0.15, 0.35, 0.5, 0.6, 0.7, 0.9], [0.1, 0.2, 0.4, 0.55, 0.65, 0.8, 0.95]),
}
#: What is beside a line: so far from it, as a share of the face.
BESIDE = 1e-13


def _direction(order: int, inner: list[float], kink: bool = False) -> Direction:
    first = [inner[0]] * (order if kink else 1)
    return Direction("N", order, np.array([0.0] * (order + 1) + first + inner[1:] + [1.0] * (order + 1)))


def greville(direction: Direction) -> FloatArray:
    """Means of the knots between the ends of each function, shape (functions,)."""
    means = np.convolve(direction.knots[1:-1], np.full(direction.order, 1.0 / direction.order), "valid")
    return np.asarray(means)


def block_over_splines(order: int, knots: str) -> Problem:
    """A block over a hilly master with weights of its own."""
    one, two = (_direction(order, inner, knots == "kinks") for inner in INNER[knots])
    line, random = Direction("N", 1, np.repeat([0.0, 1.0], 2)), np.random.default_rng(5)
    x, y, z = (a.ravel(order="F") for a in np.meshgrid(greville(one), greville(two), [-1.0, 0.0], indexing="ij"))
    hills = np.where(z < 0.0, 0.0, 0.01 * random.standard_normal(x.shape) + 0.1 * np.sin(4.0 * x + 1.0) * np.cos(3.0 * y))
    master = Patch((one, two, line), np.column_stack([x, y, z + hills]), np.exp(random.uniform(-0.2, 0.2, x.shape)))
    curve = _direction(2, [0.2, 0.5])
    x, y, z = (a.ravel(order="F") for a in np.meshgrid(greville(curve), greville(curve), [0.05, 0.3], indexing="ij"))
    slave = Patch((curve, curve, line), np.column_stack([0.03 + 0.94 * x, 0.03 + 0.94 * y, z]), np.ones(x.shape))
    bodies = tuple(Body(name, patch, Material(), (3, 3, 2)) for name, patch in (("slave", slave), ("master", master)))
    contact = Contact("interface", Face("slave", "w0"), Face("master", "w1"), 0.3, (4, 4), projection="averaged")
    return Problem("splines", bodies, (contact,), (), ())


def slave_tangents(patch: Patch, points: FloatArray, counts: tuple[int, int]) -> FloatArray:
    """Tangents of the slave's face w0 at its quadrature points, shape (points, 2, 3)."""
    one, two = (
        d.boundaries[:-1, None] + np.diff(d.boundaries)[:, None] * (np.polynomial.legendre.leggauss(n)[0] + 1.0) / 2.0
        for d, n in zip(patch.face_directions("w0"), counts, strict=True)
    )
    grid = np.stack(np.broadcast_arrays(one[None, :, None, :], two[:, None, :, None]), axis=-1).reshape(-1, 2)
    return np.stack([functions @ points for functions in Surface(patch, "w0").functions(grid)[1:]], axis=1)


class Master:
    """The master's face by another algorithm: every element, every point."""

    def __init__(self, patch: Patch, points: FloatArray) -> None:
        self.surface, self.points = Surface(patch, "w1"), points
        self.lines = [direction.boundaries for direction in patch.face_directions("w1")]
        one, two = ([self._sides(a, u) for u in greville(d)] for a, d in enumerate(patch.face_directions("w1")))
        sums = [sum(self.across(np.array([[u, v]]))[0] for u in at_u for v in at_v) for at_v in two for at_u in one]
        self.normals = np.array([total / np.linalg.norm(total) for total in sums])

    def _sides(self, axis: int, u: float) -> list[float]:
        """Coordinates on both sides of an inner line, or the one that is given."""
        on_line = np.abs(self.lines[axis][1:-1] - u) < BESIDE
        return [u - BESIDE, u + BESIDE] if on_line.any() else [u]

    def across(self, xi: FloatArray) -> FloatArray:
        """Unit normals of the surface itself, shape (points, 3)."""
        _, first, second = (functions @ self.points for functions in self.surface.functions(xi))
        normal = np.cross(first, second)
        return np.asarray(normal / np.linalg.norm(normal, axis=1)[:, None])

    def feet(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Coordinates, NaN without one, and gaps of the feet of some points: of those in all elements the smallest gap."""
        xi, gap = np.full((len(x), 2), np.nan), np.full(len(x), np.inf)
        for e in np.ndindex(*(len(line) - 1 for line in self.lines)):
            low, high = (np.array([line[k + i] for line, k in zip(self.lines, e, strict=True)]) for i in (0, 1))
            there, found, settled = self._newton(x, low, high)
            here = settled & (np.abs(found) < np.abs(gap))
            xi[here], gap[here] = there[here], found[here]
        return xi, gap

    def _newton(self, x: FloatArray, low: FloatArray, high: FloatArray) -> tuple[FloatArray, FloatArray, np.ndarray]:
        """Coordinates in one element, gaps, and at which points Newton's method has found them; steps end at the bounds."""
        xi, gap = np.tile(0.5 * (low + high), (len(x), 1)), np.zeros(len(x))
        inside = 1e-9 * (high - low)  # splines of the next element are others
        for _ in range(40):
            functions = self.surface.functions(np.clip(xi, low + inside, high - inside))
            s, *tangents = (f @ self.points for f in functions)
            m, *slopes = (f @ self.normals for f in functions)
            length = np.linalg.norm(m, axis=1)[:, None]
            normal = m / length
            turned = [(slope - (slope * normal).sum(axis=1)[:, None] * normal) / length for slope in slopes]
            sides = [tangent - gap[:, None] * turn for tangent, turn in zip(tangents, turned, strict=True)]
            step = np.linalg.solve(np.stack([*sides, -normal], axis=2), (x - s + gap[:, None] * normal)[..., None])[..., 0]
            xi, gap = np.clip(xi + step[:, :2], low, high), gap + step[:, 2]
        return xi, gap, np.abs(step).max(axis=1) < 1e-10

    def climb(self, start: FloatArray, end: FloatArray) -> float:
        """Integral of the unit normal over the straight way, in coordinates, between two feet: piece by piece between lines."""
        way = end - start
        cuts = [((line - s) / w).tolist() for line, s, w in zip(self.lines, start, way, strict=True) if abs(w) > 0.0]
        shares = sorted({0.0, 1.0, *(cut for axis in cuts for cut in axis if 0.0 < cut < 1.0)})
        points, weights = np.polynomial.legendre.leggauss(16)
        total = 0.0
        for left, right in pairwise(shares):
            functions = self.surface.functions(start + (left + (right - left) * 0.5 * (points + 1.0))[:, None] * way)
            normal = functions[0] @ self.normals
            along = way[0] * (functions[1] @ self.points) + way[1] * (functions[2] @ self.points)
            total += float((right - left) * 0.5 * weights @ ((normal * along).sum(axis=1) / np.linalg.norm(normal, axis=1)))
        return total


@case(
    claim="Along averaged normals of splines whose weights differ, with graded knots and with kinks, feet, gaps, slips and climbs over "
    "many elements are what their definition says.",
    grid={"order": (2, 3), "knots": list(INNER)},
    bounds={
        "xi": Bound(at_most=1e-12, reason="round-off: normals beside a line are evaluated 1e-13 from it; steps converge quadratically"),
        "gap": Bound(at_most=1e-12, reason="round-off: likewise"),
        "slip": Bound(at_most=1e-12, reason="round-off: likewise, of where feet are now, and were, by the functions alone"),
        "metric": Bound(at_most=1e-12, reason="round-off: of the slave's own tangents, wherever feet are"),
        "climb": Bound(at_most=1e-4, reason="quadrature: one Gauss point more than the orders together; unit normals are no polynomials"),
        "excluded": Bound(0.0, 0.0, "definition: the same points have a foot"),
        "elements": Bound(at_least=8.0, reason="definition: feet are in many elements, or little is compared"),
    },
)
def averaged_on_splines(order: int, knots: str) -> dict[str, float]:
    """Largest differences over the largest value; points that one alone has a foot for; elements that have one."""
    problem = block_over_splines(order, knots)
    equilibrium = Equilibrium(problem, Ledger())
    (pair,), numbering = equilibrium.pairs, equilibrium.numbering
    functions, area = areas(problem)
    slave, patch = problem.body("slave").patch, problem.body("master").patch
    own = numbering.reference[numbering.points["slave"][slave.face_points("w0")]]
    x = functions @ own
    master = Master(patch, numbering.reference[numbering.points["master"][patch.face_points("w1")]])
    before = np.random.default_rng(6).uniform(0.0, 1.0, (len(x), 2))
    n = len(pair.pair.slave.point)
    start = ContactState(np.zeros(n), np.zeros((n, 2)), before, np.ones(len(x), dtype=np.int32))
    kinematics = pair.kinematics(numbering.reference, start)
    xi, gap = master.feet(x)
    found = np.isfinite(gap)  # where the master falls away beside its edge there may be none
    tangents = slave_tangents(slave, own, problem.contacts[0].quadrature)
    metric = tangents @ tangents.swapaxes(1, 2)
    now, then = (master.surface.functions(place)[0] @ master.points for place in (np.where(found[:, None], xi, before), before))
    slips = np.linalg.solve(metric, (tangents @ (now - then)[..., None]))[..., 0]
    climbs = np.array([master.climb(old, new) if there else 0.0 for old, new, there in zip(before, xi, found, strict=True)])
    places = np.column_stack([np.searchsorted(line, column[found]) for line, column in zip(master.lines, xi.T, strict=True)])
    return {
        "xi": float(np.abs(kinematics.projections.xi - xi)[found].max()),
        "gap": relative(kinematics.control.gap, functions.T @ (area * np.where(found, gap, 0.0))),
        "slip": relative(kinematics.control.slip, functions.T @ (area[:, None] * slips)),
        "metric": relative(kinematics.control.metric, (functions**2).T @ (area[:, None] * metric[:, [0, 0, 1], [0, 1, 1]])),
        "climb": relative(find_climbs(pair.pair.slave, pair.pair.master, numbering.reference, kinematics.projections), climbs),
        "excluded": float(np.count_nonzero((kinematics.projections.found > 0) != found)),
        "elements": float(len(np.unique(places, axis=0))),
    }
