"""How far curves and fields are from a reference, how smooth curves are, and how good the reference itself is."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from isomortar.errors import InputError
from isomortar.geometry.patch import FloatArray


def relative_error(values: ArrayLike, reference: ArrayLike, weights: ArrayLike) -> float:
    """L2 norm of the difference over that of the reference.

    Parameters
    ----------
    values, reference : array_like, shape (n,) or (n, k)
    weights : array_like, shape (n,)
        Length, area or volume that each entry stands for.

    Returns
    -------
    float
        NaN where the reference is zero.
    """
    v, r, w = np.asarray(values, float), np.asarray(reference, float), np.asarray(weights, float)
    if v.shape != r.shape or w.shape != v.shape[:1]:
        raise InputError(f"shapes differ: values {v.shape}, reference {r.shape}, weights {w.shape}")
    size = float(w @ _squares(r))
    return math.sqrt(float(w @ _squares(v - r)) / size) if size > 0 else math.nan


def on_common_times(times: ArrayLike, values: ArrayLike, other_times: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """A curve, linear between its load times, on the times of both curves within the range that both have.

    Parameters
    ----------
    times : array_like, shape (n,)
    values : array_like, shape (n,) or (n, k)
    other_times : array_like, shape (m,)

    Returns
    -------
    times : ndarray, shape (c,)
    values : ndarray, shape (c,) or (c, k)

    Raises
    ------
    InputError
        The ranges have no two times in common.
    """
    own, other, v = np.asarray(times, float), np.asarray(other_times, float), np.asarray(values, float)
    both = np.union1d(own, other)
    both = both[(both >= max(own[0], other[0])) & (both <= min(own[-1], other[-1]))]
    if len(both) < 2:
        raise InputError(f"curves over {own[0]:g} to {own[-1]:g} and {other[0]:g} to {other[-1]:g} have no load times in common")
    columns = [np.interp(both, own, column) for column in v.reshape(len(own), -1).T]
    return both, np.stack(columns, axis=-1).reshape(len(both), *v.shape[1:])


def curve_error(times: ArrayLike, values: ArrayLike, reference_times: ArrayLike, reference: ArrayLike) -> float:
    """`relative_error` of curves over the load times that both have, by the trapezoidal rule."""
    both, ours = on_common_times(times, values, reference_times)
    theirs = on_common_times(reference_times, reference, times)[1]
    gaps = np.diff(both)
    weights = 0.5 * (np.append(gaps, 0.0) + np.insert(gaps, 0, 0.0))
    return relative_error(ours, theirs, weights)


def roughness(times: ArrayLike, values: ArrayLike, stages: ArrayLike) -> float:
    """Second-difference energy: sum of the squared second divided differences, doubled, of a curve within each stage.

    For load times one apart that is the sum of ``(f[i+1] - 2 f[i] + f[i-1])**2``. The kink between two stages is the scene's own and
    does not count.

    Parameters
    ----------
    times : array_like, shape (n,)
    values : array_like, shape (n,) or (n, k)
    stages : array_like of int, shape (n,)
    """
    t, v, s = np.asarray(times, float), np.asarray(values, float), np.asarray(stages)
    v = v.reshape(len(t), -1)
    slopes = np.diff(v, axis=0) / np.diff(t)[:, None]
    second = 2 * np.diff(slopes, axis=0) / (t[2:] - t[:-2])[:, None]
    return float(_squares(second[s[2:] == s[:-2]]).sum())


def reference_uncertainty(coarse_to_medium: float, medium_to_fine: float, expected: float) -> float:
    """Error of the finest of three meshes, each twice as fine as the one before, by what the two refinements changed.

    The changes fall by a factor s a refinement, and what all further ones would change is a geometric series: change * s / (1 - s).
    s is what was seen, but never faster than the order expected from theory: one pair of meshes may agree by chance.

    Parameters
    ----------
    coarse_to_medium, medium_to_fine : float
        Changes of the result.
    expected : float
        Best order that theory allows.

    Returns
    -------
    float
        Infinity where the changes do not fall, or are not known.
    """
    if not (math.isfinite(coarse_to_medium) and math.isfinite(medium_to_fine) and 0 <= medium_to_fine < coarse_to_medium):
        return math.inf
    s = max(medium_to_fine / coarse_to_medium, 0.5**expected)
    return medium_to_fine * s / (1 - s)


def expected_order(measure: str, order: int, slave_refined: bool) -> float:
    """Best order of a measure from theory.

    Where the slave face is refined, the free boundary of the contact zone limits it: the pressure falls to zero like the square root of
    the distance (Hertz), so that it is approximated with order 1 in L2 and the displacements with 5/2; resultants gain twice the 3/2 of
    the energy norm. On the master of a slave that stays as it is, the load is a fixed piecewise polynomial, and orders are those of smooth
    solutions up to 4 (6 for resultants).
    """
    best = {"pressure": 1.0, "displacement": 2.5, "force": 3.0, "moment": 3.0}
    if not slave_refined:
        best = {"pressure": 4.0, "displacement": 4.0, "force": 6.0, "moment": 6.0}
    smooth = 2 * order if measure in ("force", "moment") else order + 1
    return min(float(smooth), best[measure])


def _squares(values: FloatArray) -> FloatArray:
    """Squares, summed over components, shape (n,)."""
    squares: FloatArray = (values**2).sum(axis=tuple(range(1, values.ndim)))
    return squares
