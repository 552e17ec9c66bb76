"""From a coarse exact geometry to a discretisation: k-refinement, and Lagrange elements on the same geometry."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.elevation import elevated
from isomortar.geometry.patch import MAX_ORDER, Direction, Family, FloatArray, Patch
from isomortar.geometry.splines import Spline


def mesh(
    patch: Patch,
    families: Sequence[Family],
    orders: Sequence[int],
    elements: Sequence[int],
    grading: Sequence[float] = (1.0, 1.0, 1.0),
) -> Patch:
    """Discretise a NURBS geometry.

    An ``N`` direction is k-refined: order elevation first, knot insertion second; the geometry does not change.
    An ``L`` direction interpolates: its nodes lie on the geometry at equally spaced parameters of each element.
    With ``L`` in all directions every weight is 1 and the nodes are points of the body.

    Parameters
    ----------
    patch : Patch
        NURBS in all three directions.
    families : three of {"N", "L"}
    orders : three ints
        Not below the geometry's own in an ``N`` direction.
    elements : three ints
        Elements by direction. Each knot span of the geometry is cut into as many, so that they must be a
        multiple of its number of spans.
    grading : three floats
        By direction the length of the last element over that of the first, in the parameter (theory 2.16).

    Returns
    -------
    Patch

    Raises
    ------
    InputError
        Order or number of elements that the geometry cannot have (`field`: ``order``, ``elements``, ``family``).
    """
    _check(patch, families, orders, elements)
    refined = _k_refined(
        patch,
        [p if family == "N" else own.order for family, p, own in zip(families, orders, patch.directions, strict=True)],
        [
            cut(d, n, g) if family == "N" else d.boundaries
            for family, d, n, g in zip(families, patch.directions, elements, grading, strict=True)
        ],
    )
    directions = list(refined.directions)
    grid = homogeneous(refined)
    for axis in (a for a in range(3) if families[a] == "L"):
        source = directions[axis]
        directions[axis] = Direction("L", orders[axis], cut(source, elements[axis], grading[axis]))
        grid = _evaluated(source, grid, axis, directions[axis].greville)
    weights = grid[..., 3]
    points = grid[..., :3] / weights[..., None]
    if "L" in families:
        # At a Lagrange node only the ratios of the weights along the NURBS directions mean anything.
        first = tuple(slice(None) if family == "L" else slice(0, 1) for family in families)
        weights = weights / weights[first]
    return Patch((directions[0], directions[1], directions[2]), points.reshape(-1, 3, order="F"), weights.ravel(order="F"))


def raised_along(patch: Patch, face: str, order: int) -> Patch:
    """A patch of a higher order along a face, no smoother across its knot lines than it is.

    Raises
    ------
    InputError
        It is not NURBS along that face, or of a higher order there.
    """
    along = [direction for axis, direction in zip("uvw", patch.directions, strict=True) if axis != face[0]]
    lowest = min(direction.order for direction in along) + 1
    if any(direction.family == "L" for direction in along) or not lowest <= order <= MAX_ORDER["N"]:
        families = "" if all(direction.family == "N" for direction in along) else ", of NURBS"
        raise InputError(f"is {order} along {face}; allowed there{families}: {lowest} to {MAX_ORDER['N']}")
    orders = [d.order if axis == face[0] else max(order, d.order) for axis, d in zip("uvw", patch.directions, strict=True)]
    return _k_refined(patch, orders, [direction.boundaries for direction in patch.directions])


def cut(direction: Direction, elements: int, grading: float) -> FloatArray:
    """Element boundaries of a direction cut into elements, as many in each knot span, shape (elements + 1,) (theory 2.16)."""
    parts = elements // direction.elements
    if grading == 1.0:
        return direction.subdivided(parts)
    lengths = grading ** (np.arange(elements) / max(1, elements - 1)).reshape(-1, parts)
    ends = np.cumsum(lengths, axis=1)
    shares = (ends - lengths) / ends[:, -1:]
    inside = direction.boundaries[:-1, None] + np.diff(direction.boundaries)[:, None] * shares
    return np.append(inside, direction.boundaries[-1])


def _evaluated(direction: Direction, grid: FloatArray, axis: int, parameters: FloatArray) -> FloatArray:
    """Values of B-splines along an axis of a grid of control values: parameters take the place of control points."""
    control = np.moveaxis(grid, axis, 0)
    line = Spline([direction], control.reshape(len(control), -1))
    return np.moveaxis(line.evaluate(parameters[:, None]).reshape(len(parameters), *control.shape[1:]), 0, axis)


def surface_samples(patch: Patch, face: str) -> FloatArray:
    """Points on a face: its nodes as Lagrange elements of order 4, or its own ones, shape (n, 3)."""
    if all(d.family == "N" for d in patch.directions):
        patch = mesh(patch, ("L", "L", "L"), (4,) * 3, [d.elements for d in patch.directions])
    return patch.control_points[patch.face_points(face)]


def _check(patch: Patch, families: Sequence[Family], orders: Sequence[int], elements: Sequence[int]) -> None:
    if any(d.family == "L" for d in patch.directions):
        raise InputError("a patch with Lagrange directions is a mesh already; only its quadrature can be chosen", "family")
    for name, family, order, count, own in zip("uvw", families, orders, elements, patch.directions, strict=True):
        lowest = own.order if family == "N" else 1
        if not lowest <= order <= MAX_ORDER[family]:
            raise InputError(f"is {order} in direction {name}; allowed for {family} there: {lowest} to {MAX_ORDER[family]}", "order")
        if count < 1 or count % own.elements:
            raise InputError(f"is {count} in direction {name}; allowed there: multiples of {own.elements}", "elements")


def _k_refined(patch: Patch, orders: Sequence[int], boundaries: Sequence[FloatArray]) -> Patch:
    """Order elevation, then knot insertion at element boundaries; a patch that needs neither stays as it is."""
    fresh = [np.setdiff1d(wanted, d.boundaries) for d, wanted in zip(patch.directions, boundaries, strict=True)]
    plain = bool(np.all(patch.weights == 1.0))  # plain B-splines keep their weights of exactly 1
    for axis, order in enumerate(orders):
        for _ in range(order - patch.directions[axis].order):
            patch = _elevated(patch, axis, plain)
    if not any(map(len, fresh)):
        return patch
    spline = Spline(patch.directions, patch.control_points, None if plain else patch.weights)
    for axis, knots in enumerate(fresh):
        if len(knots):
            spline.insert(axis, knots)
    u, v, w = (Direction("N", order, knots) for order, knots in zip(orders, spline.knots, strict=True))
    return Patch((u, v, w), spline.control_points, spline.weights)


def _elevated(patch: Patch, axis: int, plain: bool) -> Patch:
    """The patch of the next order along an axis."""
    raised, grid = elevated(patch.directions[axis], homogeneous(patch)[..., : 3 if plain else 4], axis)
    u, v, w = (raised if number == axis else own for number, own in enumerate(patch.directions))
    flat = grid.reshape(-1, grid.shape[-1], order="F")
    return Patch((u, v, w), flat if plain else flat[:, :3] / flat[:, 3:], np.ones(len(flat)) if plain else flat[:, 3])


def homogeneous(patch: Patch) -> FloatArray:
    """Weighted control points and weights, shape (n1, n2, n3, 4)."""
    weights = patch.weights[:, None]
    return np.hstack([patch.control_points * weights, weights]).reshape((*patch.shape, 4), order="F")
