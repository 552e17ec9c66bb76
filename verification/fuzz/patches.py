"""Flat arrays of a patch on either side of what fits together: the first that does not is refused by its name, and nothing else is."""

from __future__ import annotations

import numpy as np

from isomortar._arguments import MAX_POINT
from isomortar._arrays import PatchArrays
from isomortar.errors import InputError
from isomortar.harness import Bound, case

#: NURBS of order 2 with 4 control points along two directions, Lagrange elements of order 2 along the third; what is not said below.
KNOTS, BOUNDARIES = [0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0], [0.0, 0.3, 1.0]
SOUND: dict[str, list[float]] = {
    "families": [1, 1, 2],
    "orders": [2, 2, 2],
    "counts": [4, 4, 5],
    "knots": [*KNOTS, *KNOTS, *BOUNDARIES],
    "point": [*range(80)],
    "weight": [1.0] * 80,
}


def knots(place: int, value: float) -> dict[str, list[float]]:
    """The knots, one of them another."""
    changed = list(SOUND["knots"])
    changed[place] = value
    return {"knots": changed}


#: Changes, and the array that is refused; none: they are taken.
CHANGES: tuple[tuple[dict[str, list[float]], str], ...] = (
    ({}, ""),
    (knots(3, 0.0), ""),
    (knots(3, 1.0), ""),
    *((knots(place, 0.1), "knots") for place in (0, 1, 2, 4, 5, 6)),
    *((knots(7 + place, value), "knots") for place, value in ((0, -0.1), (2, 0.1), (4, 0.9), (6, 1.1), (3, float("nan")))),
    (knots(15, 0.6), ""),
    *((knots(15, value), "knots") for value in (0.0, 1.0, -0.1, 1.1)),
    ({"knots": [0.5] * 7 + [*KNOTS, *BOUNDARIES]}, "knots"),
    ({"knots": [*SOUND["knots"], 2.0]}, "knots"),
    ({"knots": list(SOUND["knots"][:-1])}, "knots"),
    ({"families": [0, 1, 2]}, "families"),
    ({"families": [1, 1, 3]}, "families"),
    ({"orders": [0, 2, 2]}, "orders"),
    ({"orders": [11, 2, 2]}, "orders"),
    ({"orders": [2, 2, 5]}, "orders"),
    ({"counts": [2, 4, 5]}, "counts"),
    ({"counts": [4, 4, 4]}, "counts"),
    ({"counts": [4, 4, 2]}, "counts"),
    ({"point": [*range(79), MAX_POINT]}, ""),
    ({"point": [*range(79), MAX_POINT + 1]}, "point"),
    ({"point": [-1, *range(79)]}, "point"),
    ({"point": [*range(79)]}, "point"),
    ({"weight": [1.0] * 79 + [1e-3]}, ""),
    ({"weight": [1.0] * 79 + [0.0]}, "weight"),
    ({"weight": [-1.0, *[1.0] * 79]}, "weight"),
    ({"weight": [1.0] * 79 + [float("inf")]}, "weight"),
    ({"weight": [1.0] * 81}, "weight"),
)


def refused(changes: dict[str, list[float]]) -> str:
    """The array that a patch is refused for; none, where it is taken."""
    given = {
        name: np.array(value, dtype=np.float64 if name in ("knots", "weight") else np.int32) for name, value in (SOUND | changes).items()
    }
    try:
        PatchArrays(**given)  # type: ignore[arg-type]
    except InputError as error:
        return str(error.field)
    return ""


@case(
    claim="Arrays of a patch that do not fit together are refused by the name of the first that does not, and those that do are taken.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: arrays on either side of each thing that a patch asks for")},
)
def patches() -> dict[str, float]:
    """How many changes are taken for others."""
    wrong = [f"{changes}: {field}" for changes, field in CHANGES if refused(changes) != field]
    return {"wrong": float(len(wrong))}
