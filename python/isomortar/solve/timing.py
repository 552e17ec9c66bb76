"""Seconds by phase and counts of what the kernel was asked for."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter

PHASES = ("solid", "projection", "contact", "factor", "solve")


class Ledger:
    """Seconds by phase of PHASES and counts by name, since the last `take`."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = dict.fromkeys(PHASES, 0.0)
        self.counts: Counter[str] = Counter()
        self._start = perf_counter()

    @contextmanager
    def phase(self, name: str) -> Iterator[None]:
        """Time a phase."""
        start = perf_counter()
        try:
            yield
        finally:
            self.seconds[name] += perf_counter() - start

    def take(self) -> tuple[dict[str, float], dict[str, int]]:
        """Seconds by phase (what is in none of them is `other`) and counts; both begin anew."""
        total = perf_counter() - self._start
        seconds = {**self.seconds, "other": total - sum(self.seconds.values()), "total": total}
        counts = dict(self.counts)
        self.seconds = dict.fromkeys(PHASES, 0.0)
        self.counts.clear()
        self._start += total
        return seconds, counts
