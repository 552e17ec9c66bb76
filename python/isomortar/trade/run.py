"""One run of a trade: a scene file computed to its end, what users look at, and what it cost."""

from __future__ import annotations

import time
from collections import Counter
from typing import Any

import numpy as np

from isomortar.accuracy.sampling import Grid, slave_grid, values_at
from isomortar.errors import LostProjectionError
from isomortar.geometry.patch import FloatArray
from isomortar.harness.cases import Bound, Shown, Words, measured
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.results.fields import ContactSurface, contact_surfaces
from isomortar.results.gaps import gaps
from isomortar.scene.scene import Scene
from isomortar.solve.record import Observer, StepResult
from isomortar.solve.timing import PHASES


@measured(
    claim="The scene is computed to its end.",
    bounds={
        "time": Shown("of the load steps; every stage has length one"),
        "force": Shown("of the supports, shape (supports, steps, 3)"),
        "moment": Shown("of the supports, shape (supports, steps, 3)"),
        "displacement": Shown("of the supports, by motions and by forces, shape (supports, steps, 3)"),
        "area": Shown("where there is pressure, in the reference configuration, shape (contacts, steps)"),
        "pressure": Shown("at the end on the cells of all slave faces"),
        "traction": Shown("its magnitude, likewise"),
        "cells": Shown("areas of these cells"),
        "gap": Shown("largest penetration of each contact at the end, at the middle of these cells, over the size of the slave's body"),
        "counts": Shown("cells of each contact"),
        "images": Bound(at_least=1, reason="definition: how many parts the whole has by symmetry, one of which is computed"),
        "unknowns": Bound(at_least=1, reason="definition: three a control point"),
        "solves": Bound(at_least=1, reason="definition: linear solves of all load steps"),
        "cuts": Shown("load increments that were cut"),
        "phases": Shown("CPU seconds of solid, projection, contact, factors, solves"),
        "cpu_seconds": Shown("of the computation alone"),
        "warnings": Shown("what it warned of, each once, a line a warning"),
    },
)
def traded(scene: str) -> dict[str, Any]:
    """Curves and last fields of a scene file, and what they cost."""
    loaded = Scene.load(scene)
    problem = loaded.problem()
    told = _Told()
    start = time.process_time()
    steps = list(Simulation(problem, told).run())
    seconds = time.process_time() - start
    grids = [slave_grid(loaded, problem, n) if len(c.slave.faces) == 1 else None for n, c in enumerate(problem.contacts)]
    fields = [_fields(problem, step, grids) for step in steps]
    phases: Counter[str] = Counter()
    for step in steps:
        phases.update({name: step.timings[name] for name in PHASES})
    return {
        "time": stage_times(problem),
        "force": [[step.reactions[n].force for step in steps] for n in range(len(problem.supports))],
        "moment": [[step.reactions[n].moment for step in steps] for n in range(len(problem.supports))],
        "displacement": [[step.reactions[n].displacement for step in steps] for n in range(len(problem.supports))],
        "area": problem.images
        * np.array([[float(g.weights @ (p > 0)) if g else np.nan for g, p in zip(grids, f[0], strict=True)] for f in fields]).T,
        "pressure": np.concatenate([np.zeros(0), *fields[-1][0]]),
        "traction": np.concatenate([np.zeros(0), *fields[-1][1]]),
        "cells": np.concatenate([np.zeros(0), *(g.weights for g in grids if g)]),
        "gap": [_penetration(problem, steps[-1], s, g) for s, g in zip(contact_surfaces(problem, steps[-1]), grids, strict=True)],
        "counts": [len(g.weights) if g else 0 for g in grids],
        "images": problem.images,
        "unknowns": 3 * len(steps[-1].state.positions),
        "solves": sum(step.counters["solves"] for step in steps),
        "cuts": sum(step.cuts for step in steps),
        "phases": [phases[name] for name in PHASES],
        "cpu_seconds": seconds,
        "warnings": Words("\n".join(dict.fromkeys(told.warnings))),
    }


class _Told(Observer):
    """Keeps what a run warns of."""

    def __init__(self) -> None:
        self.warnings: list[str] = []

    def warned(self, message: str) -> None:
        self.warnings.append(message)


def stage_times(problem: Problem) -> FloatArray:
    """Times of all load steps where each stage takes one, however many steps it has."""
    return np.concatenate([number + np.arange(1, stage.steps + 1) / stage.steps for number, stage in enumerate(problem.stages)])


def _fields(problem: Problem, step: StepResult, grids: list[Grid | None]) -> tuple[list[FloatArray], list[FloatArray]]:
    """Pressure and magnitude of the traction on the cells of each slave face: what acts of them (theory 8.7)."""
    found: tuple[list[FloatArray], list[FloatArray]] = ([], [])
    for surface, grid in zip(contact_surfaces(problem, step), grids, strict=True):
        for of_one, control in zip(found, (surface.pressure[:, None], surface.traction[:, None]), strict=True):
            of_one.append(_acting(surface, control, grid) if grid else np.zeros(0))
    return found


def _acting(surface: ContactSurface, control: FloatArray, grid: Grid) -> FloatArray:
    """What acts of a field on the cells of a slave face, shape (cells,)."""
    values = values_at(surface.directions, surface.weights, np.hstack([surface.reference_points, control]), grid)
    return surface.footing.acting(values[:, :3], values[:, 3:], control)[:, 0]


def _penetration(problem: Problem, step: StepResult, surface: ContactSurface, grid: Grid | None) -> float:
    """Largest penetration on the cells of a slave face over the size of its body; NaN where it cannot be told."""
    if grid is None:
        return float("nan")
    points = values_at(surface.directions, surface.weights, surface.points, grid)
    try:
        found = gaps(problem, surface.contact, step.state.positions, points)
    except LostProjectionError:
        return float("nan")
    return float(np.nanmax(found, initial=0.0)) / problem.body(surface.contact.slave.body).size
