"""How a case tells that the judge is wrong, by which the case itself is judged."""

from __future__ import annotations

from collections.abc import Sequence

from isomortar.harness import Bound

#: A judge that lets wrong numbers pass may stop at an error, and the other way round: each case of the judge tells by both.
WAYS = ("by a number", "by an error")
BOUNDS = {"wrong": Bound(0.0, 0.0, "definition: what is said that should not be, by a table of what should")}


def told(wrong: Sequence[str], way: str) -> dict[str, float]:
    """What is wrong as a number, or as an error.

    Raises
    ------
    AssertionError
        Something is wrong, and it is told by an error.
    """
    if wrong and way == WAYS[1]:
        raise AssertionError("; ".join(wrong))
    return {"wrong": float(len(wrong))}
