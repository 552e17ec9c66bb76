"""Global numbers of control points: bodies one after the other, a closed ring's repeated row, a pole, and what is glued, counted once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar._bindings import BodyArrays, PatchArrays
from isomortar.errors import InputError
from isomortar.geometry.patch import FloatArray, IntArray, Patch
from isomortar.model import constants
from isomortar.model.entities import Body, Face, Problem
from isomortar.model.glue import pieces, shared_points
from isomortar.model.raised import Rows

_FAMILY_CODE = {"N": 1, "L": 2}


class Numbering:
    """Control points of a problem.

    Attributes
    ----------
    count : int
        Number of global control points; unknowns are three times as many.
    pieces : tuple of tuples of Body
        Bodies with all that is glued to them: their numbers follow each other.
    starts : ndarray of int32, shape (pieces,)
        The first control point of each piece.
    rows : dict of str to Rows
        Of bodies of two orders, whose patches have other control points than there are.
    own : dict of str to ndarray of int32
        For each body the global numbers of its control points.
    points : dict of str to ndarray of int32
        For each body the global number of each control point of its patch; with two orders, below the raised face, of the nearest one.
    reference : ndarray, shape (count, 3)
        Reference positions.
    size : float
        Length of the diagonal of the box around all bodies.

    Raises
    ------
    InputError
        The ends of a closed ring do not meet; faces that are to be glued do not conform.
    """

    def __init__(self, problem: Problem) -> None:
        self.pieces = pieces(problem)
        bodies = [body for piece in self.pieces for body in piece]
        self.rows = {body.name: Rows(body) for body in bodies if body.raised}
        references = [self.rows[b.name].reference if b.raised else b.patch.control_points for b in bodies]
        counts = [len(points) for points in references]
        offsets = dict(zip((b.name for b in bodies), np.cumsum([0, *counts]).tolist(), strict=False))
        first = _same_points(problem, bodies, counts, offsets)
        kept = first == np.arange(len(first))
        number = np.cumsum(kept, dtype=np.int32) - 1
        places = {b.name: slice(offsets[b.name], offsets[b.name] + count) for b, count in zip(bodies, counts, strict=True)}
        self.own: dict[str, IntArray] = {b.name: number[first[places[b.name]]].astype(np.int32) for b in problem.bodies}
        self.points = {name: own[self.rows[name].nearest] if name in self.rows else own for name, own in self.own.items()}
        self.count = int(np.count_nonzero(kept))
        self.starts: IntArray = number[[offsets[piece[0].name] for piece in self.pieces]]
        self.reference: FloatArray = np.ascontiguousarray(np.concatenate(references)[kept])
        self.size = float(np.linalg.norm(np.ptp(self.reference, axis=0)))

    def piece_of(self, point: int) -> int:
        """Number of the piece that a global control point belongs to."""
        return int(np.searchsorted(self.starts, point, side="right")) - 1

    def piece_points(self, piece: int) -> slice:
        """The control points of a piece."""
        return slice(int(self.starts[piece]), int([*self.starts, self.count][piece + 1]))

    def body_of(self, point: int) -> str:
        """Name of a body of a global control point; with what it is glued to, the first one there."""
        return next(body.name for body in self.pieces[self.piece_of(point)] if point in self.points[body.name])

    def whole(self, body: Body) -> IntArray:
        """Global numbers of the control points of a body with all that is glued to it."""
        own = self.piece_points(self.piece_of(int(self.points[body.name][0])))
        return np.arange(own.start, own.stop, dtype=np.int32)

    def face_points(self, body: Body, face: str) -> IntArray:
        """Global numbers of the control points of a face, in the order of its net, shape (n2 * n1,)."""
        return self.points[body.name][body.patch.face_points(face)]

    def points_at(self, body: Body, place: Face) -> IntArray:
        """Global numbers of the control points of a face, an edge or a corner of a body, ascending, each once."""
        return np.unique(self.points[body.name][body.patch.common_points(place.meeting)])

    def of_patch(self, body: str, field: FloatArray) -> FloatArray:
        """A field at the control points of a body's patch, from all control points, shape (control points of the patch, ...)."""
        if body in self.rows:
            return np.ascontiguousarray(self.rows[body].into @ field[self.own[body]])
        return field[self.points[body]]

    def deformed(self, positions: FloatArray) -> list[Body]:
        """The bodies with positions of all control points as those of their patches."""
        bodies = [body for piece in self.pieces for body in piece]
        return [replace(b, patch=replace(b.patch, control_points=self.of_patch(b.name, positions))) for b in bodies]

    def add_of_patch(self, body: str, forces: FloatArray, total: FloatArray) -> None:
        """Add forces on the control points of a body's patch to those on all control points, shape (count, 3)."""
        own = self.rows[body].into.T @ forces if body in self.rows else forces
        np.add.at(total, self.own[body], own)

    def patch_arrays(self, body: Body) -> PatchArrays:
        """The body's patch as the kernel reads it."""
        return patch_arrays(body.patch, self.points[body.name])

    def body_arrays(self, body: Body, often: bool = False) -> BodyArrays:
        """The body as the kernel reads it."""
        return BodyArrays(self.patch_arrays(body), body.quadrature, self.reference, often)


