"""A process that measures cells, one after the other: what happens in it, a crash or an endless loop, ends one cell and not the run.

The process is ``python -m isomortar.harness.worker``: one cell a line of JSON on its standard input, one measurement a line on its
standard output.
"""

from __future__ import annotations

import json
import os
import queue
import select
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from types import TracebackType
from typing import Any

from isomortar._process import own_process
from isomortar.harness.cases import TIMEOUTS, Cell
from isomortar.harness.measurement import Measurement

#: What starts a measuring process.
COMMAND = (sys.executable, "-m", "isomortar.harness.worker")
#: Lines of the standard error that a crash is reported with.
_LAST_WORDS = 30
#: Cores go to cells; who wants another share of them says so.
_ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def task_of(cell: Cell) -> dict[str, Any]:
    """A cell as a line that a worker understands, here or on another machine with the same files."""
    return {"path": str(cell.case.path), "case": cell.case.name, "settings": cell.settings, "seconds": TIMEOUTS[cell.tier]}


class Worker:
    """A measuring process, started by `command` when it is first needed and again after it died. A context manager."""

    def __init__(self, command: Sequence[str] = COMMAND) -> None:
        self._command = command
        self._process: subprocess.Popen[bytes] | None = None
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 (closed in __exit__)

    def __enter__(self) -> Worker:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        self._end()
        self._errors.close()

    def measure(self, task: dict[str, Any]) -> Measurement:
        """Measure a cell within its time."""
        start = time.perf_counter()
        process = self._started()
        try:
            answer = _ask(process, json.dumps(task).encode() + b"\n", task["seconds"])
        except BrokenPipeError:
            answer = b""
        seconds = time.perf_counter() - start
        if answer:
            return Measurement(**json.loads(answer))
        self._end()
        if answer is None:
            return Measurement("timed out", message=f"no result after {task['seconds']:.0f} s", seconds=seconds)
        return Measurement("crashed", message=f"{self._last_words()}\n{_how_it_ended(process.returncode)}", seconds=seconds)

    def _started(self) -> subprocess.Popen[bytes]:
        if self._process is None:
            self._errors.truncate(0)
            pipe = subprocess.PIPE
            # In a session of its own: Ctrl-C is for the run, which ends it; a process that dies by itself counts as crashed.
            self._process = subprocess.Popen(
                self._command, stdin=pipe, stdout=pipe, stderr=self._errors, env=_ONE_THREAD | os.environ, start_new_session=True
            )
        return self._process

    def _end(self) -> None:
        process, self._process = self._process, None
        if process:
            process.kill()
            process.wait()
            for pipe in (process.stdin, process.stdout):
                if pipe:
                    pipe.close()

    def _last_words(self) -> str:
        self._errors.seek(0)
        return "\n".join(self._errors.read().decode(errors="replace").splitlines()[-_LAST_WORDS:])


def _ask(process: subprocess.Popen[bytes], line: bytes, seconds: float) -> bytes | None:
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdin.write(line)
    process.stdin.flush()
    return _line(process.stdout.fileno(), seconds)


def _line(descriptor: int, seconds: float) -> bytes | None:
    """A line of a pipe; empty at its end, None when it took too long."""
    received = b""
    deadline = time.monotonic() + seconds
    while not received.endswith(b"\n"):
        if not select.select([descriptor], [], [], max(0.0, deadline - time.monotonic()))[0]:
            return None
        piece = os.read(descriptor, 1 << 16)
        if not piece:
            return b""
        received += piece
    return received


def _how_it_ended(code: int) -> str:
    return f"the process was ended by {signal.Signals(-code).name}" if code < 0 else f"the process ended with status {code}"


def _serve() -> None:
    """Measure what comes in, until nobody asks any more."""
    from isomortar.harness.collection import cases_of
    from isomortar.harness.measurement import measure
    from isomortar.harness.store import sources_hash

    own_process()
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a case prints must not get among the answers
    tasks: queue.SimpleQueue[str] = queue.SimpleQueue()

    def read() -> None:
        for line in sys.stdin:
            tasks.put(line)
        os._exit(0)  # the run that asked is gone: drop what is being measured

    threading.Thread(target=read, daemon=True).start()
    while True:
        task = json.loads(tasks.get())
        case = next(c for c in cases_of(Path(task["path"])) if c.name == task["case"])
        sources = sources_hash(case)  # before: a long case may outlive an edit
        measurement = replace(measure(Cell(case, task["settings"])), sources=sources)
        answers.write(json.dumps(asdict(measurement)).encode() + b"\n")
        answers.flush()


if __name__ == "__main__":
    _serve()
