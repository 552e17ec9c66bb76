"""Cells of a grid cut along the line where a field changes sign, so that the zone on either side has a smooth border."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from isomortar.geometry.patch import FloatArray

#: The triangles of a cell, by its corners in turn: in them a field has no saddle.
_TRIANGLES = np.array([[0, 1, 2], [0, 2, 3]])
#: A part of a triangle has at most two of its corners and two places where the field is zero on an edge.
_CORNERS = 4


@dataclass(frozen=True)
class Zones:
    """Cells of a grid of m2 x m1 places by the sign of a field at their corners.

    `positive`, `negative`: whole cells, shape (m2 - 1, m1 - 1). `parts`: the positive and the negative part of each triangle of the
    other cells, shape (n, 2, 4, k); corners may repeat. `cut`: rows and columns of the cells that the triangles belong to.
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
    rows, columns = (np.repeat(number, len(_TRIANGLES)) for number in np.nonzero(~positive & ~negative))
    triangle = np.tile(_TRIANGLES, (len(rows) // len(_TRIANGLES), 1))
    cut = rows[:, None], columns[:, None], triangle
    parts = [[_part(p, v, v >= 0), _part(p, v, v < 0)] for p, v in zip(corners[cut], values[cut], strict=True)]
    return Zones(positive, negative, (rows, columns), np.array(parts).reshape(-1, 2, _CORNERS, points.shape[-1]))


def corners_of(cells: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Places of the grid that are corners of one of the cells, shape (m2, m1) from (m2 - 1, m1 - 1)."""
    places = np.pad(cells, 1)
    return places[1:, 1:] | places[1:, :-1] | places[:-1, 1:] | places[:-1, :-1]


def _around(grid: FloatArray) -> FloatArray:
    """Corners of each cell in turn, shape (m2 - 1, m1 - 1, 4, k)."""
    return np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=2)


def _part(corners: FloatArray, values: FloatArray, inside: NDArray[np.bool_]) -> FloatArray:
    """The part of a triangle on the side of the corners that are inside; one corner, repeated, where none is."""
    kept = []
    for here, there in ((0, 1), (1, 2), (2, 0)):
        if inside[here]:
            kept.append(corners[here])
        if inside[here] != inside[there]:
            kept.append(corners[here] + values[here] / (values[here] - values[there]) * (corners[there] - corners[here]))
    kept = kept or [corners[0]]
    return np.array(kept + [kept[-1]] * (_CORNERS - len(kept)))
