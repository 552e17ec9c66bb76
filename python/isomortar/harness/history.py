"""Results of earlier runs, one line of JSON a run, and the places where a number changed for good."""

from __future__ import annotations

import math
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from statistics import median
from typing import Any

from isomortar._frozen import frozen
from isomortar.harness.journal import Journal
from isomortar.harness.runner import Result
from isomortar.harness.store import program_hash

#: Runs before a point that it is compared with.
_BEFORE = 8


@frozen
class Entry:
    """One earlier run: when, of which program, and by cell name its state, seconds and checked values."""

    when: str
    program: str
    cells: dict[str, dict[str, Any]]


def append(path: Path, results: Sequence[Result]) -> None:
    """Add a run to the history."""
    cells = {
        result.cell.name: {
            "state": result.state,
            "seconds": round(result.measurement.seconds, 3),
            "values": {check.name: check.value for check in result.checks},
        }
        for result in results
    }
    Journal(path).add({"when": datetime.now(UTC).isoformat(timespec="seconds"), "program": program_hash()[:12], "cells": cells})


def read(path: Path, last: int = 60) -> list[Entry]:
    """The last runs, oldest first; a line that was cut short by a crash is left out."""
    return [Entry(**entry) for entry in Journal(path).entries[-last:]]


def values_of(runs: Sequence[Entry], cell: str, number: str) -> list[float]:
    """A number over the runs; NaN where it was not measured."""
    return [float(run.cells.get(cell, {}).get("values", {}).get(number, math.nan)) for run in runs]


def change_points(values: Sequence[float], least: float = 0.0) -> list[int]:
    """Indices at which a series went to another level.

    A point counts when it is further from the median of the (up to eight) points since the last change than `least`, than 2 % of that
    median, and than five robust standard deviations, and the next point does not return. Values that are not finite are passed over.
    """
    finite = [(i, v) for i, v in enumerate(values) if math.isfinite(v)]
    found: list[int] = []
    begin = 0
    for k in range(1, len(finite)):
        before = [v for _, v in finite[max(begin, k - _BEFORE) : k]]
        middle = median(before)
        width = max(5 * 1.4826 * median(abs(v - middle) for v in before), 0.02 * abs(middle), least)
        after = [v for _, v in finite[k : k + 2]]
        if all(abs(v - middle) > width for v in after):
            found.append(finite[k][0])
            begin = k
    return found
