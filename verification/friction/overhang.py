"""Control quantities of a slave that reaches over its master's edge: what is off the master counts for nothing, and has no past."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
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
