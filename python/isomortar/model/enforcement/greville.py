"""Collocation at Greville's abscissae, one a control point, with consistent weights (theory 10.5)."""

from __future__ import annotations

from isomortar.model.enforcement.collocation import collocated
from isomortar.model.enforcement.face import SlaveFace
from isomortar.model.enforcement.side import SlaveSide


def side(face: SlaveFace) -> SlaveSide:
    """As many constraints as control points: means of inner knots, or the nodes of Lagrange elements."""
    return collocated(face, [direction.greville for direction in face.directions])
