"""The comparison fails closed: a corpus of bad results, all of which must go red."""

import ast
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from isomortar.errors import InputError
from isomortar.harness.cases import Bound, Case, Cell, Curve, Matches, Order, Shown, case
from isomortar.harness.compare import Expected, agree, judge, worst
from isomortar.harness.measurement import Measurement, measure, stored
from isomortar.harness.orders import Convergence

NAN, INF = np.nan, np.inf
H = np.array([0.5, 0.25, 0.125, 0.0625])
ALONE = {"quadrature": 1e-14}


def nothing():
    return {}


def cell_of(claim) -> Cell:
    return Cell(Case(nothing, "It holds.", {"value": claim}, "gate", {}, None, ()), {})


def state(claim, value, expected=None):
    numbers = {} if value is None else {"value": stored(value)}
    (check,) = judge(cell_of(claim), Measurement("measured", numbers), lambda *_: expected)
    return check.state


def test_equal_values_agree():
    assert agree([1.0, 2.0], [1.0, 2.0], 0.0).agrees
    assert agree(1.0, 1.0 + 1e-10, 1e-9).agrees


@pytest.mark.parametrize(
    ("measured", "expected", "tolerance"),
    [
        (NAN, 1.0, 1.0), (1.0, NAN, 1.0), (NAN, NAN, 1.0), (INF, INF, 1.0), (INF, 1.0, INF), (1.0, 1.0, NAN), (1.0, 1.0, INF),
        (1.0, 1.0, -1.0), ([], [], 1.0), ([1.0], 1.0, 1.0), ([1.0, 1.0], [1.0], 1.0), ([[1.0]], [1.0], 1.0), ([1.0], [1.0], [1.0, 1.0]),
        (None, 1.0, 1.0), ("one", 1.0, 1.0), ([1.0, [2.0]], [1.0, 2.0], 1.0), ([1.0, NAN], [1.0, 1.0], 1.0), (1.1, 1.0, 0.05),
        (1j, 1.0, 2.0), (True, 1.0, 1.0), ("1.0", 1.0, 1.0), (np.ma.masked, 0.0, 1.0),
        (np.ma.array([1.0, 2.0], mask=[0, 1]), [1.0, 2.0], 1.0),
        (np.array([1.0], object), [1.0], 1.0), (10**400, 1.0, 1.0), (2**53 + 1, 2.0**53, 0.0), (1.7e308, -1.7e308, 1.0), (5e-324, 0.0, 0.0),
        (np.zeros(1, [("a", float)]), [0.0], 1.0), ([NAN], [1.0], [INF]), (np.datetime64(1, "s"), 1.0, 1.0), (1.0, 1.0, True),
    ],
)  # fmt: skip
def test_bad_values_do_not_agree(measured, expected, tolerance):
    assert not agree(measured, expected, tolerance).agrees


@given(st.floats(allow_nan=True, allow_infinity=True), st.floats(allow_nan=True, allow_infinity=True), st.floats())
def test_agreement_is_only_a_finite_error_within_a_finite_tolerance(a, b, t):
    good = bool(np.isfinite([a, b, t]).all()) and abs(a - b) <= t
    assert agree(a, b, t).agrees == good


def test_bounds():
    bound = Bound(at_most=1e-3, reason="theory: so")
    assert state(bound, 1e-3) == "passed"
    assert state(bound, 0.0) == "passed"
    assert state(bound, np.full((2, 3), 1e-4)) == "passed"
    assert state(Bound(at_least=2.0, reason="theory: so"), 2.0) == "passed"
    assert state(Bound(at_least=-1.0, at_most=1.0, reason="theory: so"), [-1.0, 1.0]) == "passed"
    assert state(bound, Curve([1, 2], [1e-3, 1e-4], "x", "y")) == "passed"


@pytest.mark.parametrize(
    "value",
    [1.1e-3, -1.0, NAN, INF, -INF, [], [1e-4, NAN], [1e-4, 2e-3], [[1e-4], [-1e-9]], Curve([1], [1.0], "x", "y"), Convergence(H, H, ALONE)],
)
def test_bad_values_break_a_bound(value):
    assert state(Bound(at_most=1e-3, reason="theory: so"), value) == "failed"


@pytest.mark.parametrize("value", [NAN, INF, [], [1.0, NAN]])
def test_bad_values_break_lower_bounds_and_what_is_only_shown(value):
    assert state(Bound(at_least=0.0, reason="theory: so"), value) == "failed"
    assert state(Shown("to see"), value) == "failed"


