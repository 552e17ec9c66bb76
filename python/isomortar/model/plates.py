"""Faces and rigid bodies that go as plates: by as much as forces and a moment take, and what linear systems see of their turns."""

from __future__ import annotations

from dataclasses import field

import numpy as np
from scipy import sparse

from isomortar._bindings import Pattern
from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray, IntArray


def rotation(axis: FloatArray, angle: float) -> FloatArray:
    """Matrix that turns vectors about a unit axis, by Rodrigues' formula (theory 5.3); SciPy's take a tenth of a run's start."""
    x, y, z = axis
    across = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * across + 2.0 * np.sin(0.5 * angle) ** 2 * across @ across


def turn(axis: FloatArray, before: FloatArray, after: FloatArray) -> float:
    """Angle about a unit axis by which some points have turned, about whatever centre, the best one of all (theory 5.20)."""
    one, other = before - before.mean(axis=0), after - after.mean(axis=0)
    return float(np.arctan2(np.sum(np.cross(one, other) @ axis), np.sum(one * other) - np.sum((one @ axis) * (other @ axis))))


@frozen(eq=False)
class Plate:
    """Control points that go as one, with the unknowns that they have in common (theory 5.17, 5.20).

    `support` is the number of the support; `force` and `moment` are what it exerts, by its factors, on what is computed of the body.
    `pressed`: components in which a force moves it; `across`: components in which a moment does, none without one.
    `shape`: its control points as a motion of the support takes them on, where nothing else moves it.
    """

    support: int
    points: IntArray
    pressed: tuple[int, ...]
    across: tuple[int, ...]
    force: FloatArray
    moment: float
    axis: FloatArray
    centre: FloatArray
    shape: FloatArray

    @property
    def length(self) -> float:
        """What the angle is multiplied by to be an unknown like others: mean distance from the axis."""
        arms = self.shape - self.centre
        return float(np.sqrt(np.mean(np.sum(np.cross(self.axis, arms) ** 2, axis=1))))

    @property
    def slots(self) -> IntArray:
        """Where its unknowns stand among 3 * control point + component: those of forces at the first point, the angle at the second."""
        own = [3 * int(self.points[0]) + k for k in self.pressed]
        return np.array(own + [3 * int(self.points[1]) + k for k in self.across[:1]], dtype=np.int64)

    def unknowns(self, component: int) -> IntArray:
        """A component of all its points, among 3 * control point + component."""
        return np.asarray(3 * self.points + component, dtype=np.int64)

    def angle(self, positions: FloatArray) -> float:
        """By how much it has turned, in radians, from -pi to pi (theory 5.20)."""
        return turn(self.axis, self.shape, positions[self.points])

    def arms(self, angle: float) -> FloatArray:
        """From the centre to its control points after a turn, shape (points, 3) (theory 5.20)."""
        return (self.shape - self.centre) @ rotation(self.axis, angle).T

    def slopes(self, angle: float) -> tuple[FloatArray, FloatArray]:
        """First and second derivative of its positions by the unknown of its angle, shapes (points, 3) (theory 5.21)."""
        goes = np.isin(range(3), self.across) / self.length
        first = np.cross(self.axis, self.arms(angle))
        return goes * first, goes / self.length * np.cross(self.axis, first)


@frozen(eq=False)
class Seen:
    """A matrix of blocks as plates see it that turn: their control points stand in it once more, for the angle that they share.

    `block` is where each block comes from; `row` and `column` are the copies that its rows and columns are for, -1 for none.
    """

    pattern: Pattern
    block: IntArray
    row: IntArray
    column: IntArray
    own: IntArray = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "own", np.flatnonzero((self.row == self.column) & (self.row >= 0)))

    def values(self, values: FloatArray, slopes: FloatArray) -> FloatArray:
        """Its blocks, shape (blocks, 3, 3), from those of the matrix, with slopes of the copies, shape (copies, 3) (theory 5.21)."""
        found = values[self.block]
        rows, columns = self.row >= 0, self.column >= 0
        found[rows] *= slopes[self.row[rows]][:, :, None]
        found[columns] *= slopes[self.column[columns]][:, None, :]
        return np.ascontiguousarray(found)


def seen(pattern: Pattern, points: IntArray, count: int, square: bool) -> Seen:
    """A pattern with rows (if it is square) and columns once more for some of `count` control points, which follow after all others."""
    rows = len(pattern.start) - 1
    columns = count + len(points)
    marks = np.arange(1, len(pattern.column) + 1)  # sparse products take them along
    matrix = sparse.csr_array((marks, pattern.column, pattern.start), shape=(rows, count))
    again = sparse.csr_array((np.ones(len(points), dtype=np.int64), (points, np.arange(len(points)))), shape=(count, len(points)))
    wide = sparse.hstack([matrix, matrix @ again], format="csr")
    if square:
        wide = sparse.vstack([wide, again.T @ wide], format="csr")
    wide = sparse.csr_array(wide, shape=(rows + square * len(points), columns))
    wide.sort_indices()
    row = np.repeat(np.arange(wide.shape[0]), np.diff(wide.indptr))
    copies = [np.where(of >= first, of - first, -1) for of, first in ((row, rows), (wide.indices, count))]
    return Seen(Pattern(wide.indptr.astype(np.int32), wide.indices.astype(np.int32)), wide.data - 1, *copies)
