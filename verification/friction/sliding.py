"""A block pressed onto a rigid plane and pushed along it: stick, Coulomb's force in sliding, reversal."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from small_scenes import TIGHT
from transforms import turned

from isomortar.geometry.patch import FloatArray
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Body, Contact, Face, Material, Motion, Problem, RigidPlane, Stage, Support
from isomortar.model.settings import SolverSettings
from isomortar.solve.record import StepResult

FRICTION = 0.3
#: Load steps of the press and of each push, and length of a load step that slides.
PRESS_STEPS, PUSH_STEPS, STRIDE = 2, 24, 0.15
#: Load steps from end to end of a push to and fro.
STROKE = 20
SLOPE = 0.1

_COULOMB = "theory: |T| = mu N where all points slip one way, deviations of direction squared; round-off of sums over a hundred points"
_SOLVER = "round-off: contact conditions are solved to 1e-11"
#: With e the length that the base lags behind the top in sliding, a step of length s turns the drag towards the motion as the lag: what
#: is across goes from a to a e / (e + s), as (e + s) d' = e d + s m for the directions d, d' before and after, and m of the motion.
_SETTLED = "theory: backward Euler leaves e / (e + s), a third, of a wrong direction a step; e, the elastic slip, is 0.07 here"


def block(pushes: Sequence[tuple[float, int]], direction: float = 0.0, size: float = 0.06) -> Problem:
    """A flat block whose top is pressed down, then pushed along the plane.

    Parameters
    ----------
    pushes : sequence of (length, load steps)
        One stage each; lengths are signed.
    direction : float
        Of the pushes in the plane, in degrees from the first direction of the block.
    size : float
        Depth of the press.
    """
    patch = mesh(box((0, 0, 0), (1.0, 0.8, 0.4)), ("N", "N", "N"), (2, 2, 1), (3, 3, 1))
    angle = np.radians(direction)
    along = [Motion((float(length * np.cos(angle)), float(length * np.sin(angle)), 0.0)) for length, _ in pushes]
    stages = [Stage(f"push {k + 1}", steps) for k, (_, steps) in enumerate(pushes)]
    return Problem(
        name="block-on-plane",
        bodies=(Body("block", patch, Material(), (4, 4, 2)),),
        contacts=(Contact("base", Face("block", "w0"), RigidPlane((0, 0, 0), (0, 0, 1), (0.8, 0.6, 0)), FRICTION, (6, 6)),),
        supports=(Support("top", Face("block", "w1"), (Motion((0, 0, -size)), *along)),),
        stages=(Stage("press", PRESS_STEPS), *stages),
        settings=SolverSettings(**TIGHT),  # type: ignore[arg-type]
    )


def tilted(degrees: float) -> FloatArray:
    """Rotation about the y-axis that makes the x-axis rise, shape (3, 3)."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]])


def run(problem: Problem) -> list[StepResult]:
    """All load steps."""
    return list(Simulation(problem).run())


def ratio(result: StepResult, normal: FloatArray) -> float:
    """Tangential over normal contact force."""
    force = result.contacts[0].force_slave
    across = force @ normal
    return float(np.linalg.norm(force - across * normal) / abs(across))


@case(
    claim="A block that slides on a plane of any tilt, in any direction, drags with exactly mu N.",
    tier="gate",
    grid={"direction": (0.0, 30.0, 137.0), "tilt": (0.0, 30.0)},
    bounds={
        "error": Bound(at_most=1e-13, reason=_COULOMB),
        "across": Bound(at_most=1.4e-11, reason=f"{_SETTLED}: 3^-24 = 4e-12; contact conditions to 1e-11"),
        "slipping": Bound(at_least=1.0, at_most=1.0, reason="theory: all points in contact slip"),
    },
)
def sliding_force(direction: float, tilt: float) -> dict[str, float]:
    """Relative error of the drag, its share across the motion, and the share of slipping points."""
    turn = tilted(tilt)
    result = run(turned(block([(STRIDE * PUSH_STEPS, PUSH_STEPS)], direction), turn))[-1]
    angle = np.radians(direction)
    across = turn @ np.array([-np.sin(angle), np.cos(angle), 0.0])
    force = result.contacts[0].force_slave
    found = result.contacts[0]
    return {
        "error": abs(ratio(result, turn[:, 2]) / FRICTION - 1.0),
        "across": float(abs(force @ across) / (FRICTION * abs(force @ turn[:, 2]))),
        "slipping": found.slip / found.active,
    }


