"""Statements of a study: a sentence, the numbers that measure it, their limit with its reason, and the verdict."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Generic, Literal, Protocol, TypeVar

from isomortar._frozen import frozen
from isomortar.errors import IsomortarError

StatementState = Literal["holds", "partly measured", "does not hold", "not measured"]
#: Worst first. ``partly measured``: what was measured is within the limit, by one of the methods or of some runs only.
STATEMENT_STATES: tuple[StatementState, ...] = ("does not hold", "not measured", "partly measured", "holds")
#: Values by what they are of ("N3 / N2"); all of them are judged.
Values = Mapping[str, float]


class NotMeasuredError(IsomortarError):
    """A run that a statement needs did not come to its end."""


class Evidence(Protocol):
    """The runs by one method, for the functions that measure."""

    @property
    def method(self) -> str:
        """What all of them were made by."""

    @property
    def without(self) -> str:
        """Runs that the measure had to do without and why, in words; empty: none."""


_Evidence = TypeVar("_Evidence", bound=Evidence)


@frozen
class Verdict:
    """What a statement says of the runs by one method; `why` it was not measured, or not as a whole."""

    method: str
    state: StatementState
    values: Values
    why: str = ""


@frozen
class Statement(Generic[_Evidence]):
    """A finding that somebody states.

    Parameters
    ----------
    section : str
        Where.
    text : str
        The finding in a sentence.
    needs : tuple of str
        Keys of the runs that it speaks of; a study that lacks one leaves the statement out.
    measure : callable
        From the evidence to the values that are judged. What it raises as `NotMeasuredError` is told.
    unit : str
        What the values are.
    reason : str
        How the limit follows from what is stated, never from what came out.
    at_most, at_least : float, optional
        Limit of every value.
    methods : tuple of str
        What it is judged on.
    percent : bool
        Whether the values are shown in per cent.
    """

    section: str
    text: str
    needs: tuple[str, ...]
    measure: Callable[[_Evidence], Values]
    unit: str
    reason: str
    at_most: float | None = None
    at_least: float | None = None
    methods: tuple[str, ...] = ()
    percent: bool = False

    def judged(self, evidence: Sequence[_Evidence]) -> Judgement:
        """The verdict by each method."""
        return Judgement(self, tuple(map(self._verdict, evidence)))

    def _verdict(self, evidence: _Evidence) -> Verdict:
        try:
            values = dict(self.measure(evidence))
        except NotMeasuredError as error:
            return Verdict(evidence.method, "not measured", {}, str(error))
        broken = [name for name, value in values.items() if not math.isfinite(value)]
        without = f"without {evidence.without}" if evidence.without else ""
        if broken or not values:
            why = f"no finite value: {', '.join(broken) or 'none at all'} {without}".strip()
            return Verdict(evidence.method, "not measured", values, why)
        low, high = (-math.inf if self.at_least is None else self.at_least), (math.inf if self.at_most is None else self.at_most)
        kept = all(low <= v <= high for v in values.values())
        state: StatementState = "does not hold" if not kept else "partly measured" if without else "holds"
        return Verdict(evidence.method, state, values, without)


@frozen
class Judgement:
    """A statement with its verdicts."""

    statement: Statement[Any]
    verdicts: tuple[Verdict, ...]

    @property
    def state(self) -> StatementState:
        """What all methods agree on; that it does not hold where one of them says so; else it is partly measured."""
        found = {verdict.state for verdict in self.verdicts} or {"not measured"}
        if "does not hold" in found:
            return "does not hold"
        return found.pop() if len(found) == 1 else "partly measured"

    def as_data(self) -> dict[str, Any]:
        """All of it as plain data."""
        fields = ("section", "text", "unit", "at_most", "at_least", "reason")
        return {
            **{name: getattr(self.statement, name) for name in fields},
            "verdict": self.state,
            "by_method": {v.method: {"verdict": v.state, "values": dict(v.values), "why": v.why} for v in self.verdicts},
        }
