"""Gauss points that see how one rational function takes over from the next, near a knot, however much their weights differ."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.patch import Direction, FloatArray, IntArray

#: Weights of conic sections, arcs of up to 120 degrees, are within this ratio of each other; default points are made for them.
CONIC = 2.0
#: What each layer is of the one beside it, and the most layers towards an end of an element: nearer to it are no digits.
LAYER, MOST_LAYERS = 0.25, 20
#: Gauss points of a layer above the order: as many as doubling Gauss points is judged by, and what does for layers that are many.
IN_A_LAYER, IN_ONE_OF_MANY = 5, 2
#: Most points in layers, some seconds of work.
MOST_IN_LAYERS = 4_000_000


@frozen
class LinePoints:
    """Quadrature points of a direction, in the order of its elements, and their weights."""

    places: FloatArray
    weights: FloatArray

    @classmethod
    def of(cls, ends: FloatArray, points: int) -> LinePoints:
        """Gauss points between ends that follow each other."""
        at, weights = np.polynomial.legendre.leggauss(points)
        size = np.diff(ends)[:, None]
        return cls((ends[:-1, None] + 0.5 * (1.0 + at) * size).ravel(), (0.5 * weights * size).ravel())


def unlike(directions: Sequence[Direction], weights: FloatArray) -> bool:
    """Whether weights differ along a direction, within some span, by more than those of arcs do."""
    grid = weights.reshape([direction.count for direction in directions], order="F")
    return any(np.any(_layers(direction, np.moveaxis(grid, axis, 0))) for axis, direction in enumerate(directions))


def in_layers(directions: Sequence[Direction], weights: FloatArray) -> list[LinePoints]:
    """Gauss points in layers of each span that grow from its ends, as many as weights differ that count there (theory 9.2)."""
    grid = weights.reshape([direction.count for direction in directions], order="F")
    counts = [_layers(direction, np.moveaxis(grid, axis, 0)) for axis, direction in enumerate(directions)]
    for most, more in ((MOST_LAYERS, IN_A_LAYER), *((most, IN_ONE_OF_MANY) for most in range(MOST_LAYERS, 0, -1))):
        lines = [
            LinePoints.of(_ends(direction, np.minimum(own, most)), direction.order + (more if np.any(own) else IN_ONE_OF_MANY))
            for direction, own in zip(directions, counts, strict=True)
        ]
        if np.prod([len(line.places) for line in lines]) <= MOST_IN_LAYERS:
            break
    return lines


def _layers(direction: Direction, weights: FloatArray) -> IntArray:
    """Numbers of layers towards the ends of a direction's spans, by the weights along the first axis that count there.

    None where these differ no more than those of arcs.
    """
    rows = direction.first_points[:, None] + np.arange(direction.order + 1)
    own = weights.reshape(len(weights), -1)[rows]
    contrast = (own.max(axis=1) / own.min(axis=1)).max(axis=1)
    return np.where(contrast > CONIC, np.ceil(-np.log(contrast) / np.log(LAYER)), 0).astype(np.int32)


def _ends(direction: Direction, layers: IntArray) -> FloatArray:
    """Ends of the layers of a direction: the middle of each span, the parts of its halves that follow, and its ends."""
    found = [direction.boundaries]
    for low, high, count in zip(direction.boundaries[:-1], direction.boundaries[1:], layers, strict=True):
        away = 0.5 * (high - low) * LAYER ** np.arange(max(count, 1))
        found += [low + away, high - away[1:]]
    return np.sort(np.concatenate(found))
