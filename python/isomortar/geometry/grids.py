"""Points on a face in rows: so close that the cells between them are nearly flat."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.geometry.splines import Spline

#: Cells in a direction, at least: round a ring they then are off it by a five-hundredth of its radius.
CELLS = 48
#: Share of a face's size that an edge is longer than, unless it is a pole.
POINT = 1e-9


def grid(patch: Patch, face: str) -> FloatArray:
    """Points on a face in rows: corners of its cells, shape (m1, m2, 3)."""
    first, second = patch.face_directions(face)
    numbers = patch.face_points(face)
    points, weights = patch.control_points[numbers], patch.weights[numbers]
    if first.family == second.family == "N":
        u, v = _places(first), _places(second)
        queries = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
        return Spline([first, second], points, weights).evaluate(queries).reshape(len(u), len(v), 3)
    rows, of_rows = (of.reshape(first.count, second.count, -1, order="F") for of in (points, weights))
    if second.family == "L":
        return _on_lines(first, second, rows, of_rows)
    return np.swapaxes(_on_lines(second, first, np.swapaxes(rows, 0, 1), np.swapaxes(of_rows, 0, 1)), 0, 1)


def edges(patch: Patch, face: str, closed: tuple[bool, bool]) -> FloatArray:
    """Points along the edges of a face, shape (n, 3): none along directions that are closed, and of poles, which are one point."""
    points = grid(patch, face)
    lines = [] if closed[0] else [points[0], points[-1]]
    lines += [] if closed[1] else [points[:, 0], points[:, -1]]
    size = np.ptp(points.reshape(-1, 3), axis=0).max()
    return np.concatenate([np.zeros((0, 3)), *(line for line in lines if np.ptp(line, axis=0).max() > POINT * size)])


def _on_lines(along: Direction, across: Direction, rows: FloatArray, weights: FloatArray) -> FloatArray:
    """Points on lines along a direction, through nodes of one across of Lagrange elements, and between these lines: the same shape.

    A line has weights of its own: only their ratios along NURBS mean anything.
    """
    if along.family == "N":
        places = _places(along)[:, None]
        lines = np.stack([Spline([along], rows[:, j], weights[:, j]).evaluate(places) for j in range(across.count)], axis=1)
    else:
        lines = _between_nodes(along, rows)
    return np.swapaxes(_between_nodes(across, np.swapaxes(lines, 0, 1)), 0, 1)


def _places(direction: Direction) -> FloatArray:
    """Parameters along a direction of NURBS: its elements, and these in parts."""
    return direction.subdivided(-(-CELLS // direction.elements))


def _between_nodes(direction: Direction, rows: FloatArray) -> FloatArray:
    """Rows of points at the nodes of a direction, and at parts of the ways between them; shape (places, ...)."""
    p = direction.order
    parts = p * -(-CELLS // (p * direction.elements))
    nodes, places = np.arange(p + 1) / p, np.arange(parts)[:, None] / parts
    others = [np.delete(nodes, k) for k in range(p + 1)]
    values = np.column_stack([np.prod((places - other) / (node - other), axis=1) for node, other in zip(nodes, others, strict=True)])
    of_elements = rows[p * np.arange(direction.elements)[:, None] + np.arange(p + 1)]
    inside = np.einsum("kp,ep...->ek...", values, of_elements)
    return np.concatenate([inside.reshape(-1, *rows.shape[1:]), rows[-1:]])
