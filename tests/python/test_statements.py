"""What a statement says of the runs by one method, and what all methods say together."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import pytest

from isomortar.harness.statement import NotMeasuredError, Statement, Values


@dataclass(frozen=True)
class Runs:
    """The runs by a method: what is measured on them, and what the measure had to do without."""

    method: str
    values: Values
    without: str = ""


def statement(measure: Callable[[Runs], Values] = lambda runs: runs.values) -> Statement[Runs]:
    return Statement("1", "It holds.", (), measure, "shares", "theory: so", at_most=2.0, at_least=1.0)


@pytest.mark.parametrize(
    ("values", "without", "state", "why"),
    [
        ({"a": 1.0, "b": 2.0}, "", "holds", ""),
        ({"a": 1.0, "b": 2.0}, "a run", "partly measured", "without a run"),
        ({"a": 1.5, "b": 2.1}, "", "does not hold", ""),
        ({"a": 0.9, "b": 1.5}, "", "does not hold", ""),
        ({"a": 0.9, "b": 1.5}, "a run", "does not hold", "without a run"),
        ({}, "", "not measured", "no finite value: none at all"),
        ({"a": 1.5, "b": float("nan")}, "", "not measured", "no finite value: b"),
        ({"a": float("inf")}, "a run", "not measured", "no finite value: a without a run"),
    ],
)
def test_all_values_are_judged_and_what_is_none_is_told(values: Values, without: str, state: str, why: str) -> None:
    (verdict,) = statement().judged([Runs("mine", values, without)]).verdicts
    assert (verdict.method, verdict.state, verdict.why) == ("mine", state, why)
    assert list(verdict.values) == list(values)


def test_a_run_that_is_not_there_measures_nothing() -> None:
    def measure(_: Runs) -> Values:
        raise NotMeasuredError("it failed")

    (verdict,) = statement(measure).judged([Runs("mine", {})]).verdicts
    assert (verdict.state, verdict.values, verdict.why) == ("not measured", {}, "it failed")


@pytest.mark.parametrize(
    ("found", "state"),
    [
        ([1.5, 1.6], "holds"),
        ([1.5, 3.0], "does not hold"),
        ([None, 3.0], "does not hold"),
        ([1.5, None], "partly measured"),
        ([None, None], "not measured"),
        ([], "not measured"),
    ],
)
def test_methods_together(found: list[float | None], state: str) -> None:
    runs = [Runs(str(number), {} if value is None else {"a": value}) for number, value in enumerate(found)]
    judgement = statement().judged(runs)
    assert judgement.state == judgement.as_data()["verdict"] == state
    assert list(judgement.as_data()["by_method"]) == [run.method for run in runs]
