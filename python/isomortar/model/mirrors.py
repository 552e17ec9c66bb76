"""Edges of masters that are on planes of symmetry: beyond them is the mirror image, with which normals are averaged (theory 3.21)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model import constants
from isomortar.model.entities import Problem
from isomortar.model.numbering import Numbering

#: Numbers of control points by edge: of the start and the end of both directions.
Edges = list[tuple[int, IntArray]]


def mirrors_at(problem: Problem, numbering: Numbering, edges: Edges) -> IntArray:
    """Component (1 to 3) across the plane of symmetry that each edge is on, 0: none; shape (directions, 2).

    Supports that hold one component and do not move are planes of symmetry too.
    """
    found = np.zeros((2, 2), dtype=np.int32)
    for number, (direction, edge) in enumerate(edges):
        for component in _across(problem, numbering, edge):
            found[direction, number % 2] = component + 1
    return found


def _across(problem: Problem, numbering: Numbering, edge: IntArray) -> Iterator[int]:
    """Components across planes of symmetry that all of an edge is on."""
    places = numbering.reference[edge]
    for plane in problem.symmetry:
        if _is(places[:, plane.axis], plane.place, numbering):
            yield plane.axis
    for support in problem.supports:
        if len(support.components) == 1 and not support.moves:
            points = numbering.points[support.place.body][problem.body(support.place.body).patch.face_points(support.place.face)]
            (component,) = support.components
            if np.isin(edge, points).all() and _is(places[:, component], places[0, component], numbering):
                yield component


def _is(values: FloatArray, value: float, numbering: Numbering) -> bool:
    return bool(np.abs(values - value).max() <= constants.NO_PART * numbering.size)
