"""Forces and tangent of a body with a raised face, from those of its patch, whose control points follow from fewer (theory 2.12)."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from isomortar import _bindings
from isomortar._bindings import Pattern
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Body
from isomortar.model.numbering import Numbering, body_arrays
from isomortar.model.pattern import element_points, incidence, pattern_of


class Reduction:
    """What the solid asks of a body with a raised face.

    Attributes
    ----------
    reach : csr_array, shape (control points, control points)
        Which of all control points bear on which.
    """

    def __init__(self, body: Body, numbering: Numbering) -> None:
        self._body, self._numbering, count = body, numbering, len(body.patch.weights)
        rows, own = numbering.rows[body.name].into, numbering.own[body.name]
        self._arrays = body_arrays(body, often=True)
        self._into = sparse.csr_array((rows.data, own[rows.indices], rows.indptr), shape=(count, numbering.count))
        elements = incidence(element_points(body.patch, self._arrays.patch.point), count)
        met = abs(self._into).sign().astype(np.int32)
        self._pattern = pattern_of(sparse.csr_array(elements.T @ elements))
        self.reach = sparse.csr_array((elements @ met).T @ (elements @ met))
        self._gather: sparse.csr_array | None = None

    def add(self, positions: FloatArray, forces: FloatArray, pattern: Pattern | None, tangent: FloatArray | None) -> float:
        """Add internal forces and, where a pattern is given, tangent blocks; the smallest J, as `_bindings.add_body` (theory 2.12)."""
        name = self._body.name
        place, of_patch = self._numbering.of_patch(name, positions), np.zeros_like(self._arrays.reference)
        blocks = None if tangent is None else np.zeros((len(self._pattern.column), 3, 3))
        smallest = _bindings.add_body(
            self._arrays, self._body.material.arrays, place, of_patch, None if pattern is None else self._pattern, blocks
        )
        self._numbering.add_of_patch(name, of_patch, forces)
        if pattern is not None and tangent is not None and blocks is not None:
            if self._gather is None:
                self._gather = self._gathered(pattern)
            tangent += (self._gather @ blocks.reshape(-1, 9)).reshape(tangent.shape)
        return smallest

    def _gathered(self, pattern: Pattern) -> sparse.csr_array:
        """Shares that blocks of the patch have in those of a pattern: the shares of their two control points, multiplied (theory 2.12)."""
        blocks, count = len(self._pattern.column), self._into.shape[1]
        row = np.repeat(np.arange(len(self._pattern.start) - 1), np.diff(self._pattern.start))
        one, other = self._into[row], self._into[self._pattern.column]
        many = np.diff(one.indptr) * np.diff(other.indptr)
        block = np.repeat(np.arange(blocks), many)
        within, width = np.arange(len(block)) - np.repeat(np.cumsum(many) - many, many), np.diff(other.indptr)[block]
        i, j = one.indptr[block] + within // width, other.indptr[block] + within % width
        rows = np.repeat(np.arange(count), np.diff(pattern.start))
        place = np.searchsorted(rows * count + pattern.column, one.indices[i].astype(np.int64) * count + other.indices[j])
        return sparse.csr_array((one.data[i] * other.data[j], (place, block)), shape=(len(pattern.column), blocks))
