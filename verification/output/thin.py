"""Bodies that are read from a file: thin ones are, and such as have no volume are not."""

from __future__ import annotations

import tempfile
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
from output.records import SCENE, load_steps, recorded

from isomortar.errors import ResultsError
from isomortar.harness import Bound, case
from isomortar.results.reader import Results
from isomortar.scene import Scene


@case(
    claim="A load step is read whose bodies are pressed to a sheet of any thickness above round-off, and one without any is not.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: bodies that have a volume, or have none")},
)
def thin() -> dict[str, float]:
    """Of how many thicknesses it is otherwise."""
    problem, wrong = Scene.from_toml(SCENE).problem(), 0
    step = load_steps(problem)[0]
    for thickness in (1.0, 1e-3, 1e-9, 0.0):
        positions = step.state.positions * np.array([1.0, 1.0, thickness])
        with tempfile.TemporaryDirectory() as folder:
            recorded(Path(folder) / "run.h5", problem, [replace(step, state=replace(step.state, positions=positions))], "every")
            with Results(Path(folder) / "run.h5") as results:
                found = None
                with suppress(ResultsError):
                    found = results.step(1)
        wrong += (found is None) != (thickness == 0.0)
    return {"wrong": float(wrong)}
