"""Programs to measure beside isomortar: where they are, and what they cost as whole processes."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Protocol, TypeVar

from isomortar.harness.bench.declaration import REPEATS, SHORT

#: The interpreter with nutils and NGSolve, where `install.sh` puts it, and the variable that names another.
PEERS_PYTHON = Path(__file__).parents[3] / ".peers" / "bin" / "python"
PEERS_VARIABLE = "ISOMORTAR_PEERS"


class Costly(Protocol):
    """What has been run, and took CPU seconds."""

    @property
    def cpu_seconds(self) -> float:
        """User and system time."""


_Costly = TypeVar("_Costly", bound=Costly)


def timed(work: Callable[[], _Costly], repeats: int = REPEATS) -> tuple[_Costly, float]:
    """Do some work `repeats` times, a long one once: what the last run came to, and the median CPU seconds of all."""
    runs = [work()]
    while runs[0].cpu_seconds < SHORT and len(runs) < repeats:
        runs.append(work())
    return runs[-1], median(one.cpu_seconds for one in runs)


def peers_python() -> str:
    """The interpreter that has nutils and NGSolve."""
    return os.environ.get(PEERS_VARIABLE) or str(PEERS_PYTHON)
