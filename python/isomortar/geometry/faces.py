"""Faces of a patch as cells small enough to be taken for flat: where they are, how large, and which way is out of the body."""

from __future__ import annotations

import math
from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from isomortar._frozen import frozen
from isomortar.geometry.grids import CELLS, grid
from isomortar.geometry.patch import FloatArray, IntArray, Patch, opposite

#: Share of a cell's side by which a place is farther than its middle where it is beyond the cell's edge: half of it, and round-off.
BEYOND = 0.5 + 1e-9
#: Angle, in radians, between cells beside each other from which on a face has a kink there: round a whole circle it is 0.13 at the most.
KINK = 0.2


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
    grids = {face: grid(patch, face) for face in {*faces, *map(opposite, faces)}}
    return {face: _cells(face, grids[face], grids[opposite(face)]) for face in faces}


def _cells(face: str, points: FloatArray, other: FloatArray) -> Cells:
    """By points of the face, and of the opposite one."""
    along = 0.5 * (points[1:, 1:] + points[1:, :-1] - points[:-1, 1:] - points[:-1, :-1])
    aside = 0.5 * (points[1:, 1:] + points[:-1, 1:] - points[1:, :-1] - points[:-1, :-1])
    across = np.cross(points[1:, 1:] - points[:-1, :-1], points[1:, :-1] - points[:-1, 1:])
    if face[1] == "1":
        across = -across
    length = np.linalg.norm(across, axis=-1).ravel()
    normals = across.reshape(-1, 3) / np.where(length > 0.0, length, 1.0)[:, None]
    sides, thickness = np.stack([along, aside], axis=2).reshape(-1, 2, 3), np.linalg.norm(_centres(other) - _centres(points), axis=1)
    return Cells(_centres(points), normals, 0.5 * length, sides, thickness, across.shape[:2])


def spread(count: int, some: int) -> int:
    """Every which of so many cells makes about some of them, spread over the faces: it has no part in common with `CELLS` in a row."""
    step = max(1, count // some)
    while math.gcd(step, CELLS) > 1:
        step += 1
    return step


def _centres(points: FloatArray) -> FloatArray:
    return 0.25 * (points[1:, 1:] + points[:-1, :-1] + points[1:, :-1] + points[:-1, 1:]).reshape(-1, 3)
