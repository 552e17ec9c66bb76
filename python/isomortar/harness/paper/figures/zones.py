"""Cells of a grid cut along the line where a field changes sign, so that the zone on either side has a smooth border."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from isomortar.geometry.patch import FloatArray

#: A part has at most two corners of its cell and four places where the field is zero on an edge.
_CORNERS = 6


@dataclass(frozen=True)
class Zones:
    """Cells of a grid of m2 x m1 places by the sign of a field at their corners.

    `positive`, `negative`: whole cells, shape (m2 - 1, m1 - 1). `cut`: rows and columns of the other cells. `parts`: of each cut cell
    the positive and the negative part, shape (cut cells, 2, 6, k); corners may repeat.
    """

    positive: NDArray[np.bool_]
    negative: NDArray[np.bool_]
    cut: tuple[NDArray[np.int64], NDArray[np.int64]]
    parts: FloatArray


def zones(points: FloatArray, field: FloatArray) -> Zones:
    """Zones of a field of shape (m2, m1) on a grid of points of shape (m2, m1, k); zero counts as positive."""
    corners = _around(points)
    values = _around(field[..., None])[..., 0]
    positive, negative = values.min(axis=-1) >= 0, values.max(axis=-1) < 0
    cut = np.nonzero(~positive & ~negative)
    parts = [[_part(p, v), _part(p, -v)] for p, v in zip(corners[cut], values[cut], strict=True)]
    return Zones(positive, negative, (cut[0], cut[1]), np.array(parts).reshape(-1, 2, _CORNERS, points.shape[-1]))


def corners_of(cells: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Places of the grid that are corners of one of the cells, shape (m2, m1) from (m2 - 1, m1 - 1)."""
    places = np.pad(cells, 1)
    return places[1:, 1:] | places[1:, :-1] | places[:-1, 1:] | places[:-1, :-1]


def _around(grid: FloatArray) -> FloatArray:
    """Corners of each cell in turn, shape (m2 - 1, m1 - 1, 4, k)."""
    return np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=2)


def _part(corners: FloatArray, values: FloatArray) -> FloatArray:
    """The part of a quadrilateral where the field is positive, linear along its edges."""
    kept = []
    for k in range(4):
        here, there = values[k], values[(k + 1) % 4]
        if here >= 0:
            kept.append(corners[k])
        if (here > 0 > there) or (here < 0 < there):
            kept.append(corners[k] + here / (here - there) * (corners[(k + 1) % 4] - corners[k]))
    return np.array(kept + [kept[-1]] * (_CORNERS - len(kept)))
