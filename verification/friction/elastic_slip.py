"""Elastic slip: the law in closed form along a path, no creep under hold, and how fast it comes to Coulomb's law."""

from __future__ import annotations

from dataclasses import replace
from typing import Final, Literal

import numpy as np
from friction.sliding import PRESS_STEPS, block

from isomortar.geometry.patch import FloatArray
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Body, Contact, Face, Material, Motion, Problem, RigidPlane, Stage, Support
from isomortar.model.settings import SolverSettings
from isomortar.solve.record import StepResult

FRICTION = 0.3
#: Largest elastic slip of the prism, and its motions in these: there, hold, back, across the middle, slide, turn back, far back.
LENGTH: Final = 0.01
PATH: Final = (0.5, 0.0, -0.5, 0.3, 2.0, -0.5, -1.0, -1.0)
_READ = (
    "theory: slips are prescribed, and equal at all points; at the edge of sliding stretches are read off tractions to the square root of "
    "round-off (theory 4.16)"
)


def prism(method: Literal["monolithic", "uzawa"]) -> Problem:
    """One element whose sides are moved along with its top, pressed evenly: what its face slips is prescribed."""
    patch = mesh(box((0, 0, 0), (1.0, 0.8, 0.5)), ("N", "N", "N"), (1, 1, 1), (1, 1, 1))
    along = [Motion((LENGTH * stride, 0.0, 0.0)) for stride in PATH]
    still = (Motion(),) * (1 + len(PATH))
    contact = Contact("floor", Face("body", "w0"), RigidPlane((0, 0, 0), (0, 0, 1), (0.8, 0.6, 0)), FRICTION, (4, 4), elastic_slip=LENGTH)
    return Problem(
        name="prism",
        bodies=(Body("body", patch, Material(), (2, 2, 2)),),
        contacts=(contact,),
        supports=(
            Support("top", Face("body", "w1"), (Motion((0.0, 0.0, -0.05)), *along)),
            *(Support(side, Face("body", side), (Motion(), *along), (0,)) for side in ("u0", "u1")),
            *(Support(side, Face("body", side), still, (1,)) for side in ("v0", "v1")),
        ),
        stages=(Stage("press", 1), *(Stage(f"move {k + 1}", 1) for k in range(len(PATH)))),
        settings=SolverSettings(
            method=method, newton_tolerance=1e-13, complementarity_tolerance=1e-12, augmentation_tolerance=1e-12, penalty_normal=1e4
        ),
    )


def stretches() -> FloatArray:
    """Stretches along the path: slips add up, and at most one is kept."""
    kept = [0.0]
    for stride in PATH:
        kept.append(float(np.clip(kept[-1] + stride, -1.0, 1.0)))
    return np.array(kept)


@case(
    claim="Along a path of loads, holds and turns a face drags with mu N x (2 - |x|), with the slip that it has kept, x, over the "
    "largest elastic one, by either method.",
    grid={"method": ("monolithic", "uzawa")},
    bounds={
        "drag": Bound(at_most=1e-7, reason=_READ),
        "slides": Bound(0.0, 0.0, "definition: it slides where all of the stretch is used up, strictly inside a step"),
    },
)
def elastic_path(method: Literal["monolithic", "uzawa"]) -> dict[str, float]:
    """Largest difference of the drag from the closed form, over mu N, and load steps whose states are others."""
    results = list(Simulation(prism(method)).run())
    force = np.array([result.contacts[0].force_slave for result in results])
    x = stretches()
    far = np.abs(np.append(0.0, x[:-1] + np.array(PATH))) > 1.0
    slides = np.array([result.contacts[0].slip == result.contacts[0].active for result in results])
    return {
        "drag": float(np.abs(-force[:, 0] / (FRICTION * force[:, 2]) - x * (2.0 - np.abs(x))).max()),
        "slides": float(np.count_nonzero(slides != far)),
    }


def pushed(elastic_slip: float, pushes: tuple[tuple[float, int], ...]) -> list[StepResult]:
    """The flat block, pressed and pushed along with an elastic slip."""
    problem = block(pushes, direction=30.0)
    contact = replace(problem.contacts[0], elastic_slip=elastic_slip)
    return list(Simulation(replace(problem, contacts=(contact,))).run())


