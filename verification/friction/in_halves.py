"""Load steps with a tolerance for their path: two halves each, which are kept where the whole is as near to them as it has to be."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: Two pads on planes, pressed and then dragged as they are pressed on: the one that rubs goes another way in smaller load steps.
SCENE = """
format = 1
bodies.rough = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }, mesh = { order = 2, elements = [2, 2, 1] } }
bodies.smooth = { geometry = { kind = "box", lower = [3, 0, 0], upper = [4, 1, 0.5] }, mesh = { order = 2 } }
contacts.rough = { slave = "rough.w0", plane = { point = [0, 0, -0.01] }, friction = 0.3 }
contacts.smooth = { slave = "smooth.w0", plane = { point = [0, 0, -0.01] } }
supports = { rough.face = "rough.w1", smooth.face = "smooth.w1" }
solver = { newton_tolerance = 1e-12, complementarity_tolerance = 1e-12PATH }
[[stages]]
name = "press"
steps = 1
motions = { rough.translate = [0, 0, -0.03], smooth.translate = [0, 0, -0.02] }
[[stages]]
name = "drag"
steps = STEPS
motions = { rough.translate = [0.02, 0.01, -0.02], smooth.translate = [0, 0, -0.02] }
"""
#: Load steps of the second stage.
STEPS = 2
#: How far beside the distance the tolerance is: far more than Newton's method leaves of it.
BESIDE = 1e-4


def problem_of(steps: int, tolerance: float | None = None) -> Problem:
    """The scene with so many load steps in its second stage."""
    path = "" if tolerance is None else f", path_tolerance = {tolerance!r}"
    return Scene.from_toml(SCENE.replace("STEPS", str(steps)).replace("PATH", path)).problem()


def apart(one: StepResult, other: StepResult) -> float:
    """Distance of pressures and tractions from others, by equation 5.9; coordinates of a plane are lengths."""
    found = []
    for some, others in zip(one.state.contacts, other.state.contacts, strict=True):
        for a, b in ((some.pressure, others.pressure), (some.traction, others.traction)):
            found.append(float(np.linalg.norm(a - b) / np.linalg.norm(b)) if b.any() else 0.0)
    return float(np.max(found))


@case(
    claim="With a tolerance for its path a load step is two of half its length, if one of its whole length is as near to them, else four.",
    tier="gate",
    bounds={
        "forces": Bound(at_most=1e-9, reason="round-off: both end at Newton's 1e-12"),
        "works": Bound(at_most=1e-9, reason="round-off: as above"),
        "rates": Bound(at_most=1e-7, reason="round-off: as above, over the length of the last half"),
        "counts": Bound(0.0, 0.0, "definition: increments and cuts that are not those of halves, or of halves of halves"),
        "path": Bound(at_least=1e-3, reason="definition: the path matters, or nothing is tried"),
    },
)
def in_halves() -> dict[str, float]:
    """Largest relative differences from load steps of half the length; differences of counts; the distance that is estimated."""
    finer = list(Simulation(problem_of(2 * STEPS)).run())
    press, kept = finer[0], Simulation(problem_of(STEPS, 1.0), resume_from=finer[0]).run()
    ends, halves = list(kept), [finer[2 * k] for k in range(1, STEPS + 1)]
    forces = [np.array([[r.force for r in step.reactions] for step in steps]) for steps in (ends, halves)]
    works = [np.array([[c.friction_work for c in step.contacts] for step in steps]).sum(axis=0) for steps in (ends, finer[1:])]
    rates, twice = ends[0].state.rates, finer[2].state.rates
    assert rates is not None
    assert twice is not None
    counts = [step.substeps - 2 for step in ends] + [step.cuts for step in ends]

    whole = next(Simulation(problem_of(STEPS), resume_from=press).run())
    path = apart(whole, finer[2])
    above, below = (next(Simulation(problem_of(STEPS, path * (1.0 + beside)), resume_from=press).run()) for beside in (BESIDE, -BESIDE))
    counts += [above.cuts, above.substeps - 2, below.cuts - 1, below.substeps - 4]
    return {
        "forces": float(np.abs(forces[0] - forces[1]).max() / np.abs(forces[1]).max()),
        "works": float(np.abs(works[0] - works[1]).max() / np.abs(works[1]).max()),
        "rates": float(np.abs(rates.positions - 2.0 * twice.positions).max() / np.abs(rates.positions).max()),
        "counts": float(np.abs(counts).sum()),
        "path": path,
    }
