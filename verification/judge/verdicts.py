"""Verdicts on numbers, references and endings: a table of what must pass, and of what must not."""

from __future__ import annotations

from itertools import combinations_with_replacement
from typing import Any

import numpy as np
from judge.ways import BOUNDS, WAYS, told

from isomortar.errors import ConvergenceError, InputError
from isomortar.harness import Bound, Convergence, Curve, Matches, Order, Shown, Words, case, skip
from isomortar.harness.cases import Case, Cell, Claim
from isomortar.harness.compare import CHECK_STATES, CheckState, Expected, agree, judge, worst
from isomortar.harness.measurement import Measurement, measure, stored

NAN, INF = np.nan, np.inf
SMALL = Bound(at_most=1.0, reason="theory: an error")
LARGE = Bound(at_least=2.0, reason="theory: a gain")
SIGNED = Bound(1.0, -1.0, "theory: a signed number")
SHOWN = Shown("to be seen")
KEPT, WIDER = Matches("kept", "reference: as it was"), Matches("kept", "reference: as it was", allowance=0.1)
TEN = Expected(np.array(10.0), np.array(0.1), "exact")
ROW = Expected(np.array([10.0, -20.0]), np.array([0.1, 0.2]), "other code")
SIZES = np.array([0.5, 0.25, 0.125, 0.0625])


def rate(order: float) -> Convergence:
    """Errors that fall with an order."""
    return Convergence(SIZES, SIZES**order, {"quadrature": 1e-14})


#: A claim, what is measured (None: nothing), what it is compared with, and the verdict.
TABLE: tuple[tuple[Claim, Any, Expected | None, str], ...] = (
    *((SMALL, value, None, "passed") for value in (0.0, 1.0, [0.5, 1.0], [[0.0], [1.0]], Curve([1, 2], [0.1, 1.0], "x", "y"))),
    *((SMALL, value, None, "failed") for value in (1.0001, -1e-9, NAN, INF, -INF, [], [0.5, 2.0], [2.0, 0.5], [0.5, NAN], [[0.1], [-0.1]])),
    *((SMALL, value, None, "failed") for value in (Words("small"), rate(2.0), Curve([1, 2], [0.1, 1.1], "x", "y"))),
    *((claim, Curve(x, [0.1, 0.2], "x", "y"), None, "failed") for claim in (SMALL, SHOWN) for x in ([1, NAN], [1], [[1], [2]])),
    *((LARGE, value, None, "passed") for value in (2.0, 1e9, [2.0, 3.0])),
    *((LARGE, value, None, "failed") for value in (1.9999, -3.0, INF, NAN, [1.0, 3.0], [3.0, 1.0])),
    *((SIGNED, value, None, "passed") for value in (-1.0, 1.0, [-1.0, 0.0, 1.0])),
    *((SIGNED, value, None, "failed") for value in (-1.1, 1.1, NAN, [0.0, -1.1], [1.1, 0.0])),
    *((SHOWN, value, None, "passed") for value in (-1e9, [1.0, -1.0], Words("seen"))),
    *((SHOWN, value, None, "failed") for value in (NAN, INF, [], [1.0, NAN], rate(2.0))),
    *((claim, None, TEN, "not measured") for claim in (SMALL, LARGE, SIGNED, SHOWN, KEPT, Order(2.0, "theory: linear functions"))),
    *((KEPT, value, TEN, "passed") for value in (10.0, 10.1999, 9.8001)),
    *((KEPT, value, TEN, "failed") for value in (10.2001, 9.7999, -10.0, NAN, INF, [10.0], Words("ten"), Curve([1], [10.0], "x", "y"))),
    *((WIDER, value, TEN, "passed") for value in (11.1999, 8.8001)),
    *((WIDER, value, TEN, "failed") for value in (11.2001, 8.7999)),
    *((KEPT, value, ROW, "passed") for value in ([10.0, -20.0], [10.1999, -20.3999])),
    *((KEPT, value, ROW, "failed") for value in ([10.2001, -20.0], [10.0, -20.4001], [10.0, 20.0], [10.0], 10.0, [10.0, NAN])),
    (KEPT, [[10.0, -20.0]], ROW, "failed"),
    (WIDER, [12.1999, -22.3999], ROW, "passed"),
    (WIDER, [12.2001, -20.0], ROW, "failed"),
    *((claim, 10.0, None, "missing reference") for claim in (KEPT, WIDER)),
    (Order(2.0, "theory: linear functions"), rate(2.0), None, "passed"),
    *((Order(2.0, "theory: linear functions"), value, None, "failed") for value in (rate(1.0), rate(2.5), rate(3.0), 2.0, [2.0])),
)  # fmt: skip
#: Limits in words: what is at least, at most, exactly, between two numbers, an order, or a reference.
LIMITS: tuple[tuple[Claim, str], ...] = (
    (LARGE, "≥ 2"),
    (SMALL, "≤ 1"),
    (SIGNED, "-1 to 1"),
    (Bound(3.0, 3.0, "definition: a count"), "= 3"),
    (Bound(0.75, 0.25, "definition: a share"), "0.25 to 0.75"),
    (Order(2.0, "theory: linear functions"), "order 2"),
    (KEPT, "as kept"),
    (WIDER, "as kept ± 0.1"),
    (SHOWN, "shown"),
)
#: Endings of a measurement, and the state of all its numbers; and what is raised for them.
ENDINGS = {
    "not converged": "failed", "refused": "failed", "trouble": "failed", "crashed": "crashed", "timed out": "timed out",
    "skipped": "skipped", "not measured": "not measured",
}  # fmt: skip
RAISED = {
    ConvergenceError("no end"): "not converged", InputError("is wrong"): "refused", MemoryError(): "trouble", OSError(): "trouble",
    ValueError(): "crashed", AssertionError(): "crashed", KeyError(): "crashed", ZeroDivisionError(): "crashed",
}  # fmt: skip
#: What is no number, and what a case must not return.
NO_NUMBERS = (
    True,
    "1.0",
    [True],
    np.ma.masked,
    np.ma.array([1.0, 2.0], mask=[False, True]),
    2**53 + 1,
    -(2**53) - 1,
    np.array([1, 2**53 + 1], np.uint64),
    1j,
    [1.0, [2.0]],
    np.array([1.0], object),
)


