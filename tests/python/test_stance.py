"""How the sides of a contact stand to each other, by cells of their faces."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import KDTree

from isomortar.model import stance


@pytest.mark.parametrize("away", [0.0, 3e6])
@pytest.mark.parametrize(("points", "others"), [(1, 1), (25, 64), (700, 900), (2, 300_000)])
def test_nearest_cells_are_those_of_a_tree(points: int, others: int, away: float) -> None:
    """In one go and in parts, near the origin and far from it."""
    random = np.random.default_rng(0)
    some, more = random.random((points, 3)) + away, random.random((others, 3)) + away
    np.testing.assert_array_equal(stance.nearest(some, more), KDTree(more).query(some)[1])
