"""A load step that is made of several increments records what all of them do: it is the load steps that they would be, one by one."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: A block turns on a wavy master about its axis by more than one increment may; nothing slips for ever, pressures go along.
SCENE = """
format = 1
[bodies.block]
geometry = { kind = "bowl", half_width = 0.3, bottom = 0, rise = 0.02, top = 0.4 }
mesh = { order = [2, 2, 1], elements = [3, 3, 1] }
[bodies.base]
geometry = { kind = "box", lower = [-0.8, -0.7, -0.4], upper = [0.9, 0.8, 0] }
mesh = { order = [2, 2, 1], elements = [3, 3, 1] }
[contacts.c]
slave = "block.w0"
master = "base.w1"
friction = 0.3
projection = "averaged"
[supports]
top.face = "block.w1"
ground.face = "base.w0"
[solver]
newton_tolerance = 1e-12
complementarity_tolerance = 1e-11
[[stages]]
name = "press"
steps = 1
motions.top.translate = [0, 0, -0.04]
[[stages]]
name = "turn"
steps = STEPS
motions.top = { rotate = 90, translate = [0.05, 0, 0] }
"""
#: By at most 36 degrees an increment.
PARTS = 3


def end_of(steps: int) -> list[StepResult]:
    """The load steps of the second stage."""
    return list(Simulation(Scene.from_toml(SCENE.replace("STEPS", str(steps))).problem()).run())[1:]


@case(
    claim="A turn in one load step of three increments is one in three load steps: forces at its end, works and iterations of all of them.",
    tier="gate",
    bounds={
        "forces": Bound(at_most=1e-9, reason="round-off: both end at Newton's 1e-12"),
        "works": Bound(at_most=1e-9, reason="round-off: sums of three works"),
        "counts": Bound(0.0, 0.0, "definition: increments, and augmentations that are recorded of them"),
        "rubbed": Bound(at_least=1e-3, reason="definition: friction takes up work"),
    },
)
def in_parts() -> dict[str, float]:
    """Largest relative differences; differences of counts; the work of friction."""
    (whole,), parts = end_of(1), end_of(PARTS)
    works = np.array([[c.friction_work, c.spurious_work] for step in parts for c in step.contacts]).sum(axis=0)
    own = np.array([whole.contacts[0].friction_work, whole.contacts[0].spurious_work])
    forces = np.array([reaction.force for reaction in parts[-1].reactions])
    apart = np.array([reaction.force for reaction in whole.reactions]) - forces
    counts = (whole.substeps - sum(step.substeps for step in parts), whole.cuts, whole.substeps - PARTS, len(whole.augmentations) - PARTS)
    return {
        "forces": float(np.abs(apart).max() / np.abs(forces).max()),
        "works": float(np.abs(own - works).max() / np.abs(works).max()),
        "counts": float(np.abs(counts).sum()),
        "rubbed": float(works[0]),
    }
