"""Of many cells of a face some are looked at: about as many as are asked for, in all columns of the rows."""

from __future__ import annotations

import math

import numpy as np
import pytest

from isomortar.geometry.faces import spread
from isomortar.geometry.grids import CELLS


@pytest.mark.parametrize("count", [1, 300, 13824, 48 * 4 * 1000, 48 * 4 * 5000 + 2 * 48 * 48])
@pytest.mark.parametrize("some", [400, 1500])
def test_some_cells_are_about_as_many_as_asked_for_and_in_every_column(count: int, some: int) -> None:
    step = spread(count, some)
    looked_at = np.arange(0, count, step)
    assert len(looked_at) <= 1.6 * some
    assert len(looked_at) >= min(count, some // 2)
    assert math.gcd(step, CELLS) == 1
    if count >= CELLS * CELLS:
        assert set(looked_at % CELLS) == set(range(CELLS))
