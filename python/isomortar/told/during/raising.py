"""Bodies of a higher order, or of shorter elements, along some directions, of the same shape."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.elevation import elevated
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.geometry.refinement import homogeneous
from isomortar.geometry.splines import Spline
from isomortar.model.entities import Body


@frozen
class Finer:
    """How many orders more a body is of, and whether each of its elements is two."""

    orders: int
    halves: bool

    def blocks(self, body: Body, along: Sequence[int]) -> int:
        """Entries of the stiffness of a body, 3 x 3 each, that is finer along some directions, but for its ends: it has no more."""
        points, couplings = 1, 1
        for axis, direction in enumerate(body.patch.directions):
            finer = axis in along
            points *= direction.count + finer * (self.orders + self.halves) * direction.elements
            couplings *= 2 * (direction.order + finer * self.orders) + 1
        return points * couplings


def raised_body(body: Body, along: Sequence[int], more: Finer) -> Body:
    """A body whose order along some directions is higher by so many, of the same shape."""
    for axis in along:
        points = tuple(count + more.orders * (k == axis) for k, count in enumerate(body.quadrature))
        body = replace(body, patch=raised(body.patch, axis, more)[1], quadrature=(points[0], points[1], points[2]))
    return body


def raised(patch: Patch, along: int, more: Finer) -> tuple[FloatArray, Patch]:
    """What control values along a direction become if that is finer, and the finer patch; where elements meet it is as smooth as it was."""
    bounds = patch.directions[along].boundaries
    return finer(patch, along, more.orders, 0.5 * (bounds[1:] + bounds[:-1]) if more.halves else bounds[:0])


def finer(patch: Patch, along: int, orders: int, cuts: FloatArray) -> tuple[FloatArray, Patch]:
    """The same of a direction that is of so many orders more, and whose elements are cut at some parameters."""
    direction = patch.directions[along]
    matrix: FloatArray = np.eye(direction.count)
    if direction.family == "L":
        nodes = direction.greville
        knots = np.repeat(direction.boundaries, direction.order)
        direction = Direction("N", direction.order, np.concatenate([knots[:1], knots, knots[-1:]]))
        matrix = np.asarray(np.linalg.inv(Spline([direction], matrix).evaluate(nodes[:, None])))
    for _ in range(orders):
        direction, matrix = elevated(direction, matrix, 0)
    if len(cuts):
        spline = Spline([direction], matrix)
        spline.insert(0, cuts)
        direction, matrix = Direction("N", direction.order, spline.knots[0]), spline.control_points
    grid = along_axis(matrix, homogeneous(patch), along)
    u, v, w = (direction if axis == along else own for axis, own in enumerate(patch.directions))
    flat = grid.reshape(-1, 4, order="F")
    return matrix, Patch((u, v, w), flat[:, :3] / flat[:, 3:], flat[:, 3])


def along_axis(matrix: FloatArray, grid: FloatArray, along: int) -> FloatArray:
    """A matrix times a grid of values along a direction."""
    return np.moveaxis(np.tensordot(matrix, grid, (1, along)), 0, along)
