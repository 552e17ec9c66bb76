"""What the statements measure, each number defined once; energies and distances of curves are those of `measures`."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike
from paper.outcome import Outcome

from isomortar.accuracy.measures import curve_error, relative_error, roughness
from isomortar.geometry.patch import FloatArray


def rms_second_difference(outcome: Outcome) -> float:
    """Root mean square of ``f[i+1] - 2 f[i] + f[i-1]`` over the inner load steps of the window: sqrt(roughness / n).

    The square of a ratio of two of them is the ratio of the curves' second-difference energies (`measures.roughness`).
    """
    window = outcome.window
    time, values = outcome.array("time")[window], outcome.curve[window]
    return math.sqrt(roughness(time, values, np.zeros(len(time))) / (len(time) - 2))


def deviation(outcome: Outcome, reference: Outcome) -> float:
    """L2 norm over the window of the difference of two curves, over that of the reference; of equal shares of the last stage.

    Load steps need not be equal: curves are linear between them.
    """
    ours, theirs = ((o.array("share")[o.window], o.curve[o.window]) for o in (outcome, reference))
    return curve_error(*ours, *theirs)


def mean(outcome: Outcome) -> float:
    """Mean of the curve over the load steps of the window."""
    return float(outcome.curve[outcome.window].mean())


def ripple(outcome: Outcome) -> float:
    """Standard deviation of the curve over the window after removal of its cubic trend (least squares)."""
    return float(np.std(without_trend(outcome.curve[outcome.window])))


def without_trend(values: ArrayLike) -> FloatArray:
    """Values at equal distances without the cubic that fits them best."""
    v = np.asarray(values, float)
    x = np.linspace(-1.0, 1.0, len(v))
    return v - np.polynomial.Polynomial.fit(x, v, min(3, len(v) - 1))(x)


def cycles(outcome: Outcome) -> int:
    """Number of periods within the window of the strongest harmonic of the curve without its cubic trend."""
    spectrum = np.abs(np.fft.rfft(without_trend(outcome.curve[outcome.window])))
    return int(np.argmax(spectrum[1:])) + 1


def negative_share(outcome: Outcome) -> float:
    """The most negative value of the pressure field at the contact quadrature points of all load steps, over the largest one.

    Zero where there is none: ``max(0, -min p) / max p``.
    """
    pressure = outcome.array("pressure")
    return float(np.maximum(0.0, -pressure.min()) / pressure.max())


def excess_variation(field: ArrayLike, reference: ArrayLike) -> float:
    """Oscillation of a field: its total variation over that of the reference, minus one.

    The variation is ``sum |p[i+1, j] - p[i, j]| / n_j + sum |p[i, j+1] - p[i, j]| / n_i``: how much it goes up and down along a mean
    line in either direction. Without oscillation it is that of the reference or, on a coarse mesh, somewhat less.

    Parameters
    ----------
    field, reference : array_like, shape (n_j, n_i)
        Values at the points of one grid.
    """
    return _variation(np.asarray(field, float)) / _variation(np.asarray(reference, float)) - 1.0


def field_deviation(field: ArrayLike, reference: ArrayLike, areas: ArrayLike) -> float:
    """L2 norm over the slave face of the difference of two fields, over that of the reference."""
    return relative_error(np.ravel(field), np.ravel(reference), areas)


def _variation(field: FloatArray) -> float:
    return float(sum(np.abs(np.diff(field, axis=axis)).sum(axis=axis).mean() for axis in (0, 1)))
