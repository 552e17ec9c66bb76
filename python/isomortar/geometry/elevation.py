"""Raising the order of splines, without tolerances: knots and smoothness are what they should be at any scale."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.patch import Direction, FloatArray


def elevated(direction: Direction, grid: FloatArray, axis: int) -> tuple[Direction, FloatArray]:
    """A direction of the next order, and the control values that it takes along an axis of a grid; each distinct knot is there once more.

    A control value is the mean of the blossom's over all knots but one of those that belong to it (theory 2.17).

    Parameters
    ----------
    direction : Direction
        NURBS.
    grid : ndarray
        Control values; of a rational spline weighted ones and weights.
    axis : int
        The direction's.
    """
    distinct, counts = np.unique(direction.knots, return_counts=True)
    raised = Direction("N", direction.order + 1, np.repeat(distinct, counts + 1))
    control = np.moveaxis(grid, axis, 0)
    found = np.empty((raised.count, *control.shape[1:]))
    with np.errstate(over="ignore", invalid="ignore"):  # a patch refuses what is not finite
        for i in range(raised.count):
            window = raised.knots[i : i + raised.order + 2]
            spans = np.flatnonzero(np.diff(window) > 0.0)
            span = int(np.searchsorted(direction.knots, window[spans[len(spans) // 2]], side="right")) - 1
            means = window[1:-1]
            found[i] = sum(_blossom(direction, control, span, np.delete(means, j)) for j in range(len(means))) / len(means)
    return raised, np.moveaxis(found, 0, axis)


def _blossom(direction: Direction, control: FloatArray, span: int, arguments: FloatArray) -> FloatArray:
    """The blossom of the polynomial between knots `span` and `span` + 1, by de Boor's algorithm with a parameter a level (theory 2.17)."""
    knots, order = direction.knots, direction.order
    values = control[span - order : span + 1]
    for level, argument in enumerate(arguments, start=1):
        low, high = knots[span - order + level : span + 1], knots[span + 1 : span + 1 + order - level + 1]
        share = ((argument - low) / (high - low)).reshape(-1, *(1,) * (values.ndim - 1))
        values = (1.0 - share) * values[:-1] + share * values[1:]
    return values[0]
