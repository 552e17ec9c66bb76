"""A run of benchmarks as plain data, and a line a benchmark in ``history.jsonl``."""

from __future__ import annotations

from dataclasses import asdict
from datetime import datetime
from pathlib import Path
from typing import Any

from isomortar._frozen import frozen
from isomortar.harness.bench import history
from isomortar.harness.bench.machine import Machine, MachineLimits
from isomortar.harness.bench.processes import Answer
from isomortar.harness.bench.standings import standings
from isomortar.harness.store import identity

HISTORY = "history.jsonl"


@frozen
class Record:
    """What was run so far: its start, whether only tried, the machine with its limits before and after, the benchmarks that ended."""

    started: datetime
    quick: bool
    machine: Machine
    limits: tuple[MachineLimits, ...]
    answers: tuple[Answer, ...] = ()


def add(folder: Path, record: Record, answer: Answer) -> None:
    """Put a benchmark into the history. One that was only tried says nothing about speed, and one that failed not all."""
    if not (record.quick or answer.failed):
        history.append(folder / HISTORY, answer, record.started)


def as_data(record: Record) -> dict[str, Any]:
    """All of a run as plain data."""
    return {
        "started": record.started.isoformat(timespec="seconds"),
        "quick": record.quick,
        **identity(),
        "machine": asdict(record.machine),
        "limits": [asdict(limits) for limits in record.limits],
        "benchmarks": [
            {
                "name": answer.benchmark.name,
                "question": answer.benchmark.question,
                "columns": dict(answer.benchmark.columns),
                "rows": [dict(row) for row in answer.rows],
                "limits": [asdict(standing) for standing in standings(answer)],
                **asdict(answer.cost),
            }
            for answer in record.answers
        ],
    }
