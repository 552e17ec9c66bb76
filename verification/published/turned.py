"""Bodies of revolution from their profiles: a quarter, exact, whose elements are where a benchmark needs them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.geometry.primitives.arcs import QUARTER, arc
from isomortar.geometry.splines import Spline


def line(start: float, end: float) -> Direction:
    """A direction of one linear element, whose parameter is a length."""
    return Direction("N", 1, np.array([start, start, end, end]))


def turned(along: Direction, up: Direction, profile: FloatArray, spans: Sequence[Sequence[float]]) -> Patch:
    """A quarter turn about the z-axis; u, v, w run along the profile, round the axis and up.

    Parameters
    ----------
    along, up : Direction
    profile : ndarray, shape (control points along, control points up, 3)
        Radius, height and weight.
    spans : two sequences of float
        Where elements end along and up, besides where they do already.
    """
    radius, height, weight = np.moveaxis(profile, 2, 0)
    quarter = arc(0.0, QUARTER)
    points = np.stack(
        [
            np.einsum("ac,b->cba", radius, quarter.cosine),
            np.einsum("ac,b->cba", radius, quarter.sine),
            np.einsum("ac,b->cba", height, np.ones(3)),
        ],
        axis=-1,
    )
    weights = np.einsum("ac,b->cba", weight, quarter.weights)
    spline = Spline((along, quarter.direction, up), points.reshape(-1, 3), weights.ravel())
    for axis, knots in zip((0, 2), spans, strict=True):
        if len(knots):
            spline.insert(axis, np.array(knots, dtype=np.float64))
    u, w = (Direction("N", d.order, knots) for d, knots in zip((along, up), spline.knots[::2], strict=True))
    return Patch((u, quarter.direction, w), spline.control_points, spline.weights)


def disc(inner: float, radius: float, bottom: float, top: float, spans: Sequence[Sequence[float]]) -> Patch:
    """A quarter of a cylinder, hollow up to an inner radius; parameters along and up are lengths."""
    r, z = np.meshgrid([inner, radius], [bottom, top], indexing="ij")
    return turned(line(inner, radius), line(bottom, top), np.stack([r, z, np.ones((2, 2))], axis=-1), spans)


def punch(inner: float, flat: float, fillet: float, radius: float, height: float, spans: Sequence[Sequence[float]]) -> Patch:
    """A quarter of a round punch, hollow up to an inner radius, whose flat underside, at height zero, goes over into an arc up to its side.

    Along the underside the parameter is the radius of the flat part, then goes on to `radius` along the arc.

    Parameters
    ----------
    inner, flat, fillet : float
        Radii of the hole, of the flat part, and of the arc that begins there.
    radius, height : float
        Of the punch; the arc ends at its side.
    spans : two sequences of float
    """
    half = 0.5 * np.arcsin((radius - flat) / fillet)
    rise = fillet * (1.0 - np.cos(2.0 * half))
    below = [
        (inner, 0.0, 1.0),
        (0.5 * (inner + flat), 0.0, 1.0),
        (flat, 0.0, 1.0),
        (flat + fillet * np.tan(half), 0.0, np.cos(half)),
        (radius, rise, 1.0),
    ]
    above = [
        (inner, height, 1.0),
        (0.5 * (inner + flat), height, 1.0),
        (flat, height, 1.0),
        (0.5 * (flat + radius), height, 1.0),
        (radius, height, 1.0),
    ]
    along = Direction("N", 2, np.array([inner, inner, inner, flat, flat, radius, radius, radius]))
    return turned(along, line(0.0, height), np.stack([np.array(below), np.array(above)], axis=1), spans)
