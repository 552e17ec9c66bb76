"""Patches as rational Bezier elements: what ParaView draws exactly, and what pictures sample.

Along one direction both families, B-splines and Lagrange elements, are polynomials of order p on every element, so one
matrix takes the coefficients of a direction to Bezier coefficients. Neighbouring elements share the Bezier point between
them: E elements have p E + 1.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.interpolate import BSpline
from scipy.special import comb

from isomortar.geometry.patch import Direction, FloatArray


def bernstein(order: int, places: FloatArray) -> FloatArray:
    """Bernstein polynomials at `places` in [0, 1], shape (places, order + 1)."""
    k = np.arange(order + 1)
    s = np.asarray(places)[:, None]
    return comb(order, k) * s**k * (1.0 - s) ** (order - k)


def bezier_matrix(direction: Direction) -> FloatArray:
    """Matrix from the coefficients of a direction to its Bezier coefficients, shape (order * elements + 1, count).

    On each element the functions are taken at order + 1 places and interpolated by Bernstein polynomials, which is exact.
    """
    p = direction.order
    matrix = np.zeros((p * direction.elements + 1, direction.count))
    places = _chebyshev(p) if direction.family == "N" else np.linspace(0, 1, p + 1)
    to_bezier = np.linalg.inv(bernstein(p, places))
    for element, (begin, end) in enumerate(zip(direction.boundaries[:-1], direction.boundaries[1:], strict=True)):
        rows = slice(p * element, p * element + p + 1)
        if direction.family == "N":
            values = BSpline.design_matrix(begin + places * (end - begin), direction.knots, p).toarray()
            matrix[rows] = to_bezier @ values
        else:
            matrix[rows, rows] = to_bezier
    return matrix


def sampling_matrix(direction: Direction, per_element: int) -> FloatArray:
    """Matrix from the coefficients of a direction to values at `per_element` equal parts of each element.

    Returns
    -------
    ndarray, shape (per_element * elements + 1, count)
    """
    p = direction.order
    bezier = bezier_matrix(direction)
    basis = bernstein(p, np.arange(per_element) / per_element)
    inner = [basis @ bezier[p * element : p * element + p + 1] for element in range(direction.elements)]
    return np.concatenate([*inner, bezier[-1:]])


def at_parts(order: int, elements: int, parts: int) -> FloatArray:
    """Matrix from Bezier points of a direction to values at equal parts of its elements, shape (elements * parts + 1, points)."""
    matrix = np.zeros((elements * parts + 1, elements * order + 1))
    for element in range(elements):
        matrix[element * parts : (element + 1) * parts + 1, element * order : (element + 1) * order + 1] = bernstein(
            order, np.linspace(0.0, 1.0, parts + 1)
        )
    return matrix


def functions_at(direction: Direction, parameters: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Functions of a direction and their derivatives at any of its parameters, each of shape (parameters, count).

    At an inner element boundary the derivatives are those of the element that begins there.
    """
    p, ends = direction.order, direction.boundaries
    element = np.clip(np.searchsorted(ends, parameters, side="right") - 1, 0, direction.elements - 1)
    size = np.diff(ends)[element]
    places = (parameters - ends[element]) / size
    lower = np.pad(bernstein(p - 1, places), ((0, 0), (1, 1)))
    rows = bezier_matrix(direction)[p * element[:, None] + np.arange(p + 1)]
    values = np.einsum("mk,mkc->mc", bernstein(p, places), rows)
    return values, np.einsum("mk,mkc->mc", p * (lower[:, :-1] - lower[:, 1:]) / size[:, None], rows)


def inner_places(direction: Direction) -> FloatArray:
    """Order + 1 parameters inside each element, shape (elements * (order + 1),): where a field is taken that `fitted` goes through."""
    begin, size = direction.boundaries[:-1, None], np.diff(direction.boundaries)[:, None]
    return (begin + _chebyshev(direction.order) * size).ravel()