@case(
    claim="Under a load that is held nothing creeps, and nothing is lost: pressures, tractions and positions stay as they are, in elastic "
    "slip, in part of the face, and in full sliding.",
    grid={"push": (0.01, 0.05, 0.6)},
    bounds={
        "pressures": Bound(at_most=1e-10, reason="round-off: contact conditions are solved to 1e-11"),
        "tractions": Bound(at_most=1e-10, reason="round-off: contact conditions are solved to 1e-11"),
        "positions": Bound(at_most=1e-10, reason="round-off: contact conditions are solved to 1e-11; lengths are about one"),
        "drag": Bound(at_least=1e-3, reason="definition: there is something to lose"),
    },
)
def no_creep(push: float) -> dict[str, float]:
    """Largest changes over three load steps of hold, over the largest values; the drag over the normal force."""
    results = pushed(2e-3, ((push, 2), (0.0, 3)))[-4:]
    first = results[0].state
    force = results[-1].contacts[0].force_slave

    def change(name: str) -> float:
        before = getattr(first.contacts[0], name)
        changes = [np.abs(getattr(result.state.contacts[0], name) - before).max() for result in results[1:]]
        return float(np.max(changes) / np.abs(before).max())

    return {
        "pressures": change("pressure"),
        "tractions": change("traction"),
        "positions": float(np.max([np.abs(result.state.positions - first.positions).max() for result in results])),
        "drag": float(np.hypot(*force[:2]) / abs(force[2])),
    }


@case(
    claim="With a tangent in each iteration Newton's method has order 2 with elastic slip.",
    bounds={"order": Bound(at_least=1.8, reason="theory: 2, the tangent is exact and continuous; of three residuals, a tenth less")},
)
def elastic_order() -> dict[str, list[float]]:
    """Observed orders of the load steps of a push."""
    problem = block(((0.025, 2),), direction=30.0)
    contact = replace(problem.contacts[0], elastic_slip=1e-2)
    settings = replace(problem.settings, measures=tuple(m for m in problem.settings.measures if m != "keeping"))
    results = list(Simulation(replace(problem, contacts=(contact,), settings=settings)).run())
    return {"order": [result.newton_order for result in results[PRESS_STEPS:]]}


#: Elastic slips of the rate; without them an element that is pressed and pushed by `PUSH` sticks: its solid does not spread.
SLIPS: Final = (1e-4, 5e-5)
PUSH = 0.01


def sheared(elastic_slip: float) -> Problem:
    """The element without supports at its sides, of a solid that does not spread, pressed and pushed along by its top."""
    problem = prism("monolithic")
    body = replace(problem.bodies[0], material=Material(poisson=0.0))
    contact = replace(problem.contacts[0], elastic_slip=elastic_slip)
    top = replace(problem.supports[0], motions=(problem.supports[0].motions[0], Motion((PUSH, 0.0, 0.0))))
    return replace(problem, bodies=(body,), contacts=(contact,), supports=(top,), stages=(Stage("press", 1), Stage("push", 2)))


@case(
    claim="Tractions and positions come to those of Coulomb's law in proportion to the largest elastic slip.",
    bounds=dict.fromkeys(
        ("tractions", "positions"), Bound(at_least=0.9, at_most=1.1, reason="theory: order 1, in the limit of short slips (theory 4.15)")
    ),
)
def to_coulomb() -> dict[str, float]:
    """Orders of the errors of an element that is pressed and pushed, between two elastic slips."""
    exact, *states = [list(Simulation(sheared(length)).run())[-1].state for length in (0.0, *SLIPS)]
    tractions = [float(np.linalg.norm(state.contacts[0].traction - exact.contacts[0].traction)) for state in states]
    positions = [float(np.abs(state.positions - exact.positions).max()) for state in states]
    ratio = np.log(SLIPS[0] / SLIPS[1])
    return {
        "tractions": float(np.log(tractions[0] / tractions[1]) / ratio),
        "positions": float(np.log(positions[0] / positions[1]) / ratio),
    }
