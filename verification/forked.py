"""Something tried in a process of its own, with limits: a signal, a hang, a traceback end the child and are told, not met.

By a fork, and not by the harness's runner of processes: a child that begins with all modules loaded costs 0.014 s of the processor, a
new interpreter that loads them 0.6 s and more, which is most of what a small scene takes. A measuring process that lives on from try to
try would be as quick, but a limit of time or memory is of a process, and what one try leaves behind must not meet the next.
"""

from __future__ import annotations

import contextlib
import functools
import importlib
import os
import resource
import select
import signal
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from isomortar.cli import main


@dataclass(frozen=True)
class Gone:
    """How a child ended.

    Parameters
    ----------
    status : int or None
        Exit status; below zero: ended by that signal; None: it came to no end in its time.
    said : bytes
        What it was to tell.
    """

    status: int | None
    said: bytes = b""


def forked(action: Callable[[], bytes], cpu_seconds: int, wall_seconds: float, memory: int) -> Gone:
    """What an action in a child process comes to, which may take seconds of the processor and of the clock, and bytes of memory."""
    _load()
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reader)
        _act(action, writer, cpu_seconds, memory)
    os.close(writer)
    said = _heard(reader, child, wall_seconds)
    os.close(reader)
    _, status = os.waitpid(child, 0)
    return Gone(None if said is None else os.waitstatus_to_exitcode(status), said or b"")


@functools.cache
def _load() -> None:
    """Load what the program loads when it needs it: here once, and not in every child."""
    for name in ("cli.commands", "cli.progress", "driver", "results.pictures", "results.paraview"):
        importlib.import_module(f"isomortar.{name}")
    for name in ("rich.console", "scipy.interpolate", "scipy.sparse.linalg", "scipy.spatial", "splinepy"):
        importlib.import_module(name)


def _act(action: Callable[[], bytes], writer: int, cpu_seconds: int, memory: int) -> None:
    """In the child: act, tell what came of it, and be gone without what a process does at its end."""
    resource.setrlimit(resource.RLIMIT_CPU, (cpu_seconds, cpu_seconds + 5))  # past the first limit it is sent a signal
    resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    silence = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(silence, stream)
    status = 1
    try:
        os.write(writer, action())
        status = 0
    finally:
        os._exit(status)


def _heard(reader: int, child: int, wall_seconds: float) -> bytes | None:
    """What the child tells before it ends; None: it had to be killed."""
    deadline, said = time.monotonic() + wall_seconds, b""
    while True:
        left = deadline - time.monotonic()
        if left < 0.0 or not select.select([reader], [], [], left)[0]:
            os.kill(child, signal.SIGKILL)
            return None
        piece = os.read(reader, 1 << 16)
        if not piece:
            return said
        said += piece


def program(*words: str, folder: Path) -> tuple[int, str]:
    """Run ``isomortar WORDS`` within this process: its exit code, and what it said on stderr.

    A traceback it never shows: that is exit code 3.
    """
    said = folder / "stderr"
    sys.argv = ["isomortar", *words]
    code = 0
    with said.open("w") as stream, contextlib.redirect_stderr(stream), contextlib.redirect_stdout(stream):
        try:
            main()
        except SystemExit as end:
            code = int(end.code or 0)
    return code, said.read_text()
