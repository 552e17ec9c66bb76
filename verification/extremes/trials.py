"""Runs of the program by its command line: a scene file, and a process of its own with limits of time and memory."""

from __future__ import annotations

import functools
import json
import os
import signal
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

import h5py
import numpy as np
from forked import forked
from forked import program as program_within

from isomortar.geometry.patch import FloatArray
from isomortar.program.process import ONE_THREAD, Limits, Process

#: What one run may take: seconds of the processor (of the clock a few times that, as the machine may be busy), bytes of address space.
SECONDS, PATIENCE, MEMORY = 60, 10, 4 << 30
#: What is asked of the program.
_WORDS = ("run", "scene.toml", "--output", "results.h5", "--quiet")

_program: tuple[str, ...] = ()


@dataclass(frozen=True)
class Trial:
    """What became of a run.

    Parameters
    ----------
    code : int or None
        Exit status; below zero: ended by that signal; None: it came to no end in its time.
    said : str
        What it said on its standard error.
    held : dict of str to ndarray
        Numbers that its results file holds, by their path: ``curves/supports/top/force`` has shape (steps, 3).
    steps : int or None
        Load steps that the file holds; None: there is no results file.
    """

    code: int | None
    said: str = ""
    held: dict[str, FloatArray] = field(default_factory=dict)
    steps: int | None = None

    def force(self, support: str) -> FloatArray:
        """Forces that a support exerts, shape (steps, 3)."""
        return self._of_support(support, "force")

    def moment(self, support: str) -> FloatArray:
        """Moments that a support exerts, shape (steps, 3)."""
        return self._of_support(support, "moment")

    def _of_support(self, support: str, name: str) -> FloatArray:
        path = f"curves/supports/{support}/{name}"
        if path not in self.held:
            raise LookupError(f"a run that others are compared with came to nothing: {self.said.strip() or path}")
        return self.held[path]


@contextmanager
def program(command: Sequence[str]) -> Iterator[None]:
    """Let runs be those of another program, such as ``isomortar`` of another environment, for the block that follows."""
    global _program
    before, _program = _program, tuple(command)
    try:
        yield
    finally:
        _program = before


def run(scene: str, seconds: int = SECONDS, memory: int = MEMORY) -> Trial:
    """Run the text of a scene file; what was run in this process before is not run again."""
    return _run(scene, _program, seconds, memory)


@functools.lru_cache(maxsize=256)
def _run(scene: str, command: tuple[str, ...], seconds: int, memory: int) -> Trial:
    with TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "scene.toml").write_text(scene, encoding="utf-8")
        code, said = _of_another(command, folder, seconds, memory) if command else _of_this_one(folder, seconds, memory)
        if code is None:
            return Trial(None, said)
        held = _read(folder / "results.h5")
        return Trial(code, said, held or {}, None if held is None else len(held["curves/step"]))


def _of_this_one(folder: Path, seconds: int, memory: int) -> tuple[int | None, str]:
    """Exit status and words of this program, with whatever kernel this process has found; None: it came to no end in its time."""

    def compute() -> bytes:
        os.chdir(folder)
        os.environ["COLUMNS"] = "1000"
        return json.dumps(program_within(*_WORDS, folder=folder)).encode()

    gone = forked(compute, seconds, PATIENCE * seconds, memory)
    if gone.status is None or gone.status == -signal.SIGXCPU:
        return None, "no end within its seconds"
    code, said = json.loads(gone.said) if gone.said else (gone.status, "")
    return code, said


def _of_another(command: tuple[str, ...], folder: Path, seconds: int, memory: int) -> tuple[int | None, str]:
    """The same of another program."""
    with Process((*command, *_WORDS), Limits(seconds, memory), folder, ONE_THREAD | {"COLUMNS": "1000"}) as process:
        end, said = process.wait(PATIENCE * seconds), process.said()
    return end.status, end.words if end.ending == "timed out" else said


def _read(path: Path) -> dict[str, FloatArray] | None:
    """All numbers of a results file, of whatever version of the program; None where there is no file."""
    if not path.exists():
        return None
    held: dict[str, FloatArray] = {}

    def keep(name: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset) and item.dtype.kind in "iuf" and name.startswith(("curves/", "states/")):
            held[name] = np.asarray(item[()], dtype=float)

    with h5py.File(path) as file:
        file.visititems(keep)
    return held
