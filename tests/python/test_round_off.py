"""Scales of round-off: numbers are brought to size without changing a bit of them."""

from __future__ import annotations

import numpy as np
import pytest

from isomortar.solve.scales import _power_of_two


@pytest.mark.parametrize("largest", [1e-300, 3e-160, 0.7, 1.0, 5.0, 1e160, 1e300])
def test_numbers_divided_by_their_size_are_the_same_bits(largest: float) -> None:
    values = largest * np.array([[1.0, -0.3], [1e-7, 0.0]])
    size = _power_of_two(values)
    assert np.frexp(size)[0] == 0.5
    assert 0.5 <= np.abs(values / size).max() <= 1.0
    assert np.array_equal(values / size * size, values)


def test_of_nothing_the_size_is_one() -> None:
    assert _power_of_two(np.zeros(3)) == _power_of_two(np.zeros(0)) == 1.0
