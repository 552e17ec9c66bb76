"""Bodies turned about an axis: ring, sphere and torus, whole or a part of each, solid or hollow.

u runs round the axis by the right-hand rule, v from the inside to the outside, w downwards, against the axis. Angles are degrees, from the
coordinate that follows the axis in x, y, z, x; latitudes count from the plane across it.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.geometry.primitives.arcs import HALF, QUARTER, WHOLE, arc
from isomortar.geometry.primitives.blocks import Vector

Span = tuple[float, float]
Coordinate = Literal["x", "y", "z"]

_LINE = Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))


def ring(centre: Vector, inner: float, outer: float, width: float, angles: Span = (0.0, WHOLE), axis: Coordinate = "y") -> Patch:
    """Ring, pipe or cylinder: a rectangle turned about an axis (theory 2.14).

    Parameters
    ----------
    centre : three floats
    inner, outer : float
        Radii; an inner one of 0 makes it solid: face v0 is its axis then.
    width : float
        Extent along the axis, half of it on either side of the centre.
    angles : two floats
        From where to where it goes round.
    axis : {"x", "y", "z"}

    Raises
    ------
    InputError
        Not ``0 <= inner < outer``, `width` not positive, or no such arc.
    """
    _check_radii(inner, outer)
    if not width > 0:
        raise InputError(f"is {width:g}; must be positive", "width")
    radius = np.array([[inner, outer]] * 2)
    height = np.array([[0.5 * width] * 2, [-0.5 * width] * 2])
    return _turned(centre, _LINE, radius, height, np.ones(2), angles, axis)


def sphere(
    centre: Vector,
    inner: float,
    outer: float,
    latitudes: Span = (-QUARTER, QUARTER),
    angles: Span = (0.0, WHOLE),
    axis: Coordinate = "z",
) -> Patch:
    """Ball or spherical shell, or the part of one between latitudes and angles: hemisphere, octant (theory 2.14).

    On the axis, at a latitude of 90 or -90, faces v0 and v1 have a pole, an edge that is one point.

    Parameters
    ----------
    centre : three floats
    inner, outer : float
        Radii; an inner one of 0 makes it solid: face v0 is its centre then.
    latitudes : two floats
        Of its lower and upper rim, -90 to 90; w runs from the upper to the lower one.
    angles : two floats
        From where to where it goes round.
    axis : {"x", "y", "z"}

    Raises
    ------
    InputError
        Not ``0 <= inner < outer``, or no such arcs.
    """
    _check_radii(inner, outer)
    if not -QUARTER <= latitudes[0] < latitudes[1] <= QUARTER:
        raise InputError(f"are {list(latitudes)}; allowed: -90 to 90, the second above the first", "latitudes")
    return _of_round_section(centre, 0.0, inner, outer, latitudes, angles, axis)


def torus(
    centre: Vector,
    radius: float,
    inner: float,
    outer: float,
    latitudes: Span = (-HALF, HALF),
    angles: Span = (0.0, WHOLE),
    axis: Coordinate = "z",
) -> Patch:
    """Torus, solid or a tube, or a part of one, such as a rounded edge (theory 2.14).

    Parameters
    ----------
    centre : three floats
    radius : float
        Of the circle that the middle of its section goes along.
    inner, outer : float
        Radii of the section; an inner one of 0 makes it solid: face v0 is that circle then.
    latitudes : two floats
        Angles of the section, -180 to 180: 0 farthest from the axis, 90 on top; w runs from the second to the first.
    angles : two floats
        From where to where it goes round.
    axis : {"x", "y", "z"}

    Raises
    ------
    InputError
        Not ``0 <= inner < outer``, no such arcs, or a section that reaches the axis.
    """
    _check_radii(inner, outer)
    if not -HALF <= latitudes[0] < latitudes[1] <= HALF:
        raise InputError(f"are {list(latitudes)}; allowed: -180 to 180, the second above the first", "latitudes")
    inmost = radius + outer * float(np.cos(np.radians(np.abs(latitudes).max())))
    if not (radius > 0 and inmost > 0):
        raise InputError(f"is {radius:g}, too small for a section of {outer:g} that is to stay off the axis", "radius")
    return _of_round_section(centre, radius, inner, outer, latitudes, angles, axis)


def _check_radii(inner: float, outer: float) -> None:
    if not inner >= 0:
        raise InputError(f"is {inner:g}; must not be negative", "inner")
    if not outer > inner:
        raise InputError(f"is {outer:g}; must be larger than inner = {inner:g}", "outer")


def _of_round_section(centre: Vector, major: float, inner: float, outer: float, latitudes: Span, angles: Span, axis: Coordinate) -> Patch:
    """Body whose section is a part of a ring, its middle as far from the axis as `major` (theory 2.14)."""
    down = arc(QUARTER - latitudes[1], QUARTER - latitudes[0])  # from the top
    radii = np.array([inner, outer])
    return _turned(centre, down.direction, major + np.outer(down.sine, radii), np.outer(down.cosine, radii), down.weights, angles, axis)


def _turned(
    centre: Vector, along: Direction, radius: FloatArray, height: FloatArray, weights: FloatArray, angles: Span, axis: Coordinate
) -> Patch:
    """A section turned about an axis (theory 2.14).

    `radius` and `height`, shape (w, v), are distances of its control points from the axis and along it; `weights` those of w.
    """
    turn = arc(*angles)
    up = "xyz".index(axis)
    points = np.empty((*radius.shape, len(turn.weights), 3))
    points[..., (up + 1) % 3] = radius[..., None] * turn.cosine
    points[..., (up + 2) % 3] = radius[..., None] * turn.sine
    points[..., up] = height[..., None]
    both = weights[:, None, None] * turn.weights
    return Patch((turn.direction, _LINE, along), (centre + points).reshape(-1, 3), np.broadcast_to(both, points.shape[:-1]).ravel())
