"""Observed orders: their estimate and interval against SciPy's line, and the verdicts on sequences that flatter."""

from __future__ import annotations

from typing import Any

import numpy as np
from judge.ways import BOUNDS, WAYS, told
from scipy import stats

from isomortar.harness import Bound, Convergence, case
from isomortar.harness.orders import estimate_order

SIZES = 0.5 ** np.arange(1.0, 7.0)
FALLING = SIZES**2
ALONE: dict[str, Any] = {"quadrature": 1e-14}


def bent(*factors: float) -> np.ndarray:
    """Errors of order 2 times factors, those of the finest meshes last."""
    return FALLING * np.concatenate([np.ones(len(SIZES) - len(factors)), factors])


#: Sizes, errors, other sources of error, the order expected, and the verdict.
TABLE: tuple[tuple[Any, Any, dict[str, Any], float, str], ...] = (
    (SIZES, FALLING, ALONE, 2.0, "confirmed"),
    (SIZES[-4:], FALLING[-4:], ALONE, 2.0, "confirmed"),
    (SIZES, FALLING, {"quadrature": 0.09 * FALLING}, 2.0, "confirmed"),
    (SIZES, FALLING * np.array([9.0, 9.0, 1.0, 1.0, 1.0, 1.0]), ALONE, 2.0, "confirmed"),
    (SIZES, FALLING, {"quadrature": np.array([1.0, 1.0, 0, 0, 0, 1e-14]) * FALLING}, 2.0, "confirmed"),
    (SIZES, FALLING, ALONE, 1.0, "pre-asymptotic"),
    (SIZES, FALLING, ALONE, 2.1, "pre-asymptotic"),
    (SIZES, FALLING, ALONE, 1.9, "pre-asymptotic"),
    (SIZES, SIZES**2.4, ALONE, 3.0, "pre-asymptotic"),
    (SIZES, bent(1.0, 4.0, 1.0, 4.0), ALONE, 2.0, "at the floor"),
    (SIZES, 0.5 ** np.array([0.0, 1.4, 2.8, 4.2, 5.6, 5.6]), ALONE, 2.0, "diverging"),
    (SIZES, bent(1.0, 1.0, 1.0, 0.4), ALONE, 2.0, "pre-asymptotic"),
    (SIZES, bent(1.0, 1.0, 1.3, 2.2), ALONE, 2.0, "pre-asymptotic"),
    (SIZES, SIZES**-1.0, ALONE, 2.0, "diverging"),
    (SIZES, np.ones(6), ALONE, 2.0, "diverging"),
    (SIZES, FALLING, {"quadrature": 0.11 * FALLING}, 2.0, "at the floor"),
    (SIZES, FALLING, {"quadrature": 1e-14, "load step": 0.11 * FALLING[-1]}, 2.0, "at the floor"),
    (SIZES, FALLING, {"quadrature": np.array([0, 0, 0, 0.2, 0, 0]) * FALLING}, 2.0, "at the floor"),
    (SIZES, FALLING + 2.0 * FALLING[-2], ALONE, 2.0, "at the floor"),
    (SIZES, FALLING, {}, 2.0, "invalid"),
    (SIZES, FALLING, {"quadrature": 0.0}, 2.0, "invalid"),
    (SIZES, FALLING, {"quadrature": -1e-9}, 2.0, "invalid"),
    (SIZES, FALLING, {"quadrature": np.nan}, 2.0, "invalid"),
    (SIZES, FALLING, {"quadrature": [1e-14, 1e-14]}, 2.0, "invalid"),
    (SIZES[-3:], FALLING[-3:], ALONE, 2.0, "invalid"),
    (SIZES[::-1], FALLING[::-1], ALONE, 2.0, "invalid"),
    (1.1 ** -np.arange(6.0), 1.1 ** -np.arange(0.0, 12.0, 2.0), ALONE, 2.0, "invalid"),
    (SIZES[:5], FALLING, ALONE, 2.0, "invalid"),
    (SIZES, bent(0.0), ALONE, 2.0, "invalid"),
    (SIZES, bent(-1.0), ALONE, 2.0, "invalid"),
    (SIZES, bent(np.nan), ALONE, 2.0, "invalid"),
    (SIZES, bent(np.inf), ALONE, 2.0, "invalid"),
    (np.append(SIZES[:5], 0.0), FALLING, ALONE, 2.0, "invalid"),
    (SIZES, "falling", ALONE, 2.0, "invalid"),
    (SIZES, FALLING, ALONE, 0.0, "invalid"),
    (SIZES, FALLING, ALONE, np.nan, "invalid"),
)


@case(
    claim="An order is confirmed where the errors of the four finest meshes fall with it, and all else that makes errors is far below; "
    "sequences that bend, stop falling, hold too few meshes or measured nothing else are not.",
    tier="gate",
    grid={"way": WAYS},
    bounds=BOUNDS,
)
def verdicts(way: str) -> dict[str, float]:
    """How many verdicts are wrong."""
    wrong = []
    for number, (sizes, errors, others, expected, judgement) in enumerate(TABLE):
        found = estimate_order(Convergence(sizes, errors, others), expected).judgement
        wrong += [f"{number}: {found}, not {judgement}"] * (found != judgement)
    return told(wrong, way)


@case(
    claim="An observed order and its interval are the slope and Student's 95 % interval of the line through the four finest meshes.",
    tier="gate",
    bounds={
        "order": Bound(at_most=1e-12, reason="round-off: the same line by SciPy's regression"),
        "interval": Bound(at_most=1e-12, reason="round-off: SciPy's standard error times Student's quantile"),
        "steps": Bound(at_most=1e-12, reason="round-off: quotients of logarithms"),
    },
)
def line() -> dict[str, float]:
    """Largest relative differences."""
    random, worst = np.random.default_rng(3), np.zeros(3)
    for _ in range(20):
        sizes = np.sort(random.uniform(1.3, 4.0, 6).cumprod())[::-1] * 1e-3
        errors = sizes ** random.uniform(1.0, 5.0) * np.exp(0.3 * random.normal(size=6))
        found = estimate_order(Convergence(sizes, errors, ALONE), 2.0)
        fitted = stats.linregress(np.log(sizes[-4:]), np.log(errors[-4:]))
        half = np.maximum(stats.t.ppf(0.975, 2) * fitted.stderr, 0.05)
        steps = [np.log(errors[k + 1] / errors[k]) / np.log(sizes[k + 1] / sizes[k]) for k in range(5)]
        ends = [abs(found.low - (fitted.slope - half)), abs(found.high - (fitted.slope + half))]
        off = abs(found.order / fitted.slope - 1.0), np.max(ends) / half, np.abs(np.divide(found.steps, steps) - 1.0).max()
        worst = np.maximum(worst, off)
    return dict(zip(("order", "interval", "steps"), map(float, worst), strict=True))
