"""Something tried in a process of its own: a signal, a hang, a traceback end the child and are told, not met.

By a fork, and not by the harness's runner of processes: a child that begins with all modules loaded costs 0.014 s of the processor, a
new interpreter that loads them 1.6 s. The scenes, 11 a second on two cores, would take ten times as long. A measuring process that lives on
from try to try would be as quick, but a limit of time or memory is of a process, and what one try leaves behind must not meet the next.
"""

from __future__ import annotations

import contextlib
import functools
import importlib
import json
import os
import resource
import select
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from isomortar.cli import main

#: Endings that are none of the program's mistakes.
FINE = ("right", "refused", "stopped")
#: What a child may take: seconds of the processor, seconds of the clock (a busy machine), bytes of memory.
CPU_SECONDS, WALL_SECONDS, MEMORY = 40, 300.0, 6 << 30


@dataclass(frozen=True)
class Ending:
    """How a try ended: `right`, `refused` before work, `stopped` with a sentence, or `wrong`; and what was said or seen."""

    kind: str
    said: str


class Wrong(Exception):  # noqa: N818 (what was seen, not a mistake of this program)
    """Something was seen that must never be."""


@functools.cache
def load() -> None:
    """Load what the program loads when it needs it: here once, and not in every child."""
    for name in ("cli.commands", "cli.progress", "driver", "results.pictures", "results.paraview"):
        importlib.import_module(f"isomortar.{name}")
    for name in ("rich.console", "scipy.interpolate", "scipy.sparse.linalg", "scipy.spatial", "splinepy", "tomlkit"):
        importlib.import_module(name)


def tried(action: Callable[[Path], Ending]) -> Ending:
    """The ending of an action in a child process; the action is given a folder of its own."""
    load()
    with tempfile.TemporaryDirectory(prefix="fuzz-") as folder:
        reader, writer = os.pipe()
        child = os.fork()
        if child == 0:
            os.close(reader)
            _act(action, Path(folder), writer)
        os.close(writer)
        said = _heard(reader, child)
        os.close(reader)
        _, status = os.waitpid(child, 0)
    if said is None:
        return Ending("wrong", f"no end after {WALL_SECONDS:g} s")
    if os.WIFSIGNALED(status):
        number = os.WTERMSIG(status)
        return Ending("wrong", f"ended by {signal.Signals(number).name}{' (a hang)' if number == signal.SIGXCPU else ''}")
    return Ending(*json.loads(said)) if said else Ending("wrong", f"the process ended with status {os.waitstatus_to_exitcode(status)}")


def _act(action: Callable[[Path], Ending], folder: Path, writer: int) -> None:
    """In the child: act, tell the ending, and be gone without what a process does at its end."""
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS + 5))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    silence = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(silence, stream)
    try:
        ending = action(folder)
    except Wrong as error:
        ending = Ending("wrong", str(error))
    except BaseException:
        ending = Ending("wrong", f"a traceback: {traceback.format_exc()[-1500:]}")
    os.write(writer, json.dumps([ending.kind, ending.said[:3000]]).encode())
    os._exit(0)


def _heard(reader: int, child: int) -> bytes | None:
    """What the child tells before it ends; None: it had to be killed."""
    deadline, said = time.monotonic() + WALL_SECONDS, b""
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


def ending_of(code: int, said: str) -> Ending:
    """What an exit code and its words amount to; a sentence of the program begins with its name. Code 3, a fault of its own, is wrong."""
    if code == 0:
        return Ending("right", "")
    sentences = [line for line in said.splitlines() if line.startswith("isomortar: ")]
    if code not in (1, 2) or len(sentences) != 1 or len(said) > 5000:
        raise Wrong(f"exit code {code} and the words {said[-1500:]!r}")
    return Ending("refused" if code == 2 else "stopped", sentences[0])


def tally(endings: Iterable[tuple[int, Ending]], again: str) -> dict[str, float]:
    """Shares of each kind of ending.

    Raises
    ------
    AssertionError
        One was wrong, with the number that repeats it by the command `again`.
    """
    kinds: Counter[str] = Counter()
    wrong: list[str] = []
    for number, ending in endings:
        kinds[ending.kind] += 1
        if ending.kind not in FINE:
            wrong.append(f"{again} --only {number}: {ending.said}")
    if wrong:
        raise AssertionError(f"{len(wrong)} of {sum(kinds.values())} went wrong\n" + "\n".join(wrong[:20]))
    return {kind: kinds[kind] / kinds.total() for kind in FINE}
