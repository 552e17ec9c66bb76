"""Fields of different meshes at the same material points: cell centres of a fixed grid over the exact geometry."""

from __future__ import annotations

import numpy as np

from isomortar._frozen import frozen
from isomortar.accuracy.discretisations import coarse_geometry
from isomortar.geometry.halves import upper_half
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.geometry.refinement import mesh
from isomortar.model.entities import Problem
from isomortar.results.bezier import functions_at, rational
from isomortar.scene.scene import Scene

#: Cells of the grid that the fields of a slave face are compared on.
FACE_CELLS = 4096


@frozen
class Grid:
    """Cell centres by direction (parameters, first direction fastest), and the cells' areas or volumes, shape (cells,)."""

    places: tuple[FloatArray, ...]
    weights: FloatArray

    @property
    def shape(self) -> tuple[int, ...]:
        """Cells by direction."""
        return tuple(len(p) for p in self.places)


def face_grid(geometry: Patch, face: str, cells: int) -> Grid:
    """A grid of about so many cells, nearly square, over a face of a body's exact geometry."""
    numbers = geometry.face_points(face)
    return _grid(geometry.face_directions(face), geometry.weights[numbers], geometry.control_points[numbers], cells)


def slave_grid(scene: Scene, problem: Problem, contact: int) -> Grid:
    """A grid over the slave face of a contact pair, the same for all discretisations of a scene."""
    slave = problem.contacts[contact].slave
    geometry = coarse_geometry(scene, slave.body)
    for plane in problem.symmetry:
        orders, elements = zip(*((d.order, 2 * d.elements) for d in geometry.directions), strict=True)
        geometry, _ = upper_half(mesh(geometry, ("N", "N", "N"), orders, elements), plane.axis, plane.place)
    return face_grid(geometry, slave.face, FACE_CELLS)


def body_grid(geometry: Patch, cells: int) -> Grid:
    """A grid of about so many cells, nearly cubes, over a body's exact geometry."""
    return _grid(geometry.directions, geometry.weights, geometry.control_points, cells)


def values_at(directions: tuple[Direction, ...], weights: FloatArray, values: FloatArray, grid: Grid) -> FloatArray:
    """A field given by the functions of a mesh at the cell centres.

    Parameters
    ----------
    directions : tuple of Direction
        Of the mesh, two (face) or three (body).
    weights : ndarray, shape (n,)
    values : ndarray, shape (n, k)
        Coefficients at the control points.

    Returns
    -------
    ndarray, shape (cells, k)
    """
    matrices = [functions_at(d, places)[0] for d, places in zip(directions, grid.places, strict=True)]
    return rational(matrices, weights, values)[0]


def _grid(directions: tuple[Direction, ...], weights: FloatArray, points: FloatArray, cells: int) -> Grid:
    net = points.reshape(*(d.count for d in reversed(directions)), 3)
    axes = range(len(directions) - 1, -1, -1)
    lengths = np.array([np.linalg.norm(np.diff(net, axis=axis), axis=-1).sum(axis=axis).mean() for axis in axes])
    parts = np.maximum(1, np.rint(lengths * (cells / lengths.prod()) ** (1 / len(lengths)) / [d.elements for d in directions])).astype(int)
    edges = [d.subdivided(n) for d, n in zip(directions, parts, strict=True)]
    corners = rational([functions_at(d, e)[0] for d, e in zip(directions, edges, strict=True)], weights, points)[0]
    measures = _measures(corners.reshape(*(len(e) for e in reversed(edges)), 3))
    return Grid(tuple(0.5 * (e[1:] + e[:-1]) for e in edges), measures.ravel())


def _measures(corners: FloatArray) -> FloatArray:
    """Area of each cell of a surface grid, volume of each cell of a volume grid, by the edges through its middle."""
    dimension = corners.ndim - 1
    edges = []
    for axis in range(dimension):
        edge = np.diff(corners, axis=axis)
        for other in set(range(dimension)) - {axis}:
            first, last = (np.take(edge, np.arange(edge.shape[other] - 1) + k, axis=other) for k in (0, 1))
            edge = 0.5 * (first + last)
        edges.append(edge)
    if dimension == 2:
        return np.linalg.norm(np.cross(edges[0], edges[1]), axis=-1)
    return np.abs(np.einsum("...i,...i->...", edges[0], np.cross(edges[1], edges[2])))
