"""Measuring one cell: run its function, keep the numbers as plain data that JSON holds to the last bit."""

from __future__ import annotations

import contextlib
import platform
import resource
import time
import traceback
from collections.abc import Mapping
from dataclasses import asdict, field
from pathlib import Path
from typing import Any, Literal, TypeVar

import numpy as np

from isomortar._frozen import frozen
from isomortar._process import give_back_memory
from isomortar.errors import ConvergenceError, InputError
from isomortar.geometry.patch import FloatArray
from isomortar.harness.cases import Cell, Curve, SkippedError, Words
from isomortar.harness.orders import Convergence
from isomortar.program.process import Ending

#: Up to here double precision holds every whole number.
LARGEST_WHOLE = 2**53
#: A measured value as it is stored: number, nested list, Convergence, Curve or Words as a dict, None where there is none.
Stored = float | list[Any] | dict[str, Any] | None
_Kind = TypeVar("_Kind", Convergence, Curve, Words)


@frozen
class Measurement:
    """How a cell ended, its numbers (by name), what was said (skip reason or traceback), and what it cost.

    `cpu_seconds`: those of child processes included. `peak_memory`: the most that the measuring process held meanwhile, in bytes, what it
    had loaded before included; 0: not known.
    `sources`: hash of the program and of the case's files that the process found, on whatever machine.
    """

    ending: Ending | Literal["skipped", "not measured"]
    numbers: dict[str, Stored] = field(default_factory=dict)
    message: str = ""
    seconds: float = 0.0
    cpu_seconds: float = 0.0
    peak_memory: float = 0.0
    host: str = ""
    sources: str = ""

    @property
    def lasts(self) -> bool:
        """Whether it would end like this again. All else may be the machine's fault, or be there the next time."""
        return self.ending in ("measured", "not converged")

    @property
    def reason(self) -> str:
        """Why it was not measured, in one line: the last one of a traceback, without the path of the error's class."""
        last = (self.message.strip().splitlines() or [self.ending])[-1]
        name, colon, text = last.partition(": ")
        return text if colon and name.startswith("isomortar.") else last


def measure(cell: Cell) -> Measurement:
    """Run a cell here and now."""
    forget_peak_memory()
    start, cpu_start = time.perf_counter(), used()
    numbers: dict[str, Stored] = {}
    ending: Ending | Literal["skipped"] = "measured"
    message = ""
    try:
        numbers = _named(cell.case.function(**cell.settings))
    except SkippedError as skipped:
        ending, message = "skipped", str(skipped)
    except ConvergenceError:
        ending, message = "not converged", traceback.format_exc()
    except InputError:
        ending, message = "refused", traceback.format_exc()
    except (MemoryError, OSError):
        ending, message = "trouble", traceback.format_exc()
    except Exception:  # whatever a case raises is a failure of that cell, not of the run
        ending, message = "crashed", traceback.format_exc()
    seconds, cpu_seconds = time.perf_counter() - start, used() - cpu_start
    return Measurement(ending, numbers, message, seconds, cpu_seconds, peak_memory(), platform.node())


def used() -> float:
    """CPU seconds of this process so far, and of its children that have ended."""
    usages = [resource.getrusage(whose) for whose in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)


def forget_peak_memory() -> None:
    """Let the peak begin anew, where the system can (Linux); elsewhere it is that of the process so far."""
    give_back_memory()
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")


def peak_memory() -> float:
    """The most memory that this process has held, in bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1.0 if platform.system() == "Darwin" else 1024.0)


def _named(returned: Any) -> dict[str, Stored]:
    """What a case returned as plain data."""
    if not isinstance(returned, Mapping):
        raise TypeError(f"a case returns its numbers by name, in a dict; got {type(returned).__name__}")
    unnamed = [name for name in returned if not isinstance(name, str)]
    if unnamed:
        raise TypeError(f"names must be strings; got {unnamed}")
    return {name: stored(value) for name, value in returned.items()}


def stored(value: Any) -> Stored:
    """A measured value as plain data. Python's JSON keeps every bit of a float, NaN and infinity too."""
    if value is None:
        return None
    if isinstance(value, Convergence):
        others = {name: _numbers(share) for name, share in value.others.items()}
        return {"type": "convergence", "sizes": _numbers(value.sizes), "errors": _numbers(value.errors), "others": others}
    if isinstance(value, Curve):
        return {"type": "curve", **asdict(value), "x": _numbers(value.x), "y": _numbers(value.y)}
    if isinstance(value, Words):
        return {"type": "words", "text": value.text}
    return _numbers(value)


def _numbers(value: Any) -> float | list[Any]:
    plain: float | list[Any] = real_numbers(value).tolist()
    return plain


def real_numbers(value: Any) -> FloatArray:
    """A value as an array of real numbers, without loss.

    Raises
    ------
    TypeError
        Anything else, also what could be taken for numbers: truth values, strings of digits, masked arrays (which hide what they
        mask), whole numbers too large for double precision.
    """
    array = np.asarray(value)
    if _masked(value) or array.dtype.kind not in "iuf":
        kind = "a masked array" if _masked(value) else array.dtype
        raise TypeError(f"a measured value must be made of real numbers; got {kind} ({value!r:.60})")
    if array.dtype.kind in "iu" and np.any((array > LARGEST_WHOLE) | (array < -LARGEST_WHOLE)):
        raise TypeError(f"double precision does not hold all whole numbers above 2^53; got {value!r:.60}")
    return array.astype(np.float64)


def _masked(value: Any) -> bool:
    return isinstance(value, np.ma.MaskedArray) or (isinstance(value, list | tuple) and any(map(_masked, value)))


def restored(value: Stored, kind: type[_Kind]) -> _Kind | None:
    """What was stored as one of these kinds, or None if it was something else."""
    if isinstance(value, dict) and value.get("type") == kind.__name__.lower():
        return kind(**{name: entry for name, entry in value.items() if name != "type"})
    return None
