"""Whether bodies are at or in each other, by cells of their outsides."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from isomortar.geometry.faces import spread
from isomortar.geometry.patch import FloatArray
from isomortar.model.constants import NO_PART
from isomortar.model.contrasts import element_lengths
from isomortar.model.entities import Body
from isomortar.model.stance import FACING
from isomortar.model.supports import BoolArray

#: Cells of a body's outside that are compared with those of another one.
SOME = 1500
#: Shares of the way from where a body meets another one to where it begins, at which others may be between: seven places, so that layers
#: as thin as an eighth of the way are found.
PLACES = tuple(k / 8 for k in range(1, 8))
#: Depth over the thickness of the thinner body from which on bodies are in each other: what contacts leave open is below it.
PASSED = 0.01


def meet(one: Body, other: Body, way: FloatArray, between: Sequence[Body] = ()) -> bool:
    """Whether a body that has gone some way and another one are within or at each other; not where that led through one `between`."""
    size = float(np.ptp(np.concatenate([one.patch.control_points + way, other.patch.control_points]), axis=0).max())
    seen = ((one, other, way), (other, one, -way))  # the smaller may be wholly inside
    return any(_is_at(*bodies, size, between) for bodies in seen)


def _is_at(one: Body, other: Body, way: FloatArray, size: float, between: Sequence[Body]) -> bool:
    """Whether cells of a body that has gone some way are in or at another one, by the size of both, and came through no others."""
    points, normals = _middles(one, other, way, NO_PART * size)
    if not len(points):
        return False
    above, out = other.outside.heights(points)
    touches = (np.einsum("ij,ij->i", normals, out) < FACING) & (np.abs(above) < NO_PART * size)
    within = above < -NO_PART * size
    came = ~_through(points, way, size, between if (touches | within).any() else ())
    return bool((touches & came).any()) or other.outside.deepest(points[within & came], NO_PART * size) > 0.0


def _through(points: FloatArray, way: FloatArray, size: float, between: Sequence[Body]) -> BoolArray:
    """Which points have come through bodies on their way."""
    through = np.zeros(len(points), dtype=np.bool_)
    for share in PLACES if np.any(way) else ():
        for body in between:
            through |= body.outside.heights(points - share * way)[0] < -NO_PART * size
    return through


def depth(one: Body, other: Body, least: float) -> float:
    """By how much parts of the outside of one body are in another one at most, or the other way round; 0 if by no more than the least."""
    still = np.zeros(3)
    return max(into.outside.deepest(_middles(of, into, still, -least)[0], least) for of, into in ((one, other), (other, one)))


def least_depth(one: Body, other: Body) -> float:
    """Depth from which on bodies are in each other: above what flat cells are off their faces, and a share of the thinner one."""
    thin = [float(lengths.sum()) for body in (one, other) for lengths in element_lengths(body.patch)]
    return 2.0 * (one.outside.sagitta + other.outside.sagitta) + PASSED * min(thin)


def _middles(one: Body, other: Body, way: FloatArray, margin: float) -> tuple[FloatArray, FloatArray]:
    """Middles of some cells of a body that has gone some way, and their normals: of those in the box round another one."""
    sides = one.outside.sides.values()
    points, normals = np.concatenate([side.centres for side in sides]) + way, np.concatenate([side.normals for side in sides])
    found = in_box(points, other, margin)
    found = found[:: spread(len(found), SOME)]
    return points[found], normals[found]


def in_box(points: FloatArray, body: Body, margin: float) -> NDArray[np.intp]:
    """Numbers of the points in the box round the control points of a body, or so near to it; if negative, so deep in it.

    In a body a point is no deeper than in that box.
    """
    corners = body.patch.control_points
    return np.flatnonzero(np.all((points >= corners.min(axis=0) - margin) & (points <= corners.max(axis=0) + margin), axis=1))
