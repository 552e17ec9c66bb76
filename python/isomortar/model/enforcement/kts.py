"""The KTS method: constraints at the quadrature points of the contact elements, with their areas (theory 10.3)."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.patch import Direction, FloatArray
from isomortar.model.enforcement.face import SlaveFace, grid
from isomortar.model.enforcement.side import SlaveSide, pointwise


def side(face: SlaveFace) -> SlaveSide:
    """As many constraints as Gauss points (theory 10.3)."""
    (u, du), (v, dv) = (_gauss(d, n) for d, n in zip(face.directions, face.contact.quadrature, strict=True))
    coordinates = grid(u, v)
    nodes, _, slopes = face.at(coordinates)
    return pointwise(face, coordinates, np.prod(grid(du, dv), axis=1) * face.areas(nodes, slopes))


def _gauss(direction: Direction, count: int) -> tuple[FloatArray, FloatArray]:
    """Gauss points of all elements along a direction and their weights, shape (elements * count,)."""
    points, weights = np.polynomial.legendre.leggauss(count)
    lengths = np.diff(direction.boundaries)
    at = direction.boundaries[:-1, None] + lengths[:, None] * (0.5 * (1.0 + points))
    return at.ravel(), (lengths[:, None] * (0.5 * weights)).ravel()
