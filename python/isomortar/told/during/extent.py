"""Where a contact's force is along a coordinate of a face, and how wide it is there."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.patch import FloatArray

#: Standard deviations of its force, in length, that a contact is wide: of an even pressure 3.5, of that of cylinders on blocks 4.0.
WIDE = 4.0


def extent(places: FloatArray, shares: FloatArray, bounds: FloatArray, ends: FloatArray, closed: bool) -> tuple[float, float]:
    """Middle and width of a force along a coordinate, by where ends of its elements are on any scale.

    Parameters
    ----------
    places, shares : ndarray, shape (n,)
        The coordinate, and shares of the force there, which add up to one.
    bounds, ends : ndarray, shape (elements + 1,)
        Bounds of the elements by the coordinate, and on the scale, from zero on.
    closed : bool
        Whether the face meets itself where the coordinate ends: then what is told is about the middle, half a turn either way.
    """
    there = np.interp(places, bounds, ends)
    if closed:
        turn = 2.0 * np.pi / ends[-1]
        middle = np.angle(shares @ np.exp(1j * turn * there)) / turn
        there = middle + (there - middle + 0.5 * ends[-1]) % ends[-1] - 0.5 * ends[-1]
    middle = float(shares @ there)
    return middle, WIDE * float(np.sqrt(shares @ np.square(there - middle)))
