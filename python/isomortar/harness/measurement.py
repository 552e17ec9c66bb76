"""Measuring one cell: run its function, keep the numbers as plain data that JSON holds to the last bit."""

from __future__ import annotations

import platform
import time
import traceback
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

import numpy as np

from isomortar.harness.cases import Cell, Curve, SkippedError
from isomortar.harness.orders import Convergence

Ending = Literal["measured", "skipped", "raised", "crashed", "timed out"]
#: A measured value as it is stored: number, nested list, Convergence or Curve as a dict, None where there is none.
Stored = float | list[Any] | dict[str, Any] | None


@dataclass(frozen=True)
class Measurement:
    """How a cell ended, its numbers (by name), what was said (skip reason or traceback), and what it cost."""

    ending: Ending
    numbers: dict[str, Stored] = field(default_factory=dict)
    message: str = ""
    seconds: float = 0.0
    cpu_seconds: float = 0.0
    host: str = ""


def measure(cell: Cell) -> Measurement:
    """Run a cell here and now."""
    start, cpu_start = time.perf_counter(), time.process_time()
    numbers: dict[str, Stored] = {}
    ending: Ending = "measured"
    message = ""
    try:
        numbers = {name: stored(value) for name, value in cell.case.function(**cell.settings).items()}
    except SkippedError as skipped:
        ending, message = "skipped", str(skipped)
    except Exception:  # whatever a case raises is a failure of that cell, not of the run
        ending, message = "raised", traceback.format_exc()
    return Measurement(ending, numbers, message, time.perf_counter() - start, time.process_time() - cpu_start, platform.node())


def stored(value: Any) -> Stored:
    """A measured value as plain data. Python's JSON keeps every bit of a float, NaN and infinity too."""
    if value is None:
        return None
    if isinstance(value, Convergence):
        others = {name: _numbers(share) for name, share in value.others.items()}
        return {"type": "convergence", "sizes": _numbers(value.sizes), "errors": _numbers(value.errors), "others": others}
    if isinstance(value, Curve):
        return {"type": "curve", **asdict(value), "x": _numbers(value.x), "y": _numbers(value.y)}
    return _numbers(value)


def _numbers(value: Any) -> float | list[Any]:
    array = np.asarray(value)
    if array.dtype.kind not in "biuf":
        raise TypeError(f"a measured value must be made of real numbers; got {array.dtype} ({value!r:.60})")
    plain: float | list[Any] = array.astype(np.float64).tolist()
    return plain


def convergence_of(value: Stored) -> Convergence | None:
    """The convergence sequence that was stored, or None if it was something else."""
    if isinstance(value, dict) and value.get("type") == "convergence":
        return Convergence(value["sizes"], value["errors"], value["others"])
    return None


def curve_of(value: Stored) -> Curve | None:
    """The curve that was stored, or None if it was something else."""
    if isinstance(value, dict) and value.get("type") == "curve":
        return Curve(**{name: entry for name, entry in value.items() if name != "type"})
    return None
