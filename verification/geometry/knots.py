"""Knots and boundaries of elements on either side of what a direction may have."""

from __future__ import annotations

from isomortar.errors import InputError
from isomortar.geometry.patch import Direction, Family
from isomortar.harness import Bound, case

_NONE = float("nan")
#: Family, order, knots, and words of why they are refused; none: they are taken.
KNOTS: tuple[tuple[Family, int, list[float], str], ...] = (
    ("N", 1, [0, 0, 1, 2, 2], ""),
    ("N", 1, [0, 0, 1, 1, 2, 2], "an inner knot is repeated"),
    ("N", 2, [0, 0, 0, 1, 1, 2, 2, 2], ""),
    ("N", 2, [0, 0, 0, 1, 1, 1, 2, 2, 2], "an inner knot is repeated"),
    ("N", 2, [0, 0, 0, 1, 2, 2, 2, 3, 3, 3], "an inner knot is repeated"),
    ("N", 2, [0, 0, 0, 0, 1, 1, 1], "must be open"),
    ("N", 2, [0, 0, 0, 1, 1, 1, 1], "must be open"),
    ("N", 2, [0, 0, 0, 0, 0, 1, 1, 1], "must be open"),
    ("N", 2, [0, 0, 0, 2.3e-16, 1, 1, 1], ""),
    ("N", 2, [0, 0, 0, 2.1e-16, 1, 1, 1], "has a knot span of 2.1e-16 of its range"),
    ("N", 1, [-2e40, -2e40, 0, 1e-40, 2e40, 2e40], "has a knot span of 2.5e-81 of its range"),
    ("L", 2, [0, 1e-80, 1], "has a knot span of 1e-80 of its range"),
    ("L", 2, [0, 2.3e-16, 1], ""),
    ("N", 3, [0, 0, 0, 0, 1, 1, 1, 2, 3, 3, 3, 3], ""),
    ("N", 3, [0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2], "an inner knot is repeated"),
    ("N", 2, [0, 0, 0, 1, 1, 1], ""),
    ("N", 2, [0, 0, 1, 1, 1], "order 2 needs at least 6"),
    ("N", 2, [0, 0, 0.1, 1, 1, 1], "must be open"),
    ("N", 2, [0, 0, 0, 0.9, 1, 1], "must be open"),
    ("N", 2, [0, 0, 0, 0, 0, 0], "must be open"),
    ("N", 1, [0, 0, 2, 1, 3, 3], "value 3 (1) is below the one before it"),
    ("N", 1, [0, 0, _NONE, 1, 1], "must be one list of finite numbers"),
    ("L", 3, [0, 1], ""),
    ("L", 3, [0], "must increase strictly"),
    ("L", 1, [0, 1, 1, 2], "must increase strictly"),
    ("L", 1, [0, 2, 1], "must increase strictly"),
    ("L", 4, [0, 1], ""),
    ("L", 5, [0, 1], "allowed for L: 1 to 4"),
    ("N", 10, [0.0] * 11 + [1.0] * 11, ""),
    ("N", 11, [0.0] * 12 + [1.0] * 12, "allowed for N: 1 to 10"),
    ("N", 0, [0, 1], "allowed for N: 1 to 10"),
)


def refused(family: Family, order: int, knots: list[float]) -> str:
    """Why a direction is refused; nothing, where it is taken."""
    try:
        Direction(family, order, knots)  # type: ignore[arg-type]
    except InputError as error:
        return str(error)
    return ""


@case(
    claim="Knots that a direction can have are taken, and others are refused with why: order, ends, multiplicities, and which way they go.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: knots on either side of each thing that is asked of them")},
)
def knots() -> dict[str, float]:
    """How many are taken for others."""
    told = [(refused(*given), words) for *given, words in KNOTS]  # type: ignore[arg-type]
    return {"wrong": float(sum(bool(said) != bool(words) or words not in said for said, words in told))}
