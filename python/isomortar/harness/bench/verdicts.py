"""Limits of a benchmark's columns, and whether its rows kept them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from isomortar.harness.bench.declaration import Row
from isomortar.harness.bench.history import label
from isomortar.harness.bench.processes import Outcome

State = Literal["met", "missed", "not measured"]


@dataclass(frozen=True)
class Verdict:
    """A limit of a column, how it stands, and the row that came furthest (NaN: none)."""

    column: str
    at_most: float
    why: str
    state: State
    worst: float
    row: str


def state(value: object, at_most: float) -> State:
    """How one value stands; what is no number was not measured."""
    if not isinstance(value, int | float) or not math.isfinite(value):
        return "not measured"
    return "met" if value <= at_most else "missed"


def verdicts(outcome: Outcome) -> list[Verdict]:
    """How the limits stand. One missed row misses the limit; rows with a note are passed over, and others must have a number."""
    return [_verdict(outcome.rows, column, *limit) for column, limit in outcome.benchmark.limits.items()]


def _verdict(rows: Sequence[Row], column: str, at_most: float, why: str) -> Verdict:
    spoken = [(state(row[column], at_most), row) for row in rows if column in row]
    states = {found for found, _ in spoken}
    measured = [(float(row[column]), label(row)) for found, row in spoken if found != "not measured"]
    worst, where = max(measured, default=(math.nan, ""))
    total: State = "missed" if "missed" in states else "not measured" if "not measured" in states or not measured else "met"
    return Verdict(column, at_most, why, total, worst, where)
