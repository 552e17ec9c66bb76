"""Files of the format before this one: contact forces had the other sign in it, and how far supports went was told by their motions."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
from output.records import RESUMED, SCENE, load_steps, unlike

from isomortar.errors import ResultsError
from isomortar.harness import Bound, case
from isomortar.results.files import sealed
from isomortar.results.layout import EARLIEST_VERSION, FORMAT_VERSION
from isomortar.results.reader import Results
from isomortar.results.writer import ResultsWriter
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: What had the other sign.
TURNED = ("force_slave", "force_master", "moment_slave", "moment_master")
#: How far the support `ground` of the scene has gone and turned after each load step, by its motions.
WAYS = np.array([[0, 0, 0.01], [0, 0, 0.02], [0.01, 0.01 / 3, 0.02], [0.02, 0.02 / 3, 0.02], [0.03, 0.01, 0.02]])
TURNS = np.array([0, 0, 5 / 3, 10 / 3, 5])


def as_before(path: Path, version: int | None) -> None:
    """Put a file into that format, with its number, or, as the first ones, without."""
    with h5py.File(path, "a") as file:
        for contact in file["curves/contacts"].values():
            for name in TURNED:
                contact[name][...] = -contact[name][()]
        for support in file["curves/supports"].values():
            del support["displacement"], support["rotation"]
        del file.attrs["format_version"]
        if version is not None:
            file.attrs["format_version"] = version
    path.write_bytes(sealed(path.read_bytes()))


def but_ways(step: StepResult) -> StepResult:
    """A load step without how far supports have gone."""
    nothing = tuple(replace(reaction, displacement=np.zeros(3), rotation=0.0) for reaction in step.reactions)
    return replace(step, reactions=nothing)


def wrong(path: Path, steps: list[StepResult]) -> int:
    """How many numbers of the load steps a file has otherwise, but for ways; and of those of contact forces as curves."""
    with Results(path) as results:
        count = sum(unlike(but_ways(results.step(step.step)), but_ways(step)) for step in steps)
        for number, contact in enumerate(results.problem.contacts):
            for name in TURNED:
                told = np.array([getattr(step.contacts[number], name) for step in steps])
                count += unlike(np.asarray(results.curve(name, contact=contact.name)), told)
    return count


@case(
    claim="A file of the earlier format has the signs of today when it is read, and when a run goes on in it; how far supports went before "
    "is what their motions say. Other formats are refused.",
    tier="gate",
    grid={"told": ("3", "nothing")},
    bounds={
        "read": Bound(0.0, 0.0, "definition: numbers of load steps that differ"),
        "gone on with": Bound(0.0, 0.0, "definition: numbers of load steps that differ"),
        "ways": Bound(at_most=1e-15, reason="round-off: sums of shares of motions"),
        "taken": Bound(0.0, 0.0, "definition: files of formats that are not known, and are read"),
    },
)
def earlier(told: str) -> dict[str, float]:
    """How much differs, of load steps whose numbers are all by chance."""
    problem = Scene.from_toml(SCENE).problem()
    steps, taken = load_steps(problem), 0
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run.h5"
        writer = ResultsWriter(path, problem, SCENE, "0")
        for step in steps[:RESUMED]:
            writer.recorded(step)
        now = path.read_bytes()
        as_before(path, int(told) if told.isdigit() else None)
        read = wrong(path, steps[:RESUMED])
        writer = ResultsWriter(path, problem, SCENE, "0", resume=True)
        for step in steps[RESUMED:]:
            writer.recorded(step)
        with Results(path) as results:
            ways, turns = results.curve("displacement", support="ground")[:RESUMED], results.curve("rotation", support="ground")[:RESUMED]
            pushed = results.curve("displacement", support="push")[:RESUMED]
            apart = [np.abs(ways - WAYS[:RESUMED]).max(), np.abs(turns - TURNS[:RESUMED]).max(), np.abs(pushed).max()]
            number = [support.name for support in problem.supports].index("ground")
            for of_step, way, turn in zip(steps[:RESUMED], WAYS, TURNS, strict=False):
                reaction = results.step(of_step.step).reactions[number]
                apart += [np.abs(reaction.displacement - way).max(), abs(reaction.rotation - turn)]
        gone_on = wrong(path, steps)
        for version in (EARLIEST_VERSION - 1, FORMAT_VERSION + 1):
            path.write_bytes(now)
            as_before(path, version)
            try:
                Results(path).close()
                taken += 1
            except ResultsError as error:
                taken += f"has format {version}" not in str(error)
    return {"read": float(read), "gone on with": float(gone_on), "ways": float(np.max(apart)), "taken": float(taken)}
