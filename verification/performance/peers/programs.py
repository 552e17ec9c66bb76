"""Other programs as processes: what they say, and the CPU seconds of the whole process, its own children included."""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

from isomortar.harness.bench.declaration import REPEATS, SHORT
from isomortar.harness.process import ONE_THREAD

#: The interpreter that Debian's Python packages belong to, GetFEM among them.
DEBIAN_PYTHON = "/usr/bin/python3"
#: The interpreter with nutils and NGSolve, where `install.sh` puts it, and the variable that names another.
PEERS_PYTHON = Path(__file__).parents[3] / ".peers" / "bin" / "python"
PEERS_VARIABLE = "ISOMORTAR_PEERS"


@dataclass(frozen=True)
class Finished:
    """A process that ended: standard output and error, exit status, CPU seconds (user and system)."""

    output: str
    errors: str
    status: int
    seconds: float

    @property
    def last_words(self) -> str:
        """The last line that it wrote, on the standard error if there is one: why it failed, as a rule."""
        lines = (self.errors.strip() or self.output.strip()).splitlines()
        return lines[-1].strip() if lines else f"exit status {self.status}"

    def answer(self) -> dict[str, Any]:
        """The JSON object in the last line of the standard output."""
        found = json.loads(self.output.splitlines()[-1])
        if not isinstance(found, dict):
            raise ValueError(f"is no JSON object: {found!r}")
        return found


def run(command: Sequence[str], text: str = "", folder: Path | None = None) -> Finished:
    """Run a program with one thread to its end.

    Parameters
    ----------
    command : sequence of str
    text : str
        Its standard input.
    folder : Path, optional
        Where it runs.
    """
    with tempfile.TemporaryFile("w+") as given, tempfile.TemporaryFile("w+") as output, tempfile.TemporaryFile("w+") as errors:
        given.write(text)
        given.seek(0)
        environment = {**os.environ, **ONE_THREAD}
        process = subprocess.Popen(command, stdin=given, stdout=output, stderr=errors, cwd=folder, env=environment, text=True)
        try:
            _, status, used = os.wait4(process.pid, 0)
        except BaseException:  # Ctrl-C too: nothing goes on measuring behind
            process.kill()
            process.wait()
            raise
        process.returncode = os.waitstatus_to_exitcode(status)
        for file in (output, errors):
            file.seek(0)
        return Finished(output.read(), errors.read(), process.returncode, used.ru_utime + used.ru_stime)


def timed(command: Sequence[str], text: str = "", folder: Path | None = None, repeats: int = REPEATS) -> tuple[Finished, float]:
    """Run a program `repeats` times, a long one once: its last run, and the median CPU seconds of all."""
    runs: list[Finished] = []
    while not runs or (runs[0].seconds < SHORT and len(runs) < repeats):
        runs.append(run(command, text, folder))
    return runs[-1], median(one.seconds for one in runs)


def peers_python() -> str:
    """The interpreter that has nutils and NGSolve."""
    return os.environ.get(PEERS_VARIABLE) or str(PEERS_PYTHON)


def has_module(python: str, module: str) -> bool:
    """Whether an interpreter is there and finds a module."""
    try:
        return run([python, "-c", f"import importlib.util; raise SystemExit(importlib.util.find_spec({module!r}) is None)"]).status == 0
    except OSError:
        return False
