"""Collocation at Demko's abscissae, where the Chebyshev spline is largest, with consistent weights (theory 10.6)."""

from __future__ import annotations

from itertools import pairwise
from math import factorial
from typing import TYPE_CHECKING

import numpy as np

from isomortar.geometry.patch import Direction, FloatArray
from isomortar.model import constants
from isomortar.model.enforcement.collocation import collocated
from isomortar.model.enforcement.face import SlaveFace
from isomortar.model.enforcement.side import SlaveSide

if TYPE_CHECKING:
    from scipy.interpolate import BSpline, PPoly


def side(face: SlaveFace) -> SlaveSide:
    """As many constraints as control points."""
    return collocated(face, [abscissae(direction) for direction in face.directions])


def abscissae(direction: Direction) -> FloatArray:
    """Extrema of the spline that alternates between 1 and -1 as often as a spline of its space can, shape (count,) (theory 10.6).

    By Remez' exchange from Greville's abscissae. A direction of Lagrange elements has none (it is refused before).
    """
    from scipy.interpolate import make_interp_spline  # within, as in the other methods: no other method waits for it

    places = direction.greville
    signs = (-1.0) ** np.arange(direction.count)
    for _ in range(constants.CHEBYSHEV_STEPS):
        spline = make_interp_spline(places, signs, k=direction.order, t=direction.knots)
        places = _extrema(spline, places, direction.boundaries)
        if np.abs(np.abs(spline(places)) - 1.0).max() <= constants.CHEBYSHEV_LEVEL:
            break
    return places


def _extrema(spline: BSpline, places: FloatArray, knots: FloatArray) -> FloatArray:
    """Where the spline is largest between the zeros around each place."""
    pieces = _pieces(spline, knots)
    zeros = np.concatenate([[knots[0]], _roots(pieces, places), [knots[-1]]])
    stationary = pieces.derivative().roots(extrapolate=False) if spline.k > 1 else np.zeros(0)
    candidates = np.unique(np.concatenate([places, knots, stationary[np.isfinite(stationary)]]))
    sizes = np.abs(spline(candidates))
    found = [_largest(candidates, sizes, low, high) for low, high in pairwise(zeros)]
    return np.array([knots[0], *found[1:-1], knots[-1]])


def _pieces(spline: BSpline, knots: FloatArray) -> PPoly:
    """The polynomials between distinct knots; SciPy's own conversion ends the process above order 7."""
    from scipy.interpolate import PPoly

    return PPoly(np.array([spline(knots[:-1], nu=j) / factorial(j) for j in range(spline.k, -1, -1)]), knots)


def _largest(candidates: FloatArray, sizes: FloatArray, low: float, high: float) -> float:
    among = (candidates >= low) & (candidates <= high)
    return float(candidates[among][np.argmax(sizes[among])])


def _roots(pieces: PPoly, places: FloatArray) -> FloatArray:
    """The zero between each place and the next."""
    roots = pieces.roots(extrapolate=False)
    return np.array([roots[(roots > low) & (roots < high)][0] for low, high in pairwise(places)])
