"""Kinks of a master's face: lines inside it across which its tangent plane jumps, or will jump once it deforms."""

from __future__ import annotations

import numpy as np

from isomortar import _bindings
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.model import constants
from isomortar.model.numbering import patch_arrays
from isomortar.model.sheet import Sheet


def has_kinks(sheet: Sheet) -> bool:
    """Whether the face of a sheet has kinks between its edges, or where it meets itself.

    Elements of Lagrange's or of order 1, whatever the order of the row at the face, are the mesh of something else, and every line between
    them becomes a kink as they deform. A C0 line of a higher order, or of a rigid body, is one where the tangent planes of its sides differ
    as they are given: arcs that meet smoothly have none.
    """
    below = [sheet.bodies[0].orders["uvw".index(letter)] for letter in sheet.letters]
    if not sheet.rigid and any(d.kinks and (d.family == "L" or order == 1) for d, order in zip(sheet.directions, below, strict=True)):
        return True
    return any(_turn(sheet.patch, sheet.face, axis, closed) > constants.KINK_ANGLE for axis, closed in enumerate(sheet.closed))


def _turn(patch: Patch, face: str, axis: int, closed: bool) -> float:
    """Largest angle, for small ones, between the normals of both sides of C0 lines across a direction of a face."""
    directions = patch.face_directions(face)
    sides = _sides(directions[axis], closed)
    places = directions[1 - axis].greville
    turns = [np.linalg.norm(np.subtract(*(_normals(patch, face, axis, at, places) for at in side)), axis=1).max() for side in sides]
    return float(max(turns, default=0.0))


def _sides(direction: Direction, closed: bool) -> list[tuple[float, float]]:
    """Places on either side of each C0 line across a direction, the seam of a closed one among them (theory 2.9)."""
    lines = direction.boundaries
    beside = constants.BESIDE_A_LINE * np.diff(lines)
    inside = np.searchsorted(lines, direction.c0_lines)
    sides = [(float(lines[line] - beside[line - 1]), float(lines[line] + beside[line])) for line in inside]
    return [*sides, (float(lines[-1] - beside[-1]), float(lines[0] + beside[0]))] if closed else sides


def _normals(patch: Patch, face: str, axis: int, at: float, places: FloatArray) -> FloatArray:
    """Unit normals of a face where the coordinate `axis` is `at`, shape (places, 3)."""
    xi = np.empty((len(places), 2))
    xi[:, axis], xi[:, 1 - axis] = at, places
    arrays = patch_arrays(patch, np.arange(len(patch.weights), dtype=np.int32))
    nodes, functions = _bindings.surface_functions(arrays, "uvw".index(face[0]) + 1, int(face[1]), xi)
    points = patch.control_points[patch.face_points(face)][nodes]
    across = np.cross(*(np.einsum("qa,qak->qk", functions[:, derivative], points) for derivative in (1, 2)))
    length = np.linalg.norm(across, axis=1, keepdims=True)
    return np.divide(across, length, out=np.zeros_like(across), where=length > 0.0)
