"""Global numbers of control points: bodies one after the other, a closed ring's repeated row, and a pole, counted once."""

from __future__ import annotations

import numpy as np

from isomortar._bindings import PatchArrays
from isomortar.errors import InputError
from isomortar.geometry.patch import FloatArray, IntArray, Patch
from isomortar.model import constants
from isomortar.model.entities import Body, Problem

_FAMILY_CODE = {"N": 1, "L": 2}


class Numbering:
    """Control points of a problem.

    Attributes
    ----------
    count : int
        Number of global control points; unknowns are three times as many.
    points : dict of str to ndarray of int32
        For each body the global number of each control point of its patch.
    reference : ndarray, shape (count, 3)
        Reference positions.
    size : float
        Length of the diagonal of the box around all bodies.

    Raises
    ------
    InputError
        The ends of a closed ring do not meet.
    """

    def __init__(self, problem: Problem) -> None:
        self.points: dict[str, IntArray] = {}
        self.offsets: dict[str, int] = {}
        self.count = 0
        positions = []
        for body in problem.bodies:
            local, kept = _numbers(body)
            self.points[body.name] = (local + self.count).astype(np.int32)
            self.offsets[body.name] = self.count
            self.count += len(kept)
            positions.append(body.patch.control_points[kept])
        self.reference: FloatArray = np.ascontiguousarray(np.concatenate(positions))
        self.size = float(np.linalg.norm(np.ptp(self.reference, axis=0)))

    def body_of(self, point: int) -> str:
        """Name of the body of a global control point."""
        return [name for name, offset in self.offsets.items() if offset <= point][-1]

    def patch_arrays(self, body: Body) -> PatchArrays:
        """The body's patch as the kernel reads it."""
        return patch_arrays(body.patch, self.points[body.name])


def patch_arrays(patch: Patch, points: IntArray) -> PatchArrays:
    """A patch with global control point numbers, flat."""
    families = np.array([_FAMILY_CODE[d.family] for d in patch.directions], dtype=np.int32)
    orders = np.array([d.order for d in patch.directions], dtype=np.int32)
    knots = np.concatenate([d.knots for d in patch.directions])
    return PatchArrays(families, orders, np.asarray(patch.shape, dtype=np.int32), knots, points, patch.weights)


def same_points(patch: Patch, closed: str | None) -> IntArray:
    """For each control point of a patch the first one that is the same: across a ring's seam, and on a line that is one point.

    Such a line is on the body's faces, as round the pole of a sphere: its points are one, or the body would open there.
    """
    first = np.arange(len(patch.weights), dtype=np.int32)
    if closed is not None:
        first[patch.face_points(closed + "1")] = patch.face_points(closed + "0")
    size = np.linalg.norm(np.ptp(patch.control_points, axis=0))
    numbers = np.arange(len(first), dtype=np.int32).reshape(patch.shape[::-1])
    for axis in range(3):
        lines = np.moveaxis(numbers, axis, 0).reshape(numbers.shape[axis], -1)
        of_no_length = np.linalg.norm(np.ptp(patch.control_points[lines], axis=0), axis=1) <= constants.SAME_POINT * size
        first[lines[:, of_no_length]] = first[lines[0, of_no_length]]
    return first[first]


def ends_apart(patch: Patch, axis: str) -> float:
    """How far the control points at the two ends of a direction are from each other at most."""
    ends = [patch.control_points[patch.face_points(axis + end)] for end in "01"]
    return float(np.linalg.norm(ends[1] - ends[0], axis=1).max())


def check_closed(body: Body) -> None:
    """Refuse a ring that does not close.

    Raises
    ------
    InputError
        Its first and last control points, or their weights, differ.
    """
    if body.closed is None:
        return
    apart = ends_apart(body.patch, body.closed)
    first, last = (body.patch.weights[body.patch.face_points(body.closed + end)] for end in "01")
    if apart > constants.SAME_POINT * body.size or not np.allclose(first, last, rtol=constants.SAME_POINT):
        raise InputError(
            f"is {body.closed!r}, but the first and last control points along {body.closed} differ (by {apart:g}, or in their weights)",
            f"bodies.{body.name}.closed",
        )


def _numbers(body: Body) -> tuple[IntArray, IntArray]:
    """For each control point of a body its number among those kept, and the kept ones."""
    check_closed(body)
    first = same_points(body.patch, body.closed)
    kept = np.flatnonzero(first == np.arange(len(first))).astype(np.int32)
    number = np.empty(len(first), dtype=np.int32)
    number[kept] = np.arange(len(kept), dtype=np.int32)
    return number[first], kept
