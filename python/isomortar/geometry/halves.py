"""A patch that is its own mirror image, cut along the plane."""

from __future__ import annotations

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.geometry.refinement import homogeneous
from isomortar.geometry.splines import Spline

#: Apart by this share of a patch's size, or of a weight, or of a knot vector, points, weights and knots are mirror images.
_SAME = 1e-12


def upper_half(patch: Patch, axis: int, place: float) -> tuple[Patch, str]:
    """The half of a patch on the upper side of a plane of symmetry.

    Parameters
    ----------
    patch : Patch
    axis : int
        Coordinate across the plane.
    place : float
        Where the plane is.

    Returns
    -------
    Patch
        Of the same functions within its elements; its points on the plane are exactly there.
    str
        The face that is on the plane.

    Raises
    ------
    InputError
        The patch is not its own mirror image, or the plane goes through elements (`field`: ``mesh.elements``).
    """
    plane = f"the plane {'xyz'[axis]} = {place:g}"
    cut = next((k for k in range(3) if _is_mirrored(patch, k, axis, place)), None)
    if cut is None:
        raise InputError(
            f"is not its own mirror image in {plane}, by its control points, weights and knots; {_instead(patch, axis, place)}"
        )
    direction, letter = patch.directions[cut], "uvw"[cut]
    if direction.elements % 2:
        raise InputError(
            f"is {direction.elements} in direction {letter}, which {plane} halves; allowed there: even numbers", "mesh.elements"
        )
    grid = np.moveaxis(homogeneous(patch), cut, 0)
    upper = grid[(len(grid) + 1) // 2 :]
    rises = upper[..., axis].sum() / upper[..., 3].sum() > place
    half, kept = _half(direction, grid.reshape(len(grid), -1), bool(rises))
    kept = np.moveaxis(kept.reshape(-1, *grid.shape[1:]), 0, cut)
    weights = np.ones_like(kept[..., 3]) if np.all(patch.weights == 1.0) else kept[..., 3]
    points = kept[..., :3] / weights[..., None]
    face = f"{letter}{0 if rises else 1}"
    u, v, w = (half if k == cut else other for k, other in enumerate(patch.directions))
    part = Patch((u, v, w), points.reshape(-1, 3, order="F"), weights.ravel(order="F"))
    part.control_points[part.face_points(face), axis] = place
    if part.control_points[:, axis].min() < place - _SAME * _far(patch):
        raise InputError(f"goes back and forth through {plane}; allowed: bodies of which one half is above it")
    return part, face


def _instead(patch: Patch, axis: int, place: float) -> str:
    """What to do with a patch that is not its own mirror image."""
    letter, off = "xyz"[axis], patch.control_points[:, axis] - place
    if min(off.max(), -off.min()) <= _SAME * _far(patch):
        return (
            f"it is all on one side: symmetry takes whole bodies, and halves them. Give the whole one, or leave symmetry.{letter} out and "
            f'hold the face on the plane by a support, components = ["{letter}"]'
        )
    grid = patch.control_points.reshape(*patch.shape, 3, order="F")
    closed = any(np.abs(np.take(grid, 0, k) - np.take(grid, -1, k)).max() <= _SAME * _far(patch) for k in range(3))
    if closed:
        return (
            f"a closed body never is, as it begins on one side. Give half of it, leave symmetry.{letter} out, and hold its faces on the "
            f'plane by supports, components = ["{letter}"]'
        )
    return "allowed: bodies a direction of which goes from one side to the other, alike on both"


def _half(direction: Direction, control: FloatArray, upper: bool) -> tuple[Direction, FloatArray]:
    """The upper or lower half of a direction with the control values of that."""
    middle = direction.elements // 2
    if direction.family == "L":
        node, knots = direction.order * middle, direction.knots
        half = knots[middle:] if upper else knots[: middle + 1]
        return Direction("L", direction.order, half), control[node:] if upper else control[: node + 1]
    order, knot = direction.order, direction.boundaries[middle]
    spline = Spline([direction], control)
    lacking = order - np.count_nonzero(direction.knots == knot)
    if lacking:
        spline.insert(0, np.full(lacking, knot))
    knots, values = spline.knots[0], spline.control_points
    first = int(np.searchsorted(knots, knot))
    if upper:
        return Direction("N", order, np.append(knot, knots[first:])), values[first - 1 :]
    return Direction("N", order, np.append(knots[: first + order], knot)), values[:first]


def _is_mirrored(patch: Patch, direction: int, axis: int, place: float) -> bool:
    """Whether a patch that is run through the other way in one direction is its mirror image."""
    knots, other = patch.directions[direction].knots, patch.directions[direction].reversed().knots
    if np.abs(knots - other).max() > _SAME * np.ptp(knots):
        return False
    grid = patch.control_points.reshape(*patch.shape, 3, order="F")
    image = np.flip(grid, direction).copy()
    image[..., axis] = 2.0 * place - image[..., axis]
    weights = patch.weights.reshape(patch.shape, order="F")
    far = _far(patch)
    same = np.abs(weights - np.flip(weights, direction)) <= _SAME * weights
    return bool(np.abs(grid - image).max() <= _SAME * far and same.all())


def _far(patch: Patch) -> float:
    """What round-off of its points is a share of."""
    return max(float(np.ptp(patch.control_points, axis=0).max()), float(np.abs(patch.control_points).max()))
