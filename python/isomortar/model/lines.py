"""Functions of a patch along one of its directions: tensor products of them take control points to places, and forces back."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from isomortar import _bindings
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.model.numbering import patch_arrays


def functions_along(direction: Direction, places: FloatArray) -> tuple[sparse.csr_array, sparse.csr_array]:
    """Polynomial functions of a direction and their derivatives at some of its places, each of shape (places, control points).

    They are those of an edge of a patch with two flat directions.
    """
    count, flat = direction.count, Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))
    patch = patch_arrays(Patch((direction, flat, flat), np.zeros((4 * count, 3)), np.ones(4 * count)), np.arange(4 * count, dtype=np.int32))
    nodes, functions = _bindings.surface_functions(patch, 3, 0, np.column_stack([places, np.zeros(len(places))]))
    row = np.broadcast_to(np.arange(len(places))[:, None], nodes.shape)
    edge = nodes < count
    value, slope = (sparse.csr_array((functions[:, k][edge], (row[edge], nodes[edge])), shape=(len(places), count)) for k in range(2))
    return value, slope


def along(matrix: sparse.csr_array, net: FloatArray, axis: int) -> FloatArray:
    """A matrix times an array along one of its axes."""
    moved = np.moveaxis(net, axis, 0)
    return np.moveaxis((matrix @ moved.reshape(len(moved), -1)).reshape(-1, *moved.shape[1:]), 0, axis)


def quotient(slope: FloatArray, value: FloatArray) -> FloatArray:
    """Derivative of a point from values and derivatives of its homogeneous coordinates."""
    weight = value[..., 3:]
    return np.asarray((slope[..., :3] - value[..., :3] / weight * slope[..., 3:]) / weight)
