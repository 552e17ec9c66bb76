"""Tables for pandas and xarray: what these are given of a results file, against its load steps."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from output.records import SCENE, load_steps, recorded

from isomortar.harness import Bound, case
from isomortar.model.entities import Problem
from isomortar.results.reader import Results
from isomortar.results.table import data_frame, data_set
from isomortar.scene import Scene
from isomortar.solve.record import StepResult


@contextmanager
def given(**packages: Any) -> Iterator[None]:
    """Other packages by some names: these take down what they are given."""
    before = {name: sys.modules.get(name) for name in packages}
    sys.modules.update(packages)
    try:
        yield
    finally:
        for name, module in before.items():
            sys.modules.pop(name)
            if module is not None:
                sys.modules[name] = module


def tabulated(problem: Problem, steps: list[StepResult]) -> Any:
    """Columns and index of the table of a run; its arrays, their places and attributes."""
    pandas = SimpleNamespace(DataFrame=lambda columns, index: (columns, index), Index=lambda values, name: (values, name))
    xarray = SimpleNamespace(Dataset=lambda arrays, coords, attrs: (arrays, coords, attrs))
    with tempfile.TemporaryDirectory() as folder, given(pandas=pandas, xarray=xarray):
        path = Path(folder) / "run.h5"
        recorded(path, problem, steps, "last")
        with Results(path) as results:
            return data_frame(results), data_set(results)


@case(
    claim="A table has the numbers of the load steps, by their numbers: columns by name, and arrays over supports, contacts and loads.",
    tier="gate",
    bounds={
        "index": Bound(at_most=0.0, reason="definition: numbers of the load steps, which begin at one"),
        "frame": Bound(at_most=0.0, reason="definition: the numbers of the load steps"),
        "arrays": Bound(at_most=0.0, reason="definition: the numbers of the load steps"),
        "names": Bound(0.0, 0.0, "definition: names along supports, contacts and loads that are others than in the scene"),
        "places": Bound(
            0.0, 0.0, "definition: dimensions of arrays without places, or places along what no array has; without contacts too"
        ),
    },
)
def tables() -> dict[str, float]:
    """Largest differences from the load steps, of forces of supports, loads and contacts; and wrong names and dimensions."""
    problem = Scene.from_toml(SCENE).problem()
    steps = load_steps(problem)
    (frame, (index, _)), (arrays, places, _) = told = tabulated(problem, steps)
    bare = [replace(step, contacts=(), state=replace(step.state, contacts=(), rates=None)) for step in steps]
    alone = tabulated(replace(problem, contacts=()), bare)
    numbers = np.array([step.step for step in steps])
    sides: dict[str, tuple[Any, Any, str]] = {
        "force": ([[r.force for r in step.reactions] for step in steps], problem.supports, "{}"),
        "force_master": ([[c.force_master for c in step.contacts] for step in steps], problem.contacts, "{}"),
        "load_force": ([[load.force for load in step.loads] for step in steps], problem.loads, "load.{}"),
    }
    of_frame = of_arrays = 0.0
    for name, (values, owners, label) in sides.items():
        exact = np.array(values)
        named = [label.format(owner.name) for owner in owners]
        columns = [[frame[f"{name.removeprefix('load_')}.{owner}.{k}"] for k in "xyz"] for owner in named]
        of_frame = float(np.maximum(of_frame, np.abs(np.array(columns).transpose(2, 0, 1) - exact).max()))
        of_arrays = float(np.maximum(of_arrays, np.abs(arrays[name][1] - exact).max()))
    wrong = [list(places[kind]) != [owner.name for owner in getattr(problem, f"{kind}s")] for kind in ("support", "contact", "load")]
    return {
        "index": float(np.abs(np.asarray(index) - numbers).max() + np.abs(np.asarray(places["step"]) - numbers).max()),
        "frame": of_frame,
        "arrays": of_arrays,
        "names": float(sum(wrong)),
        "places": float(sum(unplaced(arrays, places) for _, (arrays, places, _) in (told, alone))),
    }


def unplaced(arrays: Mapping[str, Any], places: Mapping[str, Any]) -> int:
    """Dimensions of arrays that have no places, and places along what is no dimension of one."""
    dimensions = {name for array in arrays.values() for name in array[0]} | {"time", "stage"}
    return len(dimensions ^ places.keys())
