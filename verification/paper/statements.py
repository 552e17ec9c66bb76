"""A statement of the paper, the numbers that measure it, their limit, and the verdict."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Literal

from paper.outcome import Outcome, Outcomes
from paper.sections import METHODS, Method, Section

from isomortar.errors import IsomortarError

State = Literal["holds", "partly measured", "does not hold", "not measured"]
#: Worst first. ``partly measured``: what was measured is within the limit, by one of the methods or of some runs of a series only.
STATES: tuple[State, ...] = ("does not hold", "not measured", "partly measured", "holds")
#: Values by what they are of ("N3 / N2"); all of them are judged.
Values = Mapping[str, float]


class NotMeasuredError(IsomortarError):
    """A run that a statement needs did not come to its end."""


@dataclass(frozen=True)
class Evidence:
    """The runs of all sections by one method, for the functions that measure; `left_out`: those that they had to do without."""

    outcomes: Outcomes
    method: Method
    left_out: list[Outcome] = field(default_factory=list)

    def run(self, key: str) -> Outcome:
        """The run of a key such as ``twist-N3`` or ``iron-reference``.

        Raises
        ------
        NotMeasuredError
            It failed.
        """
        (found,) = self.all(key)
        if found.failure:
            raise NotMeasuredError(_reasons([found]))
        return found

    def series(self, key: str) -> list[Outcome]:
        """The runs of a series such as ``iron-N``, lowest order first: of NURBS all, of Lagrange elements those that came to their end.

        Raises
        ------
        NotMeasuredError
            One of NURBS failed, one of Lagrange elements for another reason than that it does not converge, or fewer than two are left.
        """
        found = self.all(key)
        ended = [o for o in found if not o.failure]
        failed = [o for o in found if o.failure]
        if len(ended) < min(2, len(found)) or not all(o.run.lagrange for o in failed):
            raise NotMeasuredError(_reasons(failed))
        self.left_out.extend(o for o in failed if o not in self.left_out)
        return ended

    def all(self, key: str) -> list[Outcome]:
        """The runs that a key stands for, those that do not converge too.

        Raises
        ------
        NotMeasuredError
            One failed for another reason.
        """
        found = self.planned(key)
        if any(o.lost for o in found):
            raise NotMeasuredError(_reasons([o for o in found if o.lost]))
        return found

    def planned(self, key: str) -> list[Outcome]:
        """The runs that a key stands for, however they ended."""
        section, entry = _split(self.outcomes, key)
        return [found for name in section.names(entry) if (found := self.outcomes.named(section, name, self.method))]


@dataclass(frozen=True)
class Verdict:
    """What a statement says of the runs by one method; `why` it was not measured, or not as a whole."""

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
        Keys of the runs and series that it speaks of; a quick section that lacks one leaves the statement out.
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

    def concerns(self, sections: tuple[Section, ...]) -> bool:
        """Whether the sections have all that it speaks of."""
        found = {section.scene: section for section in sections}
        pairs = [key.split("-", 1) for key in self.needs]
        return all(scene in found and found[scene].names(entry) for scene, entry in pairs)

    def judge(self, outcomes: Outcomes) -> Judgement:
        """The verdict by each method that all of its runs were planned by."""
        by_method = [Evidence(outcomes, method) for method in self.methods]
        return Judgement(self, tuple(self._verdict(e) for e in by_method if all(e.planned(key) for key in self.needs)))

    def _verdict(self, evidence: Evidence) -> Verdict:
        try:
            values = dict(self.measure(evidence))
        except NotMeasuredError as error:
            return Verdict(evidence.method, "not measured", {}, str(error))
        broken = [name for name, value in values.items() if not math.isfinite(value)]
        words = ", ".join(f"{o.key}, which failed: {o.failure}" for o in evidence.left_out)
        without = f"without {words}" if words else ""
        if broken or not values:
            return Verdict(
                evidence.method, "not measured", values, f"no finite value: {', '.join(broken) or 'none at all'} {without}".strip()
            )
        low, high = (-math.inf if self.at_least is None else self.at_least), (math.inf if self.at_most is None else self.at_most)
        kept = all(low <= v <= high for v in values.values())
        state: State = "does not hold" if not kept else "partly measured" if without else "holds"
        return Verdict(evidence.method, state, values, without)


@dataclass(frozen=True)
class Judgement:
    """A statement with its verdicts."""

    statement: Statement
    verdicts: tuple[Verdict, ...]

    @property
    def state(self) -> State:
        """What all methods agree on; that it does not hold where one of them says so; else it is partly measured."""
        found = {verdict.state for verdict in self.verdicts} or {"not measured"}
        if "does not hold" in found:
            return "does not hold"
        return found.pop() if len(found) == 1 else "partly measured"


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


def _reasons(failed: list[Outcome]) -> str:
    return "; ".join(f"{o.key} failed: {o.failure}" for o in failed)


def _split(outcomes: Outcomes, key: str) -> tuple[Section, str]:
    scene, entry = key.split("-", 1)
    return next(section for section in outcomes.sections if section.scene == scene), entry
