"""Quadrature of contact surfaces against another library's Gauss points."""

from __future__ import annotations

import numpy as np
from numpy.polynomial.legendre import leggauss

from isomortar import _bindings
from isomortar.geometry.patch import Direction
from isomortar.geometry.primitives import box
from isomortar.geometry.quadrature import load_points
from isomortar.harness import Bound, case
from isomortar.model.numbering import patch_arrays

EPSILON = float(np.finfo(float).eps)


def bounds(count: int) -> dict[str, Bound]:
    """A weight is off by 2 / (1 - z^2) times the rounding of its point z in [-1, 1], in each of the rules."""
    sensitivity = 2 / (1 - leggauss(count + 1)[0][-1] ** 2)
    return {
        "points": Bound(at_most=8 * EPSILON, reason="round-off: both rules end their Newton iterations within a few units"),
        "weights": Bound(at_most=(8 + 2 * sensitivity) * EPSILON, reason="round-off: of the points, magnified near the ends"),
    }


@case(
    claim="Points and weights of a contact surface are those of the Gauss-Legendre rule, the first coordinate running fastest.",
    tier="gate",
    grid={"count": [1, 2, 3, 4, 5, 6, 8, 11, 16]},
    bounds=bounds,
)
def gauss_points(count: int) -> dict[str, float]:
    """Largest error of the points on a unit square of one element, and of the weights, relative; one more point across."""
    patch = box((0, 0, 0), (1, 1, 1))
    arrays = patch_arrays(patch, np.arange(len(patch.weights), dtype=np.int32))
    nodes, values, _, area = _bindings.slave_tables(arrays, 3, 1, (count, count + 1), patch.control_points)
    corners = patch.control_points[patch.face_points("w1")][nodes[0], :2]
    (x, across), (y, along) = (leggauss(n) for n in (count, count + 1))
    points = np.stack(np.meshgrid((1 + x) / 2, (1 + y) / 2), axis=-1).reshape(-1, 2)
    weights = np.outer(along, across).ravel() / 4
    return {
        "points": float(np.abs(values @ corners - points).max()),
        "weights": float(np.abs(area / weights - 1).max()),
    }


@case(
    claim="A loaded face has one Gauss point more by direction than what is polynomial of a pressure's forces needs, of any order.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "theory: a function times the product of two tangents is of order 3 p - 1")},
)
def points_of_loads() -> dict[str, float]:
    """Orders for which the rule has another number of points."""
    wrong = 0
    for order in range(1, 6):
        direction = Direction("N", order, np.repeat([0.0, 1.0], order + 1))
        exact = next(points for points in range(1, 20) if 2 * points - 1 >= 3 * order - 1)
        wrong += load_points(direction) != exact + 1
    return {"wrong": float(wrong)}
