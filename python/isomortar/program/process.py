"""Processes with limits: each is started in a session of its own, and when it has ended it is known why."""

from __future__ import annotations

import contextlib
import math
import os
import resource
import select
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Literal

from isomortar._frozen import frozen
from isomortar.errors import IsomortarError

#: Why something ended. The first two are results: it was measured, or it does not converge, which it will not the next time either.
#: ``refused``: what it was given; ``crashed``: a mistake of the program; ``trouble``: the machine's, of memory, disk or connection.
Ending = Literal["measured", "not converged", "refused", "crashed", "timed out", "trouble"]
#: Cores go to processes, one to each. Who wants another share says so in the environment.
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
#: Lines of the standard error that a crash is reported with.
_LAST_WORDS = 30
#: Seconds that a process with nothing more to say has until it is gone.
GRACE = 5.0
#: Seconds between two looks at whether an answer is still wanted.
_LOOK = 0.2


@frozen
class Limits:
    """What a process may take: seconds of the processor, bytes of address space; None: no limit."""

    cpu_seconds: int | None = None
    memory: int | None = None


@frozen
class End:
    """Why a process ended, in one word and in others, and its exit status: below zero by that signal, None by its limit of time."""

    ending: Ending
    words: str
    status: int | None


class Process:
    """A process with limits. A context manager, at whose end it is gone.

    Parameters
    ----------
    command : sequence of str
    limits : Limits, optional
    folder : Path, optional
        Where it works.
    environment : mapping of str to str, optional
        Besides that of this process, with one thread as the default.
    """

    def __init__(
        self,
        command: Sequence[str],
        limits: Limits | None = None,
        folder: Path | None = None,
        environment: Mapping[str, str] | None = None,
    ) -> None:
        self._received = b""
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 (closed in __exit__)
        # In a session of its own: Ctrl-C is for who started it, who ends it; a process that dies by itself counts as crashed.
        self._process = subprocess.Popen(
            command,
            bufsize=0,
            cwd=folder,
            env={**ONE_THREAD, **os.environ, **(environment or {})},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            start_new_session=True,
        )
        self._limit(limits or Limits())

    def _limit(self, limits: Limits) -> None:
        """From outside: code between fork and start is not safe beside other threads."""
        if limits.cpu_seconds is not None:  # past the first limit it is sent a signal
            resource.prlimit(self._process.pid, resource.RLIMIT_CPU, (limits.cpu_seconds, limits.cpu_seconds + 5))
        if limits.memory is not None:
            resource.prlimit(self._process.pid, resource.RLIMIT_AS, (limits.memory, limits.memory))
            resource.prlimit(self._process.pid, resource.RLIMIT_CORE, (0, 0))

    def __enter__(self) -> Process:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """End it, and let go of its files."""
        self.kill()
        for file in (self._process.stdin, self._process.stdout, self._errors):
            if file:
                file.close()

    def kill(self) -> None:
        """End it now, with what it has started. Who waits for a line of it gets none."""
        if self._process.poll() is None:
            started = descendants(self._process.pid)
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self._process.pid, signal.SIGKILL)
            end_now(started)
        self._process.wait()

    def send(self, line: bytes) -> None:
        """Write a line to its standard input; whether it was read, the answer tells.

        Raises
        ------
        BrokenPipeError
            It has ended.
        """
        assert self._process.stdin is not None
        self._process.stdin.write(line + b"\n")

    def given_all(self) -> None:
        """Close its standard input: nothing more will be written to it."""
        assert self._process.stdin is not None
        self._process.stdin.close()

    def line(self, seconds: float | None = None, wanted: Callable[[], bool] = lambda: True) -> bytes | None:
        """The next line of its standard output, empty where it has ended.

        Parameters
        ----------
        seconds : float, optional
            Of the clock, to wait for it.
        wanted : callable
            Asked now and then whether to go on waiting.

        Returns
        -------
        bytes or None
            None: it took too long, or is not wanted any more.
        """
        deadline = math.inf if seconds is None else time.monotonic() + seconds
        while b"\n" not in self._received:
            if not (piece := self._piece(deadline, wanted)):
                return piece
            self._received += piece
        line, _, self._received = self._received.partition(b"\n")
        return line

    def rest(self, seconds: float) -> bytes | None:
        """All that it has yet to write on its standard output until it ends; None: that takes more seconds of the clock."""
        deadline = time.monotonic() + seconds
        while piece := self._piece(deadline, lambda: True):
            self._received += piece
        return None if piece is None else self._received

    def _piece(self, deadline: float, wanted: Callable[[], bool]) -> bytes | None:
        """What comes next on its standard output, empty where it has ended; None: not in time, or not wanted any more."""
        assert self._process.stdout is not None
        while not select.select([self._process.stdout], [], [], max(0.0, min(_LOOK, deadline - time.monotonic())))[0]:
            if time.monotonic() >= deadline or not wanted():
                return None
        return os.read(self._process.stdout.fileno(), 1 << 16)

    def wait(self, seconds: float) -> End:
        """Why it ended, of itself within so many seconds of the clock, or by these."""
        try:
            self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            return End("timed out", f"no end after {seconds:g} s", None)
        return self.end()

    def end(self) -> End:
        """Why it ended; it is ended if it goes on."""
        self.kill()
        status = self._process.returncode
        if status == -signal.SIGXCPU:
            return End("timed out", "no end within its seconds of the processor", None)
        if status == 0:
            return End("measured", "the process ended with status 0", 0)
        how = f"was ended by {signal.Signals(-status).name}" if status < 0 else f"ended with status {status}"
        words = "\n".join([*self.said().splitlines()[-_LAST_WORDS:], f"the process {how}"])
        # Nobody but a system without memory, or a person, sends that signal.
        return End("trouble" if status == -signal.SIGKILL else "crashed", words, status)

    def said(self) -> str:
        """All of its standard error so far."""
        self._errors.seek(0)
        return self._errors.read().decode(errors="replace")


