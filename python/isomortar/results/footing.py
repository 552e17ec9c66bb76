"""Where a slave face has its master opposite: beside that its pressure acts on nothing."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy import sparse

from isomortar._bindings import SlaveArrays
from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model.supports import BoolArray

if TYPE_CHECKING:
    from scipy.spatial import cKDTree


@frozen(eq=False)
class Footing:
    """Quadrature points of a slave face, and which of them have a foot on the master.

    Parameters
    ----------
    places : ndarray, shape (q, 3)
        In the reference configuration.
    functions : csr_array, shape (q, n)
        Of the face's control points, at the points.
    found : ndarray of bool, shape (q,)
    """

    places: FloatArray
    functions: sparse.csr_array
    found: BoolArray

    @classmethod
    def of(cls, slave: SlaveArrays, within: IntArray, reference: FloatArray, found: BoolArray) -> Footing:
        """That of a slave side.

        Parameters
        ----------
        slave : SlaveArrays
        within : ndarray of int, shape (n,)
            Which of its control points each of the face is.
        reference : ndarray, shape (control points of all bodies, 3)
        found : ndarray of bool, shape (q,)
        """
        first = np.zeros(len(slave.point), dtype=np.int32)
        first[within[::-1]] = np.arange(len(within), dtype=np.int32)[::-1]
        nodes, values = np.repeat(slave.shape.nodes, slave.per_element, axis=0), slave.shape.values
        rows = np.repeat(np.arange(len(nodes)), nodes.shape[1])
        functions = sparse.csr_array((values.ravel(), (rows, first[nodes].ravel())), shape=(len(nodes), len(within)))
        return cls(np.einsum("qa,qac->qc", values, reference[slave.point[nodes]]), functions, found)

    @cached_property
    def _tree(self) -> cKDTree:
        from scipy.spatial import cKDTree

        return cKDTree(self.places)

    def at(self, places: FloatArray) -> BoolArray:
        """Whether places at rest, shape (..., 3), have the master opposite: as the nearest quadrature point has (theory 8.7)."""
        if self.found.all():
            return np.ones(places.shape[:-1], dtype=bool)
        return self.found[self._tree.query(places)[1]]

    def acting(self, places: FloatArray, values: FloatArray, control_values: FloatArray) -> FloatArray:
        """What acts of a field: zero beside the master, nowhere larger than at all points with a foot (theory 8.7), shape (..., k).

        Parameters
        ----------
        places : ndarray, shape (..., 3)
            Of the reference configuration.
        values : ndarray, shape (..., k)
            Of the field there.
        control_values : ndarray, shape (n, k)
        """
        if self.found.all():
            return values
        largest, sizes = self.largest(control_values), np.linalg.norm(values, axis=-1)
        kept = np.where(sizes > largest, largest / np.where(sizes > 0.0, sizes, 1.0), 1.0)
        return np.where(self.at(places)[..., None], kept[..., None] * values, 0.0)

    def largest(self, control_values: FloatArray) -> float:
        """Largest size of a field at the points that have a foot; infinite where all have one, and the field acts as it is."""
        if self.found.all():
            return np.inf
        at_points = (self.functions @ control_values.reshape(len(control_values), -1))[self.found]
        return float(np.linalg.norm(at_points, axis=1).max(initial=0.0))
