"""Benchmarks of earlier runs: one line of JSON a benchmark, for the trend over nights."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import field
from datetime import datetime
from itertools import takewhile
from pathlib import Path

from isomortar._frozen import frozen
from isomortar.harness.bench.declaration import NOTE, Row
from isomortar.harness.bench.processes import Answer
from isomortar.harness.journal import Journal
from isomortar.harness.store import program_hash

#: Runs that a trend shows.
_SHOWN = 60


@frozen
class Trend:
    """What a benchmark said in its last runs, oldest first: by row and column."""

    runs: tuple[dict[str, dict[str, float]], ...] = field(default=())

    def values(self, row: str, column: str) -> list[float]:
        """One number over the runs; NaN where it was not measured."""
        return [run.get(row, {}).get(column, math.nan) for run in self.runs]


def label(row: Row) -> str:
    """What tells a row from the others: its entries before the first that is not a word or a whole number."""
    return ", ".join(str(value) for value in takewhile(lambda value: not isinstance(value, float), _without_note(row)))


def append(path: Path, answer: Answer, when: datetime) -> None:
    """Add what a benchmark said to the history."""
    rows = {label(row): {name: value for name, value in row.items() if isinstance(value, float)} for row in answer.rows}
    entry = {"when": when.isoformat(timespec="seconds"), "program": program_hash()[:12], "benchmark": answer.benchmark.name, "rows": rows}
    Journal(path).add(entry)


def read(path: Path, name: str) -> Trend:
    """The last runs of a benchmark; a line that was cut short by a crash is left out."""
    runs = [entry["rows"] for entry in Journal(path).entries if entry["benchmark"] == name]
    return Trend(tuple(runs[-_SHOWN:]))


def _without_note(row: Row) -> Iterator[float | int | str]:
    return (value for name, value in row.items() if name != NOTE)
