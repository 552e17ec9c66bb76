"""A process that measures cells, one after the other: what happens in it, a crash or an endless loop, ends one cell and not the run.

The process is ``python -m isomortar.harness.worker``: one cell a line of JSON on its standard input, one measurement a line on its
standard output.
"""

from __future__ import annotations

import contextlib
import functools
import json
import os
import queue
import sys
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from types import TracebackType
from typing import Any

from isomortar._process import own_process
from isomortar.errors import IsomortarError
from isomortar.harness.cases import TIMEOUTS, Cell
from isomortar.harness.measurement import Measurement, measure
from isomortar.program.process import GRACE, Limits, Process, descendants, end_now

#: What starts a measuring process.
COMMAND = (sys.executable, "-m", "isomortar.harness.worker")


def task_of(cell: Cell) -> dict[str, Any]:
    """A cell as a line that a worker understands, here or on another machine with the same files."""
    return {"path": str(cell.case.path), "case": cell.case.name, "settings": cell.settings, "seconds": TIMEOUTS[cell.tier]}


class Worker:
    """A measuring process, started by `command` when it is first needed and again after it ended. A context manager.

    It may be left while another thread waits for a measurement: that one is given up.
    """

    def __init__(self, command: Sequence[str] = COMMAND, limits: Limits | None = None) -> None:
        self._command, self._limits = command, limits
        self._process: Process | None = None
        self._closed = False
        self._starting, self._measuring = threading.Lock(), threading.Lock()

    def __enter__(self) -> Worker:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        with self._starting:
            self._closed = True
            if self._process:
                self._process.kill()
        self.restart()

    def restart(self) -> None:
        """Let the next measurement begin with a new process."""
        with self._measuring:
            self._drop()

    def measure(self, task: dict[str, Any], wanted: Callable[[], bool] = lambda: True) -> Measurement:
        """Measure a cell within its time, as long as it is `wanted`.

        Raises
        ------
        IsomortarError
            It was given up: that its process ended then says nothing about it.
        """
        with self._measuring:
            start = time.perf_counter()
            process = self._started()
            answer: bytes | None = b""
            with contextlib.suppress(BrokenPipeError):
                process.send(json.dumps(task).encode())
                answer = process.line(task["seconds"], wanted)
            if answer:
                return Measurement(**json.loads(answer))
            seconds = time.perf_counter() - start
            end = process.wait(GRACE) if answer is not None else None
            self._drop()
            if self._closed or not wanted():
                raise IsomortarError("the measurement was given up")
            if end is None:
                return Measurement("timed out", message=f"no result after {task['seconds']:.0f} s", seconds=seconds)
            return Measurement("trouble" if end.ending == "trouble" else "crashed", message=end.words, seconds=seconds)

    def _started(self) -> Process:
        with self._starting:
            if self._closed:
                raise IsomortarError("the measurement was given up")
            self._process = self._process or Process(self._command, self._limits)
            return self._process

    def _drop(self) -> None:
        process, self._process = self._process, None
        if process:
            process.close()


def serve(measure: Callable[[Cell], Measurement] = measure) -> None:
    """Measure what comes in, until nobody asks any more."""
    from isomortar.harness.collection import cases_of
    from isomortar.harness.store import sources_hash

    own_process()
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a case prints must not get among the answers
    asked = os.fdopen(os.dup(0))
    with Path(os.devnull).open() as nothing:
        os.dup2(nothing.fileno(), 0)  # nor must it read the tasks, or end this process by putting an end in their place
    tasks: queue.SimpleQueue[str] = queue.SimpleQueue()

    def read() -> None:
        for line in asked:
            tasks.put(line)
        end_now(descendants(os.getpid()))  # the run that asked is gone: drop what is being measured, other programs too
        os._exit(0)

    threading.Thread(target=read, daemon=True).start()
    known = functools.cache(cases_of)  # a file is read once, as its module is
    while True:
        task = json.loads(tasks.get())
        case = next(c for c in known(Path(task["path"])) if c.name == task["case"])
        sources = sources_hash(case)  # before: a long case may outlive an edit
        measurement = replace(measure(Cell(case, task["settings"])), sources=sources)
        answers.write(json.dumps(asdict(measurement)).encode() + b"\n")
        answers.flush()


if __name__ == "__main__":
    serve()
