"""A body of which nothing is free: its forces follow from the prescribed positions."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: One element of order 1 between two supports.
_BLOCK = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 2, 0.5] }, mesh = { order = [1, 1, 1] } }
supports.base.face = "block.w0"
supports.top.face = "block.w1"
stages = [{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.1] }]
"""
STRETCH, AREA = 0.8, 2.0


@case(
    claim="Where nothing is free, supports report the forces of the prescribed state.",
    tier="gate",
    grid={"method": ("monolithic", "uzawa")},
    bounds={
        "force": Bound(at_most=1e-13, reason="round-off: a state of uniform stress, formulas against sums over eight control points"),
        "balance": Bound(at_most=1e-13, reason="round-off: the same force on both ends"),
    },
)
def nothing_free(method: str) -> dict[str, float]:
    """Relative error of the force of a block in uniaxial strain, and the sum of the two support forces over it."""
    problem = Scene.from_toml(_BLOCK, overrides=[f"solver.method={method}"]).problem()
    top, base = (reaction.force for reaction in list(Simulation(problem).run())[-1].reactions)
    bulk, shear = problem.bodies[0].material.bulk, problem.bodies[0].material.shear
    trace = 2.0 + STRETCH**2
    stress = bulk * np.log(STRETCH) / STRETCH + shear * STRETCH ** (-2 / 3) * (STRETCH - trace / 3.0 / STRETCH)
    if problem.supports[0].name == "base":
        top, base = base, top
    return {
        "force": float(np.linalg.norm(top - [0.0, 0.0, AREA * stress]) / abs(AREA * stress)),
        "balance": float(np.linalg.norm(top + base) / abs(AREA * stress)),
    }
