"""The tangent along averaged normals: exact in every part, at next to lines and corners of the master, over its rim, and turned about."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from small_scenes import at_few_points
from tangents.kinks import _SCENE
from tangents.placed import placed

from isomortar._bindings import FaceArrays
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.harness.cases import Tier
from isomortar.harness.tangents import BOUND, PARTS, measure
from isomortar.harness.visits import PairVisit, Visit
from isomortar.model.entities import Problem, SymmetryPlane
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import ContactState
from isomortar.solve.timing import Ledger

#: Family and order of the master.
MASTERS = {"L1": ("L", 1), "L2": ("L", 2), "L3": ("L", 3), "N1": ("N", 1), "N2": ("N", 2), "N3": ("N", 3)}
#: How uneven the master is, by order: linear ones are flat otherwise.
UNEVEN = {1: 0.03, 2: 0.007, 3: 0.004}
#: Trial pressures (shares of the largest) and lengths of trial tractions (shares of the cone), given to the control points in turn.
STATES = {
    "frictionless": ((-1.0, 1.0, 0.7), (0.0,)),
    "stick": ((1.0, 0.7), (0.5, 0.9)),
    "slip": ((1.0, 0.7), (1.2, 2.0)),
    "mixed": ((-1.0, 1.0, 0.7), (0.0, 0.5, 2.0)),
}
#: Where the bowl is: deep and with gaps; slid by half an element both ways; a part of it over the master's edge, or over an edge with a
#: mirror image beyond it; a point at next to a line, or a corner of elements.
PLACES = (
    "inside",
    "from elements beside",
    "over the rim",
    "over a mirror",
    "line: before",
    "line: behind",
    "corner: before",
    "corner: behind",
)
#: Where the bowl is over the master's lines before it slides: in the middle of its elements, or, along the second direction, beside them.
MIDDLE, ACROSS = "centre = [0.03, 0.02]", "centre = [0.03, 0.1]"
#: How far from a line, as a share of an element; and lengths of directions, of which some hundredths are off there.
OFF, SHORT = 1e-8, 1e-6
#: How much nearer than that a point is put to where it is wanted.
SETTLED = 1e-3
#: Parts that there are: pressures are not conservative, and tractions work in the slave's basis.
ALONG = tuple(part for part in PARTS if part not in ("symmetry", "tangential, projection"))


@dataclass(frozen=True)
class Posed:
    """A pair in its place: problem, equilibrium with room for the whole tangent, positions, and where slips count from."""

    problem: Problem
    equilibrium: Equilibrium
    positions: FloatArray
    start: ContactState

    @property
    def xi(self) -> FloatArray:
        """Master coordinates of all quadrature points."""
        return self.equilibrium.pairs[0].kinematics(self.positions, self.start).projections.xi

    def moved(self, shift: FloatArray) -> Posed:
        """The slave moved."""
        positions = self.positions.copy()
        positions[self.equilibrium.numbering.points["slave"]] += shift
        return replace(self, positions=positions)


def posed(master: str, place: str, friction: float) -> Posed:
    """The bowl in an uneven master, slid from where it was."""
    family, order = MASTERS[master]
    scene = _SCENE.format(order=order, elements=3).replace('"L"', f'"{family}"').replace("friction = 0.3", f"friction = {friction}")
    if place == "from elements beside":
        assert MIDDLE in scene
        scene = scene.replace(MIDDLE, ACROSS)  # elsewhere its elements begin on the master's, and all points of one come from one
    problem = at_few_points(Scene.from_toml(scene).problem())
    problem = replace(
        problem,
        contacts=(replace(problem.contacts[0], projection="averaged"),),
        settings=replace(problem.settings, method="uzawa"),
    )
    if place == "over a mirror":
        problem = replace(problem, symmetry=(SymmetryPlane(0, 0.7),))
    equilibrium = Equilibrium(problem, Ledger())
    state = equilibrium.initial_state()
    uneven = np.random.default_rng(1).standard_normal(state.positions.shape)
    pose = Posed(problem, equilibrium, state.positions + UNEVEN[order] * uneven, state.contacts[0])
    slid = {"over the rim": (0.45, 0.03), "over a mirror": (0.45, 0.03), "from elements beside": (0.1, 0.13)}.get(place, (0.07, 0.03))
    pose = pose.moved(np.array([*slid, -0.02]))
    if ":" not in place:
        return pose
    side = OFF if place.endswith("behind") else -OFF
    return beside(pose, side, (0, 1) if place.startswith("corner") else (1,))


def beside(pose: Posed, off: float, directions: tuple[int, ...]) -> Posed:
    """The slave moved along the master until the point in its middle is `off` (in elements) from lines in these directions."""
    lines = [direction.boundaries for direction in pose.problem.body("master").patch.face_directions("w1")]
    xi = pose.xi
    q = int(np.argmin(np.abs(xi - 0.5).sum(axis=1)))
    target = xi[q].copy()
    for a in directions:
        inner = lines[a][1:-1]
        target[a] = inner[np.argmin(np.abs(inner - target[a]))] + off * np.diff(lines[a]).min()
    left, step = target - xi[q], 1e-7
    slopes = np.column_stack([(pose.moved(step * axis).xi[q] - xi[q]) / step for axis in np.eye(3)[:2]])
    for _ in range(30):
        pose = pose.moved(np.append(np.linalg.solve(slopes, left), 0.0))
        left = target - pose.xi[q]
        if np.abs(left).max() < SETTLED * abs(off):
            break
    return pose


def bounds(master: str, place: str, state: str) -> dict[str, Bound]:  # noqa: ARG001
    """A bound for every part that a state has, for the balances, and that the place is what it is called."""
    absent: dict[str, tuple[str, ...]] = {
        "frictionless": (*(part for part in ALONG if part.startswith("tangential")), "stick", "slip", "multipliers"),
        "stick": ("slip",),
        "slip": ("stick",),
    }
    twin = Bound(at_most=BOUND, reason="round-off: products of double precision against differences of a twin in extended precision")
    balance = Bound(at_most=1e-12, reason="round-off: both sides' forces are opposite, and act along the way from point to foot")
    placed_right = Bound(at_least=1.0, reason="definition: a part is tested only where it acts")
    return (
        {part: twin for part in ALONG if part not in absent.get(state, ())}
        | dict.fromkeys(("forces",) if place == "over a mirror" else ("forces", "moments"), balance)  # its moments are the whole's
        | {"there": placed_right}
    )


def tier(master: str, place: str, state: str) -> Tier:
    """The gate has every place and state, and masters up to N3, not all of their products.

    Of lines and corners of curved elements it has one side each, and of states that where points stick beside others that slip.
    """
    chosen = (master == "L1" and place == "inside") or (master in ("L1", "L2") and state == "mixed")
    spared = master == "L3" or (master == "L2" and place in ("line: behind", "corner: before"))
    return "gate" if (chosen or (place, state) == ("inside", "mixed")) and not spared else "nightly"


@case(
    claim="Along averaged normals every part of the tangent is exact, whatever the master, the place and the state, and contact forces and "
    "moments are in balance.",
    tier=tier,
    grid={"master": tuple(MASTERS), "place": PLACES, "state": tuple(STATES)},
    bounds=bounds,
)
def averaged(master: str, place: str, state: str) -> dict[str, float]:
    """Largest relative error of each part and of the balances; how many points are over the rim, or next to the line."""
    pose = posed(master, place, 0.0 if state == "frictionless" else 0.3)
    pair = pose.equilibrium.pairs[0]
    n = len(pair.pair.slave.point)
    law = pair.law(np.array([20.0, 10.0]), np.zeros(n), np.zeros((n, 2)))
    pressure, length = (np.resize(np.array(pattern), n) for pattern in STATES[state])
    visit = placed(pair, pose.positions, PairVisit(pose.start, law), pressure, length)
    kinematics = pair.kinematics(pose.positions, pose.start)
    result = pair.result(pose.positions, kinematics, pair.respond(kinematics, visit.law), np.zeros(2))
    report = measure(pose.problem, 1, [Visit(pose.positions, (visit,))], directions=1, length=SHORT if ":" in place else 1e-3)
    sums = (result.force_slave, result.force_master), (result.moment_slave, result.moment_master)
    forces, moments = (float(np.abs(slave + main).max() / np.abs(slave).max()) for slave, main in sums)
    errors = {row.part: row.error for row in report.rows}
    whole = {} if place == "over a mirror" else {"moments": moments}
    return errors | {"forces": forces, "there": there(pose, place)} | whole


def there(pose: Posed, place: str) -> float:
    """Points without a foot, elements that points of a slave's came from beside the first, points at next to a line, or with a foot.

    Points of one slave element that are in one of the master, and came from others that differ in one direction alone, count; of both
    directions that with fewer.
    """
    pair = pose.equilibrium.pairs[0]
    projections = pair.kinematics(pose.positions, pose.start).projections
    if place == "over the rim":
        return float(np.count_nonzero(projections.found == 0))
    if place == "over a mirror":
        assert isinstance(pair.pair.master, FaceArrays)
        beside_it = projections.xi[:, 0] > pair.pair.master_boundaries[0][-2]
        return float(np.count_nonzero(projections.found[beside_it]) * np.array_equal(pair.pair.master.mirror, [[0, 1], [0, 0]]))
    if place == "inside":
        return float(np.count_nonzero(projections.found))
    lines = [direction.boundaries for direction in pose.problem.body("master").patch.face_directions("w1")]
    if place == "from elements beside":
        now, then = (
            np.column_stack([np.searchsorted(line, x) for x, line in zip(xi.T, lines, strict=True)])
            for xi in (projections.xi, pose.start.projection)
        )
        slides = (projections.found > 0) & (projections.slips > 0)
        own = np.arange(len(now)) // pair.pair.slave.per_element
        kept = (np.column_stack([own, now, then[:, 1 - a]])[slides] for a in range(2))
        parted = [
            len(np.unique(np.column_stack([rows, then[slides, a]]), axis=0)) - len(np.unique(rows, axis=0)) for a, rows in enumerate(kept)
        ]
        return float(min(parted))
    near = [
        np.abs(xi[:, None] - line).min(axis=1) < 2.0 * OFF * np.diff(line).min() for xi, line in zip(projections.xi.T, lines, strict=True)
    ]
    return float(np.count_nonzero(near[0] & near[1] if place.startswith("corner") else near[1]))
