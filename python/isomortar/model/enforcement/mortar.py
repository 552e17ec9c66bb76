"""The mortar-KTS method: constraints weighted with the functions of the face, integrated by Gauss points (theory 10.1)."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from isomortar._bindings import FunctionArrays, SlaveArrays
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model.enforcement.face import SlaveFace
from isomortar.model.enforcement.side import SlaveSide
from isomortar.model.enforcement.subcells import Subcells


class MortarSide(SlaveSide):
    """A slave side whose constraints are those of its control points."""

    def on_control_points(self, values: FloatArray) -> FloatArray:
        """The values as they are."""
        return values

    @property
    def nearest(self) -> IntArray:
        """Each control point's own constraint."""
        return np.arange(self.arrays.test.count, dtype=np.int32)


def side(face: SlaveFace) -> SlaveSide:
    """A constraint a control point (theory 10.1)."""
    nodes, values, slopes, area = Subcells(face).gauss() if face.contact.subcells else face.gauss()
    count = len(face.point)
    functions = FunctionArrays(nodes, values, count)
    arrays = SlaveArrays(functions, functions, area, face.point, slopes, face.outward)
    return MortarSide(arrays, sparse.csr_array(sparse.identity(count)), face.control_places)
