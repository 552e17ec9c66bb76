"""How a run at an extreme ends: right, warned of, refused, stopped for the true cause, or wrong."""

from __future__ import annotations

import re
import signal
from collections.abc import Callable, Mapping, Sequence
from enum import IntEnum
from typing import Any

import numpy as np
from extremes.trials import Trial
from numpy.typing import ArrayLike

from isomortar.harness.cases import Bound, Claim, Shown, Words

#: Digits of a result that agrees to the last bit.
ALL_DIGITS = 16.0


class Ending(IntEnum):
    """How a point of a sweep ended, the worst first. Only `WRONG` does not pass; within the claimed interval only `RIGHT` does."""

    WRONG = 0
    STOPPED = 1
    REFUSED = 2
    WARNED = 3
    RIGHT = 4


def digits(values: ArrayLike, right: ArrayLike, size: float | None = None) -> float:
    """Decimal digits that two results have in common: of the largest error over the largest entry of what is right, or over `size`."""
    a, b = np.asarray(values, float), np.asarray(right, float)
    if a.shape != b.shape or not a.size:
        return float("nan")
    scale = float(np.abs(b).max()) if size is None else size
    error = float(np.abs(a / scale - b / scale).max())
    return -float(np.log10(np.maximum(error, 10.0**-ALL_DIGITS)))  # NaN stays NaN


def endings(right: bool) -> Mapping[str, Claim]:
    """Claims on what `judge` returns, where the program is claimed to be `right` and elsewhere."""
    limit = Ending.RIGHT if right else Ending.STOPPED
    told = "definition: right here" if right else "definition: right, or refused, stopped or warned of with the true cause; never wrong"
    return {
        "ending": Bound(at_least=limit, at_most=Ending.RIGHT, reason=told),
        "digits": Shown("definition: digits in common with what is right; 0 where nothing was computed"),
        "words": Shown("definition: what the program said, or what is wrong"),
    }


def judge(trial: Trial, found: Callable[[Trial], float], needed: float, causes: Sequence[str] = ()) -> dict[str, Any]:
    """How a trial ended, as the numbers of a case.

    Parameters
    ----------
    trial : Trial
    found : callable
        Digits of a run that came to its end.
    needed : float
        Digits from which a result is right.
    causes : sequence of str
        Regular expressions, of which what the program says on refusing, stopping or warning must contain one: the true causes here.
        Without any it has to be right.
    """
    ending, kept, words = _ended(trial, found, needed, causes)
    return {"ending": float(ending), "digits": kept, "words": Words(words)}


def _ended(trial: Trial, found: Callable[[Trial], float], needed: float, causes: Sequence[str]) -> tuple[Ending, float, str]:
    said = [line for line in trial.said.splitlines() if line.strip()]
    last = trial.said.rpartition("isomortar: ")[2].strip() or "nothing was said"
    if trial.code is None:
        return Ending.WRONG, 0.0, last
    if trial.code < 0:
        return Ending.WRONG, 0.0, f"{signal.Signals(-trial.code).name}: {last}"
    if "Traceback" in trial.said or trial.code > 2:
        return Ending.WRONG, 0.0, f"a traceback: {said[-1]}"
    if trial.code == 0:
        return _finished(trial, found, needed, [line for line in said if line.startswith("warning: ") and _names(line, causes)])
    if not _names(last, causes):
        return Ending.WRONG, 0.0, f"not the true cause: {last}"
    if trial.code == 1:
        announced = re.search(r"load step (\d+)", last)
        if announced and int(announced[1]) - 1 != (trial.steps or 0):
            return Ending.WRONG, 0.0, f"{trial.steps} load steps are kept: {last}"
        return Ending.STOPPED, 0.0, last
    if trial.steps is not None:
        return Ending.WRONG, 0.0, f"refused after it had begun: {last}"
    return Ending.REFUSED, 0.0, last


def _finished(trial: Trial, found: Callable[[Trial], float], needed: float, warnings: list[str]) -> tuple[Ending, float, str]:
    kept = found(trial)
    if not np.isfinite(kept):
        return Ending.WRONG, 0.0, "the result is not finite, or not there"
    if kept >= needed:
        return Ending.RIGHT, kept, ""
    if warnings:
        return Ending.WARNED, kept, warnings[0]
    return Ending.WRONG, kept, f"{kept:.1f} digits for {needed:g}, and not a word"


def _names(text: str, causes: Sequence[str]) -> bool:
    """Whether a text contains one of the causes, each from the beginning of a word: "thin" is not in "nothing"."""
    return any(re.search(rf"(?<!\w)(?:{cause})", text) for cause in causes)
