"""The tangent by state: open, closed, stick, slip, mixed, and on either side of the edges between them and of a knot line."""

from __future__ import annotations

import functools
from dataclasses import replace
from typing import Final

import numpy as np
from small_scenes import at_few_points, bowl
from tangents.placed import placed

from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.harness import Bound, case
from isomortar.harness.tangents import BOUND, PARTS, SYMMETRY_BOUND, PairTangent, measure
from isomortar.harness.visits import Visit, visited_states
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.solve.contact import PairMechanics
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.system import block_product
from isomortar.solve.timing import Ledger

#: How far from an edge of the active set, as a share of the pressures: a thousand times their round-off.
OFF = 1e-12
#: How far from a knot line, as a share of an element. The projection compares squared distances: closer by than about 1e-8 of the
#: distance it may stay on the line.
OFF_LINE = 1e-8
#: How much nearer than that a point is put to where it is wanted.
SETTLED = 1e-3
#: Length of the directions next to an edge: with the twin's step of 1e-11 no difference reaches across.
SHORT = 1e-6
#: The next number above the cone 0.5.
ABOVE = float(np.nextafter(0.5, 1.0))
STEP = 2

#: Trial pressures (shares of the largest) and lengths of trial tractions (shares of the cone), given to the control points in turn.
PLACED: Final[dict[str, tuple[tuple[float, ...], tuple[float, ...]]]] = {
    "open": ((-1.0,), (0.0,)),
    "closed": ((1.0,), (0.0,)),  # without friction
    "stick": ((1.0, 0.7), (0.5, 0.9)),
    "slip": ((1.0, 0.7), (1.2, 2.0)),
    "mixed": ((-1.0, 1.0, 0.7), (0.0, 0.5, 2.0)),
    "open | closed: open": ((-OFF, 1.0, 1.0, -1.0), (0.0, 0.5, 2.0, 0.0)),
    "open | closed: closed": ((OFF, 1.0, 1.0, -1.0), (0.5, 0.5, 2.0, 0.0)),
    "stick | slip: stick": ((1.0, 0.7, 1.0, -1.0), (1.0 - OFF, 0.5, 2.0, 0.0)),
    "stick | slip: slip": ((1.0, 0.7, 1.0, -1.0), (1.0 + OFF, 0.5, 2.0, 0.0)),
}
KNOT_LINE: Final = {"knot line: before": -OFF_LINE, "knot line: behind": OFF_LINE}
STATES = (*PLACED, *KNOT_LINE)

FRICTIONLESS = ("solid", "normal, geometric", "normal, gap", "normal, pressure", "whole", "symmetry")
#: Parts that a state lacks.
ABSENT: Final[dict[str, tuple[str, ...]]] = {
    "open": tuple(part for part in PARTS if part not in ("solid", "whole", "symmetry")),
    "closed": tuple(part for part in PARTS if part not in FRICTIONLESS),
    "stick": ("slip",),
    "slip": ("stick",),
}
_ROUND_OFF = "round-off: products of double precision against differences of a twin in extended precision"


@functools.cache
def scene(friction: float) -> tuple[Problem, Equilibrium, Visit]:
    """The bowl on a deformable block, where the press ends, and the pair in it."""
    problem = at_few_points(bowl("block", friction))
    condensed = replace(problem, settings=replace(problem.settings, method="uzawa"))
    return problem, Equilibrium(condensed, Ledger()), visited_states(problem, STEP)[-1]


def put(state: str) -> tuple[Problem, Equilibrium, Visit]:
    """A scene, its equilibrium and the visit in a given state."""
    problem, equilibrium, visit = scene(0.0 if state == "closed" else 0.3)
    pair = equilibrium.pairs[0]
    if state in KNOT_LINE:
        visit = near_knot_line(problem, equilibrium, visit, KNOT_LINE[state])
    n = len(pair.pair.slave.point)
    largest = float(pair.respond(pair.kinematics(visit.positions, visit.pairs[0].start), visit.pairs[0].law).pressure.max())
    pressure, length = (np.resize(np.array(pattern), n) for pattern in PLACED["mixed" if state in KNOT_LINE else state])
    return problem, equilibrium, Visit(visit.positions, (placed(pair, visit.positions, visit.pairs[0], largest * pressure, length),))


def near_knot_line(problem: Problem, equilibrium: Equilibrium, visit: Visit, off: float) -> Visit:
    """The visit with the slave body moved along y until a point under pressure projects `off` (in elements) from a knot line.

    The quadratic master is curved and its second derivatives jump there.
    """
    pair, start = equilibrium.pairs[0], visit.pairs[0].start
    line = problem.body("master").patch.face_directions("w1")[1]
    moved = equilibrium.numbering.points["slave"]

    def at(shift: float) -> tuple[FloatArray, FloatArray]:
        positions = visit.positions.copy()
        positions[moved, 1] += shift
        return positions, pair.kinematics(positions, start).projections.xi[:, 1]

    knots = np.unique(line.knots)[1:-1]
    q, knot = _nearest_under_pressure(pair, visit, knots)
    target = knot + off * float(np.diff(np.unique(line.knots)).min())
    positions, shift = visit.positions, 0.0
    slope = (at(1e-6)[1][q] - at(0.0)[1][q]) / 1e-6
    for _ in range(30):
        positions, xi = at(shift)
        if abs(xi[q] - target) < SETTLED * abs(target - knot):
            break
        shift -= (xi[q] - target) / slope
    return Visit(positions, visit.pairs)


