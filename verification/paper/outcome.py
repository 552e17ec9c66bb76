"""What became of the runs of a section: curves of those that ended, and of those that failed what had converged."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from paper.run import computed, curves, results_file
from paper.sections import Method, Section, Variant

from isomortar.errors import ResultsError
from isomortar.geometry.patch import FloatArray
from isomortar.harness.measurement import Stored, stored
from isomortar.harness.runner import Result
from isomortar.harness.study import Run
from isomortar.results.reader import Results


@dataclass(frozen=True)
class Outcome:
    """A variant by a method, and how its run ended.

    Parameters
    ----------
    section : Section
    variant : Variant
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
    variant: Variant
    method: Method
    path: Path
    failure: str
    lost: bool
    numbers: Mapping[str, Any]

    @property
    def key(self) -> str:
        """Section and variant: ``twist-N3``."""
        return f"{self.section.scene}-{self.variant.name}"

    @cached_property
    def total_steps(self) -> int:
        """Load steps of the whole run."""
        return self.section.load(self.variant, self.method).problem().total_steps

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
        """The recorded load steps within the section's window; empty where the run did not come there."""
        last = self.array("stage") == len(self.section.load(self.variant, self.method).tables.stages) - 1
        share, (begin, end) = self.array("share"), self.section.window
        within = np.flatnonzero(last & (share >= begin - 1e-9) & (share <= end + 1e-9))
        return slice(int(within[0]), int(within[-1]) + 1) if len(within) else slice(0, 0)

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
        run = section.variant(name)
        return next((o for o in self.of(section, method) if o.variant == run), None)


def planned(sections: Sequence[Section]) -> list[tuple[Section, Variant, Method]]:
    """All that is run, in this order."""
    return [(section, variant, method) for section in sections for variant in section.variants for method in variant.methods]


def run_of(section: Section, variant: Variant, method: Method) -> Run:
    """The run of a variant by a method.

    Raises
    ------
    InputError
        The scene is wrong.
    """
    scene = section.load(variant, method)
    scene.problem()
    return Run(f"{section.scene}-{variant.name}-{method}", scene, computed, leaves=results_file)


def outcome(section: Section, variant: Variant, method: Method, result: Result) -> Outcome:
    """How a run ended, with what its results file holds if it failed."""
    path, measurement = results_file(Path(result.cell.settings["scene"])), result.measurement
    if measurement.ending == "measured":
        return Outcome(section, variant, method, path, "", False, measurement.numbers)
    numbers: dict[str, Stored]
    try:
        with Results(path) as results:
            numbers = {name: stored(value) for name, value in curves(results).items()}
    except ResultsError:
        numbers = {}
    return Outcome(section, variant, method, path, measurement.reason, measurement.ending != "not converged", numbers)
