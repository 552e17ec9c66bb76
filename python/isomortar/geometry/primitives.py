"""Exact coarse bodies: box, bowl and ring. `refinement.mesh` makes their discretisations."""

from __future__ import annotations

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.patch import Direction, FloatArray, Patch

Vector = tuple[float, float, float]


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


def ring(centre: Vector, inner: float, outer: float, width: float) -> Patch:
    """Ring about the y-axis: four exact quarter arcs whose joints are only continuous (theory 2.10).

    u runs round the ring from its highest point towards +x (knots 0 to 4, one unit an arc; the last row of
    control points repeats the first), v from the inner to the outer radius, w along -y.

    Parameters
    ----------
    centre : three floats
    inner, outer : float
        Radii.
    width : float
        Extent along y, half of it on either side of the centre.

    Raises
    ------
    InputError
        Not ``0 < inner < outer``, or `width` not positive.
    """
    if not inner > 0:
        raise InputError(f"is {inner:g}; must be positive", "inner")
    if not outer > inner:
        raise InputError(f"is {outer:g}; must be larger than inner = {inner:g}", "outer")
    if not width > 0:
        raise InputError(f"is {width:g}; must be positive", "width")
    arcs = Direction("N", 2, np.array([0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4], dtype=np.float64))
    sine = np.array([0, 1, 1, 1, 0, -1, -1, -1, 0])  # corners and mid-sides of a square round the unit circle
    cosine = np.array([1, 1, 0, -1, -1, -1, 0, 1, 1])
    radius = np.array([inner, outer])[:, None]
    shape = (2, 2, 9)
    x = np.broadcast_to(centre[0] + radius * sine, shape)
    y = np.broadcast_to(centre[1] + np.array([0.5, -0.5])[:, None, None] * width, shape)
    z = np.broadcast_to(centre[2] + radius * cosine, shape)
    weights = np.tile([1.0, np.sqrt(0.5)], 5)[:9]
    return _patch((arcs, _bezier(1), _bezier(1)), x, y, z, np.broadcast_to(weights, shape))


def _bezier(order: int) -> Direction:
    """A direction of a single element over 0 <= u <= 1."""
    return Direction("N", order, np.repeat([0.0, 1.0], order + 1))


def _patch(
    directions: tuple[Direction, Direction, Direction], x: FloatArray, y: FloatArray, z: FloatArray, weights: FloatArray | None = None
) -> Patch:
    """Patch from coordinates indexed [w, v, u]."""
    points = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    return Patch(directions, points, np.ones(len(points)) if weights is None else weights.ravel())