def fitted(directions: Sequence[Direction], weights: FloatArray, values: FloatArray) -> FloatArray:
    """A field that no functions give, as rational Bezier elements: through its values in each, and the mean of neighbours between them.

    Parameters
    ----------
    directions : sequence of Direction
    weights : ndarray, shape (n,)
        Of the patch's control points.
    values : ndarray, shape (m, k)
        At `inner_places` of the directions, first direction fastest.

    Returns
    -------
    ndarray, shape (b, k)
        At the Bezier points of the patch.
    """
    places = [functions_at(direction, inner_places(direction))[0] for direction in directions]
    _, at_places = rational(places, weights, weights[:, None])
    _, at_points = rational([bezier_matrix(direction) for direction in directions], weights, weights[:, None])
    return _tensor_product([_fit(direction) for direction in directions], at_places[:, None] * values) / at_points[:, None]


def _fit(direction: Direction) -> FloatArray:
    """Matrix from values at `inner_places` to Bezier coefficients, shape (order * elements + 1, elements * (order + 1))."""
    p, elements = direction.order, direction.elements
    matrix = np.zeros((p * elements + 1, elements * (p + 1)))
    to_bezier = np.linalg.inv(bernstein(p, _chebyshev(p)))
    for element in range(elements):
        matrix[p * element : p * element + p + 1, (p + 1) * element : (p + 1) * (element + 1)] = to_bezier
    matrix[p:-1:p] *= 0.5
    return matrix


def _chebyshev(order: int) -> FloatArray:
    """Order + 1 places between 0 and 1 that are good to interpolate at."""
    return 0.5 - 0.5 * np.cos(np.pi * (np.arange(order + 1) + 0.5) / (order + 1))


def rational(matrices: Sequence[FloatArray], weights: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Apply one matrix a direction to values at the control points of a rational tensor product (theory 2.4).

    Parameters
    ----------
    matrices : sequence of ndarray, shape (m_i, n_i)
        `bezier_matrix` or `sampling_matrix` of each direction.
    weights : ndarray, shape (n,)
    values : ndarray, shape (n, k)
        Any field given by the rational functions; n = n_1 n_2 ..., first direction fastest.

    Returns
    -------
    values : ndarray, shape (m, k)
        m = m_1 m_2 ..., first direction fastest.
    weights : ndarray, shape (m,)
    """
    flat = _tensor_product(matrices, np.column_stack([weights[:, None] * values, weights]))
    return flat[:, :-1] / flat[:, -1:], flat[:, -1]


def rational_gradient(
    functions: Sequence[tuple[FloatArray, FloatArray]], weights: FloatArray, values: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """A field of rational functions and its derivatives by parameter, by `functions_at` of each direction.

    Returns
    -------
    values : ndarray, shape (m, k)
    gradient : ndarray, shape (m, k, directions)
    """
    homogeneous = np.column_stack([weights[:, None] * values, weights])
    flat = _tensor_product([value for value, _ in functions], homogeneous)
    field, weight = flat[:, :-1] / flat[:, -1:], flat[:, -1:]
    columns = []
    for axis in range(len(functions)):
        matrices = [pair[1 if number == axis else 0] for number, pair in enumerate(functions)]
        slope = _tensor_product(matrices, homogeneous)
        columns.append((slope[:, :-1] - field * slope[:, -1:]) / weight)
    return field, np.stack(columns, axis=-1)


def _tensor_product(matrices: Sequence[FloatArray], values: FloatArray) -> FloatArray:
    """One matrix a direction applied to values of shape (n, k), first direction fastest."""
    grid = values.reshape(*(m.shape[1] for m in reversed(matrices)), -1)
    for axis, matrix in enumerate(reversed(matrices)):
        grid = np.moveaxis(np.tensordot(matrix, grid, axes=(1, axis)), 0, axis)
    return grid.reshape(-1, values.shape[1])
