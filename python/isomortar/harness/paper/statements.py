"""A statement of the paper, the numbers that measure it, their limit, and the verdict."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from isomortar.errors import IsomortarError
from isomortar.harness.paper.outcome import Outcome, Outcomes
from isomortar.harness.paper.studies import METHODS, Method, Study

State = Literal["holds", "does not hold", "not measured"]
#: Worst first.
STATES: tuple[State, ...] = ("does not hold", "not measured", "holds")
#: Values by what they are of ("N3 / N2"); all of them are judged.
Values = Mapping[str, float]


class NotMeasuredError(IsomortarError):
    """A run that a statement needs did not come to its end."""


@dataclass(frozen=True)
class Evidence:
    """The runs of all studies by one method, for the functions that measure."""

    outcomes: Outcomes
    method: Method

    def run(self, key: str) -> Outcome:
        """The run of a key such as ``twist-N3`` or ``iron-reference``.

        Raises
        ------
        NotMeasuredError
            It failed.
        """
        (found,) = self.all(key)
        if found.failure:
            raise NotMeasuredError(f"{found.key} failed: {found.failure}")
        return found

    def series(self, key: str) -> list[Outcome]:
        """The runs of a series such as ``iron-N``, lowest order first: of NURBS all, of Lagrange elements those that came to their end.

        Raises
        ------
        NotMeasuredError
            One of NURBS failed, or fewer than two are left.
        """
        found = self.all(key)
        ended = [o for o in found if not o.failure]
        lost = [o for o in found if o.failure and (not o.run.lagrange or len(ended) < min(2, len(found)))]
        if lost:
            raise NotMeasuredError("; ".join(f"{o.key} failed: {o.failure}" for o in lost))
        return ended

    def all(self, key: str) -> list[Outcome]:
        """The runs that a key stands for, those that failed too."""
        study, entry = _split(self.outcomes, key)
        return [found for name in study.names(entry) if (found := self.outcomes.named(study, name, self.method))]


@dataclass(frozen=True)
class Verdict:
    """What a statement says of the runs by one method; `why` it was not measured."""

    method: Method
    state: State
    values: Values
    why: str = ""


@dataclass(frozen=True)
class Statement:
    """A finding of the paper.

    Parameters
    ----------
    section : str
    text : str
        The finding in a sentence.
    needs : tuple of str
        Keys of the runs and series that it speaks of; a quick study that lacks one leaves the statement out.
    measure : callable
        From the evidence to the values that are judged.
    unit : str
        What the values are.
    at_most, at_least : float, optional
        Limit of every value.
    reason : str
        How the limit follows from the paper's words, never from what came out.
    methods : tuple of {"monolithic", "paper"}
        What it is judged on.
    percent : bool
        Whether the values are shown in per cent.
    """

    section: str
    text: str
    needs: tuple[str, ...]
    measure: Callable[[Evidence], Values]
    unit: str
    reason: str
    at_most: float | None = None
    at_least: float | None = None
    methods: tuple[Method, ...] = METHODS
    percent: bool = False

    def concerns(self, studies: tuple[Study, ...]) -> bool:
        """Whether the studies have all that it speaks of."""
        found = {study.scene: study for study in studies}
        pairs = [key.split("-", 1) for key in self.needs]
        return all(scene in found and found[scene].names(entry) for scene, entry in pairs)

    def judge(self, outcomes: Outcomes) -> Judgement:
        """The verdict by each method that all of its runs were planned by."""
        by_method = [Evidence(outcomes, method) for method in self.methods]
        return Judgement(self, tuple(self._verdict(e) for e in by_method if all(e.all(key) for key in self.needs)))

    def _verdict(self, evidence: Evidence) -> Verdict:
        try:
            values = dict(self.measure(evidence))
        except NotMeasuredError as error:
            return Verdict(evidence.method, "not measured", {}, str(error))
        broken = [name for name, value in values.items() if not math.isfinite(value)]
        if broken or not values:
            return Verdict(evidence.method, "not measured", values, f"no finite value: {', '.join(broken) or 'none at all'}")
        low, high = (-math.inf if self.at_least is None else self.at_least), (math.inf if self.at_most is None else self.at_most)
        return Verdict(evidence.method, "holds" if all(low <= v <= high for v in values.values()) else "does not hold", values)


@dataclass(frozen=True)
class Judgement:
    """A statement with its verdicts."""

    statement: Statement
    verdicts: tuple[Verdict, ...]

    @property
    def state(self) -> State:
        """The worst of the verdicts by methods whose runs came to their end; a method whose runs did not is shown beside it."""
        ended = [v.state for v in self.verdicts if v.state != "not measured" or v.values]
        return min(ended, key=STATES.index, default="not measured")


def successive(runs: list[Outcome], measure: Callable[[Outcome], float]) -> dict[str, float]:
    """A measure of each run over that of the one before it in the series."""
    found = [(run.run.name, measure(run)) for run in runs]
    return {f"{b} / {a}": _ratio(y, x) for (a, x), (b, y) in pairwise(found)}


def ratio(run: Outcome, other: Outcome, measure: Callable[[Outcome], float]) -> dict[str, float]:
    """A measure of a run over that of another."""
    return {f"{run.run.name} / {other.run.name}": _ratio(measure(run), measure(other))}


def each(runs: list[Outcome], measure: Callable[[Outcome], float]) -> dict[str, float]:
    """A measure of every run."""
    return {run.run.name: measure(run) for run in runs}


def _ratio(value: float, other: float) -> float:
    return value / other if other else math.inf if value else math.nan


def _split(outcomes: Outcomes, key: str) -> tuple[Study, str]:
    scene, entry = key.split("-", 1)
    return next(study for study in outcomes.studies if study.scene == scene), entry