def test_orders():
    assert state(Order(2, "theory: so"), Convergence(H, H**2, ALONE)) == "passed"
    for value in (
        2.0,
        H**2,
        Convergence(H, H**2, {}),
        Convergence(H, H, ALONE),
        Convergence(H[:3], H[:3] ** 2, ALONE),
        Convergence(H, H * NAN, ALONE),
        Curve(H, H**2, "h", "e"),
    ):
        assert state(Order(2, "theory: so"), value) == "failed"


def test_references():
    claim = Matches("hertz", "reference: its uncertainty", allowance=0.01)
    exact = Expected(np.array([100.0, 50.0]), np.array(0.25), "exact")
    assert state(claim, [101.5, 50.0], exact) == "passed"  # 2 * 0.25 + 0.01 * 100
    assert state(claim, [101.6, 50.0], exact) == "failed"
    assert state(claim, [100.0, NAN], exact) == "failed"
    assert state(claim, [100.0], exact) == "failed"
    assert state(claim, Curve([1, 2], [100.0, 50.0], "x", "y"), exact) == "failed"  # at which x the reference is, it does not say
    assert state(claim, [100.0, 50.0], None) == "missing reference"
    (check,) = judge(
        cell_of(claim), Measurement("measured", {"value": [100.0, 50.0]}), lambda *_: Expected(exact.values, exact.uncertainty, "self")
    )
    assert "not correctness" in check.found


def test_a_number_that_is_not_there_is_not_measured():
    assert state(Bound(at_most=1.0, reason="theory: so"), None) == "not measured"
    (check,) = judge(cell_of(Bound(at_most=1.0, reason="theory: so")), Measurement("measured", {"value": None}), lambda *_: None)
    assert check.state == "not measured"


def test_a_number_without_a_bound_fails():
    checks = judge(cell_of(Bound(at_most=1.0, reason="theory: so")), Measurement("measured", {"value": 0.5, "more": 0.1}), lambda *_: None)
    assert [c.state for c in checks] == ["passed", "failed"]


@pytest.mark.parametrize(
    ("ending", "expected"),
    [
        *((ending, "failed") for ending in ("not converged", "refused", "trouble")),
        *((ending, ending) for ending in ("skipped", "crashed", "timed out", "not measured")),
    ],
)
def test_what_did_not_end_well_does_not_pass(ending, expected):
    (check,) = judge(cell_of(Shown("to see")), Measurement(ending, message="why"), lambda *_: None)
    assert check.state == expected
    assert check.found == "why"


def test_worst_state():
    assert worst([]) == "not measured"
    assert worst(["passed", "skipped", "failed", "passed"]) == "failed"
    assert worst(["passed"]) == "passed"


ANY = {"value": Bound(at_least=-1e9, at_most=1e9, reason="theory: so")}


@pytest.mark.parametrize(
    "value",
    [
        "text", "1.0", 1j, [[1.0], [1.0, 2.0]], {"a": 1.0}, object(), True, [True, False], np.bool_(False), np.ma.masked, [1.0, None],
        np.ma.array([1.0], mask=[True]), np.array([1.0], object), 10**400, 2**53 + 1, np.array([2**60]), np.zeros(1, [("a", float)]),
        -(2**53) - 1, [np.ma.array([1.0], mask=[True])], np.datetime64(1, "s"), b"1", (x for x in [1.0]), Convergence(H, [None] * 4, ALONE),
        Convergence([True] * 4, H, ALONE), Curve(H, ["a"], "x", "y"),
    ],
)  # fmt: skip
def test_a_case_that_returns_something_else_has_failed(value):
    made = case(claim="It holds.", bounds=ANY)(lambda: {"value": value})
    assert measure(made.cells[0]).ending == "crashed"


def yields():
    yield {"value": 0.5}


async def later():
    return {"value": 0.5}


@pytest.mark.parametrize(
    "function", [lambda: None, lambda: 3, lambda: [1.0], lambda: {1: 1.0}, lambda: {"value"}, lambda: [("value", 0.5)], yields]
)
def test_a_case_that_returns_no_names_has_failed(function):
    made = case(claim="It holds.", bounds=ANY)(function)
    assert measure(made.cells[0]).ending == "crashed"


@pytest.mark.filterwarnings("ignore:coroutine")
def test_a_case_that_returns_later_has_failed():
    assert measure(case(claim="It holds.", bounds=ANY)(later).cells[0]).ending == "crashed"


def test_what_is_measured_says_what_it_cost():
    def large():
        return {"value": np.ones(30_000_000).sum()}

    def small():
        return {"value": 0.5}

    costs = [measure(case(claim="It holds.", bounds=ANY)(function).cells[0]).peak_memory for function in (small, large, small)]
    assert costs[1] - costs[0] > 2e8
    assert costs[1] - costs[2] > 2e8


