"""What decides how long the next increment is: linear solves and tangents of the longest of its Newton loops."""

from __future__ import annotations

from unittest.mock import Mock

import numpy as np

from isomortar.harness import Bound, case
from isomortar.solve.equilibrium import Balance
from isomortar.solve.method import Increment
from isomortar.solve.newton import KEPT_FACTORS
from isomortar.solve.record import AugmentationRecord, IterationRecord


def loop(number: int, kept: list[bool]) -> AugmentationRecord:
    """An augmentation whose Newton loop has taken a solve for each of `kept`, by new factors or by those that were kept."""
    notes = [(), *((KEPT_FACTORS, "cut") if old else () for old in kept)]
    records = (IterationRecord(k, 0.1**k, 3, 2, 1, note) for k, note in enumerate(notes))
    return AugmentationRecord(number, 1.0, 1.0, 0.1, 0.1, tuple(records))


@case(
    claim="An increment has as many linear solves, and as many tangents, as that of its Newton loops that has most of them.",
    tier="gate",
    bounds={
        "solves": Bound(0.0, 0.0, "definition: increments of which another number is told"),
        "tangents": Bound(0.0, 0.0, "definition: likewise; solves by factors that are kept take none"),
    },
)
def in_loops() -> dict[str, float]:
    """How many of some, whose loops are as long as chance has it."""
    random, solves, tangents = np.random.default_rng(2), 0, 0
    for _ in range(50):
        loops = [(random.random(random.integers(1, 30)) < random.random()).tolist() for _ in range(random.integers(1, 6))]
        increment = Increment(Mock(spec=Balance), tuple(loop(number, kept) for number, kept in enumerate(loops)), ())
        solves += increment.iterations != np.max([len(kept) for kept in loops])
        tangents += increment.tangents != np.max([kept.count(False) for kept in loops])
    return {"solves": float(solves), "tangents": float(tangents)}
