"""Faces of a patch as cells small enough to be taken for flat: where they are, how large, and which way is out of the body."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping

import numpy as np
from numpy.typing import NDArray

from isomortar._frozen import frozen
from isomortar.geometry.patch import Direction, FloatArray, IntArray, Patch, opposite
from isomortar.geometry.splines import Spline

#: Cells in a direction, at least: round a ring they then are off it by a five-hundredth of its radius.
CELLS = 48
#: Share of a face's size that an edge is longer than, unless it is a pole.
POINT = 1e-9
#: Share of a cell's side by which a place is farther than its middle where it is beyond the cell's edge: half of it, and round-off.
BEYOND = 0.5 + 1e-9

#: Angle, in radians, between cells beside each other from which on a face has a kink there: round a whole circle it is 0.13 at the most.
KINK = 0.2

#: A face of less than this share of the largest one's area is a line or a point: the axis of a cylinder, a pole of a ball.
NO_AREA = 1e-9


@frozen
class Cells:
    """Cells of a face.

    Parameters
    ----------
    centres, normals : ndarray, shape (n, 3)
        Normals are of unit length, out of the body; zero for cells without an area.
    areas : ndarray, shape (n,)
    sides : ndarray, shape (n, 2, 3)
        From the middle of one of a cell's edges to that of the opposite one, along both directions.
    thickness : ndarray, shape (n,)
        Distance of each centre from that of its counterpart on the opposite face.
    shape : tuple of int
        Number of cells by direction.
    """

    centres: FloatArray
    normals: FloatArray
    areas: FloatArray
    sides: FloatArray
    thickness: FloatArray
    shape: tuple[int, int]

    @property
    def sagitta(self) -> float:
        """How far the face is from its cells at most, about, but for kinks."""
        normals, sides = self.normals.reshape(*self.shape, 3), self.sides.reshape(*self.shape, 2, 3)
        found = [0.0]
        for axis in (0, 1):
            turns = np.linalg.norm(np.diff(normals, axis=axis), axis=2)
            lengths = np.linalg.norm(np.delete(sides[..., axis, :], 0, axis=axis), axis=2)
            found.append(float(np.max(0.125 * lengths * turns, where=turns < KINK, initial=0.0)))
        return max(found)

    def outermost(self, closed: tuple[bool, bool]) -> NDArray[np.bool_]:
        """Which cells are at an edge of the face, which may be closed along a direction; shape (n,)."""
        inner = [np.full(count, whole) for count, whole in zip(self.shape, closed, strict=True)]
        for line in inner:
            line[1:-1] = True
        return ~np.logical_and.outer(*inner).ravel()

    def ways(self, numbers: IntArray, arms: FloatArray) -> FloatArray:
        """How many sides along both directions places are from the middles of cells, by numbers and arms, (k, 3): shape (2, k)."""
        first, second = self.sides[numbers, 0], self.sides[numbers, 1]
        normals = np.cross(first, second)
        squares = np.einsum("ij,ij->i", normals, normals)
        parts = np.stack([np.einsum("ij,ij->i", np.cross(arms, second), normals), np.einsum("ij,ij->i", np.cross(first, arms), normals)])
        return np.divide(parts, squares, out=np.zeros_like(parts), where=squares > 0.0)

    def beyond(self, numbers: IntArray, arms: FloatArray) -> NDArray[np.bool_]:
        """Which places are beyond an edge of the face, by numbers of cells, shape (k,), and from where their centres are, shape (k, 3)."""
        ways = self.ways(numbers, arms)
        places, last = np.stack(np.unravel_index(numbers, self.shape)), np.array(self.shape)[:, None] - 1
        return np.asarray(np.any((places == 0) & (ways < -BEYOND) | (places == last) & (ways > BEYOND), axis=0))


def cells(patch: Patch, face: str) -> Cells:
    """The cells of a face. Its coordinates say which way is out, not where the opposite face is: bodies may be bent round."""
    return cells_of(patch, (face,))[face]


def cells_of(patch: Patch, faces: Collection[str]) -> dict[str, Cells]:
    """The cells of some faces, by their names."""
    grids = {face: _grid(patch, face) for face in {*faces, *map(opposite, faces)}}
    return {face: _cells(face, grids[face], grids[opposite(face)]) for face in faces}


def enclosing(sides: Mapping[str, Cells]) -> dict[str, Cells]:
    """Those faces that have an area: the others are lines and points, on these or within the body, and tell no way out."""
    least = NO_AREA * np.max([side.areas.sum() for side in sides.values()])
    return {face: side for face, side in sides.items() if side.areas.sum() >= least}


def _cells(face: str, grid: FloatArray, other: FloatArray) -> Cells:
    """By points of the face, and of the opposite one."""
    along = 0.5 * (grid[1:, 1:] + grid[1:, :-1] - grid[:-1, 1:] - grid[:-1, :-1])
    aside = 0.5 * (grid[1:, 1:] + grid[:-1, 1:] - grid[1:, :-1] - grid[:-1, :-1])
    across = np.cross(grid[1:, 1:] - grid[:-1, :-1], grid[1:, :-1] - grid[:-1, 1:])
    if face[1] == "1":
        across = -across
    length = np.linalg.norm(across, axis=-1).ravel()
    normals = across.reshape(-1, 3) / np.where(length > 0.0, length, 1.0)[:, None]
    sides, thickness = np.stack([along, aside], axis=2).reshape(-1, 2, 3), np.linalg.norm(_centres(other) - _centres(grid), axis=1)
    return Cells(_centres(grid), normals, 0.5 * length, sides, thickness, across.shape[:2])


def triangles(patch: Patch, faces: Iterable[str]) -> FloatArray:
    """Corners of two triangles for each cell of some faces, shape (2 n, 3, 3), seen from out of the body counter-clockwise."""
    found = []
    for face in faces:
        grid = _grid(patch, face)
        if face[1] == "1":
            grid = grid[::-1]
        a, b, c, d = (part.reshape(-1, 3) for part in (grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]))
        found += [np.stack([a, c, b], axis=1), np.stack([a, d, c], axis=1)]
    return np.concatenate(found)


def spread(count: int, some: int) -> int:
    """Every which of so many cells makes about some of them, spread over the faces: it has no part in common with `CELLS` in a row."""
    step = max(1, count // some)
    while math.gcd(step, CELLS) > 1:
        step += 1
    return step


def edges(patch: Patch, face: str, closed: tuple[bool, bool]) -> FloatArray:
    """Points along the edges of a face, shape (n, 3): none along directions that are closed, and of poles, which are one point."""
    grid = _grid(patch, face)
    lines = [] if closed[0] else [grid[0], grid[-1]]
    lines += [] if closed[1] else [grid[:, 0], grid[:, -1]]
    size = np.ptp(grid.reshape(-1, 3), axis=0).max()
    return np.concatenate([np.zeros((0, 3)), *(line for line in lines if np.ptp(line, axis=0).max() > POINT * size)])


def _centres(grid: FloatArray) -> FloatArray:
    return 0.25 * (grid[1:, 1:] + grid[:-1, :-1] + grid[1:, :-1] + grid[:-1, 1:]).reshape(-1, 3)


def _grid(patch: Patch, face: str) -> FloatArray:
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
