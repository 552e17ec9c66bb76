"""Cells of the slave's contact elements, cut where knot lines of the master cross them: quadrature that sees the master (theory 10.9)."""

from __future__ import annotations

import numpy as np

from isomortar import _bindings
from isomortar._bindings import SlaveArrays
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model import constants
from isomortar.model.enforcement.face import SlaveFace, grid


class Subcells:
    """The contact elements of a slave face, cut again and again (theory 10.9).

    Parameters
    ----------
    face : SlaveFace
        Its master is a face.

    Attributes
    ----------
    low, high : ndarray, shape (cells, 2)
        Bounds of the cells by the face's coordinates.
    """

    def __init__(self, face: SlaveFace) -> None:
        self._face = face
        first, second = (direction.boundaries for direction in face.directions)
        self.low, self.high = grid(first[:-1], second[:-1]), grid(first[1:], second[1:])
        self._margin = constants.CELL_MARGIN * (self.high - self.low)
        for _ in range(face.contact.subcells):
            self._cut(0)
            self._cut(1)

    def gauss(self) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:
        """Tables at the cells' Gauss points: control points by cell, values, derivatives, reference areas."""
        (u, du), (v, dv) = (np.polynomial.legendre.leggauss(count) for count in self._face.contact.quadrature)
        at, weights = 0.5 * (1.0 + grid(u, v)), 0.25 * np.prod(grid(du, dv), axis=1)
        length = self.high - self.low
        coordinates = (self.low[:, None] + length[:, None] * at).reshape(-1, 2)
        nodes, values, slopes = self._face.at(coordinates)
        area = (np.prod(length, axis=1)[:, None] * weights).ravel() * self._face.areas(nodes, slopes)
        return np.ascontiguousarray(nodes[:: len(weights)]), values, slopes, area

    def lines(self) -> int:
        """The most of the master's knot lines of one family, and edges, that are seen to cross a cell along one of its middle lines."""
        return max(self._seen(axis) for axis in (0, 1))

    def _seen(self, axis: int) -> int:
        """The same along one direction, as changes of the element from one of a row of places to the next."""
        places = np.repeat(0.5 * (self.low + self.high)[:, None], constants.CELL_PLACES, axis=1)
        low, high = (self.low + self._margin)[:, axis], (self.high - self._margin)[:, axis]
        places[..., axis] = np.linspace(low, high, constants.CELL_PLACES, axis=1)
        labels = self._labels(places.reshape(-1, 2)).reshape(places.shape)
        elements = np.where(labels == 1, 2, labels) // 2  # the master's first edge is of its first element, as its last one is of the last
        return int(np.count_nonzero(np.diff(elements, axis=1), axis=1).max())

    def _cut(self, axis: int) -> None:
        """Cut cells across a direction where the master's element changes along their middle, else along their edges (theory 10.9).

        Those that two margins fill are left: there is no place between them.
        """
        places = np.full((2, len(self.low)), np.nan)
        wide = (self.high - self.low - 2.0 * self._margin)[:, axis] > 0.0
        for lines in constants.CELL_LINES:
            left = wide & np.isnan(places[0])
            low, high = self.low[left] + self._margin[left], self.high[left] - self._margin[left]
            many = np.repeat(lines, len(low))[:, None]
            found = self._crossing(axis, np.tile(low, (len(lines), 1)), np.tile(high, (len(lines), 1)), many)
            places[:, left] = _nearest(0.5 * (low + high)[:, axis], found.reshape(2 * len(lines), len(low)), self._margin[left, axis])
        lowest, highest = places
        self._split(axis, highest)
        self._split(axis, np.where(lowest < highest, lowest, np.nan))

    def _split(self, axis: int, at: FloatArray) -> None:
        """Cut the first cells, as many as there are places, in two; NaN: not that one. What is above a place comes last."""
        here = np.flatnonzero(~np.isnan(at))
        low, high = self.low[here].copy(), self.high.copy()
        low[:, axis] = high[here, axis] = at[here]
        self.low, self.high = np.concatenate([self.low, low]), np.concatenate([high, self.high[here]])
        self._margin = np.concatenate([self._margin, self._margin[here]])

    def _crossing(self, axis: int, low: FloatArray, high: FloatArray, line: FloatArray) -> FloatArray:
        """Where what is below a line of each box changes next to its middle on either side (theory 10.9), by halving; NaN: nowhere.

        `line`: where it lies across, shape (m, 1). A middle on a knot line, which others leave, is the place itself. Both sides are
        halved together: a search for feet costs what it learns of the master first, however few these are.
        """
        middle = low + line * (high - low)
        middle[:, axis] = 0.5 * (low + high)[:, axis]
        start, end = middle.copy(), middle.copy()
        start[:, axis], end[:, axis] = low[:, axis], high[:, axis]
        below, *ends = np.split(self._labels(np.concatenate([middle, start, end])), 3)
        differs = np.stack([labels != below for labels in ends])
        on_line = np.any(differs.any(axis=0) & (below % 2 == 1) & (below > 0), axis=1)
        changes = np.any(differs, axis=2) & ~on_line
        near, far, here = np.stack([middle, middle])[changes], np.stack([start, end])[changes], np.stack([below, below])[changes]
        for _ in range(constants.CELL_HALVINGS):
            between = 0.5 * (near + far)
            same = np.all(self._labels(between) == here, axis=1)
            near[same], far[~same] = between[same], between[~same]
        sides = np.where(on_line, middle[:, axis], np.full((2, 1), np.nan))
        sides[changes] = 0.5 * (near + far)[:, axis]
        return sides

    def _labels(self, coordinates: FloatArray) -> IntArray:
        """Twice the elements of the master below places of the face, one more on the line to the next, shape (m, 2); -1 beside it."""
        count = len(coordinates)
        if not count:
            return np.zeros((0, 2), dtype=np.int32)
        master, reference = self._face.master, self._face.reference
        assert master is not None
        nodes, values, _ = self._face.at(coordinates)
        places = np.einsum("ma,max->mx", values, reference[self._face.point[nodes]])
        points = SlaveArrays.of_points(len(reference) + np.arange(count, dtype=np.int32))
        positions = np.concatenate([reference, places])
        feet = _bindings.project_points(points, master, positions, np.zeros((count, 2)), np.zeros(count, dtype=np.int32))
        below = []
        for lines, xi in zip(self._face.lines, feet.xi.T, strict=True):
            on_line = constants.ON_LINE * np.diff(lines).min()
            below.append(np.searchsorted(lines, xi + on_line, side="right") + np.searchsorted(lines, xi - on_line, side="right"))
        return np.where(feet.found[:, None] != 0, np.stack(below, axis=1), -1)


def _nearest(middle: FloatArray, places: FloatArray, margin: FloatArray) -> FloatArray:
    """Of rows of places, some of which are NaN, the one that is nearest to the middles, twice, or two that are as near but for a margin."""
    away = np.where(np.isnan(places), np.inf, np.abs(places - middle))
    near = np.where(away <= away.min(axis=0) + margin, places, np.nan)
    lowest, highest = np.fmin.reduce(near), np.fmax.reduce(near)
    return np.where(highest - lowest > 2.0 * margin, [lowest, highest], 0.5 * (lowest + highest))
