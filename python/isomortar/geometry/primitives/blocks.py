"""Blocks: box, bowl, cap and wedge, of one element each."""

from __future__ import annotations

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.patch import Direction, FloatArray, Patch

Vector = tuple[float, float, float]

#: Half width of a cap over its radius with which its corners are on the sphere's equator.
WIDEST_CAP = 2.0 * np.sqrt(2.0) / 3.0


def box(lower: Vector, upper: Vector) -> Patch:
    """Axis-parallel box as one trilinear element; u, v, w run along x, y, z.

    Parameters
    ----------
    lower, upper : three floats
        Opposite corners.

    Raises
    ------
    InputError
        `upper` is not above `lower` in each coordinate.
    """
    if not all(low < high for low, high in zip(lower, upper, strict=True)):
        message = f"is {list(upper)}; each coordinate must be larger than that of lower = {list(lower)}"
        sizes, last_bit = np.subtract(upper, lower), np.spacing(np.abs([lower, upper]).max())
        if 0.0 < sizes.max() <= 4.0 * last_bit:
            message += "; so far from the origin coordinates hold no smaller differences"
        raise InputError(message, "upper")
    z, y, x = np.meshgrid(*((low, high) for low, high in zip(lower[::-1], upper[::-1], strict=True)), indexing="ij")
    return _patch((_bezier(1), _bezier(1), _bezier(1)), x, y, z)


def bowl(centre: tuple[float, float], half_width: float, bottom: float, rise: float, top: float) -> Patch:
    """Block with a flat top and a paraboloid below; u, v, w run along x, y, z. One bi-quadratic by linear element (theory 2.10).

    The underside is ``z = bottom + rise ((x - x0)^2 + (y - y0)^2) / half_width^2`` over a square: its
    mid-edges are raised by `rise`, its corners by twice that.

    Parameters
    ----------
    centre : two floats
        Middle (x0, y0) of the square.
    half_width, bottom, rise, top : float
        Lengths; `bottom` and `top` are heights z.

    Raises
    ------
    InputError
        `half_width` is not positive, or `top` is not above the corners of the underside.
    """
    if not half_width > 0:
        raise InputError(f"is {half_width:g}; must be positive", "half_width")
    highest = bottom + max(0.0, 2.0 * rise)
    if not top > highest:
        raise InputError(f"is {top:g}; must be above the highest point of the underside, {highest:g}", "top")
    along = np.array([-half_width, 0.0, half_width])
    square = np.array([1.0, -1.0, 1.0])  # Bezier coefficients of s^2 over -1 <= s <= 1
    underside = bottom + rise * (square[:, None] + square)
    z = np.stack([underside, np.full((3, 3), top)])
    x = np.broadcast_to(centre[0] + along, z.shape)
    y = np.broadcast_to(centre[1] + along[:, None], z.shape)
    return _patch((_bezier(2), _bezier(2), _bezier(1)), x, y, z)


def cap(centre: tuple[float, float], radius: float, half_width: float, bottom: float, top: float) -> Patch:
    """Block with a flat top and a part of a sphere below; u, v, w run along x, y, z. One bi-quadratic by linear element (theory 2.15).

    The underside is the stereographic image of a square round the lowest point: nowhere singular, its sides arcs. Columns are vertical.

    Parameters
    ----------
    centre : two floats
        Where (x0, y0) it is lowest.
    radius, half_width, bottom, top : float
        Of the sphere; from the middle to the middle of a side, in the plane; heights z of the lowest point and the top.

    Raises
    ------
    InputError
        Lengths that are not positive, a width with corners beyond the sphere's equator, or a top below the corners.
    """
    if not radius > 0:
        raise InputError(f"is {radius:g}; must be positive", "radius")
    if not 0 < half_width < WIDEST_CAP * radius:
        raise InputError(f"is {half_width:g}; allowed: above 0, below {WIDEST_CAP:.3f} radius = {WIDEST_CAP * radius:g}", "half_width")
    slope = half_width / radius
    end = 2.0 * half_width / (1.0 + np.sqrt(1.0 - slope**2))  # of the square in the plane that is projected from the sphere's top
    share = (0.5 * end / radius) ** 2
    highest = bottom + 4.0 * radius * share / (1.0 + 2.0 * share)
    if not top > highest:
        raise InputError(f"is {top:g}; must be above the corners of the underside, {highest:g}", "top")
    square = np.array([1.0, -1.0, 1.0])  # Bezier coefficients of s^2 over -1 <= s <= 1
    rising = share * (square[:, None] + square)
    weights, along = 1.0 + rising, np.array([-end, 0.0, end])
    z = np.stack([bottom + 2.0 * radius * rising / weights, np.full((3, 3), top)])
    x = np.broadcast_to(centre[0] + along / weights, z.shape)
    y = np.broadcast_to(centre[1] + along[:, None] / weights, z.shape)
    return _patch((_bezier(2), _bezier(2), _bezier(1)), x, y, z, np.broadcast_to(weights, z.shape))


def wedge(bottom: tuple[float, float], top: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Patch:
    """Prism along y of a trapezium or a triangle; u, v, w run along x, y, z. One trilinear element.

    Parameters
    ----------
    bottom, top : two floats
        From where to where along x its lower and its upper side are; one of them may be an edge, both values the same.
    y, z : two floats
        From where to where it goes.

    Raises
    ------
    InputError
        Values in the wrong order, or two edges.
    """
    for name, (low, high) in (("bottom", bottom), ("top", top), ("y", y), ("z", z)):
        if not low <= high or (low == high and name in ("y", "z")):
            raise InputError(f"is {[low, high]}; the second must be larger than the first", name)
    if bottom[0] == bottom[1] and top[0] == top[1]:
        raise InputError(f"is {list(top)}, an edge, as bottom is; allowed: one of them an edge", "top")
    grid = np.broadcast_to(np.array([bottom, top])[:, None, :], (2, 2, 2))
    heights, lengths = np.broadcast_to(np.array(z)[:, None, None], (2, 2, 2)), np.broadcast_to(np.array(y)[:, None], (2, 2, 2))
    return _patch((_bezier(1), _bezier(1), _bezier(1)), grid, lengths, heights)


def _bezier(order: int) -> Direction:
    """A direction of a single element over 0 <= u <= 1."""
    return Direction("N", order, np.repeat([0.0, 1.0], order + 1))


def _patch(
    directions: tuple[Direction, Direction, Direction], x: FloatArray, y: FloatArray, z: FloatArray, weights: FloatArray | None = None
) -> Patch:
    """Patch from coordinates indexed [w, v, u]."""
    points = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    return Patch(directions, points, np.ones(len(points)) if weights is None else weights.ravel())
