"""The evidence for the paper's statements: runs and series by their keys, and the quotients that most statements are about."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import field
from itertools import pairwise

from paper.outcome import Outcome, Outcomes
from paper.sections import METHODS, Method, Section

from isomortar._frozen import frozen
from isomortar.harness import statement
from isomortar.harness.statement import Judgement, NotMeasuredError


@frozen
class Evidence:
    """The runs of all sections by one method, for the functions that measure; `left_out`: those that they had to do without."""

    outcomes: Outcomes
    method: Method
    left_out: list[Outcome] = field(default_factory=list)

    @property
    def without(self) -> str:
        """What was left out, in words."""
        return ", ".join(f"{o.key}, which failed: {o.failure}" for o in self.left_out)

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
        if len(ended) < min(2, len(found)) or not all(o.variant.lagrange for o in failed):
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


@frozen
class Statement(statement.Statement[Evidence]):
    """A finding of the paper, judged on runs by both methods where it does not say on which."""

    methods: tuple[Method, ...] = METHODS

    def concerns(self, sections: tuple[Section, ...]) -> bool:
        """Whether the sections have all that it speaks of."""
        found = {section.scene: section for section in sections}
        pairs = [key.split("-", 1) for key in self.needs]
        return all(scene in found and found[scene].names(entry) for scene, entry in pairs)

    def judge(self, outcomes: Outcomes) -> Judgement:
        """The verdict by each method that all of its runs were planned by."""
        by_method = [Evidence(outcomes, method) for method in self.methods]
        return self.judged([e for e in by_method if all(e.planned(key) for key in self.needs)])


def successive(runs: list[Outcome], measure: Callable[[Outcome], float]) -> dict[str, float]:
    """A measure of each run over that of the one before it in the series."""
    found = [(run.variant.name, measure(run)) for run in runs]
    return {f"{b} / {a}": quotient(y, x) for (a, x), (b, y) in pairwise(found)}


def ratio(run: Outcome, other: Outcome, measure: Callable[[Outcome], float]) -> dict[str, float]:
    """A measure of a run over that of another."""
    return {f"{run.variant.name} / {other.variant.name}": quotient(measure(run), measure(other))}


def each(runs: list[Outcome], measure: Callable[[Outcome], float]) -> dict[str, float]:
    """A measure of every run."""
    return {run.variant.name: measure(run) for run in runs}


def quotient(value: float, other: float) -> float:
    """A value over another; not a number where both are nothing."""
    return value / other if other else math.inf if value else math.nan


def _reasons(failed: list[Outcome]) -> str:
    return "; ".join(f"{o.key} failed: {o.failure}" for o in failed)


def _split(outcomes: Outcomes, key: str) -> tuple[Section, str]:
    scene, entry = key.split("-", 1)
    return next(section for section in outcomes.sections if section.scene == scene), entry
