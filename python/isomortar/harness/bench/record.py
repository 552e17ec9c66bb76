"""A run of benchmarks as it is stored: ``bench.json``, ``bench.html``, and a line a benchmark in ``history.jsonl``."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from isomortar.harness.bench import history, page
from isomortar.harness.bench.machine import Limits, Machine
from isomortar.harness.bench.processes import Outcome
from isomortar.harness.bench.verdicts import verdicts
from isomortar.harness.report import plain
from isomortar.harness.store import compiler, kernel_hash, program_hash, write_whole

HISTORY, PAGE, DATA = "history.jsonl", "bench.html", "bench.json"


@dataclass(frozen=True)
class Run:
    """What was run so far: its start, whether only tried, the machine with its limits before and after, the benchmarks that ended."""

    started: datetime
    quick: bool
    machine: Machine
    limits: tuple[Limits, ...]
    outcomes: tuple[Outcome, ...] = ()


def keep(folder: Path, run: Run) -> None:
    """Write page and data of a run, each whole."""
    trends = {outcome.benchmark.name: history.read(folder / HISTORY, outcome.benchmark.name) for outcome in run.outcomes}
    write_whole(folder / DATA, json.dumps(plain(as_data(run)), indent=1))
    write_whole(folder / PAGE, page.page(run, trends))


def add(folder: Path, run: Run, outcome: Outcome) -> None:
    """Put a benchmark into the history. One that was only tried says nothing about speed, and one that failed not all."""
    if not (run.quick or outcome.failed):
        history.append(folder / HISTORY, outcome, run.started)


def as_data(run: Run) -> dict[str, Any]:
    """All of a run as plain data."""
    return {
        "started": run.started.isoformat(timespec="seconds"),
        "quick": run.quick,
        "program": program_hash(),
        "kernel": kernel_hash(),
        "compiler": compiler(),
        "machine": asdict(run.machine),
        "limits": [asdict(limits) for limits in run.limits],
        "benchmarks": [
            {
                "name": outcome.benchmark.name,
                "question": outcome.benchmark.question,
                "columns": dict(outcome.benchmark.columns),
                "rows": [dict(row) for row in outcome.rows],
                "limits": [asdict(verdict) for verdict in verdicts(outcome)],
                **asdict(outcome.cost),
            }
            for outcome in run.outcomes
        ],
    }
