"""Wavy strips with several feet of a point in one element: the nearest of them all, from no start and from any other of them."""

from __future__ import annotations

import numpy as np
from projection.closest_points import Surface

from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.harness import Bound, case

#: Heights of a strip's control points by order and elements: up to five feet of a point, three in an element.
HEIGHTS = {
    "5 in 1": (0.0, 4.0, -4.0, 4.0, -4.0, 0.0),
    "4 in 3": (0.6, -2.0, 2.5, -2.0, 2.5, -2.0, 0.6),
}
#: Length one, width; coordinates along the strip are none that are special.
WIDTH, LOW, HIGH = 1e-2, 5.0, 9.0
#: Places along a strip, and points beside it.
SAMPLES, POINTS = 1001, 400


def strip(waves: str, along: int) -> Surface:
    """The upper face of a strip along coordinate 0 or 1, one element wide; x is along it, z up."""
    heights, line = np.array(HEIGHTS[waves]), Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))
    order = int(waves[0])
    length = Direction("N", order, np.pad(np.linspace(LOW, HIGH, len(heights) - order + 1), order, mode="edge"))
    points = np.zeros((2, 2, len(heights), 3))
    points[..., 0] = (length.greville - LOW) / (HIGH - LOW)
    points[:, 1, :, 1] = WIDTH
    points[..., 2] = heights - np.array([1.0, 0.0])[:, None, None]
    if along == 0:
        return Surface(Patch((length, line, line), points.reshape(-1, 3), np.ones(points[..., 0].size)), "w1")
    across = points[:, ::-1].swapaxes(1, 2).reshape(-1, 3)
    return Surface(Patch((line, length, line), across, np.ones(len(across))), "w1")


def feet(face: Surface, along: int, targets: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Least distance of each target in the plane of the strip, and coordinates of one of the places that are nearest to it near there."""
    xi = np.full((SAMPLES, 2), 0.5)
    xi[:, along] = np.linspace(LOW, HIGH, SAMPLES)
    distance = np.linalg.norm(face.points(xi)[:, [0, 2]] - targets[:, None, [0, 2]], axis=2)
    inner, random = distance[:, 1:-1], np.random.default_rng(3)
    low = (inner < distance[:, :-2]) & (inner <= distance[:, 2:])
    return distance.min(axis=1), xi[1 + np.argmax(low * random.uniform(0.5, 1.0, low.shape), axis=1)]


@case(
    claim="Of several feet in one element the nearest is found, from none and from any other of them, whichever direction they lie along.",
    grid={"waves": list(HEIGHTS), "along": [0, 1]},
    bounds={
        "nearer": Bound(at_most=1e-13, reason="definition: no place of a fine grid is nearer; round-off of the distances"),
        "others": Bound(at_least=50.0, at_most=float(POINTS), reason="definition: so many starts are at other places than the nearest"),
    },
)
def nearest_of_an_element(waves: str, along: int) -> dict[str, float]:
    """Most that a place of the strip is nearer than a foot, from none and from a foot at random; how many of these are not the nearest."""
    face = strip(waves, along)
    targets = np.random.default_rng(2).uniform([-0.05, 0.0, -2.0], [1.05, WIDTH, 2.0], (POINTS, 3))
    least, starts = feet(face, along, targets)
    cold = face.project(targets)
    found = cold.found == 1  # from a start, what is deeper than the body is refused as a whole
    warm = face.project(targets[found], starts[found])
    ways = face.points(cold.xi) - targets, face.points(warm.xi) - targets[found]
    excess = [np.linalg.norm(way[:, [0, 2]], axis=1) - there for way, there in zip(ways, (least, least[found]), strict=True)]
    return {
        "nearer": float(np.maximum(0.0, np.concatenate(excess).max())),
        "others": float(np.sum(np.abs(starts[found] - warm.xi)[:, along] > 0.1)),
    }
