"""Control quantities of a slave that reaches over its master's edge: what is off the master counts for nothing, and has no past."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.simulation import Simulation
from isomortar.solve.timing import Ledger

#: A square slave of 4 x 4 elements, two columns of which lie over a flat master whose parameters are lengths over 1 and 1.5.
_SCENE = """
format = 1
bodies.slave = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = [2, 3, 1], elements = [4, 4, 1] } }
bodies.master = { geometry = { kind = "box", lower = [-0.5, -0.25, -1], upper = [0.5, 1.25, 0] } }
contacts.interface = { slave = "slave.w0", master = "master.w1", friction = 0.5 }
supports.top.face = "slave.w1"
supports.floor.face = "master.w0"
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.1] }]
"""
#: Metric of the master: 11, 12, 22.
METRIC = np.array([1.0, 0.0, 2.25])
#: The slave moves by one element: a third column comes over the master.
STEP = -0.25
_ROUND_OFF = "round-off: sums over some hundred quadrature points; element boundaries lie on the master's edge, so nothing else is left"


@case(
    claim="Points off the master take no part in any control quantity, and one that comes over the master has not slipped.",
    tier="gate",
    bounds={name: Bound(at_most=1e-13, reason=_ROUND_OFF) for name in ("weight", "metric", "new weight", "slip", "new slip")},
)
def edge() -> dict[str, float]:
    """Errors of the area met before and after the motion, of the metric, of the slip's integral, and the slip of new points."""
    equilibrium = Equilibrium(Scene.from_toml(_SCENE).problem(), Ledger())
    pair, state = equilibrium.pairs[0], equilibrium.initial_state()
    before = pair.kinematics(state.positions, state.contacts[0])
    positions = state.positions.copy()
    positions[pair.pair.slave.point, 0] += STEP
    after = pair.kinematics(positions, state.contacts[0])
    met = before.control.square > 0
    ratio = before.control.metric[met] / before.control.square[met, None]
    new = (after.projections.found == 1) & (before.projections.found == 0)
    return {
        "weight": abs(before.control.weight.sum() - 0.5),
        "new weight": abs(after.control.weight.sum() - 0.75),
        "metric": float(np.abs(ratio - METRIC).max()),
        "slip": float(np.abs(after.control.slip.sum(axis=0) - [0.5 * STEP, 0.0]).max()),
        "new slip": float(np.abs(after.projections.slip[new]).max()),
    }


#: A bowl pressed near the corner of its master, then moved over the corner and off.
_CORNER = """
format = 1
bodies.slave.geometry = { kind = "bowl", half_width = 0.3, bottom = 0.0, rise = 0.05, top = 0.4 }
bodies.slave.mesh = { order = [2, 2, 1], elements = [4, 4, 1] }
bodies.master.geometry = { kind = "box", lower = [-0.6, -0.6, -0.5], upper = [0.6, 0.6, 0] }
bodies.master.mesh = { order = [3, 3, 1], elements = [4, 4, 1] }
contacts.interface = { slave = "slave.w0", master = "master.w1", friction = FRICTION }
supports.top.face = "slave.w1"
supports.base.face = "master.w0"
stages = [
    { name = "press", steps = 1, motions.top.translate = [0, 0, -0.03] },
    { name = "slide", steps = 10, motions.top.translate = [1.2, 1.2, 0] },
]
"""


@case(
    claim="A slave that leaves its master over a corner is followed to the last point, and is free of forces then.",
    tier="gate",
    grid={"friction": (0.0, 0.3)},
    bounds={
        "force": Bound(at_most=1e-8, reason="round-off: Newton's method stops at 1e-9 of the stiffness; nothing is left in contact"),
        "left": Bound(at_least=1.0, at_most=1.0, reason="definition: the last points have left the master"),
        "alone": Bound(at_least=1.0, reason="definition: in some load step most control points are off the master, and some bear"),
    },
)
def over_a_corner(friction: float) -> dict[str, float]:
    """Force at the end over the largest one, share of points off the master, and load steps with a contact on few points."""
    results = list(Simulation(Scene.from_toml(_CORNER.replace("FRICTION", str(friction))).problem()).run())
    forces = [float(np.linalg.norm(result.reactions[0].force)) for result in results]
    points = 16 * 6 * 6
    alone = [result.contacts[0].excluded > points / 2 and result.contacts[0].active > 0 for result in results]
    return {"force": forces[-1] / max(forces), "left": results[-1].contacts[0].excluded / points, "alone": float(sum(alone))}
