"""One run of a study: a scene file in one discretisation, computed to its end."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from isomortar.accuracy.discretisations import coarse_geometry
from isomortar.accuracy.sampling import Grid, body_grid, slave_grid, values_at
from isomortar.geometry.patch import FloatArray
from isomortar.harness.cases import Bound, Shown, measured
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.results.fields import body_points, contact_surfaces
from isomortar.scene.scene import Scene
from isomortar.solve.record import StepResult

#: Cells of the grid that displacements are compared on.
BODY_CELLS = 2000


@measured(
    claim="The scene is computed to its end.",
    bounds={
        "time": Shown("load times of the recorded steps"),
        "stage": Shown("number of each step's stage"),
        "force": Shown("on the moving supports, shape (supports, steps, 3)"),
        "moment": Shown("on the moving supports, shape (supports, steps, 3)"),
        "pressure": Shown("on the slave face at the end"),
        "displacement": Shown("in the swept body at the end, shape (cells, 3)"),
        "control_points": Shown("of all bodies"),
        "tangents": Bound(at_least=1, reason="definition: tangents of all load steps, factorised"),
        "cuts": Shown("load increments that were cut"),
        "cpu_seconds": Shown("of the computation alone"),
    },
)
def discretised(scene: str, body: str, contact: str) -> dict[str, Any]:
    """Curves and last fields of a scene file, and what they cost."""
    loaded = Scene.load(scene)
    problem = loaded.problem()
    start = time.process_time()
    simulation = Simulation(problem)
    steps = list(simulation.run())
    seconds = time.process_time() - start
    moving = [number for number, support in enumerate(problem.supports) if support.moves]
    stages = [stage.name for stage in problem.stages]
    number = [c.name for c in problem.contacts].index(contact)
    return {
        "time": [step.time for step in steps],
        "stage": [stages.index(step.stage) for step in steps],
        "force": [[step.reactions[s].force for step in steps] for s in moving],
        "moment": [[step.reactions[s].moment for step in steps] for s in moving],
        "pressure": pressure(problem, steps[-1], number, slave_grid(loaded, problem, number)),
        "displacement": displacement(problem, steps[-1], body, swept_grid(loaded, body)),
        "control_points": len(steps[-1].state.positions),
        "tangents": sum(step.counters["factorisations"] for step in steps),
        "cuts": sum(step.cuts for step in steps),
        "cpu_seconds": seconds,
    }


def swept_grid(scene: Scene, body: str) -> Grid:
    """Where the displacement of a body is sampled, the same for all discretisations."""
    return body_grid(coarse_geometry(scene, body), BODY_CELLS)


def pressure(problem: Problem, step: StepResult, contact: int, grid: Grid) -> FloatArray:
    """Contact pressure on the slave face, shape (cells,)."""
    surface = contact_surfaces(problem, step)[contact]
    return values_at(surface.directions, surface.weights, surface.pressure[:, None], grid)[:, 0]


def displacement(problem: Problem, step: StepResult, body: str, grid: Grid) -> FloatArray:
    """Displacement of a body, shape (cells, 3)."""
    patch = problem.body(body).patch
    moved: FloatArray = np.asarray(body_points(problem, step.state.positions)[body]) - patch.control_points
    return values_at(patch.directions, patch.weights, moved, grid)
