"""Uzawa's method ends at the solution of the monolithic one whatever the penalties and the friction, or says that it did not get there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from small_scenes import at_few_points, bowl

from isomortar.errors import ConvergenceError
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

_TOLERANCE = (
    "definition: augmentations end where the change, the gap and the slip are each worth a hundredth of the multipliers; the monolithic "
    "method is exact beside that"
)


def run(problem: Problem) -> tuple[list[StepResult], bool]:
    """The load steps of a problem, and whether they are all: a load increment that does not converge ends them."""
    found: list[StepResult] = []
    try:
        found.extend(Simulation(problem).run())
    except ConvergenceError:
        return found, False
    return found, True


def against_monolithic(problem: Problem, tolerance: float = 1e-9) -> dict[str, float]:
    """Largest distance of the results of augmentations from those of the monolithic method, at the load steps that are reached.

    Newton's method has the tolerance with augmentations.
    """
    problem = replace(problem, settings=replace(problem.settings, newton_tolerance=1e-9, complementarity_tolerance=1e-8))
    found, complete = run(replace(problem, settings=replace(problem.settings, method="uzawa", max_cuts=0, newton_tolerance=tolerance)))
    right = list(Simulation(problem).run())[: len(found)]
    apart = {"forces": 0.0, "moments": 0.0}
    for a, b in zip(found, right, strict=True):
        force = float(np.abs([r.force for r in b.reactions]).max())
        moment = float(np.abs([r.moment for r in b.reactions]).max())
        for x, y in zip(a.reactions, b.reactions, strict=True):
            apart["forces"] = max(apart["forces"], float(np.abs(x.force - y.force).max()) / force)
            apart["moments"] = max(apart["moments"], float(np.abs(x.moment - y.moment).max()) / moment)
    return {**apart, "got there": float(complete)}


BOUNDS = {
    "forces": Bound(at_most=0.03, reason=_TOLERANCE),
    "moments": Bound(at_most=0.03, reason=_TOLERANCE),
}
REACHED = Bound(at_least=1.0, at_most=1.0, reason="definition: all load steps are reached")
EITHER = Bound(at_least=0.0, at_most=1.0, reason="definition: where the penalty is no match for the body, a load step may be refused")


@case(
    claim="The penalties leave the results, over a range of 1e4; beyond it load steps are refused and never wrong.",
    tier=lambda factor: "nightly" if factor == 0.1 else "gate",
    grid={"factor": (1e-3, 0.1, 1.0, 100.0, 1e4, 1e9)},
    bounds=lambda factor: {**BOUNDS, "got there": REACHED if 1.0 <= factor <= 1e4 else EITHER},
)
def penalties(factor: float) -> dict[str, float]:
    """The default is 100; the tangential one is a tenth."""
    problem = at_few_points(bowl("plane"))
    settings = replace(problem.settings, penalty_normal=factor, penalty_tangential=0.1 * factor)
    return against_monolithic(replace(problem, settings=settings))


@case(
    claim="Any friction: results are those of the monolithic method.",
    tier="gate",
    grid={"friction": (0.0, 1e-3, 1.0, 1e3, 1e200)},
    bounds={**BOUNDS, "got there": REACHED},
)
def frictions(friction: float) -> dict[str, float]:
    """From none to more than any traction asks for."""
    problem = at_few_points(bowl("plane"))
    return against_monolithic(replace(problem, contacts=tuple(replace(c, friction=friction) for c in problem.contacts)))


@case(
    claim="Augmentations come to the same forces whatever digits are asked of Newton's method: round-off that penalties multiply is left.",
    tier="gate",
    grid={"master": ("block", "plane"), "tolerance": (1e-12, 1e-16)},
    bounds={**BOUNDS, "got there": REACHED},
)
def digits(master: str, tolerance: float) -> dict[str, float]:
    """With penalties ten times the default."""
    problem = at_few_points(bowl(master))
    settings = replace(problem.settings, penalty_normal=1e3, penalty_tangential=1e2)
    return against_monolithic(replace(problem, settings=settings), tolerance)


#: A bowl that is pressed onto a plane and pushed along it, with penalties that are small.
SOFTLY = """
format = 1
bodies.bowl.geometry = { kind = "bowl", half_width = 0.5, bottom = 0, rise = 0.1, top = 0.5 }
bodies.bowl.mesh = { order = [2, 2, 1], elements = [4, 4, 1] }
contacts.floor = { slave = "bowl.w0", plane = { point = [0, 0, 0] }, friction = 0.3 }
supports.top.face = "bowl.w1"
stages = [{ name = "press", steps = 1, motions.top.translate = [0.01, 0, -0.04] }]
solver = { max_augmentations = 400, max_cuts = 0 }
"""


@case(
    claim="Augmentations that change little, as by small penalties, go on until contact conditions are met within their tolerance.",
    tier="gate",
    grid={"penalty": (0.1, 0.01)},
    bounds={
        "off": Bound(at_most=0.01, reason="definition: solver.augmentation_tolerance, of the force that the monolithic method finds"),
        "augmentations": Bound(at_least=20.0, reason="definition: by larger penalties half as many are enough"),
    },
)
def by_small_penalties(penalty: float) -> dict[str, float]:
    """Largest component that a force is off by, over the force; how many augmentations that took."""
    small = [f"solver.penalty_{way}={penalty}" for way in ("normal", "tangential")]
    found, exact = (
        list(Simulation(Scene.from_toml(SOFTLY, overrides=[f"solver.method='{method}'", *more]).problem()).run())[-1]
        for method, more in (("uzawa", small), ("monolithic", []))
    )
    force = exact.reactions[0].force
    return {
        "off": float(np.abs(found.reactions[0].force - force).max() / np.linalg.norm(force)),
        "augmentations": float(len(found.augmentations)),
    }
