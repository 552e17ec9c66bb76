"""When loops end, and increments grow or shorten: by tangents, changes and solves, as the documents say and the log counts them."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Literal
from unittest.mock import patch

import numpy as np

from isomortar.errors import ConvergenceError
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model import constants
from isomortar.model.entities import Problem
from isomortar.model.settings import SolverSettings
from isomortar.scene import Scene
from isomortar.solve.method import Increment
from isomortar.solve.monolithic import Monolithic
from isomortar.solve.newton import KEPT_FACTORS
from isomortar.solve.record import IterationRecord, State, StepResult

#: A pad that is pressed onto a plane, and then pressed and dragged by a little more, so that some of it slips.
SCENE = """
format = 1
bodies.pad = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }, mesh = { order = 2, elements = [2, 2, 1] } }
contacts.floor = { slave = "pad.w0", plane = { point = [0, 0, 0] }, friction = 0.3 }
supports.top.face = "pad.w1"
stages = [
    { name = "press", steps = 1, motions.top.translate = [0.005, 0, -0.03] },
    { name = "more", steps = 4, motions.top.translate = [0.002, 0.001, -0.004] },
]
"""
ADVANCE = Monolithic.advance


def problem_of(**settings: object) -> Problem:
    """The scene with some settings of the solver."""
    problem = Scene.from_toml(SCENE).problem()
    return replace(problem, settings=replace(problem.settings, **settings))  # type: ignore[arg-type]


@case(
    claim="A Newton loop may take so many tangents as the scene says; iterations by the factors of an earlier one are none.",
    tier="gate",
    bounds={
        "enough": Bound(0.0, 0.0, "definition: whether it is refused where it takes just as many as it may"),
        "too few": Bound(1.0, 1.0, "definition: whether it is where it would take one more"),
        "kept": Bound(at_least=1.0, reason="definition: iterations by earlier factors before the last tangent, or nothing is tried"),
    },
)
def most_tangents() -> dict[str, float]:
    """Whether the first load step is refused with as many tangents as it takes, and with one less; iterations without one."""
    measures = tuple(name for name in SolverSettings().measures if name != "extrapolation")
    with patch.multiple(constants, KEPT_SHARE=0.9, KEPT_FAR=0.9):  # as long as they help at all, so that some do before the last tangent
        (record,) = next(Simulation(problem_of(measures=measures)).run()).augmentations
        own = np.array([KEPT_FACTORS not in iteration.notes for iteration in record.iterations[1:]])
        tangents, refused = int(own.sum()), []
        for most in (tangents, tangents - 1):
            try:
                refused.append(next(Simulation(problem_of(measures=measures, max_iterations=most, max_cuts=0)).run()).cuts)
            except ConvergenceError:
                refused.append(1)
    return {"enough": float(refused[0]), "too few": float(refused[1]), "kept": float(np.flatnonzero(own)[-1] + 1 - tangents)}


@case(
    claim="What an augmentation is said to change is how far its multipliers are from those before it: apart, or in the paper's norm.",
    tier="gate",
    grid={"norm": ("separate", "paper")},
    bounds={
        "changes": Bound(at_most=1e-9, reason="definition: of load steps with one augmentation, whose start and end are recorded"),
        "single": Bound(at_least=2.0, reason="definition: there are some"),
        "size": Bound(at_least=1e-3, reason="definition: something changes"),
    },
)
def changes(norm: Literal["separate", "paper"]) -> dict[str, float]:
    """Largest difference of changes, over them, from those of recorded states; how many load steps, and the least change."""
    settings = {"augmentation_tolerance": 0.1, "penalty_normal": 1e3, "penalty_tangential": 1e3, "newton_tolerance": 1e-12}
    steps = list(Simulation(problem_of(method="uzawa", augmentation_norm=norm, **settings)).run())
    off, sizes = [], []
    for before, after in pairwise(steps):
        if len(after.augmentations) > 1:
            continue
        (old,), (new,), (record,) = before.state.contacts, after.state.contacts, after.augmentations
        squares = [
            (np.sum((some - other) ** 2), np.sum(other**2)) for some, other in ((new.pressure, old.pressure), (new.traction, old.traction))
        ]
        if norm == "paper":
            squares = [np.sum(squares, axis=0)] * 2
        wanted = np.array([np.sqrt(change / size) for change, size in squares])
        off.append(np.abs(np.array([record.change_pressure, record.change_traction]) / wanted - 1.0).max())
        sizes.append(wanted.min())
    return {"changes": float(np.max(off)), "single": float(len(off)), "size": float(np.min(sizes))}


#: The length of the first increment over the longest; tangents and kept factors of all loops, in whose words they are said; the next
#: length. With a tolerance for the path an increment has three loops, the first of which, that of the whole, is not kept.
SAID: tuple[tuple[float, tuple[tuple[int, int], ...], float], ...] = (
    (1.0, ((12, 0),), 1.0),
    (1.0, ((24, 30),), 1.0),
    (1.0, ((25, 0),), 0.5),
    (0.5, ((13, 0), (13, 0)), 0.5),
    (0.5, ((13, 0), (6, 7)), 0.5),
    (0.5, ((13, 0), (12, 0)), 1.0),
    (1.0, ((30, 0), (24, 3), (24, 2)), 1.0),
    (1.0, ((1, 0), (25, 0), (1, 0)), 0.5),
    (1.0, ((1, 0), (1, 0), (25, 3)), 0.5),
    (0.5, ((1, 0), (13, 0), (1, 0), (1, 0), (1, 0), (13, 0)), 0.5),
    (0.5, ((30, 0), (13, 0), (1, 0), (30, 0), (12, 0), (1, 0)), 1.0),
)


def next_length(first: StepResult, begun: float, loops: tuple[tuple[int, int], ...]) -> float:
    """The next increment after the second load step, of one increment or two, whose loops are said to be these."""
    said = iter(loops)

    def advance(method: Monolithic, start: State, time: float, step: int) -> Increment:
        increment = ADVANCE(method, start, time, step)
        tangents, kept = next(said)
        notes = [()] + [()] * tangents + [(KEPT_FACTORS,)] * kept
        log = tuple(IterationRecord(k, 1.0, 1, 1, 0, note) for k, note in enumerate(notes))
        return replace(increment, augmentations=(replace(increment.augmentations[0], iterations=log),))

    halves = len(loops) * begun > 1.0
    with patch.object(Monolithic, "advance", advance):
        simulation = Simulation(problem_of(path_tolerance=1.0 if halves else None), resume_from=replace(first, next_increment=begun))
        return next(simulation.run()).next_increment


@case(
    claim="Increments grow back after loops of 12 solves or fewer, and shorten after 25 tangents or more, in whichever of two halves.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: docs/theory.md says when")},
)
def next_lengths() -> dict[str, float]:
    """How many increments are followed by another length than they should be."""
    first = next(Simulation(problem_of()).run())
    return {"wrong": float(sum(next_length(first, begun, loops) != wanted for begun, loops, wanted in SAID))}
