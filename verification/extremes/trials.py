"""Runs of the program as a user starts them: a scene file, and a process of its own with limits of time and memory."""

from __future__ import annotations

import functools
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

import h5py
import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.program.process import ONE_THREAD, Limits, Process

#: What one run may take: seconds of the processor (of the clock a few times that, as the machine may be busy), bytes of address space.
SECONDS, PATIENCE, MEMORY = 60, 10, 4 << 30
#: Whatever kernel this process has found, the program that it starts finds too.
_START = "import sys; sys.path[:] = {path!r}; sys.argv[0] = 'isomortar'; from isomortar.cli import main; main()"

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
    return _run(scene, _program or _this_program(), seconds, memory)


def _this_program() -> tuple[str, ...]:
    flags = ("-S",) if sys.flags.no_site else ()
    return (sys.executable, *flags, "-c", _START.format(path=sys.path))


@functools.lru_cache(maxsize=256)
def _run(scene: str, command: tuple[str, ...], seconds: int, memory: int) -> Trial:
    with TemporaryDirectory() as folder:
        (Path(folder) / "scene.toml").write_text(scene, encoding="utf-8")
        command = (*command, "run", "scene.toml", "--output", "results.h5", "--quiet")
        with Process(command, Limits(seconds, memory), Path(folder), ONE_THREAD | {"COLUMNS": "1000"}) as process:
            end, said = process.wait(PATIENCE * seconds), process.said()
        if end.ending == "timed out":
            return Trial(None, end.words)
        held = _read(Path(folder) / "results.h5")
        steps = None if held is None else len(held["curves/step"])
        return Trial(end.status, said, held or {}, steps)


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