@case(
    claim="A block pushed up an incline needs (tan a + mu) / (1 - mu tan a) of its weight: 0.412371 (NAFEMS CGS-4).",
    tier="gate",
    bounds={"error": Bound(at_most=1e-12, reason=f"{_COULOMB}; the support's force is the contact's to Newton's 1e-12")},
)
def incline() -> dict[str, float]:
    """Relative error of horizontal over vertical force at tan a = 0.1, mu = 0.3, by prescribed motion up the slope."""
    result = run(turned(block([(STRIDE * PUSH_STEPS, PUSH_STEPS)]), tilted(float(np.degrees(np.arctan(SLOPE))))))[-1]
    force = result.reactions[0].force
    exact = (SLOPE + FRICTION) / (1.0 - FRICTION * SLOPE)
    return {"error": float(abs(force[0] / -force[2] / exact - 1.0))}


@case(
    claim="Points stick under a small push, and the drag never exceeds mu N on the way to sliding.",
    tier="gate",
    bounds={
        "excess": Bound(at_most=1e-11, reason=f"theory: the sum of tractions is at most mu times that of pressures; {_SOLVER}"),
        "sticking": Bound(at_least=1.0, reason="theory: the middle of the block sticks under a push of a fiftieth of what slides"),
        "rises": Bound(at_least=-1e-10, reason=f"theory: the drag grows until all points slip; {_SOLVER}"),
    },
)
def stick_before_slip() -> dict[str, float]:
    """Excess of the drag over mu N, sticking points in the first step of a fine push, smallest rise of the drag from step to step."""
    results = run(block([(0.04, 8)]))[PRESS_STEPS - 1 :]
    drag = np.array([ratio(result, np.array([0.0, 0.0, 1.0])) for result in results])
    first = results[1].contacts[0]
    return {
        "excess": float(np.maximum(0.0, drag.max() / FRICTION - 1.0)),
        "sticking": float(first.active - first.slip),
        "rises": float(np.diff(drag).min()),
    }


def dissipation(problem: Problem, before: StepResult, after: StepResult) -> float:
    """Work of the control tractions on the slips of one load step."""
    pair = Simulation(problem).equilibrium.pairs[0]
    slip = pair.kinematics(after.state.positions, before.state.contacts[0]).control.slip
    return float(np.sum(after.state.contacts[0].traction * slip))


@case(
    claim="Pushed to and fro, a block never gives back what friction took, and its loop of force against motion closes.",
    tier="gate",
    bounds={
        "gained": Bound(at_most=1e-12, reason=f"theory: a traction is along its slip; {_SOLVER}"),
        "taken": Bound(at_least=1e-3, reason="definition: a block that slides dissipates"),
        "open": Bound(at_most=3e-10, reason=f"{_SETTLED}: 3^-20 = 3e-10"),
    },
)
def reversal() -> dict[str, float]:
    """Work given back in any step over all that was taken, what was taken, and the distance of the second loop from the third."""
    there = STRIDE * STROKE
    problem = block([(length, STROKE) for length in (there / 2, -there, there, -there, there)])
    results = run(problem)
    work = np.array([dissipation(problem, a, b) for a, b in zip(results[PRESS_STEPS - 1 :], results[PRESS_STEPS:], strict=False)])
    force = np.array([result.reactions[0].force for result in results])
    second, third = force[PRESS_STEPS + STROKE : PRESS_STEPS + 3 * STROKE], force[PRESS_STEPS + 3 * STROKE :]
    return {
        "gained": float(np.maximum(0.0, -work.min()) / work.sum()),
        "taken": float(work.sum()),
        "open": float(np.abs(third - second).max() / np.abs(second).max()),
    }
