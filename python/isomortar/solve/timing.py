"""CPU seconds by phase and counts of what was done."""

from __future__ import annotations

from collections import Counter
from contextlib import AbstractContextManager
from time import process_time

import numpy as np

from isomortar._bindings import LongArray
from isomortar._codes import WORK

PHASES = ("solid", "projection", "contact", "factor", "solve")
#: What is counted, by name. Orders are those of derivatives.
COUNTERS = {
    "solid residuals": "internal forces of all bodies, those that are at hand still included",
    "solid tangents": "tangents of all bodies, but for those that stand where contact alone has another",
    "solid points": "quadrature points of bodies, each time that a stress is computed there",
    "contact tangents": "tangents of contacts",
    "contact points": "quadrature points of contacts, each time that a foot or kinematics are computed there",
    "warm projections": "feet found by a search that begins at the last one",
    "cold projections": "feet that the whole master was searched for",
    "elements searched": "elements of a master that were searched for a foot",
    **{
        name: f"places of masters where functions were evaluated {name.removeprefix('evaluations ')}"
        for name in WORK
        if name.startswith("evaluations")
    },
    "analyses": "orderings of linear systems",
    "factorisations": "factors of linear systems, those of faces alone included",
    "solves": "solutions of linear systems",
    "system non-zeros": "entries of the largest linear system",
    "factor non-zeros": "entries of the largest factors, dense blocks of faces included",
    "history bytes": "what states take in the results file",
}
#: Counts that are sizes: of several the largest is told, not the sum.
SIZES = ("system non-zeros", "factor non-zeros")


class Ledger:
    """CPU seconds of all threads by phase of PHASES, and counts by name, since the last `take`.

    Attributes
    ----------
    counts : Counter
        What Python counts, by name.
    work : ndarray of int64
        What the kernel counts, to which it adds; numbers of `_codes.WORK`.
    """

    def __init__(self) -> None:
        self.seconds: dict[str, float] = dict.fromkeys(PHASES, 0.0)
        self.counts: Counter[str] = Counter()
        self.work: LongArray = np.zeros(len(WORK), dtype=np.int64)
        self._start = process_time()

    def phase(self, name: str) -> AbstractContextManager[None]:
        """Time a phase."""
        return _Phase(self.seconds, name)

    def largest(self, name: str, size: int) -> None:
        """Note one of SIZES."""
        self.counts[name] = max(self.counts[name], size)

    def take(self) -> tuple[dict[str, float], dict[str, int]]:
        """Seconds by phase (what is in none of them is `other`) and counts; both begin anew."""
        total = process_time() - self._start
        seconds = {**self.seconds, "other": total - sum(self.seconds.values()), "total": total}
        counts = {**dict.fromkeys(COUNTERS, 0), **self.counts, **dict(zip(WORK, self.work.tolist(), strict=True))}
        self.seconds = dict.fromkeys(PHASES, 0.0)
        self.counts.clear()
        self.work[:] = 0
        self._start += total
        return seconds, counts


class _Phase(AbstractContextManager[None]):
    """Adds the CPU seconds of a block to those of its phase: thousands a run, by a class that costs less than a generator."""

    def __init__(self, seconds: dict[str, float], name: str) -> None:
        self._seconds, self._name = seconds, name

    def __enter__(self) -> None:
        self._start = process_time()

    def __exit__(self, *raised: object) -> None:
        self._seconds[self._name] += process_time() - self._start