def cell_of(**claims: Claim) -> Cell:
    """A cell with these claims."""
    return Cell(Case(dict, "It holds.", claims, "gate", {}, None, ()), {})


def verdict(claim: Claim, value: Any, expected: Expected | None) -> str:
    """Of the judge on one number."""
    numbers = {} if value is None else {"value": stored(value)}
    (check,) = judge(cell_of(value=claim), Measurement("measured", numbers), lambda *_: expected)
    return check.state


def measured(value: Any) -> Measurement:
    """Of a case that returns this, raises it or skips."""

    def function() -> Any:
        if isinstance(value, Exception):
            raise value
        return skip("no library") if value == "skip" else value

    return measure(Cell(Case(function, "It holds.", {"value": SHOWN}, "gate", {}, None, ()), {}))


@case(
    claim="Numbers pass that are within their bounds, entry by entry, finite and there; no others do, whatever they are; "
    "limits are told in words.",
    tier="gate",
    grid={"way": WAYS},
    bounds=BOUNDS,
)
def numbers(way: str) -> dict[str, float]:
    """How many verdicts are wrong."""
    wrong = [f"{claim} of {value!r:.60}: {found}" for claim, value, of, state in TABLE if (found := verdict(claim, value, of)) != state]
    more = judge(cell_of(value=SMALL), Measurement("measured", {"value": 0.5, "other": 0.5}), lambda *_: None)
    if [(check.name, check.state) for check in more] != [("value", "passed"), ("other", "failed")]:
        wrong.append("a number without a bound")
    ten, no_tolerance = np.array([10.0, 20.0]), (NAN, INF, -1.0, True, [1.0], [[1.0, 1.0]], [1.0, NAN])
    wrong += [f"tolerance {tolerance}" for tolerance in no_tolerance if agree(ten, ten, tolerance).agrees]
    bad: tuple[Any, ...] = (NAN, INF, -INF, None, "1")
    wrong += [f"both {value}" for value in bad if agree(value, value, 1.0).agrees]
    for claim, words in LIMITS:
        (check,) = judge(cell_of(value=claim), Measurement("measured", {}), lambda *_: TEN)
        wrong += [f"{claim} in words: {check.limit}"] * (check.limit != words)
    return told(wrong, way)


@case(
    claim="What did not come to its end, returned no numbers or was skipped does not pass, and of several states the worst counts.",
    tier="gate",
    grid={"way": WAYS},
    bounds=BOUNDS,
)
def endings(way: str) -> dict[str, float]:
    """How many states are wrong."""
    both = cell_of(one=SMALL, other=SHOWN)
    wrong = []
    for ending, state in ENDINGS.items():
        states = [check.state for check in judge(both, Measurement(ending, {"one": 0.5, "other": 0.5}), lambda *_: None)]  # type: ignore[arg-type]
        wrong += [f"{ending}: {states}"] * (states != [state, state])
    wrong += [f"{error!r}: {found}" for error, ending in RAISED.items() if (found := measured(error).ending) != ending]
    wrong += [f"{value!r:.40}: {found}" for value in NO_NUMBERS if (found := measured({"value": value}).ending) != "crashed"]
    wrong += [f"{value!r:.40}: {found}" for value in (None, 1.0, [1.0], {1: 1.0}) if (found := measured(value).ending) != "crashed"]
    wrong += [found for found in [measured("skip").ending] if found != "skipped"]
    kept = {ending for ending in (*ENDINGS, "measured") if Measurement(ending).lasts}  # type: ignore[arg-type]
    wrong += [f"kept: {kept}"] * (kept != {"measured", "not converged"})
    order: tuple[CheckState, ...] = ("passed", "missing reference", "not measured", "skipped", "failed", "crashed", "timed out")
    wrong += ["states"] * (order != CHECK_STATES)
    pairs = [
        (one, other)
        for one, other in combinations_with_replacement(order, 2)
        if worst((one, other)) != other or worst((other, one)) != other
    ]
    wrong += [f"worst of {pair}" for pair in pairs] + ["worst of none"] * (worst(()) != "not measured")
    return told(wrong, way)
