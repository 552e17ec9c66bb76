"""Turns of any size in one load step: what counts is how far a support has turned, not where it has come to."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: A rod with one end fixed and the other turned, once all at a time and once by degrees.
_ROD = """
format = 1
bodies.rod = { geometry = { kind = "box", lower = [0, 0, 0], upper = [8, 1, 1] }, mesh = { order = [2, 2, 2], elements = [8, 1, 1] } }
supports.end = { face = "rod.u1", centre = [8, 0.5, 0.5], axis = [1, 0, 0] }
supports.base = { face = "rod.u0" }
solver.newton_tolerance = 1e-10
"""
#: Degrees of a load step of the slow turn.
SLOW = 15.0


def turned(angle: float, steps: int) -> list[StepResult]:
    """The rod turned by an angle in degrees, and held for a load step."""
    stages = f'stages = [{{ name = "turn", steps = {steps}, motions.end.rotate = {angle} }}, {{ name = "hold", steps = 1 }}]'
    return list(Simulation(Scene.from_toml(_ROD + stages).problem()).run())


@case(
    claim="A turn in one load step, past a half and past whole turns, ends where many small load steps end.",
    tier=lambda angle: "nightly" if angle == 720.0 else "gate",
    grid={"angle": (170.0, 350.0, 360.0, -360.0, 720.0)},
    bounds={
        "moment": Bound(at_most=1e-9, reason="theory: without contact the path does not matter; Newton's method stops at 1e-10"),
        "positions": Bound(at_most=1e-9, reason="theory: without contact the path does not matter; Newton's method stops at 1e-10"),
        "stiffness": Bound(
            at_least=0.9, at_most=1.2, reason="theory: the moment per angle is that of a small turn; long rods stiffen with it"
        ),
        "cuts": Bound(at_most=0.0, reason="definition: increments that a turn makes short are no cuts"),
    },
)
def one_step(angle: float) -> dict[str, float]:
    """Relative distance of moment and positions from those of the slow turn; moment per angle over that of one degree; cuts."""
    fast, slow = turned(angle, 1), turned(angle, int(np.ceil(abs(angle) / SLOW)))
    small = turned(1.0, 1)[0].reactions[0].moment[0]
    moment = slow[-1].reactions[0].moment
    return {
        "moment": float(np.linalg.norm(fast[-1].reactions[0].moment - moment) / np.linalg.norm(moment)),
        "positions": float(np.abs(fast[-1].state.positions - slow[-1].state.positions).max()),
        "stiffness": float(fast[0].reactions[0].moment[0] / angle / small),
        "cuts": float(sum(result.cuts for result in fast)),
    }
