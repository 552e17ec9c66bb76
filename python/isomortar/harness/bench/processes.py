"""Benchmarks in processes of their own: a fresh one each, with one thread of the linear algebra libraries.

The process is ``python -m isomortar.harness.bench.processes FILE NAME [quick]``: it writes a row a line of JSON on its standard output, and
last what the whole cost.
"""

from __future__ import annotations

import json
import os
import sys
import time
import traceback
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

import numpy as np

from isomortar._frozen import frozen
from isomortar._process import own_process
from isomortar.harness.bench.declaration import Benchmark, Row
from isomortar.harness.measurement import peak_memory
from isomortar.program.process import GRACE, ONE_THREAD, Process


@frozen
class Cost:
    """What a whole benchmark took: CPU seconds, the most memory in bytes; and why it ended early, if it did."""

    cpu_seconds: float = 0.0
    peak_memory: float = 0.0
    message: str = ""


@frozen
class Answer:
    """A benchmark with its rows. Those that came before a failure stand."""

    benchmark: Benchmark
    rows: tuple[Row, ...]
    cost: Cost

    @property
    def failed(self) -> bool:
        """Whether it ended before its end, or measured nothing."""
        return bool(self.cost.message) or not self.rows


def fresh(*arguments: str) -> Process:
    """A Python process with one thread, given arguments of the interpreter."""
    return Process([sys.executable, *arguments], environment=ONE_THREAD)


def run(benchmark: Benchmark, quick: bool, found: Callable[[Row], None]) -> Answer:
    """Run a benchmark in a process of its own; `found` is told of every row as it comes."""
    rows: list[Row] = []
    cost: Cost | None = None
    with fresh("-m", __name__, str(benchmark.path), benchmark.name, *(["quick"] if quick else [])) as process:
        while line := process.line():
            entry = json.loads(line)
            if "cost" in entry:
                cost = Cost(**entry["cost"])
            else:
                rows.append(entry["row"])
                found(rows[-1])
        return Answer(benchmark, tuple(rows), cost or Cost(message=process.wait(GRACE).words))


def measure(benchmark: Benchmark, quick: bool, found: Callable[[Row], None]) -> Cost:
    """Run a benchmark here and now."""
    start, message = time.process_time(), ""
    try:
        for row in benchmark.function(quick):
            found(_plain(benchmark.checked(row)))
    except Exception:  # whatever a benchmark raises is its failure, not that of the run
        message = traceback.format_exc()
    return Cost(time.process_time() - start, peak_memory(), message)


def _plain(row: Row) -> Row:
    """Python's own numbers, which JSON knows."""
    return {name: value.item() if isinstance(value, np.generic) else value for name, value in row.items()}


def _main(path: str, name: str, *quick: str) -> None:
    from isomortar.harness.bench.collection import benchmarks_of, select

    own_process()
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)  # what a benchmark prints must not get among the rows
    (benchmark,) = select(benchmarks_of(Path(path)), [name])
    cost = measure(benchmark, bool(quick), lambda row: print(json.dumps({"row": row}), file=answers))
    print(json.dumps({"cost": asdict(cost)}), file=answers)


if __name__ == "__main__":
    _main(*sys.argv[1:])
