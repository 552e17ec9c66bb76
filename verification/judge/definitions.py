"""What is refused as a case: bounds without limits or reasons, and claims that could not fail."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from judge.runs import refused
from judge.ways import BOUNDS, WAYS, told

from isomortar.harness import Bound, Matches, Order, Shown, case

REASON = "theory: so"
GOOD: dict[str, Any] = {"claim": "It holds.", "bounds": {"error": Bound(1.0, reason=REASON)}}
#: Bounds that are none.
NONE: tuple[Callable[[], object], ...] = (
    *(partial(Bound, 1.0, reason=reason) for reason in ("", "so", "theory", "theory:", "theory: ", "luck: so", "Theory: so")),
    *(
        partial(Bound, most, least, REASON)
        for most, least in ((None, None), (np.nan, None), (None, np.nan), (np.inf, None), (1.0, 2.5), (-0.5, None))
    ),
    *(partial(Order, order, REASON) for order in (0.0, -1.0, np.nan, np.inf)),
    *(partial(Matches, "kept", REASON, allowance) for allowance in (-1e-9, np.nan, np.inf)),
    partial(Order, 2.0, "luck: so"),
    partial(Matches, "kept", "luck: so"),
)
GRIDS: tuple[dict[str, Any], ...] = ({}, {"l": [1]}, {"k": [1], "l": [1]}, {"k": []}, {"k": [1, 1]}, {"k": [None]}, {"k": [[1]]})
#: Cases that are none, of a function of k.
NO_CASES: tuple[dict[str, Any], ...] = (
    GOOD,
    *({**GOOD, "grid": grid} for grid in GRIDS),
    *({**GOOD, "grid": {"k": [1]}, "claim": claim} for claim in ("", " ")),
    *({**GOOD, "grid": {"k": [1]}, "tier": tier} for tier in ("", "daily", lambda k: f"{k}")),
    *({**GOOD, "grid": {"k": [1]}, "bounds": bounds} for bounds in ({}, {"a": Shown("seen")}, {"a": 1.0}, [1.0])),
    *({**GOOD, "grid": {"k": [1]}, "bounds": bounds} for bounds in (lambda k: dict.fromkeys(range(0 * k)), lambda k: [k])),
)  # fmt: skip


def of_k(k: int) -> dict[str, float]:
    """Nothing that would be wrong."""
    return {"error": 0.0 * k}


@case(
    claim="A bound has a limit and a reason with its ground, a case arguments, a tier and claims that can fail; all else is refused when "
    "it is defined.",
    tier="gate",
    grid={"way": WAYS},
    bounds=BOUNDS,
)
def definitions(way: str) -> dict[str, float]:
    """How many are taken that should not be, or refused."""
    wrong = [f"bound {number}" for number, made in enumerate(NONE) if not refused(made)]
    wrong += [f"case {number}" for number, given in enumerate(NO_CASES) if not refused(lambda given=given: case(**given)(of_k))]  # type: ignore[misc]
    wrong += ["a good bound"] * any(refused(made) for made in (partial(Bound, 1.0, 1.0, REASON), partial(Bound, None, 0.0, REASON)))
    wrong += ["a good case"] * refused(lambda: case(**GOOD, grid={"k": [1, 2]})(of_k))
    return told(wrong, way)
