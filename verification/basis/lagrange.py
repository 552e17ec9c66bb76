"""Lagrange functions of a face and their derivatives to order three against products of Taylor series in exact fractions."""

from __future__ import annotations

import math
from bisect import bisect_right
from fractions import Fraction

import numpy as np

from isomortar import _bindings
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.harness import Bound, case
from isomortar.model.numbering import patch_arrays

EPSILON = float(np.finfo(float).eps)
#: Powers of the two coordinates in the columns of the kernel's table.
POWERS = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2), (3, 0), (2, 1), (1, 2), (0, 3)]
#: Ends of three elements of unequal length; binary fractions, as are the points.
ENDS = [0.0, 0.3125, 1.125, 2.0]


def line(order: int, u: float) -> tuple[FloatArray, FloatArray]:
    """Derivatives 0..3 of the functions of an element at u, and the size of the terms that they are sums of: (functions, 4)."""
    element = bisect_right(ENDS, u) - 1
    low, high = Fraction(ENDS[element]), Fraction(ENDS[element + 1])
    at, slope = (Fraction(u) - low) * order / (high - low), order / (high - low)
    values, terms = [], []
    for j in range(order + 1):
        series, sizes = [Fraction(1), *[Fraction(0)] * 3], [Fraction(1), *[Fraction(0)] * 3]
        for m in (m for m in range(order + 1) if m != j):
            series = [((at - m) * series[k] + slope * (series[k - 1] if k else 0)) / (j - m) for k in range(4)]
            sizes = [((at + m) * sizes[k] + slope * (sizes[k - 1] if k else 0)) / abs(j - m) for k in range(4)]
        values.append([float(math.factorial(k) * x) for k, x in enumerate(series)])
        terms.append([float(math.factorial(k) * x) for k, x in enumerate(sizes)])
    return np.array(values), np.array(terms)


@case(
    claim="Values and derivatives to order three of Lagrange functions have all their digits.",
    tier="gate",
    grid={"order": [1, 2, 3, 4]},
    bounds={
        "error": Bound(at_most=50.0, reason="round-off: units in the last place of the largest term of a derivative, over all functions"),
        "largest": Bound(at_least=1.0, at_most=1e12, reason="definition: derivatives were there to be compared"),
    },
)
def lagrange_digits(order: int) -> dict[str, float]:
    """Largest error over points, derivatives and functions, in units of round-off of the largest term; largest derivative met."""
    along, third = Direction("L", order, np.array(ENDS)), Direction("L", 1, np.array([0.0, 1.0]))
    count = 2 * along.count**2
    patch = Patch((along, along, third), np.random.default_rng(order).standard_normal((count, 3)), np.ones(count))
    xi = np.array([[0.25, 1.75], [0.6875, 0.3125], [1.125, 0.0625], [1.9375, 0.875]])
    _, found = _bindings.surface_functions(patch_arrays(patch, np.arange(count, dtype=np.int32)), 3, 1, xi)
    worst = largest = 0.0
    for (u, v), functions in zip(xi, found, strict=True):
        (first, first_size), (second, second_size) = line(order, u), line(order, v)
        terms: dict[tuple[int, int], FloatArray] = {}
        for (k, m), ours in zip(POWERS, functions, strict=True):
            exact, size = (np.outer(b[:, m], a[:, k]).ravel() for a, b in ((first, second), (first_size, second_size)))
            # The kernel divides by the sum of the functions, as for NURBS; its derivatives are round-off here.
            shares = (math.comb(k, i) * math.comb(m, j) * terms[i, j] for i, j in terms if i <= k and j <= m)
            terms[k, m] = sum(shares, start=size)
            worst = float(np.maximum(worst, float(np.abs(ours - exact).max() / terms[k, m].max()) / EPSILON))
            largest = float(np.maximum(largest, np.abs(exact).max()))
    return {"error": worst, "largest": largest}
