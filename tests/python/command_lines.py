"""Command lines that tests run, on a scene of a second or less."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import isomortar
from isomortar.solve.record import StepResult

#: Settings that make `press` small.
SMALL = ("bodies.block.mesh.elements=[3,3,2]", "stages.press.steps=3")

#: Runs a command line in an empty folder; exit code, stdout, stderr (fixture `invoke`).
Invoke = Callable[..., tuple[int, str, str]]


def settings(values: Sequence[str]) -> list[str]:
    return [word for value in values for word in ("--set", value)]


def last(path: str | Path) -> StepResult:
    with isomortar.Results(path) as results:
        step = results.last_step()
    assert step is not None
    return step