def body_arrays(body: Body, often: bool = False) -> BodyArrays:
    """A body alone as the kernel reads it: its control points are those of its patch."""
    points = np.arange(len(body.patch.weights), dtype=np.int32)
    return BodyArrays(patch_arrays(body.patch, points), body.quadrature, body.patch.control_points, often)


def patch_arrays(patch: Patch, points: IntArray) -> PatchArrays:
    """A patch with global control point numbers, flat."""
    families = np.array([_FAMILY_CODE[d.family] for d in patch.directions], dtype=np.int32)
    orders = np.array([d.order for d in patch.directions], dtype=np.int32)
    knots = np.concatenate([d.knots for d in patch.directions])
    return PatchArrays(families, orders, np.asarray(patch.shape, dtype=np.int32), knots, points, patch.weights)


def same_points(patch: Patch, closed: str | None) -> IntArray:
    """For each control point of a patch the first one that is the same: across the seams of a ring, and on a line that is one point.

    Such a line is on the body's faces, as round the pole of a sphere: its points are one, or the body would open there.
    """
    links = [np.stack([patch.face_points(letter + end) for end in "01"]) for letter in closed or ""]
    size = np.linalg.norm(np.ptp(patch.control_points, axis=0))
    numbers = np.arange(len(patch.weights), dtype=np.int32).reshape(patch.shape[::-1])
    for axis in range(3):
        lines = np.moveaxis(numbers, axis, 0).reshape(numbers.shape[axis], -1)
        of_no_length = np.linalg.norm(np.ptp(patch.control_points[lines], axis=0), axis=1) <= constants.SAME_POINT * size
        first, others = lines[0, of_no_length], lines[1:, of_no_length]
        links.append(np.stack([np.broadcast_to(first, others.shape).ravel(), others.ravel()]))
    return _linked(numbers.size, links)


def _linked(count: int, links: list[IntArray]) -> IntArray:
    """For each of some points the first one that links, pairs of shape (2, n), lead to from it."""
    first = np.arange(count, dtype=np.int32)
    one, other = np.concatenate(links, axis=1)
    while np.any(first[one] != first[other]):  # what is linked to the same has the same first one: as often as links follow each other
        np.minimum.at(first, one, first[other])
        np.minimum.at(first, other, first[one])
    return first


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
    for axis in body.closed or "":
        apart = ends_apart(body.patch, axis)
        first, last = (body.patch.weights[body.patch.face_points(axis + end)] for end in "01")
        if apart > constants.SAME_POINT * body.size or not np.allclose(first, last, rtol=constants.SAME_POINT, atol=0.0):
            raise InputError(
                f"is {body.closed!r}, but the first and last control points along {axis} differ (by {apart:g}, or in their weights)",
                f"bodies.{body.name}.closed",
            )


def check_raised(body: Body) -> None:
    """Refuse what a body of two orders can not be.

    Raises
    ------
    InputError
        It is closed or rigid, or a line of its control points is one point.
    """
    words = "closed" if body.closed else "rigid" if body.rigid else ""
    if not words and body.raised and len(np.unique(same_points(body.patch, None))) < len(body.patch.weights):
        words = "one with a pole"
    if body.raised and words:
        raise InputError(
            f"is given, and the body is {words}; remove it, or take that order for the whole", f"bodies.{body.name}.mesh.contact_order"
        )


def _same_points(problem: Problem, bodies: list[Body], counts: list[int], offsets: dict[str, int]) -> IntArray:
    """For each control point of all bodies, one body after the other, the first one that is the same."""
    for body in bodies:
        check_closed(body)
        check_raised(body)
    of_bodies = [np.arange(n) if body.raised else same_points(body.patch, body.closed) for body, n in zip(bodies, counts, strict=True)]
    first = np.concatenate([points + offsets[body.name] for body, points in zip(bodies, of_bodies, strict=True)])
    links = [np.stack([np.arange(len(first), dtype=np.int32), first.astype(np.int32)])]
    for number, joint in enumerate(problem.glue):
        shared = zip(shared_points(problem, number), joint, strict=True)
        links.append(np.stack([points + offsets[face.body] for points, face in shared]))
    return _linked(len(first), links)
