"""Functions of patches and faces as SciPy has their B-splines, and by the nodes of Lagrange elements: what shares nothing with ours."""

from __future__ import annotations

import functools
from collections.abc import Sequence

import numpy as np
from scipy.interpolate import BSpline

from isomortar.geometry.patch import Direction, FloatArray


def functions(direction: Direction, parameters: FloatArray) -> FloatArray:
    """Functions of a direction, shape (parameters, count)."""
    p, ends = direction.order, direction.boundaries
    if direction.family == "N":
        return np.asarray(BSpline.design_matrix(parameters, direction.knots, p).toarray())
    nodes = nodes_of(direction)
    found = np.zeros((len(parameters), len(nodes)))
    for e in range(direction.elements):
        mine, own = (parameters >= ends[e]) & (parameters <= ends[e + 1]), nodes[p * e : p * e + p + 1]
        for a in range(p + 1):
            others = np.delete(own, a)
            found[mine, p * e + a] = np.prod((parameters[mine, None] - others) / (own[a] - others), axis=1)
    return found


def nodes_of(direction: Direction) -> FloatArray:
    """Nodes of Lagrange elements, evenly spaced in each."""
    p, ends = direction.order, direction.boundaries
    return np.append((ends[:-1, None] + np.diff(ends)[:, None] * np.arange(p) / p).ravel(), ends[-1])


def shares(directions: Sequence[Direction], weights: FloatArray, places: FloatArray) -> FloatArray:
    """Rational functions of a patch or face at parameters, shape (places, control points); the first direction runs fastest."""
    tables = [functions(d, places[:, k]) for k, d in enumerate(directions)]
    found = functools.reduce(lambda a, b: np.einsum("qi,qj->qij", b, a).reshape(len(places), -1), tables)
    found = found * weights
    return np.asarray(found / found.sum(axis=1, keepdims=True))
