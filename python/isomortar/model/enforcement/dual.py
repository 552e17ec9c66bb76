"""The dual mortar method: consistent control gaps and slips, with the multipliers that do work on these alone (theory 10.13)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar._bindings import FunctionArrays
from isomortar.geometry.patch import FloatArray
from isomortar.model.enforcement import mortar
from isomortar.model.enforcement.face import SlaveFace
from isomortar.model.enforcement.side import SlaveSide


def side(face: SlaveFace) -> SlaveSide:
    """A constraint a control point: what the mortar method has, but for the functions that weight constraints (theory 10.13)."""
    found = mortar.side(face)
    shape, area = found.arrays.shape, found.arrays.area
    test = FunctionArrays(shape.nodes, _biorthogonal(shape, area), shape.count)
    return replace(found, arrays=replace(found.arrays, test=test))


def _biorthogonal(shape: FunctionArrays, area: FloatArray) -> FloatArray:
    """Functions whose integrals with those of the face are, in each element, these functions' areas, or zero (theory 10.13).

    Values at the quadrature points, shape (points, local). An element may have several cells: they have its control points in common.
    Pseudo-inverses, as mass matrices lose twice the digits.
    """
    elements, of_cell = np.unique(shape.nodes, axis=0, return_inverse=True)
    element = np.repeat(of_cell.ravel(), len(area) // len(shape.nodes))
    found = np.empty_like(shape.values)
    for e in range(len(elements)):
        own = np.flatnonzero(element == e)
        root = np.sqrt(area[own])[:, None]
        values = root * shape.values[own]
        found[own] = np.linalg.pinv(values).T * (root * values).sum(axis=0) / root
    return found
