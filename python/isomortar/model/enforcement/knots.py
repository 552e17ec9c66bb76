"""Collocation at unique knots, the corners of the contact elements; a corner's area is that of its bilinear share (theory 10.4)."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.patch import Direction, FloatArray
from isomortar.model.enforcement.face import SlaveFace, grid
from isomortar.model.enforcement.side import SlaveSide, open_ends, pointwise


def side(face: SlaveFace) -> SlaveSide:
    """Fewer constraints than control points above order 1 (theory 10.4)."""
    bounds = [open_ends(d.boundaries, closed) for d, closed in zip(face.directions, face.closed, strict=True)]
    *_, area = face.gauss()
    counts = face.contact.quadrature
    shares = [_shares(d, n, closed) for d, n, closed in zip(face.directions, counts, face.closed, strict=True)]
    by_element = area.reshape(face.directions[1].elements, face.directions[0].elements, counts[1], counts[0])
    return pointwise(face, grid(bounds[0], bounds[1]), np.einsum("ieq,jfr,ferq->ji", *shares, by_element).ravel())


def _shares(direction: Direction, count: int, closed: bool) -> FloatArray:
    """Share of each knot in each Gauss point of each element, shape (knots, elements, points): linear between its neighbours."""
    points = 0.5 * (1.0 + np.polynomial.legendre.leggauss(count)[0])
    shares = np.zeros((direction.elements + 1, direction.elements, count))
    element = np.arange(direction.elements)
    shares[element, element] = 1.0 - points
    shares[element + 1, element] = points
    if closed:
        shares[0] += shares[-1]
        return shares[:-1]
    return shares
