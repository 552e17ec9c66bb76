"""CPU seconds and counts of load steps: of each by itself, by a clock that is set by hand."""

from __future__ import annotations

from unittest.mock import patch

import numpy as np

from isomortar._codes import WORK
from isomortar.harness import Bound, case
from isomortar.solve import timing

#: Load steps, and phases of each.
STEPS, TIMES = 5, 7


@case(
    claim="Each load step is told its own CPU seconds, by phase and those of none, its own counts, and its largest sizes; all add up "
    "to what has passed.",
    tier="gate",
    bounds={
        "seconds": Bound(at_most=1e-12, reason="round-off: of differences of times of some thousand seconds"),
        "counts": Bound(0.0, 0.0, "definition: counts that are others, or of an earlier load step"),
    },
)
def timed() -> dict[str, float]:
    """Largest difference over the seconds of a load step, and wrong counts."""
    random, now, worst, wrong = np.random.default_rng(4), 1000.0, 0.0, 0
    with patch.object(timing, "process_time", lambda: now):
        ledger = timing.Ledger()
        for _ in range(STEPS):
            expected = dict.fromkeys((*timing.PHASES, "other", "total"), 0.0)
            solves = int(random.integers(1, 9))
            ledger.counts["solves"] += solves
            ledger.work[0] += 2 * solves
            sizes = random.integers(1, 1000, 3).tolist()
            for size in sizes:
                ledger.largest(timing.SIZES[0], size)
            for name in random.choice(timing.PHASES, TIMES):
                between, within = random.uniform(1.0, 20.0, 2)
                now += between
                with ledger.phase(str(name)):
                    now += within
                expected[str(name)] += within
                expected["other"] += between
            expected["total"] = sum(expected.values())
            seconds, counts = ledger.take()
            wrong += seconds.keys() != expected.keys() or (counts["solves"], counts[next(iter(WORK))]) != (solves, 2 * solves)
            wrong += [counts[name] for name in timing.SIZES] != [np.max(sizes), 0]
            differences = [abs(seconds.get(name, np.nan) - value) for name, value in expected.items()]
            worst = float(np.maximum(worst, np.max(differences) / expected["total"]))
    return {"seconds": worst, "counts": float(wrong)}
