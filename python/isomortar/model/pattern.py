"""Compressed patterns from cliques: lists of control points that all bear on one another."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from isomortar._bindings import Pattern
from isomortar.geometry.patch import Direction, IntArray, Patch


def incidence(members: IntArray, columns: int) -> sparse.csr_array:
    """Matrix of ones: row k has the columns `members[k]`, shape (len(members), columns)."""
    rows, width = members.shape
    matrix = sparse.csr_array(
        (np.ones(members.size, dtype=np.int32), members.ravel(), np.arange(0, members.size + 1, width)), shape=(rows, columns)
    )
    matrix.sum_duplicates()
    return matrix


def pattern_of(matrix: sparse.csr_array) -> Pattern:
    """The places of a matrix's entries, columns in order."""
    matrix.sort_indices()
    return Pattern(matrix.indptr.astype(np.int32), matrix.indices.astype(np.int32))


def rows_of(matrix: sparse.csr_array, chosen: np.ndarray) -> sparse.csr_array:
    """The chosen rows of a matrix of ones; the others are empty."""
    count = np.diff(matrix.indptr)
    start = np.zeros_like(matrix.indptr)
    np.cumsum(np.where(chosen, count, 0), out=start[1:])
    return sparse.csr_array((np.ones(start[-1], dtype=np.int32), matrix.indices[np.repeat(chosen, count)], start), shape=matrix.shape)


def element_points(patch: Patch, points: IntArray) -> IntArray:
    """Global control points of each element of a patch, shape (elements, control points of an element)."""
    index = [_direction_points(d) for d in patch.directions]
    n1, n2, _ = patch.shape
    grid = (
        index[0][None, None, :, None, None, :]
        + n1 * (index[1][None, :, None, None, :, None] + n2 * index[2][:, None, None, :, None, None])
    )  # fmt: skip
    return points[grid.reshape(-1, np.prod([d.order + 1 for d in patch.directions]))]


def _direction_points(direction: Direction) -> IntArray:
    """Control points along a direction of each of its elements, shape (elements, order + 1)."""
    return (direction.first_points[:, None] + np.arange(direction.order + 1)).astype(np.int32)


def elements_about(patch: Patch, face: str, points: IntArray) -> sparse.csr_array:
    """Which elements of a face meet at the nodes of each, shape (elements, elements); `points` are the patch's global control points."""
    first, second = patch.face_directions(face)
    grid = points[patch.face_points(face)].reshape(second.count, first.count)
    closed = bool(np.all(grid[:, 0] == grid[:, -1])), bool(np.all(grid[0] == grid[-1]))
    return sparse.csr_array(sparse.kron(_meeting(second, closed[1]), _meeting(first, closed[0])))


def _meeting(direction: Direction, closed: bool) -> sparse.csr_array:
    """Elements along a direction that meet at a node of each, shape (elements, elements) (theory 3.21)."""
    bounds, nodes, points = direction.boundaries, direction.greville, _direction_points(direction)
    slack = 1e-6 * np.diff(bounds)
    beside = (nodes[:, None] >= bounds[:-1] - slack) & (nodes[:, None] <= bounds[1:] + slack)
    if closed:  # the first and the last node are the same
        beside[[0, -1]] |= beside[[-1, 0]]
    has = np.zeros((len(points), direction.count), dtype=np.int32)
    np.put_along_axis(has, points, 1, axis=1)
    return sparse.csr_array((has @ beside > 0).astype(np.int32))


def surface_element_points(patch: Patch, face: str, points: IntArray) -> IntArray:
    """Global control points of each element of a face, shape (elements, control points of an element)."""
    first, second = patch.face_directions(face)
    grid = _direction_points(first)[None, :, None, :] + first.count * _direction_points(second)[:, None, :, None]
    return points[patch.face_points(face)][grid.reshape(-1, (first.order + 1) * (second.order + 1))]
