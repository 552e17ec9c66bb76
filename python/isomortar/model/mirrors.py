"""Edges of masters that are on planes of symmetry: beyond them is the mirror image, with which normals are averaged (theory 3.21)."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.patch import IntArray
from isomortar.model import constants
from isomortar.model.entities import Problem
from isomortar.model.numbering import Numbering

#: Numbers of control points by edge: of the start and the end of both directions.
Edges = list[tuple[int, IntArray]]


def mirrors_at(problem: Problem, numbering: Numbering, edges: Edges) -> IntArray:
    """Component (1 to 3) across the plane of symmetry that each edge is on, 0: none; shape (directions, 2) (theory 3.21)."""
    found = np.zeros((2, 2), dtype=np.int32)
    for number, (direction, edge) in enumerate(edges):
        for plane in problem.symmetry:
            off = np.abs(numbering.reference[edge, plane.axis] - plane.place)
            if off.max() <= constants.NO_PART * numbering.size:
                found[direction, number % 2] = plane.axis + 1
    return found