def descendants(pid: int) -> list[int]:
    """Processes that a process has started, those that they have, and so on, in any session; where the system tells (Linux)."""
    found: list[int] = []
    for children in Path(f"/proc/{pid}/task").glob("*/children"):
        with contextlib.suppress(OSError):
            for child in map(int, children.read_text().split()):
                found += [child, *descendants(child)]
    return found


def end_now(processes: Iterable[int]) -> None:
    """End processes of ours by their numbers, those that are there."""
    for pid in processes:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)


@frozen
class Finished:
    """A process that was run to its end: why it ended, its standard output and error, CPU seconds with those of its own children."""

    end: End
    output: str
    errors: str
    cpu_seconds: float

    @property
    def last_words(self) -> str:
        """The last line that it wrote, on the standard error if there is one: why it failed, as a rule."""
        lines = (self.errors.strip() or self.output.strip()).splitlines()
        return lines[-1].strip() if lines else self.end.words


def run(
    command: Sequence[str],
    text: str = "",
    seconds: float = math.inf,
    folder: Path | None = None,
    environment: Mapping[str, str] | None = None,
) -> Finished:
    """Run a program to its end.

    Parameters
    ----------
    command : sequence of str
    text : str
        A line for its standard input, which it reads before it writes.
    seconds : float
        Of the clock, that it may take.
    folder, environment
        As of `Process`.

    Returns
    -------
    Finished
        `cpu_seconds` counts children of this process that ended meanwhile: exact where one is run at a time.

    Raises
    ------
    FileNotFoundError
        There is no such program.
    """
    before = _children_seconds()
    with Process(command, folder=folder, environment=environment) as process:
        with contextlib.suppress(BrokenPipeError):
            process.send(text.encode())
            process.given_all()
        output = process.rest(seconds)
        end = process.wait(GRACE) if output is not None else End("timed out", f"no end after {seconds:g} s", None)
        process.kill()
        return Finished(end, (output or b"").decode(errors="replace"), process.said(), _children_seconds() - before)


def output_of(
    command: Sequence[str], seconds: float = math.inf, folder: Path | None = None, environment: Mapping[str, str] | None = None
) -> str:
    """What a program writes on its standard output; arguments as of `run`.

    Raises
    ------
    IsomortarError
        It is not installed, or did not end well in its time: with its last words.
    """
    try:
        done = run(command, seconds=seconds, folder=folder, environment=environment)
    except FileNotFoundError as error:
        raise IsomortarError(f"{command[0]} is not there: {error.strerror}") from None
    if done.end.status != 0:
        said = f"{done.output[-2000:]}{done.errors[-2000:]}"
        raise IsomortarError(f"{' '.join(command)} in {folder or Path()}: {done.end.words.splitlines()[-1]}\n{said}")
    return done.output


def tools_first() -> dict[str, str]:
    """The environment in which programs that stand beside this interpreter, such as meson and ninja, are found first."""
    return {"PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ.get('PATH', os.defpath)}"}


def _children_seconds() -> float:
    """User and system time of the children of this process that have ended."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime
