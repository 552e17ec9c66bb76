"""How a command ends: whatever is raised becomes one sentence on stderr, and an exit code."""

from __future__ import annotations

import re
import signal
import sys
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import current_thread, main_thread
from types import FrameType

from isomortar.errors import InputError, IsomortarError

#: Exit codes; 130 is what shells expect of a program that Ctrl-C ended.
FAILED, BAD_INPUT, OWN_FAULT, INTERRUPTED = 1, 2, 3, 130

_INTERRUPTED = INTERRUPTED, "interrupted"

#: What interrupts, and who hears it where nobody else does: Ctrl-C, and what batch systems and containers ask by before they kill.
_INTERRUPTS: dict[signal.Signals, Callable[[int, FrameType | None], object] | signal.Handlers] = {
    signal.SIGINT: signal.default_int_handler,
    signal.SIGTERM: signal.SIG_DFL,
}

#: Letters that are left of a longer word.
LONGEST_WORD = 600


@contextmanager
def told() -> Iterator[None]:
    """End the process with a sentence, where the block does not end by itself."""
    try:
        with _heard() as interrupts:
            try:
                yield
            finally:
                if sys.stdout is not None:  # as it is where it was closed
                    sys.stdout.flush()  # here a full disk still has its sentence
    except Exception as error:
        code, sentence = _ending(error, interrupted=bool(interrupts))
    except (KeyboardInterrupt, SystemExit) as error:
        if isinstance(error, SystemExit) and error.code != INTERRUPTED:  # that is what Typer makes of Ctrl-C, without a word
            raise
        code, sentence = _INTERRUPTED
    else:
        return
    print(f"isomortar: {_readable(sentence)}", file=sys.stderr)
    sys.exit(code)


@contextmanager
def _heard() -> Iterator[list[int]]:
    """The interrupts that came, also where they are raised as something else: extensions that are loading make an ImportError of them."""
    interrupts: list[int] = []

    def note(number: int, frame: FrameType | None) -> None:
        interrupts.append(number)
        signal.default_int_handler(number, frame)

    ours = [number for number, hears in _INTERRUPTS.items() if signal.getsignal(number) is hears]
    if current_thread() is not main_thread():
        ours = []
    for number in ours:
        signal.signal(number, note)
    try:
        yield interrupts
    finally:
        for number in ours:
            signal.signal(number, _INTERRUPTS[number])


def _ending(error: Exception, *, interrupted: bool) -> tuple[int, str]:
    """Exit code and sentence."""
    match error:
        case InputError():
            return BAD_INPUT, str(error)
        case IsomortarError():
            return FAILED, str(error)
        case MemoryError():
            return FAILED, "memory ran out: take fewer elements or a lower order, or a machine with more memory"
        case OSError():
            return FAILED, _of_the_system(error)
        case _ if interrupted:
            return _INTERRUPTED
        case ImportError():
            return FAILED, f"the installation is not complete: {error}"
    return OWN_FAULT, f"{_place(error)}. This is a fault of the program, not of your input: please report it with the scene and the command"


def _readable(sentence: str) -> str:
    """The sentence with words shortened in their middle that are longer than any path: names by mistake, or by malice."""
    return re.sub(rf"(\S{{{LONGEST_WORD // 2}}})\S+(\S{{{LONGEST_WORD // 2}}})", r"\1...\2", sentence)


def _of_the_system(error: OSError) -> str:
    """What the system refused, and for which file where it says that."""
    return (error.strerror or str(error)) + (f": {error.filename}" if error.filename else "")


def _place(error: Exception) -> str:
    """The error with the innermost line of the program that it went through."""
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if "isomortar" in Path(frame.filename).parts]
    where = f" ({Path(frames[-1].filename).name}, line {frames[-1].lineno})" if frames else ""
    return f"{type(error).__name__}: {error}{where}"
