"""Arcs of a circle as exact rational functions of order 2."""

from __future__ import annotations

import numpy as np

from isomortar._frozen import frozen
from isomortar.errors import InputError
from isomortar.geometry.patch import Direction, FloatArray

#: Degrees of a quarter, a half and the whole of a circle.
QUARTER, HALF, WHOLE = 90.0, 180.0, 360.0


@frozen
class Arc:
    """An arc of the unit circle.

    Parameters
    ----------
    direction : Direction
        One unit of the parameter a part: one part up to a quarter of a circle, two up to half of it, else as many as quarters begin.
    cosine, sine, weights : ndarray, shape (count of the direction,)
        Control points and their weights.
    """

    direction: Direction
    cosine: FloatArray
    sine: FloatArray
    weights: FloatArray


def degrees(start: float, end: float) -> float:
    """From one angle to another one, in degrees: quarters of a circle exactly where only the last bits of the angles are in the way."""
    apart = end - start
    quarters = QUARTER * float(np.round(apart / QUARTER))
    return quarters if abs(apart - quarters) <= 2.0 * np.spacing(max(abs(start), abs(end))) else apart


def arc(start: float, end: float) -> Arc:
    """The arc between two angles in degrees, counted from the first coordinate towards the second (theory 2.13).

    Up to half of a circle its functions are smooth; joints of longer ones are only continuous.

    Raises
    ------
    InputError
        The end is not beyond the start, or by more than once round (`field`: ``angles``).
    """
    if not 0.0 < (angle := degrees(start, end)) <= WHOLE:
        raise InputError(f"are {[start, end]}; allowed: the second beyond the first, by up to 360 degrees", "angles")
    parts = int(np.ceil(angle / QUARTER))
    joints = np.array([_on_circle(start + angle * k / parts) for k in range(parts + 1)])
    flat, _ = _on_circle(angle / parts)
    middles = (joints[:-1] + joints[1:]) / (1.0 + flat)  # where tangents meet
    weight = np.sqrt(0.5 * (1.0 + flat))
    if parts == 2:
        points, weights = np.array([joints[0], *middles, joints[2]]), np.array([1.0, weight**2, weight**2, 1.0])
        return Arc(Direction("N", 2, np.array([0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0])), points[:, 0], points[:, 1], weights)
    points, weights = np.repeat(joints, 2, axis=0)[:-1], np.ones(2 * parts + 1)
    points[1::2], weights[1::2] = middles, weight
    knots = np.repeat(np.arange(parts + 1.0), 2)
    return Arc(Direction("N", 2, np.pad(knots, 1, mode="edge")), points[:, 0], points[:, 1], weights)


def _on_circle(angle: float) -> tuple[float, float]:
    """Cosine and sine of an angle in degrees; on the axes exactly."""
    quarters, rest = divmod(angle, QUARTER)
    along, across = (1.0, 0.0) if rest == 0.0 else (float(np.cos(np.radians(rest))), float(np.sin(np.radians(rest))))
    for _ in range(int(quarters) % 4):
        along, across = -across, along
    return along + 0.0, across + 0.0  # no negative zeros
