"""Bodies whose functions are of a higher order in the row of control points at a face than below it (theory 2.12).

The patch of such a body is of the higher order throughout. Its control points at the face are unknowns; those below follow from fewer, of
the lower order: both kinds of functions have the same knot lines and are as smooth across them, so that one space is part of the other.
"""

from __future__ import annotations

from functools import reduce

import numpy as np
from scipy import sparse

from isomortar.errors import InputError
from isomortar.geometry.patch import Direction, FloatArray, IntArray
from isomortar.geometry.splines import Spline
from isomortar.model import constants
from isomortar.model.entities import Body


class Rows:
    """The control points of a body of two orders: those of the lower order below the face, and then those at the face.

    Attributes
    ----------
    reference : ndarray, shape (n, 3)
    into : csr_array, shape (control points of the patch, n)
        Positions of the control points of the patch from these.
    nearest : ndarray of int32, shape (control points of the patch,)
        Of each the one of these that is nearest to where it belongs; at the face it is the same.

    Raises
    ------
    InputError
        The body is not of that order below the face.
    """

    def __init__(self, body: Body) -> None:
        assert body.raised is not None
        patch, face = body.patch, body.raised.face
        across = "uvw".index(face[0])
        below = [lowered(direction, order) for direction, order in zip(patch.directions, body.orders, strict=True)]
        lines = [_line(low, high) for low, high in zip(below, patch.directions, strict=True)]
        shape = tuple(direction.count for direction in below)
        numbers = np.arange(np.prod(shape)).reshape(shape, order="F")
        kept, ends = np.setdiff1d(numbers, np.take(numbers, -int(face[1]), axis=across)), patch.face_points(face)
        homogeneous = np.column_stack([patch.control_points * patch.weights[:, None], patch.weights])
        own = np.concatenate([_below(homogeneous.reshape((*patch.shape, 4), order="F"), lines)[kept], homogeneous[ends]])
        at_face = sparse.csc_array((np.ones(len(ends)), (ends, np.arange(len(ends)))), shape=(len(homogeneous), len(ends)))
        into = sparse.hstack([sparse.csc_array(_product(lines))[:, kept], at_face])
        self.reference = np.ascontiguousarray(own[:, :3] / own[:, 3:])
        self.into = sparse.csr_array(sparse.diags_array(1.0 / patch.weights) @ into @ sparse.diags_array(own[:, 3]))
        near = [abs(high.greville[:, None] - low.greville).argmin(axis=1) for low, high in zip(below, patch.directions, strict=True)]
        place = np.searchsorted(kept, numbers[np.ix_(*near)].ravel(order="F"))
        place[ends] = len(kept) + np.arange(len(ends))
        self.nearest: IntArray = place.astype(np.int32)
        apart = float(np.abs(self.into @ self.reference - patch.control_points).max())
        if not apart <= constants.SAME_POINT * body.size or below[across].order != patch.directions[across].order:
            raise InputError(f"body {body.name!r}: control points are not those of functions of orders {list(body.orders)} below {face}")


def lowered(direction: Direction, order: int) -> Direction:
    """The direction of an order that a direction comes from by raising it: with as many fewer knots at each line; itself, of its own order.

    Raises
    ------
    InputError
        There is none.
    """
    if order == direction.order:
        return direction
    lines, counts = np.unique(direction.knots, return_counts=True)
    left = counts - (direction.order - order)
    if not 1 <= order < direction.order or np.any(left < 1):  # of Lagrange elements none is left
        raise InputError(
            f"no direction of order {order} comes to one of order {direction.order} ({direction.family}) with these knots by raising it"
        )
    return Direction("N", order, np.repeat(lines, left))


def _line(low: Direction, high: Direction) -> FloatArray:
    """T of (theory 2.12) along a direction, shape (control points, those of lower order)."""
    if low.order == high.order:
        return np.eye(high.count)
    there, here = (Spline([d], np.eye(d.count)).evaluate(high.greville[:, None]) for d in (high, low))
    values = np.linalg.solve(there, here)
    return np.where(np.abs(values) > constants.NO_ENTRY, values, 0.0)


def _below(grid: FloatArray, lines: list[FloatArray]) -> FloatArray:
    """Control values of lower order, shape (n, fields), that a grid of control values comes from, (n1, n2, n3, fields)."""
    for axis, line in enumerate(lines):
        grid = np.moveaxis(np.tensordot(np.linalg.pinv(line), grid, axes=(1, axis)), 0, axis)
    return grid.reshape(-1, grid.shape[-1], order="F")


def _product(lines: list[FloatArray]) -> sparse.csr_array:
    """Of all control points from those of the three directions, the first of which is fastest."""
    return sparse.csr_array(reduce(lambda inner, line: sparse.kron(line, inner), map(sparse.csr_array, lines)))
