"""What became of the runs of a section: curves of those that ended, and of those that failed what had converged."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from paper import run as cells
from paper.sections import Method, Run, Section

from isomortar.errors import InputError, ResultsError
from isomortar.geometry.patch import FloatArray
from isomortar.harness.cases import Cell
from isomortar.harness.measurement import Measurement, Stored, stored
from isomortar.harness.store import Store, write_whole
from isomortar.results.reader import Results


@dataclass(frozen=True)
class Outcome:
    """A run by a method, and how it ended.

    Parameters
    ----------
    section : Section
    run : Run
    method : {"monolithic", "paper"}
    path : Path
        Its results file.
    failure : str
        Why it did not come to its end; empty: it did.
    lost : bool
        Whether that is not that it does not converge, but the machine's (a crash, no time, no memory, no disk) or a mistake of the
        program: nothing follows from it.
    numbers : dict
        As of `paper.run.curves`, up to where it came; empty: no load step converged.
    """

    section: Section
    run: Run
    method: Method
    path: Path
    failure: str
    lost: bool
    numbers: Mapping[str, Any]

    @property
    def key(self) -> str:
        """Section and run: ``twist-N3``."""
        return f"{self.section.scene}-{self.run.name}"

    @cached_property
    def total_steps(self) -> int:
        """Load steps of the whole run."""
        return self.section.load(self.run, self.method).problem().total_steps

    @property
    def steps(self) -> int:
        """Load steps that converged."""
        return len(self.numbers["step"]) if self.numbers else 0

    @property
    def curve(self) -> FloatArray:
        """The section's quantity over the recorded load steps, shape (steps,)."""
        return self.array(self.section.quantity.kind)[:, "xyz".index(self.section.quantity.component)]

    def array(self, name: str) -> FloatArray:
        """One of its numbers over the recorded load steps."""
        return np.asarray(self.numbers[name], float)

    @property
    def window(self) -> slice:
        """The recorded load steps within the section's window."""
        last = self.array("stage") == len(self.section.load(self.run, self.method).tables.stages) - 1
        share, (begin, end) = self.array("share"), self.section.window
        within = np.flatnonzero(last & (share >= begin - 1e-9) & (share <= end + 1e-9))
        return slice(int(within[0]), int(within[-1]) + 1)

    @contextmanager
    def results(self) -> Iterator[Results]:
        """Its results file, open."""
        with Results(self.path) as results:
            yield results


@dataclass(frozen=True)
class Outcomes:
    """All runs of the chosen sections."""

    sections: tuple[Section, ...]
    entries: tuple[Outcome, ...]

    def of(self, section: Section, method: Method | None = None) -> list[Outcome]:
        """The runs of a section, in its order, by one method or by both."""
        return [o for o in self.entries if o.section == section and method in (None, o.method)]

    def named(self, section: Section, name: str, method: Method) -> Outcome | None:
        """The run of a name by a method; None where the section does not have it."""
        if not section.names(name):
            return None
        run = section.run(name)
        return next((o for o in self.of(section, method) if o.run == run), None)


def cells_of(sections: Sequence[Section], folder: Path) -> list[tuple[Section, Run, Method, Cell]]:
    """A cell a run and method; their scene files go to the folder, to be run by anyone.

    Raises
    ------
    InputError
        A scene is wrong, or the results file of a run that was measured is gone.
    """
    planned, store = [], Store(folder / "cells")
    for section in sections:
        for run in section.runs:
            for method in run.methods:
                path = folder / "scenes" / f"{section.scene}-{run.name}-{method}.toml"
                scene = section.load(run, method)
                scene.problem()
                write_whole(path, scene.to_toml())
                cell = Cell(replace(cells.computed, files=(path.absolute(),)), {"scene": str(path)})
                if store.get(cell) and not cells.results_file(path).exists():
                    raise InputError(f"{cells.results_file(path)} is gone; remove {store.folder} too, and what is missing is run again")
                planned.append((section, run, method, cell))
    return planned


def outcome(section: Section, run: Run, method: Method, cell: Cell, measurement: Measurement) -> Outcome:
    """How a run ended, with what its results file holds if it failed."""
    path = cells.results_file(Path(cell.settings["scene"]))
    if measurement.ending == "measured":
        return Outcome(section, run, method, path, "", False, measurement.numbers)
    numbers: dict[str, Stored]
    try:
        with Results(path) as results:
            numbers = {name: stored(value) for name, value in cells.curves(results).items()}
    except ResultsError:
        numbers = {}
    return Outcome(section, run, method, path, measurement.reason, measurement.ending != "not converged", numbers)