@pytest.mark.parametrize(
    "curve",
    [
        Curve([], [1e-4], "x", "y"), Curve([1, 2], [1e-4], "x", "y"), Curve([NAN], [1e-4], "x", "y"), Curve([[1]], [[1e-4]], "x", "y"),
        Curve([], [], "x", "y"), Curve(1.0, 1e-4, "x", "y"), Curve([1, INF], [1e-4, 1e-4], "x", "y"), Curve([1], [NAN], "x", "y"),
    ],
)  # fmt: skip
def test_bad_curves_break_a_bound(curve):
    assert state(Bound(at_most=1e-3, reason="theory: so"), curve) == "failed"
    assert state(Shown("to see"), curve) == "failed"


def test_definitions_that_could_not_fail_are_refused():
    good = {"claim": "It holds.", "bounds": {"value": Bound(at_most=1.0, reason="theory: so")}}
    assert case(**good)(nothing).cells[0].tier == "gate"
    for wrong in (
        {"bounds": {}}, {"claim": " "}, {"tier": "sometimes"}, {"grid": {"order": [1]}}, {"bounds": {"value": 1.0}}, {"bounds": None},
        {"bounds": lambda: None}, {"bounds": dict}, {"bounds": ["value"]}, {"bounds": {"value": Shown("to see")}}, {"tier": lambda: None},
    ):  # fmt: skip
        with pytest.raises(InputError):
            case(**{**good, **wrong})(nothing)
    with pytest.raises(InputError, match="grid"):
        case(**good, grid={"order": []})(lambda order: {"value": order})
    with pytest.raises(InputError, match="twice"):
        case(**good, grid={"order": [1, 2, 1]})(lambda order: {"value": order})
    for limits in ({}, {"at_most": NAN}, {"at_most": INF}, {"at_most": -1.0}, {"at_least": 2.0, "at_most": 1.0}):
        with pytest.raises(InputError):
            Bound(**limits, reason="theory: so")
    for reason in ("", "because", "theory:", "hope: so"):
        with pytest.raises(InputError, match="reason"):
            Bound(at_most=1.0, reason=reason)
    for expected in (0, -1, NAN):
        with pytest.raises(InputError):
            Order(expected, "theory: so")
    with pytest.raises(InputError):
        Matches("hertz", "reference: so", allowance=-1.0)


def test_bounds_and_tier_may_depend_on_the_settings():
    made = case(
        claim="It holds.",
        grid={"order": [1, 4]},
        tier=lambda order: "gate" if order < 3 else "nightly",
        bounds=lambda order: {"value": Order(order + 1, "theory: so")},
    )(lambda order: {"value": Convergence(H, H ** (order + 1), ALONE)})
    assert [cell.tier for cell in made.cells] == ["gate", "nightly"]
    for cell in made.cells:
        assert [c.state for c in judge(cell, measure(cell), lambda *_: None)] == ["passed"]


def keeps_nan_out(tree: ast.AST) -> list[int]:
    """Lines with Python's ``max`` or ``min`` of a value and zero or the value so far, or of values as they come: max(0.0, nan) is 0.0."""
    lines = []
    for node in ast.walk(tree):
        if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in ("max", "min")) or node.keywords:
            continue
        if len(node.args) == 1:
            as_they_come = isinstance(node.args[0], ast.GeneratorExp | ast.ListComp) or ast.unparse(node.args[0]).endswith(".values()")
            lines += [node.lineno] * as_they_come
            continue
        parents = [n for n in ast.walk(tree) if isinstance(n, ast.Assign) and node in ast.walk(n)]
        targets = {t.id for n in parents for t in n.targets if isinstance(t, ast.Name)}
        again = any(isinstance(a, ast.Name) and a.id in targets for a in node.args)
        if again or any(isinstance(a, ast.Constant) and a.value == 0.0 for a in node.args):
            lines.append(node.lineno)
    return sorted(lines)


def test_no_case_keeps_nan_out_of_its_numbers() -> None:
    """``worst = max(worst, error)`` drops an error that is NaN; numpy.maximum hands it on."""
    text = "worst = max(worst, f(x))\nn = max(4, m)\ny = {'e': max(0.0, z)}\nmax(f(o) for o in runs)\nmin(found.values())\nmax(sizes)"
    assert keeps_nan_out(ast.parse(text)) == [1, 3, 4, 5]
    root = Path(__file__).parents[2]
    measuring = [*(root / "verification").glob("*/*.py"), *(root / "verification/paper/findings").glob("*.py")]
    measuring += [root / "verification/bundled_scenes.py"]
    texts = {path: path.read_text() for path in measuring}
    found = {path.name: lines for path, text in texts.items() if "matplotlib" not in text and (lines := keeps_nan_out(ast.parse(text)))}
    assert not found
