"""Rational functions of contact surfaces at the quadrature points, weights spread over six decades."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar import _bindings
from isomortar.geometry.patch import Family, FloatArray, IntArray, Patch
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import LAGRANGE, NURBS, Bound, case
from isomortar.model.numbering import patch_arrays

EPSILON = float(np.finfo(float).eps)


def functions(kind: str) -> FloatArray:
    """Functions at the quadrature points of a face of 4 x 3 elements, shape (points, functions of an element)."""
    family: Family = "N" if kind[0] == "N" else "L"
    order = int(kind[1:])
    meshed = mesh(box((0, 0, 0), (1, 1, 1)), (family,) * 3, (order,) * 3, (4, 3, 1))
    weights = 10.0 ** np.random.default_rng(order).uniform(-3, 3, len(meshed.weights))
    patch = Patch(meshed.directions, meshed.control_points, weights if family == "N" else meshed.weights)
    arrays = patch_arrays(patch, np.arange(len(weights), dtype=np.int32))
    _, values, *_ = _bindings.slave_tables(arrays, 3, 1, (order + 2, order + 2), patch.control_points)
    return values


@case(
    claim="The functions of a surface add up to one at every point.",
    tier="gate",
    grid={"kind": NURBS + LAGRANGE},
    bounds={"error": Bound(at_most=50 * EPSILON, reason="round-off: 50 units in the last place of the sum")},
)
def partition_of_unity(kind: str) -> dict[str, float]:
    """Largest deviation of the sum of all functions from one."""
    return {"error": float(np.abs(functions(kind).sum(axis=1) - 1).max())}


@case(
    claim="NURBS functions are never negative.",
    tier="gate",
    grid={"kind": NURBS},
    bounds={"smallest": Bound(at_least=0.0, reason="theory: sums and quotients of non-negative terms, whatever the rounding")},
)
def non_negative(kind: str) -> dict[str, float]:
    """Smallest value of any function at any point."""
    return {"smallest": float(functions(kind).min())}


@case(
    claim="Functions of weights that hardly differ are those of these weights, and of one weight everywhere those without any.",
    tier="gate",
    grid={"share": (0.0, 1e-9, 1e-6, 1e-3, 0.1)},
    bounds={"error": Bound(at_most=50 * EPSILON, reason="round-off: of quotients of sums, against polynomials and their weights")},
)
def nearly_alike(share: float) -> dict[str, float]:
    """Largest difference from w_i N_i over the sum of all of these."""
    meshed = mesh(box((0, 0, 0), (1, 1, 1)), ("N",) * 3, (2, 2, 2), (4, 3, 1))
    weights = 0.7 * (1.0 + share * np.random.default_rng(5).uniform(0.0, 1.0, len(meshed.weights)))
    points = np.random.default_rng(6).uniform(0.0, 1.0, (40, 2)) * [meshed.directions[k].boundaries[-1] for k in (0, 1)]

    def values(weights: FloatArray) -> tuple[IntArray, FloatArray]:
        arrays = patch_arrays(replace(meshed, weights=weights), np.arange(len(weights), dtype=np.int32))
        nodes, found = _bindings.surface_functions(arrays, 3, 1, points)
        return nodes, found[:, 0]

    nodes, found = values(weights)
    exact = values(np.ones(len(weights)))[1] * weights[meshed.face_points("w1")[nodes]]
    return {"error": float(np.abs(found - exact / exact.sum(axis=1, keepdims=True)).max())}
