"""The tangent where feet are on C0 lines of the master: exact in every part, and forces and moments in balance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from tangents.placed import placed

from isomortar.harness import Bound, case
from isomortar.harness.tangents import BOUND, PARTS, SYMMETRY_BOUND, measure
from isomortar.harness.visits import PairVisit, Visit
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger

#: A bowl over a master of Lagrange elements.
_SCENE = """
format = 1

[bodies.slave]
geometry = {{ kind = "bowl", centre = [0.03, 0.02], half_width = 0.35, bottom = 0, rise = 0.06, top = 0.4 }}
mesh = {{ order = [2, 2, 1], elements = [{elements}, {elements}, 1] }}

[bodies.master]
geometry = {{ kind = "box", lower = [-0.6, -0.6, -0.5], upper = [0.7, 0.65, 0] }}
mesh = {{ family = "L", order = [{order}, {order}, 1], elements = [6, 5, 1] }}

[contacts.interface]
slave = "slave.w0"
master = "master.w1"
projection = "closest"
friction = 0.3
subcells = 0

[supports.top]
face = "slave.w1"

[supports.floor]
face = "master.w0"

[[stages]]
name = "press"
steps = 1
motions.top = {{ translate = [0, 0, -0.05] }}
"""
#: Uneven by how much, by order: on a more hollow master feet are beyond centres of curvature, where friction is refused.
UNEVEN = {1: 0.03, 2: 0.007}
#: How far the bowl is moved (order 2, where the uneven master is curved, half of it): above the master feet are on ridges, below its
#: surface in valleys.
MOVED = {"ridges": 0.08, "valleys": -0.06}
#: Elements of the bowl in each direction, by the side: enough for some feet on lines.
ELEMENTS = {"ridges": 3, "valleys": 4}
#: Quadrature of the contact by order and side, where fewer points than usual are enough: feet on curved ridges cost the twin most.
QUADRATURE = {(2, "ridges"): (3, 3), (2, "valleys"): (4, 5)}
#: Directions this short (as a share of the size) keep the differences from reaching the end of a line's share of the points.
SHORT = 1e-3
#: On lines tractions do not work on the projection's change: it has no part there.
ON_LINES = tuple(part for part in PARTS if part != "tangential, projection")


def bounds(order: int, side: str) -> dict[str, Bound]:
    """A bound for every part, for the balances, and that there are feet on lines (on corners of linear elements)."""
    parts = {
        part: Bound(
            at_most=SYMMETRY_BOUND if part == "symmetry" else BOUND,
            reason="round-off: products of double precision against differences of a twin in extended precision",
        )
        for part in ON_LINES
    }
    corners = 1.0 if (order, side) == (1, "ridges") else 0.0
    return parts | {
        "forces": Bound(at_most=1e-12, reason="round-off: the contact forces of both sides are opposite"),
        "moments": Bound(at_most=1e-12, reason="round-off: the normal is along the distance, so both sides' moments are opposite"),
        "on lines": Bound(at_least=5.0, reason="definition: a part is tested only where it acts"),
        "at corners": Bound(at_least=corners, reason="definition: a part is tested only where it acts"),
    }


@case(
    claim="Where feet are on C0 lines the tangent is exact in every part, and contact forces and moments are in balance.",
    tier=lambda order, side: "gate" if (order == 1) == (side == "valleys") else "nightly",
    grid={"order": [1, 2], "side": list(MOVED)},
    bounds=bounds,
)
def on_lines(order: int, side: str) -> dict[str, float]:
    """Largest relative error of each part, of the balances, and the numbers of feet on lines and at corners."""
    problem = Scene.from_toml(_SCENE.format(order=order, elements=ELEMENTS[side])).problem()
    (contact,) = problem.contacts
    contact = replace(contact, quadrature=QUADRATURE.get((order, side), contact.quadrature))
    problem = replace(problem, contacts=(contact,), settings=replace(problem.settings, method="uzawa"))
    equilibrium = Equilibrium(problem, Ledger())
    pair, state = equilibrium.pairs[0], equilibrium.initial_state()
    uneven = np.random.default_rng(1).standard_normal(state.positions.shape)
    positions = state.positions + UNEVEN[order] * uneven
    positions[equilibrium.numbering.points["slave"], 2] += MOVED[side] / order
    start = state.contacts[0]
    n = len(pair.pair.slave.point)
    law = pair.law(np.array([20.0, 10.0]), np.zeros(n), np.zeros((n, 2)))
    pressure, length = (np.resize(np.array(pattern), n) for pattern in ((-1.0, 1.0, 0.7), (0.0, 0.5, 2.0)))
    visit = placed(pair, positions, PairVisit(start, law), pressure, length)
    kinematics = pair.kinematics(positions, start)
    result = pair.result(positions, kinematics, pair.respond(kinematics, visit.law), np.zeros(2))
    fixed = kinematics.projections.fixed.sum(axis=1)
    report = measure(problem, 1, [Visit(positions, (visit,))], directions=1, length=SHORT)
    return {row.part: row.error for row in report.rows if row.part in ON_LINES} | {
        "forces": float(np.abs(result.force_slave + result.force_master).max() / np.abs(result.force_slave).max()),
        "moments": float(np.abs(result.moment_slave + result.moment_master).max() / np.abs(result.moment_slave).max()),
        "on lines": float(np.count_nonzero(fixed)),
        "at corners": float(np.count_nonzero(fixed == 2)),
    }