def _nearest_under_pressure(pair: PairMechanics, visit: Visit, knots: FloatArray) -> tuple[int, float]:
    """The quadrature point under noticeable pressure whose projection is nearest to a knot line, and that line."""
    kinematics = pair.kinematics(visit.positions, visit.pairs[0].start)
    field = pair.pair.field(pair.respond(kinematics, visit.pairs[0].law).pressure)
    distance = np.abs(kinematics.projections.xi[:, 1, None] - knots)
    distance[field < 0.2 * field.max()] = np.inf
    q, k = np.unravel_index(np.argmin(distance), distance.shape)
    return int(q), float(knots[k])


def bounds(state: str) -> dict[str, Bound]:
    """A bound for every part that a state has."""
    parts = [part for part in PARTS if part not in ABSENT.get(state, ())]
    return {part: Bound(at_most=SYMMETRY_BOUND if part == "symmetry" else BOUND, reason=_ROUND_OFF) for part in parts}


@case(
    claim="In every state, and from either side of every edge, each part of the tangent is the derivative that belongs there.",
    grid={"state": STATES},
    bounds=bounds,
)
def every_state(state: str) -> dict[str, float]:
    """Largest relative error of each part; next to an edge the differences stay on one side of it."""
    problem, _, visit = put(state)
    length = SHORT if "|" in state or state in KNOT_LINE else 1.0
    return {row.part: row.error for row in measure(problem, STEP, [visit], directions=1, length=length).rows}


def edge_bounds(edge: str) -> dict[str, Bound]:
    """Where trials are placed they differ by twice `OFF`; over a knot line tractions turn that come from next to no slip."""
    apart = Bound(
        at_most=3 * OFF, reason="definition: trials are placed 1e-12 off the edge to either side; round-off of the control quantities"
    )
    if edge == "knot line":
        apart = Bound(at_most=1e-6, reason="definition: a thousandth of the least jump, which is then none of a slope's")
    return {
        "apart": apart,
        "jump": Bound(at_least=1e-3, reason="definition: a check of the two sides tells nothing where they have one tangent"),
    }


@case(
    claim="The two sides of an edge, at next to one state, have different tangents.",
    grid={"edge": ("open | closed", "stick | slip", "knot line")},
    bounds=edge_bounds,
)
def edges(edge: str) -> dict[str, float]:
    """Largest difference of the control tractions and pressures on the two sides; and of a part of the tangent along a random field."""
    sides = [put(state) for state in STATES if state.startswith(f"{edge}:")]
    pairs = [PairTangent(equilibrium.pairs[0], visit.positions, visit.pairs[0]) for _, equilibrium, visit in sides]
    along = np.random.default_rng(0).standard_normal(sides[0][2].positions.shape)
    parts = ("normal", "tangential", "condensed")
    products = [[block_product(pair.pattern, getattr(pair, part), along) for part in parts] for pair in pairs]
    values = [np.column_stack([pair.response.pressure, pair.response.traction]) for pair in pairs]
    return {"apart": _difference(*values), "jump": float(np.max([_difference(*both) for both in zip(*products, strict=True)]))}


_FLAT = """
format = 1
bodies.slave.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
contacts.floor = { slave = "slave.w0", plane = { point = [0, 0, 0], normal = [0, 0, 1] }, friction = 0.5 }
supports.top.face = "slave.w1"
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.1] }]
"""
TIES: Final = {"no pressure": (0.0, 0.0, 0), "least pressure": (1e-300, 0.0, 1), "on the cone": (1.0, 0.5, 1), "above it": (1.0, ABOVE, 2)}


@case(
    claim="Exactly on an edge a control point without pressure is open, and one whose traction is on the cone sticks.",
    grid={"tie": tuple(TIES)},
    bounds=lambda tie: {"state": Bound(TIES[tie][2], TIES[tie][2], "definition: active if p > 0, slip if the trial is longer than mu p")},
)
def ties(tie: str) -> dict[str, IntArray]:
    """States (0 open, 1 stick, 2 slip) of a flat body that just touches a plane and has not moved: its trials are the multipliers."""
    equilibrium = Equilibrium(Scene.from_toml(_FLAT).problem(), Ledger())
    pair, state = equilibrium.pairs[0], equilibrium.initial_state()
    n = len(pair.pair.slave.point)
    pressure, traction, _ = TIES[tie]
    law = pair.law(np.array([1.0, 1.0]), np.full(n, pressure), np.column_stack([np.full(n, traction), np.zeros(n)]))
    return {"state": pair.respond(pair.kinematics(state.positions, state.contacts[0]), law).state}


def _difference(one: FloatArray, other: FloatArray) -> float:
    return float(np.abs(one - other).max() / np.abs(one).max())
