"""Where a contact's force is along a coordinate of a face, and how wide it is there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Face, Problem

#: Standard deviations of its force, in length, that a contact is wide: of an even pressure 3.5, of that of cylinders on blocks 4.0.
WIDE = 4.0


def extent(
    places: FloatArray, shares: FloatArray, bounds: FloatArray, ends: FloatArray, closed: bool, mirror: int | None = None
) -> tuple[float, float]:
    """Middle and width of a force along a coordinate, by where ends of its elements are on any scale.

    Parameters
    ----------
    places, shares : ndarray, shape (n,)
        The coordinate, and shares of the force there, which add up to one.
    bounds, ends : ndarray, shape (elements + 1,)
        Bounds of the elements by the coordinate, and on the scale, from zero on.
    closed : bool
        Whether the face meets itself where the coordinate ends: then what is told is about the middle, half a turn either way.
    mirror : int, optional
        The end, 0 or -1, that is on a plane of symmetry: what is told is that of the whole, in the middle of which this is.
    """
    there = np.interp(places, bounds, ends)
    if closed:
        turn = 2.0 * np.pi / ends[-1]
        middle = np.angle(shares @ np.exp(1j * turn * there)) / turn
        there = middle + (there - middle + 0.5 * ends[-1]) % ends[-1] - 0.5 * ends[-1]
    middle = float(shares @ there) if mirror is None else float(ends[mirror])
    return middle, WIDE * float(np.sqrt(shares @ np.square(there - middle)))


def mirrored_ends(problem: Problem, place: Face, letters: Sequence[str]) -> list[int | None]:
    """Which end of each direction of a face, 0 or -1, is on a plane of symmetry; None: neither, or both."""
    names = {plane.holding(place.body) for plane in problem.symmetry}
    held = {s.place.face for s in problem.supports if s.name in names and isinstance(s.place, Face) and s.place.body == place.body}
    ends = [[end for end in (0, -1) if f"{letter}{-end}" in held] for letter in letters]
    return [found[0] if len(found) == 1 else None for found in ends]
