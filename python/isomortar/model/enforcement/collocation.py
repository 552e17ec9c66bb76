"""Collocation with as many points as control points: areas for which a pressure field gives the forces that it should (theory 10.5)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import sparse

from isomortar.geometry.patch import FloatArray
from isomortar.model.enforcement.face import SlaveFace, grid
from isomortar.model.enforcement.side import SlaveSide, functions_at, open_ends, pointwise


def collocated(face: SlaveFace, abscissae: Sequence[FloatArray]) -> SlaveSide:
    """Constraints at the grid of some abscissae, with areas for which a uniform pressure's forces are exact (theory 10.5)."""
    from scipy.sparse.linalg import splu

    first, second = (open_ends(a, closed) for a, closed in zip(abscissae, face.closed, strict=True))
    coordinates = grid(first, second)
    nodes, values, _, area = face.gauss()
    elements = np.repeat(nodes, len(area) // len(nodes), axis=0)
    integrals = np.bincount(elements.ravel(), weights=(area[:, None] * values).ravel(), minlength=len(face.point))
    transposed = sparse.csc_array(functions_at(face, coordinates).T)
    return pointwise(face, coordinates, splu(transposed).solve(integrals))
