"""Limits of a benchmark's columns, and whether its rows kept them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Literal, get_args

from isomortar._frozen import frozen
from isomortar.harness.bench.declaration import ASIDE, Row
from isomortar.harness.bench.history import label
from isomortar.harness.bench.processes import Answer

LimitState = Literal["met", "missed", "not compared", "not measured"]
#: Best first.
LIMIT_STATES: tuple[LimitState, ...] = get_args(LimitState)


@frozen
class Standing:
    """A limit of a column, how it stands, and the row that came furthest (NaN: none)."""

    column: str
    at_most: float
    why: str
    state: LimitState
    worst: float
    row: str


def state(value: object, at_most: float) -> LimitState:
    """How one value stands; where there is none nothing was compared, and no number, or one below zero, was not measured."""
    if value is None:
        return "not compared"
    if not isinstance(value, int | float) or not 0 <= value < math.inf:
        return "not measured"
    return "met" if value <= at_most else "missed"


def standings(answer: Answer) -> list[Standing]:
    """How the limits stand. One missed row misses the limit, one that lacks the column leaves it open, and so does one without a number.

    What a benchmark that failed has not missed so far it might have missed.
    """
    found = [_standing(answer.rows, column, *limit) for column, limit in answer.benchmark.limits.items()]
    return [replace(v, state="not measured") if answer.failed and v.state != "missed" else v for v in found]


def _standing(rows: Sequence[Row], column: str, at_most: float, why: str) -> Standing:
    spoken = [(state(row.get(column), at_most), row) for row in rows if row.get(column) != ASIDE]
    states = {found for found, _ in spoken}
    worst, where = max(((float(row[column]), label(row)) for found, row in spoken if found in ("met", "missed")), default=(math.nan, ""))
    found: LimitState = next((kind for kind in ("missed", "not measured", "not compared", "met") if kind in states), "not measured")
    return Standing(column, at_most, why, found, worst, where)
