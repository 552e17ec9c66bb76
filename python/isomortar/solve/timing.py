"""Seconds by phase and counts of what the kernel was asked for."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter

PHASES = ("solid", "projection", "contact", "factor", "solve")


class Ledger:
    """Running totals of a computation: `seconds` by phase of PHASES, `counts` by name."""

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

    def totals(self) -> dict[str, float]:
        """Seconds by phase; what is not in one of them is `other`."""
        total = perf_counter() - self._start
        return {**self.seconds, "other": total - sum(self.seconds.values()), "total": total}
