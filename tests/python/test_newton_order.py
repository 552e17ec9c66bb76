"""The observed order of Newton's method: right on sequences of known order, silent where it can not be told."""

from __future__ import annotations

from itertools import accumulate, repeat
from types import SimpleNamespace

import numpy as np
import pytest

from isomortar.model.constants import MOST_TANGENTS
from isomortar.solve.newton import Newton, observed_order
from isomortar.solve.record import IterationRecord

ROUND_OFF = 2e-12


def log(residuals: list[float], slip: list[int] | None = None, notes: tuple[str, ...] = ()) -> list[IterationRecord]:
    return [IterationRecord(k, r, 5, 5 - s, s, notes) for k, (r, s) in enumerate(zip(residuals, slip or [0] * len(residuals), strict=True))]


def sequence(order: float, factor: float, start: float, count: int) -> list[float]:
    return list(accumulate(repeat(start, count), lambda r, _: factor * r**order))


@pytest.mark.parametrize("order", [1.0, 1.5, 2.0, 3.0])
def test_known_orders(order: float) -> None:
    assert observed_order(log(sequence(order, 0.3, 0.1, 4 if order < 2 else 3)), ROUND_OFF) == pytest.approx(order, rel=1e-12)


def test_slow_convergence_is_not_hidden() -> None:
    assert observed_order(log(sequence(1.0, 1e-3, 1.0, 4)), ROUND_OFF) == pytest.approx(1.0)


def test_round_off_is_left_out() -> None:
    residuals = [*sequence(2.0, 0.5, 0.02, 3), 3e-14]
    assert residuals[2] ** 3 / residuals[1] ** 2 < 1e-12
    assert observed_order(log(residuals), ROUND_OFF) == pytest.approx(2.0)


def test_changing_states_and_measures_are_left_out() -> None:
    residuals = sequence(2.0, 0.5, 0.3, 3)
    assert np.isnan(observed_order(log(residuals, slip=[0, 1, 1]), ROUND_OFF))
    assert np.isnan(observed_order(log(residuals, notes=("halved 1 times: merit",)), ROUND_OFF))


def test_too_few_iterations() -> None:
    assert np.isnan(observed_order([], ROUND_OFF))
    assert np.isnan(observed_order(log([1.0, 0.1]), ROUND_OFF))


@pytest.mark.parametrize("advances", [True, False])
@pytest.mark.parametrize("most", [1, 7])
def test_a_loop_has_its_tangents_and_so_many_times_as_many_while_a_front_gets_on(most: int, advances: bool) -> None:
    loop = SimpleNamespace(_settings=SimpleNamespace(max_iterations=most), _trail=SimpleNamespace(advances=advances))
    taken = next(count for count in range(10 * MOST_TANGENTS * most) if Newton._spent(loop, count))  # type: ignore[arg-type]
    assert taken == most * (MOST_TANGENTS if advances else 1)
