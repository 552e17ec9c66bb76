"""How high points are above a body, below zero within it: by the nearest places on cells of its faces."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from isomortar.geometry.faces import Cells
from isomortar.geometry.nearest import nearest
from isomortar.geometry.patch import FloatArray, IntArray

#: Share of a square of a distance by which a cell that a point is straight above is nearer than one that it is beside of, as far away: at
#: edges the latter does not tell on which side of it the point is. Cells that are twisted leave open 1e-4 of the size, and where edges are
#: sharper than a right angle 0.2 % of the distance was too little, a twelfth of the size away.
STRAIGHT = 2e-2
#: Share of a cell's sides from its middle to its edges: what is farther is nearer to the next one, or beside the face, if there is none.
HALF = 0.5


def heights_above(points: FloatArray, sides: Collection[Cells]) -> tuple[FloatArray, FloatArray]:
    """How high points are above all of some faces, that enclose a body, and the outward normals of the cells that are nearest.

    Where three faces meet in a sharp corner, or a body is folded closer than its cells are long, the side may be the other one:
    `Outside.turns` tells which it is.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
    sides : collection of Cells
        Of the faces, all with an area.

    Returns
    -------
    heights : ndarray, shape (n,)
        Distances from the nearest places; those within the body are negative.
    normals : ndarray, shape (n, 3)
    """
    bounds = np.stack([_bounds(points, side) for side in sides])
    order, scores = np.argsort(bounds, axis=0), np.full(len(points), np.inf)
    arms, normals = np.zeros((len(points), 3)), np.zeros((len(points), 3))
    for rank in order:  # the likeliest face first: most of the others are farther than the place that is found there
        for number, side in enumerate(sides):
            those = np.flatnonzero((rank == number) & (bounds[number] ** 2 <= scores * (1.0 + STRAIGHT)))
            if len(those):
                further, out = _from(points[those], side)
                found = _scores(further, out)
                nearer = found < scores[those]
                those = those[nearer]
                scores[those], arms[those], normals[those] = found[nearer], further[nearer], out[nearer]
    return np.copysign(np.linalg.norm(arms, axis=1), np.einsum("ij,ij->i", arms, normals)), normals


def _bounds(points: FloatArray, side: Cells) -> FloatArray:
    """Distances of points from the box round a face, which no place of it is nearer than."""
    reach = np.abs(side.sides).sum(axis=1) * HALF
    low, high = (side.centres - reach).min(axis=0), (side.centres + reach).max(axis=0)
    return np.asarray(np.linalg.norm(np.maximum(np.maximum(low - points, points - high), 0.0), axis=1))


def _from(points: FloatArray, side: Cells) -> tuple[FloatArray, FloatArray]:
    """Ways to points from the nearest places of a face, and its normals there; by steps from the nearest middle of a cell."""
    at = nearest(points, side.centres)
    arms, steps = _reached(points, side, at)
    moving = np.flatnonzero(steps.any(axis=0))
    while len(moving):
        there = np.clip(np.stack(np.unravel_index(at[moving], side.shape)) + steps[:, moving], 0, np.array(side.shape)[:, None] - 1)
        tried = np.ravel_multi_index(tuple(there), side.shape)
        further, onwards = _reached(points[moving], side, tried)
        nearer = _scores(further, side.normals[tried]) < _scores(arms[moving], side.normals[at[moving]])
        those = moving[nearer]
        at[those], arms[those], steps[:, those] = tried[nearer], further[nearer], onwards[:, nearer]
        steps[:, moving[~nearer]] = np.fix(0.5 * steps[:, moving[~nearer]])
        moving = moving[steps[:, moving].any(axis=0)]
    return arms, side.normals[at]


def _reached(points: FloatArray, side: Cells, numbers: IntArray) -> tuple[FloatArray, IntArray]:
    """Ways to points from the nearest places of cells, shape (n, 3), and how many cells on they are beyond these, shape (2, n)."""
    arms, ways = points - side.centres[numbers], side.ways(numbers, points - side.centres[numbers])
    cell = side.sides[numbers]
    places = np.zeros((5, 2, len(numbers)))
    places[0] = ways  # straight above, or else on one of the edges
    for edge, (axis, end) in enumerate([(0, -HALF), (0, HALF), (1, -HALF), (1, HALF)], start=1):
        places[edge, axis] = end
        places[edge, 1 - axis] = _share(arms - end * cell[:, axis], cell[:, 1 - axis])
    there = np.clip(places, -HALF, HALF)
    further = arms - np.einsum("ean,nai->eni", there, cell)
    squares = np.einsum("eni,eni->en", further, further)
    squares[0, np.any(there[0] != ways, axis=0)] = np.inf
    best, each = np.argmin(squares, axis=0), np.arange(len(numbers))
    on_edge = places[best, :, each].T
    return further[best, each], np.rint(np.where(np.abs(on_edge) == HALF, ways, on_edge)).astype(np.int64)


def _share(arms: FloatArray, of: FloatArray) -> FloatArray:
    squares = np.einsum("ij,ij->i", of, of)
    return np.divide(np.einsum("ij,ij->i", arms, of), squares, out=np.zeros(len(arms)), where=squares > 0.0)


def _scores(arms: FloatArray, normals: FloatArray) -> FloatArray:
    """Squares of distances, less a share of those straight above."""
    above = np.einsum("...j,...j->...", arms, normals)
    return np.asarray(np.einsum("...j,...j->...", arms, arms) - STRAIGHT * above * above)
