"""Global numbers of control points: bodies one after the other, the repeated row of a closed ring counted once."""

from __future__ import annotations

import numpy as np

from isomortar._bindings import PatchArrays
from isomortar.errors import InputError
from isomortar.geometry.patch import FloatArray, IntArray, Patch
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
            local, kept = _ring_numbers(body)
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
    layout = [_FAMILY_CODE[d.family] for d in patch.directions] + [d.order for d in patch.directions] + list(patch.shape)
    knots = np.concatenate([d.knots for d in patch.directions])
    return PatchArrays(np.asarray(layout, np.int32), knots, points, patch.weights)


def _ring_numbers(body: Body) -> tuple[IntArray, IntArray]:
    """For each control point of a body its number among those kept, and the kept ones."""
    total = len(body.patch.weights)
    twin = np.arange(total, dtype=np.int32)
    if body.closed is not None:
        first, last = body.patch.face_points(body.closed + "0"), body.patch.face_points(body.closed + "1")
        apart = np.linalg.norm(body.patch.control_points[first] - body.patch.control_points[last], axis=1).max()
        size = np.linalg.norm(np.ptp(body.patch.control_points, axis=0))
        if not apart <= 1e-9 * size or not np.allclose(body.patch.weights[first], body.patch.weights[last], rtol=1e-9):
            raise InputError(
                f"the first and last row of control points of a closed ring must coincide; they are {apart:.3g} apart",
                f"bodies.{body.name}.closed",
            )
        twin[last] = first
    kept = np.flatnonzero(twin == np.arange(total)).astype(np.int32)
    number = np.empty(total, dtype=np.int32)
    number[kept] = np.arange(len(kept), dtype=np.int32)
    return number[twin], kept
