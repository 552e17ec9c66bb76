"""Contact integrals against their definition, written down anew with SciPy's splines: nothing of the kernel is in what it is compared with.

Gaps and coordinates of the foot come from a closest-point search of its own, their variations from differences of that; the geometric
tangent is compared with differences of the forces.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import BSpline
from small_scenes import bowl

from isomortar._bindings import Response
from isomortar.geometry.patch import FloatArray, Patch
from isomortar.harness import Bound, case
from isomortar.harness.tangents import row_product
from isomortar.model.entities import Problem, RigidPlane
from isomortar.solve.contact import Kinematics
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import ContactState
from isomortar.solve.system import block_product
from isomortar.solve.timing import Ledger

#: Steps of the differences, of points of size one, with their shares: of fourth order.
STEPS = {sign * size * 2e-5: sign * share / (12.0 * 2e-5) for sign in (1.0, -1.0) for size, share in ((1.0, 8.0), (2.0, -1.0))}
MASTERS = ("block", "edge", "plane", "oblique plane")
#: A plane whose normal and tangent are neither of length one nor at right angles.
OBLIQUE = RigidPlane((0.1, -0.2, 0.01), (0.2, -0.1, 2.0), (0.7, 1.9, 0.8))


class Surface:
    """A face of a patch as a tensor product of SciPy's splines."""

    def __init__(self, patch: Patch, face: str) -> None:
        self._lines = [(BSpline(d.knots, np.eye(d.count), d.order), d.knots[[0, -1]]) for d in patch.face_directions(face)]
        self._weights = patch.weights[patch.face_points(face)]

    def functions(self, xi: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Rational functions and their derivatives along both directions, each of shape (points, functions)."""
        (one, _), (two, _) = self._lines
        values, slopes = (one(xi[:, 0]), two(xi[:, 1])), (one.derivative()(xi[:, 0]), two.derivative()(xi[:, 1]))
        kinds = [
            np.einsum("qi,qj->qji", a, b).reshape(len(xi), -1) * self._weights
            for a, b in (values, (slopes[0], values[1]), (values[0], slopes[1]))
        ]
        total, first, second = (kind.sum(axis=1)[:, None] for kind in kinds)
        return kinds[0] / total, (kinds[1] - kinds[0] * first / total) / total, (kinds[2] - kinds[0] * second / total) / total

    def inside(self, xi: FloatArray) -> np.ndarray:
        """Which coordinates are on the face."""
        return np.all([(low <= x) & (x <= high) for x, (_, (low, high)) in zip(xi.T, self._lines, strict=True)], axis=0)

    def grid(self, count: int) -> FloatArray:
        """Coordinates all over the face."""
        lines = [np.linspace(low, high, count) for _, (low, high) in self._lines]
        return np.stack(np.meshgrid(*lines), axis=-1).reshape(-1, 2)


@dataclass(frozen=True)
class Feet:
    """Coordinates, gap (positive: penetration), metric 11, 12, 22 of points' feet, and whether they are on the master."""

    xi: FloatArray
    gap: FloatArray
    metric: FloatArray
    found: np.ndarray


def on_plane(plane: RigidPlane, x: FloatArray) -> Feet:
    """Feet on a plane: lengths along its tangent, as far as that is in the plane, and across it."""
    normal = np.array(plane.normal) / np.linalg.norm(plane.normal)
    along = np.array(plane.tangent) - np.dot(plane.tangent, normal) * normal
    along /= np.linalg.norm(along)
    arm = x - np.array(plane.point)
    xi = np.column_stack([arm @ along, arm @ np.cross(normal, along)])
    return Feet(xi, -arm @ normal, np.tile([1.0, 0.0, 1.0], (len(x), 1)), np.ones(len(x), dtype=bool))


def on_surface(surface: Surface, points: FloatArray, x: FloatArray) -> Feet:
    """Feet on a surface with control points `points`: the nearest of a grid, then Gauss-Newton until nothing moves."""
    xi = surface.grid(41)
    grid = surface.functions(xi)[0] @ points
    xi = xi[np.argmin(((x[:, None, :] - grid) ** 2).sum(axis=2), axis=1)]
    for _ in range(60):
        foot, first, second = (functions @ points for functions in surface.functions(xi))
        tangents = np.stack([first, second], axis=1)
        metric = tangents @ tangents.swapaxes(1, 2)
        xi = xi + np.linalg.solve(metric, tangents @ (x - foot)[..., None])[..., 0]
    normal = np.cross(first, second)
    gap = -((x - foot) * normal).sum(axis=1) / np.linalg.norm(normal, axis=1)
    return Feet(xi, gap, metric[:, [0, 0, 1], [0, 1, 1]], surface.inside(xi))


def placed(master: str) -> tuple[Equilibrium, FloatArray]:
    """The bowl a little into its master, all control points shaken and with weights of their own; by the edge, beyond it."""
    random = np.random.default_rng(8)
    problem = bowl("block" if master in ("block", "edge") else "plane")
    bodies = tuple(
        replace(body, patch=replace(body.patch, weights=np.exp(random.uniform(-0.3, 0.3, body.patch.weights.shape))))
        for body in problem.bodies
    )
    if master == "oblique plane":
        problem = replace(problem, contacts=(replace(problem.contacts[0], master=OBLIQUE),))
    problem = replace(problem, bodies=bodies, settings=replace(problem.settings, method="uzawa"))
    equilibrium = Equilibrium(problem, Ledger())
    positions = equilibrium.numbering.reference + 0.004 * random.standard_normal(equilibrium.numbering.reference.shape)
    positions[equilibrium.numbering.points["slave"]] += [0.4 if master == "edge" else 0.03, 0.0, -0.02]
    return equilibrium, positions


def areas(problem: Problem) -> tuple[FloatArray, FloatArray]:
    """Functions of the slave face at its quadrature points, and their shares of the reference area."""
    (contact,) = problem.contacts
    patch = problem.body("slave").patch
    face = contact.slave.face
    coordinates, weights = [], []
    for direction, count in zip(patch.face_directions(face), contact.quadrature, strict=True):
        x, w = np.polynomial.legendre.leggauss(count)
        low, high = direction.boundaries[:-1, None], direction.boundaries[1:, None]
        coordinates.append(low + (high - low) * (x + 1.0) / 2.0)
        weights.append((high - low) / 2.0 * w)
    (one, two), (one_weight, two_weight) = coordinates, weights  # elements and the points in them: those of the first direction faster
    grid = np.stack(np.broadcast_arrays(one[None, :, None, :], two[:, None, :, None]), axis=-1).reshape(-1, 2)
    size = (one_weight[None, :, None, :] * two_weight[:, None, :, None]).ravel()
    functions, first, second = Surface(patch, face).functions(grid)
    points = patch.control_points[patch.face_points(face)]
    return functions, size * np.linalg.norm(np.cross(first @ points, second @ points), axis=1)


#: Multipliers: one in so many control points is active; whether there are pressures, first and second tractions.
PATTERNS: dict[str, tuple[int, int, int, int]] = {
    "all": (1, 1, 1, 1),
    "pressures alone": (1, 1, 0, 0),
    "first tractions alone": (1, 0, 1, 0),
    "second tractions alone": (1, 0, 0, 1),
    "tractions alone": (1, 0, 1, 1),
    "pressures and second tractions": (1, 1, 0, 1),
    "every second active": (2, 1, 1, 1),
    "pressures of every second": (2, 1, 0, 0),
    "every fifth active": (5, 1, 1, 1),
}


def response_of(pattern: str, n: int, points: int) -> Response:
    """Random multipliers in a pattern; inactive control points hold values that must not count."""
    random = np.random.default_rng(n)
    every, pressures, first, second = PATTERNS[pattern]
    state = np.where(np.arange(n) % every == 0, 1 + np.arange(n) % 2, 0).astype(np.int32)
    pressure = pressures * random.uniform(0.5, 1.5, n)
    traction = np.array([first, second]) * random.standard_normal((n, 2))
    return Response(pressure, traction, state, np.zeros(n), np.zeros((n, 6, 2)), np.zeros((points, 2)))


class Placed:
    """A placed pair with the feet of its quadrature points; slips count from somewhere near them, at some points from nowhere."""

    def __init__(self, master: str) -> None:
        equilibrium, self.positions = placed(master)
        self._problem, self._points = equilibrium.problem, equilibrium.numbering.points
        self.pair = equilibrium.pairs[0]
        (contact,) = self._problem.contacts
        self._master, self._slave = contact.master, self._points["slave"][self._problem.body("slave").patch.face_points("w0")]
        self.functions, self.area = areas(self._problem)
        random = np.random.default_rng(2)
        self.now = self.feet(self.positions)
        n, had = len(self._slave), (random.uniform(size=len(self.area)) < 0.8) & self.now.found
        origin = self.now.xi + 0.02 * random.standard_normal(self.now.xi.shape)
        self.start = ContactState(np.zeros(n), np.zeros((n, 2)), np.where(had[:, None], origin, 0.0), had.astype(np.int32))

    def feet(self, positions: FloatArray) -> Feet:
        """Feet of all quadrature points."""
        x = self.functions @ positions[self._slave]
        if isinstance(self._master, RigidPlane):
            return on_plane(self._master, x)
        patch = self._problem.body("master").patch
        points = self._points["master"][patch.face_points(self._master.face)]
        return on_surface(Surface(patch, self._master.face), positions[points], x)

    def integral(self, field: FloatArray, squared: bool = False) -> FloatArray:
        """Integrals of a field times each function, or its square, over the points that have a foot: shape (control points, ...)."""
        functions = self.functions**2 if squared else self.functions
        return np.einsum("q,qi,q...->i...", self.area * self.now.found, functions, field)


_ROUND_OFF = Bound(at_most=1e-11, reason="round-off: sums of some hundred products; the search here stops where nothing moves")
_DIFFERENCES = Bound(
    at_most=1e-8,
    reason="discretisation: differences of fourth order; the third derivatives of an order-3 master jump at its knot lines: STEP squared "
    "times a jump of some ten where a step crosses one; below it round-off over STEP",
)


def relative(one: FloatArray, other: FloatArray) -> float:
    """Largest difference over the largest value of the second."""
    return float(np.abs(one - other).max() / np.abs(other).max())


@case(
    claim="Control quantities are the integrals that they are named by, over the points that have a foot.",
    grid={"master": MASTERS},
    bounds=lambda master: (
        dict.fromkeys(("functions", "area", "weight", "square", "gap", "slip", "metric"), _ROUND_OFF)
        | {
            "excluded": Bound(0.0, 0.0, "definition: the same points have a foot"),
            "beyond": Bound(at_least=50.0, reason="definition: points beyond the edge are tested")
            if master == "edge"
            else Bound(0.0, 0.0, "definition: a plane has no edge, and the block is wider than the bowl"),
        }
    ),
)
def control_quantities(master: str) -> dict[str, float]:
    """Largest differences over the largest value; points without a foot."""
    it = Placed(master)
    kinematics = it.pair.kinematics(it.positions, it.start)
    control, slave = kinematics.control, it.pair.pair.slave
    element = np.repeat(slave.shape.nodes, slave.per_element, axis=0)
    one = np.ones(len(it.area))
    slips = (it.now.xi - it.start.projection) * (it.start.projected[:, None] > 0)
    return {
        "functions": relative(slave.shape.values, np.take_along_axis(it.functions, element, axis=1)),
        "area": relative(slave.area, it.area),
        "weight": relative(control.weight, it.integral(one)),
        "square": relative(control.square, it.integral(one, squared=True)),
        "gap": relative(control.gap, it.integral(it.now.gap)),
        "slip": relative(control.slip, it.integral(slips)),
        "metric": relative(control.metric, it.integral(it.now.metric, squared=True)),
        "excluded": float(np.count_nonzero((kinematics.projections.found > 0) != it.now.found)),
        "beyond": float(np.count_nonzero(~it.now.found)),
    }


@case(
    claim="Contact forces do the work of pressures on gaps and of tractions on coordinates, whichever of them act at whichever control "
    "points; constraint rows are the variations of the control quantities, the geometric tangent that of the forces.",
    grid={"master": MASTERS},
    bounds=lambda master: {name: _DIFFERENCES for name in ("work", "rows", "tangent") if name != "tangent" or "plane" not in master},
)
def virtual_work(master: str) -> dict[str, float]:
    """Largest relative differences over all patterns of multipliers, along a random change of all positions."""
    it = Placed(master)
    pair, n = it.pair, len(it.pair.pair.slave.point)
    along = np.random.default_rng(4).standard_normal(it.positions.shape)
    sides = [(share, it.feet(it.positions + step * along)) for step, share in STEPS.items()]
    gap, xi, metric = (np.sum([share * getattr(feet, name) for share, feet in sides], axis=0) for name in ("gap", "xi", "metric"))
    by_gap, by_xi, by_metric = it.integral(gap), it.integral(xi), it.integral(metric, squared=True)
    by_slip = it.integral(xi * (it.start.projected[:, None] > 0))
    kinematics = pair.kinematics(it.positions, it.start)
    near = {step: pair.kinematics(it.positions + step * along, it.start) for step in STEPS}
    law = pair.law(np.ones(2), np.zeros(n), np.zeros((n, 2)))
    found: dict[str, list[float]] = {"work": [], "rows": [], "tangent": []}
    for pattern in PATTERNS:
        response = response_of(pattern, n, len(it.area))
        active = response.state > 0

        def forces(positions: FloatArray, at: Kinematics, response: Response = response) -> FloatArray:
            total = np.zeros_like(positions)
            pair.add_forces(positions, at, response, total)
            return total

        expected = active @ (response.pressure * by_gap + (response.traction * by_xi).sum(axis=1))
        now = forces(it.positions, kinematics)
        found["work"].append(abs(float((now * along).sum() - expected)) / float(np.abs(now).sum()))
        blocks = pair.blocks(it.positions, kinematics, law, response)
        products = row_product(blocks.patterns.rows, blocks.rows, along)[active]
        wanted = np.column_stack([by_gap, by_xi, by_slip, by_metric])[active]
        size = np.abs(wanted).max(axis=0)
        found["rows"].append(float((np.abs(products - wanted).max(axis=0) / np.maximum(size, 1e-3 * size.max())).max()))
        change = np.sum([share * forces(it.positions + step * along, near[step]) for step, share in STEPS.items()], axis=0)
        product = block_product(blocks.patterns.tangent, blocks.geometric, along)
        if "plane" not in master:
            found["tangent"].append(relative(product, change))
    return {name: float(np.max(errors)) for name, errors in found.items() if errors}
