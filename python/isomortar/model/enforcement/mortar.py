"""The mortar-KTS method: constraints weighted with the functions of the face, integrated by Gauss points (theory 10.1)."""

from __future__ import annotations

from scipy import sparse

from isomortar._bindings import FunctionArrays, SlaveArrays
from isomortar.model.enforcement.face import SlaveFace
from isomortar.model.enforcement.side import SlaveSide


def side(face: SlaveFace) -> SlaveSide:
    """A constraint a control point (theory 10.1)."""
    nodes, values, slopes, area = face.gauss()
    count = len(face.point)
    functions = FunctionArrays(nodes, values, count)
    arrays = SlaveArrays(functions, functions, area, face.point, slopes, face.outward)
    return SlaveSide(arrays, face.control_places, sparse.csr_array(sparse.identity(count)), face.control_places)
