"""One run: a scene file computed to its end, from where it was if it was killed, and its curves."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

import numpy as np

from isomortar.driver import run
from isomortar.harness.cases import Bound, Shown, measured
from isomortar.harness.store import program_hash
from isomortar.results.reader import Results
from isomortar.scene.scene import Scene
from isomortar.solve.record import Observer


@measured(
    claim="The run comes to its end.",
    bounds={
        "step": Shown("numbers of the recorded load steps"),
        "time": Shown("load times of the recorded steps"),
        "stage": Shown("number of each step's stage"),
        "share": Shown("of each step's stage, how much is done"),
        "force": Shown("on the moving support, shape (steps, 3)"),
        "moment": Shown("on the moving support, shape (steps, 3)"),
        "pressure": Shown("smallest and largest value of the pressure field at contact quadrature points, shape (steps, 2)"),
        "control_pressure": Shown("smallest control pressure, shape (steps,)"),
        "traction": Shown("root mean square of the covariant control tractions by surface direction, shape (steps, 2)"),
        "traction_norm": Shown("root mean square of the lengths of the control tractions, shape (steps,)"),
        "control_points": Shown("of all bodies"),
        "tangents": Bound(at_least=1, reason="definition: tangents of all load steps, factorised"),
        "factorisations": Shown("of tangents by load step, shape (steps,)"),
        "solves": Shown("linear solves by load step, those with kept factors too, shape (steps,)"),
        "friction_work": Shown("by load step, shape (steps,)"),
        "spurious_work": Shown("of pressures along averaged normals, by load step, shape (steps,)"),
        "augmentations": Shown("of all load steps; one an increment where multipliers are unknowns"),
        "cuts": Shown("load increments that were cut"),
        "seconds": Shown("wall clock of the recorded load steps, also of those before a kill"),
    },
)
def computed(scene: str) -> dict[str, Any]:
    """Curves of a scene file's run, and what it cost."""
    path = Path(scene)
    with run(Scene.load(path), results_file(path), Observer(), resume=True) as results:
        return curves(results)


def results_file(scene: Path) -> Path:
    """Where a scene file's run is kept: what another program, or another text, made is never continued."""
    key = hashlib.sha256(scene.read_bytes() + program_hash().encode()).hexdigest()
    return scene.parent.parent / "runs" / f"{scene.stem}-{key[:12]}.h5"


def curves(results: Results) -> dict[str, Any]:
    """Curves over the recorded load steps, of a run that may have ended early, and what they cost.

    Raises
    ------
    ResultsError
        The file is damaged, or holds no load step.
    """
    problem = results.problem
    moving = next(support for support in problem.supports if support.moves)
    stages = [stage.name for stage in problem.stages]
    ends = np.cumsum([0, *(stage.steps for stage in problem.stages)])
    stage = np.array([stages.index(name) for name in results.stages])
    time = np.asarray(results.curve("time"), float)
    contact = results.contact(problem.contacts[0].name)
    return {
        "step": results.steps,
        "time": time,
        "stage": stage,
        "share": (time - ends[stage]) / np.diff(ends)[stage],
        "force": results.curve("force", support=moving.name),
        "moment": results.curve("moment", support=moving.name),
        "pressure": results.curve("pressure_field", contact=contact.contact.name),
        "control_pressure": contact.pressure.min(axis=1),
        "traction": np.sqrt((contact.traction**2).mean(axis=1)),
        "traction_norm": np.sqrt((contact.traction_norm**2).mean(axis=1)),
        "control_points": len(results.step(int(results.steps[-1])).state.positions),
        "tangents": results.counters()["factorisations"].sum(),
        **{counter: results.counters()[counter] for counter in ("factorisations", "solves")},
        **{work: results.curve(work, contact=contact.contact.name) for work in ("friction_work", "spurious_work")},
        "augmentations": results.augmentations().sum(),
        "cuts": results.curve("cuts").sum(),
        "seconds": results.timings()["total"].sum(),
    }
