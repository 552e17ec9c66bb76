"""Rational functions and their derivatives to order three against the recursion of Cox and de Boor in 40 digits.

A function is carried through the recursion as its Taylor series about the point, so that derivatives need no formula of their own.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import mpmath
import numpy as np
from numpy.typing import NDArray

from isomortar import _bindings
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.harness import Bound, case
from isomortar.model.numbering import patch_arrays

Series = NDArray[Any]  # of mpmath numbers
EPSILON = float(np.finfo(float).eps)
#: Powers of the two coordinates in the columns of the kernel's table.
POWERS = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3)]


def direction(order: int) -> Direction:
    """Three elements of unequal length; the second inner knot is repeated where the order allows."""
    inner = [0.3, 1.1, 1.1] if order > 1 else [0.3, 1.1]
    return Direction("N", order, np.array([0.0] * (order + 1) + inner + [2.0] * (order + 1)))


def line(along: Direction, u: float) -> Series:
    """Taylor coefficients of all functions about u to the third, shape (functions, 4)."""
    knots = [mpmath.mpf(float(k)) for k in along.knots]
    at = mpmath.mpf(float(u))
    table = [np.array([mpmath.mpf(a <= at < b), *[mpmath.mpf(0)] * 3]) for a, b in pairwise(knots)]

    def ramp(series: Series, start: mpmath.mpf, length: mpmath.mpf) -> Series:
        """The series times (u - start) / length; none over no length."""
        if length == 0:
            return series * 0
        return (series * (at - start) + np.concatenate([[mpmath.mpf(0)], series[:-1]])) / length

    for p in range(1, along.order + 1):
        table = [
            ramp(table[i], knots[i], knots[i + p] - knots[i]) - ramp(table[i + 1], knots[i + p + 1], knots[i + p + 1] - knots[i + 1])
            for i in range(len(table) - 1)
        ]
    return np.array(table)


def exact(patch: Patch, xi: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Derivatives of all functions of face w1 at a point, and the size of what they are sums of: shapes (10, control points)."""
    first, second = line(patch.directions[0], xi[0]), line(patch.directions[1], xi[1])
    weights = np.array([mpmath.mpf(float(w)) for w in patch.weights[patch.face_points("w1")]])
    tops = {(k, m): weights * np.outer(second[:, m], first[:, k]).ravel() for k, m in POWERS}
    total = {power: top.sum() for power, top in tops.items()}
    sizes = {power: abs(top).sum() for power, top in tops.items()}
    quotient: dict[tuple[int, int], Series] = {}
    terms: dict[tuple[int, int], Series] = {}
    for k, m in POWERS:
        lower = [(i, j) for i, j in quotient if i <= k and j <= m]
        quotient[k, m] = (tops[k, m] - sum(quotient[i, j] * total[k - i, m - j] for i, j in lower)) / total[0, 0]
        terms[k, m] = (abs(tops[k, m]) + sum(terms[i, j] * sizes[k - i, m - j] for i, j in lower)) / total[0, 0]
    factor = [math.factorial(k) * math.factorial(m) for k, m in POWERS]
    values, scale = ([[float(f * x) for x in table[power]] for f, power in zip(factor, POWERS, strict=True)] for table in (quotient, terms))
    return np.array(values), np.array(scale)


@case(
    claim="Values and derivatives to order three of rational functions have all their digits, weights spread over six decades.",
    tier="gate",
    grid={"order": [1, 2, 3, 4, 5, 6, 7, 8]},
    bounds={
        "error": Bound(at_most=50.0, reason="round-off: units in the last place of the largest term of a derivative, over all functions"),
        "largest": Bound(at_least=1.0, at_most=1e12, reason="definition: third derivatives were there to be compared"),
    },
)
def digits(order: int) -> dict[str, float]:
    """Largest error over points, derivatives and functions, in units of round-off of the largest term; largest derivative met."""
    along = direction(order)
    count = 2 * along.count**2
    third = Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))
    random = np.random.default_rng(order)
    patch = Patch((along, along, third), random.standard_normal((count, 3)), 10.0 ** random.uniform(-3, 3, count))
    xi = np.array([[0.2, 1.7], [0.65, 0.3], [1.1, 0.05], [1.99, 0.9]])
    nodes, found = _bindings.surface_functions(patch_arrays(patch, np.arange(count, dtype=np.int32)), 3, 1, xi)
    worst = largest = 0.0
    with mpmath.workdps(40):
        for point, local, functions in zip(xi, nodes, found, strict=True):
            values, scale = exact(patch, point)
            ours = np.zeros_like(values)
            ours[:, local] = functions
            worst = float(np.maximum(worst, float((np.abs(ours - values).max(axis=1) / scale.max(axis=1)).max()) / EPSILON))
            largest = float(np.maximum(largest, np.abs(values).max()))
    return {"error": worst, "largest": largest}
