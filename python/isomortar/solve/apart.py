"""Pairs that are out of each other's reach: boxes about control points tell that no point of the slave can bear on the master.

A point bears where its gap is positive and its foot is one. Between boxes that are apart by more than the master's body is deep, a point
behind the master is too deep for a foot (theory 3.19), and every other one is open. That a point which had a foot has not come behind
the master since the start of the load increment, which would be an error, is told by boxes about both places: these are apart as well.
"""

from __future__ import annotations

from typing import Self

import numpy as np

from isomortar._bindings import FaceArrays, PlaneArrays
from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model import constants
from isomortar.model.pairs import Pair


@frozen
class Box:
    """Lower and upper corner, shape (3,)."""

    low: FloatArray
    high: FloatArray

    @classmethod
    def about(cls, points: FloatArray, spread: float) -> Self:
        """The box that holds sums of points with coefficients that add up to one, and their sizes to no more than `spread`."""
        low, high = points.min(axis=0), points.max(axis=0)
        beyond = 0.5 * (spread - 1.0) * (high - low)
        return cls(low - beyond, high + beyond)

    def joined(self, other: Self) -> Self:
        """The box about both."""
        return type(self)(np.minimum(self.low, other.low), np.maximum(self.high, other.high))

    def distance(self, other: Self) -> float:
        """How far it is from another one; 0 where they meet, not a number where one is none."""
        return float(np.linalg.norm(np.maximum(np.maximum(self.low - other.high, other.low - self.high), 0.0)))


class Separation:
    """Whether a pair is out of reach at the places of a load increment; never where some multiplier acted at its start."""

    def __init__(self, pair: Pair) -> None:
        self._slave, self._master = pair.slave.point, pair.master
        self._spread = float(np.abs(pair.slave.shape.values).sum(axis=1).max())
        # Weights below zero could make a penetration of gaps that are none; feet beyond the edges are not between control points.
        # And smooth contact acts at any distance.
        sharp = pair.contact.smoothing == 0.0
        self._told = sharp and float(pair.slave.test.values.min()) >= 0.0 and getattr(pair.master, "brim", 0.0) == 0.0
        self._start: tuple[Box, Box] | None = None
        self._begun = False
        if isinstance(self._master, FaceArrays):
            self._face, self._across, self._spread_of_master, self._same = _faces(self._master)

    def begin(self, positions: FloatArray, acts: bool) -> None:
        """Begin a load increment at positions, where multipliers act or not."""
        self._begun, self._start = self._told and not acts, None
        if self._begun and isinstance(self._master, FaceArrays):
            self._start = self._boxes(positions)

    def holds(self, positions: FloatArray) -> bool:
        """Whether no point of the slave can bear on the master at some positions."""
        if not self._begun:
            return False
        clear = constants.CLEAR * float(np.abs(positions[self._slave]).max())
        if isinstance(self._master, PlaneArrays):
            normal = self._master.normal / np.linalg.norm(self._master.normal)
            heights = (positions[self._slave] - self._master.origin) @ normal
            return bool(heights.min() - 0.5 * (self._spread - 1.0) * np.ptp(heights) > clear)
        assert self._start is not None, "begun"
        slave, master = self._boxes(positions)
        apart = slave.joined(self._start[0]).distance(master.joined(self._start[1]))
        return apart > clear and apart > self._depth(positions) + clear

    def _boxes(self, positions: FloatArray) -> tuple[Box, Box]:
        """About slave and master."""
        return Box.about(positions[self._slave], self._spread), Box.about(positions[self._face], self._spread_of_master)

    def _depth(self, positions: FloatArray) -> float:
        """No place of the master has more of its body below it (theory 3.19)."""
        near, far = positions[self._face], positions[self._across]
        if self._same:  # a sum of distances between control points
            return self._spread_of_master * float(np.linalg.norm(far - near, axis=1).max())
        both = Box.about(np.vstack([near, far]), self._spread_of_master)
        return float(np.linalg.norm(both.high - both.low))


def _faces(master: FaceArrays) -> tuple[IntArray, IntArray, float, bool]:
    """Control points of a master's face and of that across from it, the spread of its functions, and whether both have the same weights."""
    patch, axis = master.patch, master.axis - 1
    grid = np.arange(len(patch.point)).reshape(patch.counts[::-1])
    ends = [np.take(grid, end, axis=2 - axis).ravel() for end in (-master.side, master.side - 1)]
    within = [d for d in range(3) if d != axis]
    # Equally spaced Lagrange functions: their sizes add up to less than two to the power of the order less one, by direction.
    spread = float(np.prod([2.0 ** (patch.orders[d] - 1) if patch.families[d] == 2 else 1.0 for d in within]))
    near, far = (patch.weight[end] for end in ends)
    return patch.point[ends[0]], patch.point[ends[1]], spread, bool(np.all(near * far[0] == far * near[0]))
