"""Runs of a study that are compared by what made them: what became of each, who is asked for them, and the page that shows them."""

from __future__ import annotations

import json
from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import field
from datetime import datetime
from itertools import groupby
from pathlib import Path
from types import MappingProxyType
from typing import Any, Generic, TypeVar

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.harness.cases import Words
from isomortar.harness.measurement import restored
from isomortar.harness.report import plain, template
from isomortar.harness.runner import Result
from isomortar.harness.statement import STATEMENT_STATES, Judgement, NotMeasuredError
from isomortar.harness.store import identity
from isomortar.harness.study import Conclusion
from isomortar.results.files import write_whole


@frozen
class Computed(ABC):
    """What became of a run that measures how many load steps are ``missing``, and ``words`` where one did not converge."""

    result: Result

    @property
    @abstractmethod
    def name(self) -> str:
        """What was computed, for people."""

    @property
    @abstractmethod
    def method(self) -> str:
        """What it was made by: what statements are judged on."""

    @property
    def ending(self) -> str:
        """In the words of a process's ending; what was skipped was not measured."""
        ending = self.result.measurement.ending
        if ending == "measured" and self.result.measurement.numbers["missing"]:
            return "not converged"
        return "not measured" if ending == "skipped" else ending

    @property
    def words(self) -> str:
        """Why it ended so; empty where all load steps are there."""
        said = restored(self.result.measurement.numbers.get("words"), Words)
        return said.text if said else self.result.measurement.reason

    def number(self, name: str) -> float:
        """One of its numbers; NaN: not known."""
        return float(np.asarray(self.result.measurement.numbers.get(name, np.nan), float))

    @property
    def cpu_seconds(self) -> float:
        """What it took; NaN: not known."""
        return self.number("cpu_seconds")

    def curves(self, name: str, *shape: int) -> FloatArray:
        """Numbers by load step, shape (load steps that converged, ...)."""
        return np.array(self.result.measurement.numbers.get(name, []), float).reshape(-1, *shape)


_Run = TypeVar("_Run", bound=Computed)


@frozen
class ByMethod(Generic[_Run]):
    """The runs by one method, beside those by the others, for the functions that measure.

    Parameters
    ----------
    runs : sequence of Computed
        By all methods.
    method : str
    left_out : list of str
        Runs that a measure had to do without, in words.
    """

    runs: Sequence[_Run]
    method: str
    left_out: list[str] = field(default_factory=list)

    @property
    def without(self) -> str:
        """Runs that did not come as far as a statement speaks of; empty: none."""
        return "; ".join(self.left_out)

    def by(self, method: str) -> list[_Run]:
        """The runs by a method, however far they came.

        Raises
        ------
        NotMeasuredError
            One ended by what says nothing of the problem; its program is not installed, say.
        """
        found = [run for run in self.runs if run.method == method]
        if lost := [run for run in found if run.ending not in ("measured", "not converged")]:
            raise NotMeasuredError("; ".join(dict.fromkeys(f"{run.method}: {run.words or run.ending}" for run in lost)))
        return found


def groups(runs: Sequence[_Run], by: Callable[[_Run], str]) -> list[list[_Run]]:
    """Runs that follow each other, by what `by` says of them."""
    return [list(group) for _, group in groupby(runs, by)]


def written(
    beside: Path,
    folder: Path,
    runs: Sequence[Computed],
    judgements: Sequence[Judgement],
    started: datetime,
    names: Sequence[str],
    sections: Sequence[Mapping[str, Any]],
    data: Mapping[str, Any],
    more: Mapping[str, Any] = MappingProxyType({}),
) -> Conclusion:
    """Write ``report.html`` and ``report.json``, and say what the study came to.

    Parameters
    ----------
    beside : Path
        Source file beside which ``page.html`` stands, which extends ``runs.html``.
    folder : Path
        Of the study.
    runs, judgements, started
        All that was run and judged, and when.
    names : sequence of str
        Of the methods.
    sections : sequence of mapping
        What the page's template takes of each scene: its ``setup``, and what it shows of it.
    data : mapping
        All numbers of the runs, for ``report.json``.
    more : mapping
        What the page's template takes besides.
    """
    path = folder / "report.html"
    unmeasured = [verdict for judgement in judgements for verdict in judgement.verdicts if verdict.state == "not measured"]
    failed = [run for run in runs if run.ending != "measured"]
    text = template("page.html", beside).render(
        judgements=judgements,
        names={name: name for name in names},
        sections=sections,
        total=len(runs),
        failed=failed,
        unmeasured=unmeasured,
        seconds=float(np.nansum([run.cpu_seconds for run in runs])),
        started=started,
        **more,
    )
    write_whole(path, text)
    stated = {"started": started.isoformat(timespec="seconds"), **identity(), "statements": [j.as_data() for j in judgements], **data}
    write_whole(path.with_suffix(".json"), json.dumps(plain(stated), indent=1))
    states = Counter(judgement.state for judgement in judgements)
    counted = ", ".join(f"{states[state]} {state}" for state in reversed(STATEMENT_STATES))
    return Conclusion(path, len(failed), not unmeasured, counted)
