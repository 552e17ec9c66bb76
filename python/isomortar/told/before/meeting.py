"""Whether bodies are at or in each other, by cells of their outsides."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.faces import cells
from isomortar.geometry.patch import FloatArray
from isomortar.model.constants import NO_PART, SAME_POINT
from isomortar.model.entities import Body
from isomortar.model.stance import FACING, nearest
from isomortar.model.supports import BoolArray

#: Cells of a body's outside that are compared with those of another one.
SOME = 1500
#: Shares of the way from where a body meets another one to where it begins, at which others may be between: seven places, so that layers
#: as thin as an eighth of the way are found.
PLACES = tuple(k / 8 for k in range(1, 8))


@frozen
class _Heights:
    """Of some cells of a body's outside: where, how high they are above another body, whether beside its nearest cell, and facing it."""

    points: FloatArray
    above: FloatArray
    beside: BoolArray
    facing: BoolArray


def meet(one: Body, other: Body, way: FloatArray, between: Sequence[Body] = ()) -> bool:
    """Whether a body that has gone some way and another one are within or at each other; not where that led through one `between`."""
    size = _common_size(one, other, way)
    return size > 0.0 and any(  # of two the smaller may be wholly inside
        _are_at(_heights(*seen), size, seen[2], between) for seen in ((one, other, way), (other, one, -way))
    )


def _are_at(heights: _Heights, size: float, way: FloatArray, between: Sequence[Body]) -> bool:
    """Whether some cells are in or at a body, by the size of both, that have not come through others on their way."""
    in_or_at = (heights.above < -NO_PART * size) | (heights.facing & (heights.above < NO_PART * size))
    points = heights.points[~heights.beside & in_or_at]
    through = np.zeros(len(points), dtype=np.bool_)
    for share in PLACES if len(points) and np.any(way) else ():
        for body in between:
            above, _, beside = heights_above(points - share * way, body)
            through |= (above < -NO_PART * size) & ~beside
    return not through.all()


def depth(one: Body, other: Body) -> float:
    """By how much parts of the outside of one body are inside another one at most, or the other way round; 0 where they are not."""
    still = np.zeros(3)
    if not _common_size(one, other, still):
        return 0.0
    found = (_heights(one, other, still), _heights(other, one, still))
    return float(np.max([np.max(-h.above[~h.beside], initial=0.0) for h in found]))


def _common_size(one: Body, other: Body, way: FloatArray) -> float:
    """Size of the box around both, of which one has gone some way; 0 where their own boxes are apart."""
    first, second = one.patch.control_points + way, other.patch.control_points
    size = float(np.ptp(np.concatenate([first, second]), axis=0).max())
    low, high = np.maximum(first.min(axis=0), second.min(axis=0)), np.minimum(first.max(axis=0), second.max(axis=0))
    return 0.0 if np.any(high < low - SAME_POINT * size) else size


def _heights(one: Body, other: Body, way: FloatArray) -> _Heights:
    """Of some cells of the outside of a body that has gone some way."""
    centres, normals, _ = _outside(one)
    step = max(1, len(centres) // SOME)
    points, normals = centres[::step] + way, normals[::step]
    above, out, beside = heights_above(points, other)
    return _Heights(points, above, beside, np.einsum("ij,ij->i", normals, out) < FACING)


def heights_above(points: FloatArray, body: Body) -> tuple[FloatArray, FloatArray, BoolArray]:
    """How high points are above a body, the normals of its nearest cells, and which points are beside these."""
    theirs, out, areas = _outside(body)
    found = nearest(points, theirs)
    arms = points - theirs[found]
    above = np.einsum("ij,ij->i", arms, out[found])
    beside = np.linalg.norm(arms - above[:, None] * out[found], axis=1) > np.sqrt(areas[found])
    return above, out[found], beside


def _outside(body: Body) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Centres, normals and areas of the cells of all faces of a body."""
    sides = [cells(body.patch, face) for face in body.outer]
    centres, normals, areas = (np.concatenate([getattr(side, name) for side in sides]) for name in ("centres", "normals", "areas"))
    return centres, normals, areas
