"""Bezier nets of fields that are nowhere negative: what is fitted through values of one overshoots where these bend sharply."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from isomortar.geometry.patch import Direction, FloatArray
from isomortar.results.bezier import at_parts, rational

#: Equal parts of an element at whose ends it is looked.
_PARTS = 8


def not_negative(directions: Sequence[Direction], weights: FloatArray, values: FloatArray, least: float) -> FloatArray:
    """The net with its values below zero raised towards it, in elements where the field is below `least`, and as far as that takes.

    Parameters
    ----------
    directions : sequence of Direction
    weights, values : ndarray, shape (b,)
        At the Bezier points, first direction fastest.
    least : float
        What is round-off: elements in which all is have no values below zero.
    """
    by = np.maximum(-values, 0.0)
    matrices = [at_parts(direction.order, direction.elements, _PARTS) for direction in directions]
    field, raised = rational(matrices, weights, np.column_stack([values, by]))[0].T
    share = np.clip((least - field) / np.where(raised > 0.0, raised, np.inf), 0.0, 1.0)
    share = share.reshape([len(matrix) for matrix in matrices], order="F")
    for axis, direction in enumerate(directions):
        share = _at_points(_of_elements(share, axis), axis, direction.order)
    return values + share.ravel(order="F") * by


def _of_elements(share: FloatArray, axis: int) -> FloatArray:
    """The largest share in each element along an axis, both of its ends included."""
    windows = sliding_window_view(share, _PARTS + 1, axis=axis).max(axis=-1)
    return np.take(windows, np.arange(0, windows.shape[axis], _PARTS), axis)


def _at_points(share: FloatArray, axis: int, order: int) -> FloatArray:
    """The larger share of the elements that a Bezier point belongs to, along an axis."""
    inside = np.repeat(share, order, axis)
    ends = (np.take(inside, [0], axis), np.take(inside, [-1], axis))
    return np.maximum(np.concatenate([ends[0], inside], axis), np.concatenate([inside, ends[1]], axis))
