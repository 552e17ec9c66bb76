"""Nets of faces that are turned: what runs the other way, and what does not."""

from __future__ import annotations

import numpy as np
import pytest

from isomortar.geometry.net import Net
from isomortar.geometry.patch import Direction


@pytest.mark.parametrize("axis", [0, 1])
def test_a_net_that_is_reversed_along_one_coordinate_is_as_it_was_along_the_other(axis: int) -> None:
    uneven = (Direction("N", 2, np.array([0, 0, 0, 0.2, 1, 1, 1])), Direction("N", 1, np.array([0, 0, 0.7, 1, 1])))
    numbers = np.arange(12, dtype=np.int32).reshape(3, 4)
    points = np.random.default_rng(0).standard_normal((3, 4, 3))
    net = Net("uv", uneven, numbers, points, 1.0 + numbers / 12)
    back = net.reversed(axis)
    assert np.array_equal(back.directions[1 - axis].knots, uneven[1 - axis].knots)
    assert np.allclose(back.directions[axis].knots, 1.0 - uneven[axis].knots[::-1])
    for whole, turned in ((numbers, back.numbers), (points, back.points), (net.weights, back.weights)):
        assert np.array_equal(turned, whole[:, ::-1] if axis == 0 else whole[::-1])
    again = back.reversed(axis)
    assert all(np.allclose(one.knots, other.knots) for one, other in zip(again.directions, uneven, strict=True))
