"""Functions of the kernel against the recursion in 40 digits, and their derivatives against those of its own polynomials."""

from __future__ import annotations

import functools
from fractions import Fraction
from itertools import pairwise

import mpmath
import numpy as np
import pytest

from isomortar import _bindings
from isomortar.geometry.patch import Direction, Patch
from isomortar.model.numbering import patch_arrays

mpmath.mp.dps = 40

#: Order of the partial derivatives by each coordinate, in the order of the kernel's table.
DERIVATIVES = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3)]


def nurbs(order: int, inner: list[float]) -> Direction:
    return Direction("N", order, np.array([0.0] * (order + 1) + inner + [2.0] * (order + 1)))


DIRECTIONS = {
    "N1": nurbs(1, [0.7]),
    "N2": nurbs(2, [0.3, 0.3, 1.25]),
    "N3": nurbs(3, [0.5, 0.9, 0.9, 1.1]),
    "N5": nurbs(5, [0.5, 1.0]),
    "N10": nurbs(10, [0.25, 1.5]),
    "L1": Direction("L", 1, np.array([0.0, 0.5, 2.0])),
    "L2": Direction("L", 2, np.array([0.0, 0.5, 2.0])),
    "L4": Direction("L", 4, np.array([0.0, 0.7, 2.0])),
}


@functools.cache
def bspline(knots: tuple[mpmath.mpf, ...], i: int, p: int, u: mpmath.mpf) -> mpmath.mpf:
    """Cox-de Boor by its definition."""
    if p == 0:
        return mpmath.mpf(knots[i] <= u < knots[i + 1])
    total = mpmath.mpf(0)
    if knots[i + p] > knots[i]:
        total += (u - knots[i]) / (knots[i + p] - knots[i]) * bspline(knots, i, p - 1, u)
    if knots[i + p + 1] > knots[i + 1]:
        total += (knots[i + p + 1] - u) / (knots[i + p + 1] - knots[i + 1]) * bspline(knots, i + 1, p - 1, u)
    return total


def lagrange(boundaries: tuple[mpmath.mpf, ...], order: int, i: int, u: mpmath.mpf) -> mpmath.mpf:
    """The nodal function of node i by its product."""
    for element, (low, high) in enumerate(pairwise(boundaries)):
        own = i - element * order
        if low <= u < high:
            if not 0 <= own <= order:
                return mpmath.mpf(0)
            nodes = [low + (high - low) * Fraction(k, order) for k in range(order + 1)]
            return mpmath.fprod((u - node) / (nodes[own] - node) for k, node in enumerate(nodes) if k != own)
    raise ValueError(u)


def exact_line(direction: Direction, u: float) -> list[list[mpmath.mpf]]:
    """All functions of a direction at u with their derivatives to order three, from the polynomial through nearby values."""
    knots = tuple(mpmath.mpf(float(k)) for k in direction.knots)
    if direction.family == "N":
        functions = [lambda x, i=i: bspline(knots, i, direction.order, x) for i in range(direction.count)]
    else:
        functions = [lambda x, i=i: lagrange(knots, direction.order, i, x) for i in range(direction.count)]
    step = mpmath.mpf("1e-6")  # within the element the function is the polynomial through order + 1 of its values
    offsets = range(-(direction.order // 2) - 1, direction.order // 2 + 2)
    powers = mpmath.matrix([[mpmath.mpf(k) ** m for m in range(len(offsets))] for k in offsets])
    with mpmath.workdps(150):
        inverse = powers**-1
        tables = []
        for function in functions:
            coefficients = inverse * mpmath.matrix([function(mpmath.mpf(u) + k * step) for k in offsets])
            tables.append([coefficients[m] * mpmath.factorial(m) / step**m if m < len(offsets) else mpmath.mpf(0) for m in range(4)])
    return tables


def face_patch(first: Direction, second: Direction, seed: int) -> Patch:
    """A patch whose face w1 has the two directions and random weights; its shape does not matter here."""
    third = Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))
    random = np.random.default_rng(seed)
    count = first.count * second.count * third.count
    return Patch((first, second, third), random.standard_normal((count, 3)), random.uniform(0.3, 3.0, count))


def kernel_functions(patch: Patch, xi: np.ndarray) -> np.ndarray:
    """Values and derivatives of all functions of face w1, shape (points, 10, control points of the face)."""
    arrays = patch_arrays(patch, np.arange(len(patch.weights), dtype=np.int32))
    nodes, local = _bindings.surface_functions(arrays, 3, 1, xi)
    full = np.zeros((len(xi), 10, patch.shape[0] * patch.shape[1]))
    for k in range(len(xi)):
        full[k][:, nodes[k]] = local[k]
    return full


def exact_functions(patch: Patch, xi: np.ndarray) -> np.ndarray:
    """The same by the quotient of Taylor series in 40 digits."""
    weights = [mpmath.mpf(float(w)) for w in patch.weights[patch.face_points("w1")]]
    lines = [exact_line(direction, float(u)) for direction, u in zip(patch.directions, xi, strict=False)]
    n1, n2 = patch.shape[:2]

    def series(numbers: list[int]) -> dict[tuple[int, int], mpmath.mpf]:
        return {(k, m): mpmath.fsum(weights[a] * lines[0][a % n1][k] * lines[1][a // n1][m] for a in numbers) for k, m in DERIVATIVES}

    total = series(list(range(n1 * n2)))
    result = np.zeros((10, n1 * n2))
    for a in range(n1 * n2):
        top, quotient = series([a]), {}
        for k, m in DERIVATIVES:  # sum over i, j of binomials times quotient(i, j) total(k - i, m - j) = top(k, m)
            known = mpmath.fsum(
                mpmath.binomial(k, i) * mpmath.binomial(m, j) * quotient[i, j] * total[k - i, m - j]
                for i in range(k + 1)
                for j in range(m + 1)
                if (i, j) != (k, m)
            )
            quotient[k, m] = (top[k, m] - known) / total[0, 0]
        result[:, a] = [float(quotient[key]) for key in DERIVATIVES]
    return result


@pytest.mark.parametrize(("first", "second"), [("N1", "N2"), ("N3", "L2"), ("N5", "N2"), ("L4", "N3"), ("L1", "N10")])
def test_functions_and_derivatives_to_forty_digits(first: str, second: str) -> None:
    patch = face_patch(DIRECTIONS[first], DIRECTIONS[second], seed=3)
    xi = np.array([[0.2, 1.6], [1.9, 0.4], [0.61, 0.95]])
    for point, ours in zip(xi, kernel_functions(patch, xi), strict=True):
        exact = exact_functions(patch, point)
        scale = np.abs(exact).max(axis=1, keepdims=True)
        assert np.all(np.abs(ours - exact) <= 1e-14 * np.maximum(scale, 1.0))


@pytest.mark.parametrize("kind", DIRECTIONS)
def test_functions_sum_to_one_and_their_derivatives_to_zero(kind: str) -> None:
    patch = face_patch(DIRECTIONS[kind], DIRECTIONS["N2"], seed=5)
    xi = np.random.default_rng(1).uniform(0.0, 2.0, (50, 2))
    xi[:4] = [[0.0, 0.0], [2.0, 2.0], [0.5, 0.3], [0.0, 1.25]]  # ends and inner knots
    functions = kernel_functions(patch, xi)
    sums = functions.sum(axis=2)
    size = np.abs(functions).sum(axis=2)
    np.testing.assert_allclose(sums[:, 0], 1.0, rtol=0, atol=1e-14)
    assert np.all(np.abs(sums[:, 1:]) <= 1e-13 * np.maximum(size[:, 1:], 1.0))
