"""A face of a patch as a net of control points, which can be turned, and what keeps two nets from being one."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.patch import Direction, FloatArray, IntArray, Patch

#: Steps to the places beside a net, with the edges that meet there: in the net here, and in the one there.
BESIDE = (
    ((1, 0), np.s_[:, -1], np.s_[:, 0]),
    ((-1, 0), np.s_[:, 0], np.s_[:, -1]),
    ((0, 1), np.s_[-1, :], np.s_[0, :]),
    ((0, -1), np.s_[0, :], np.s_[-1, :]),
)


@frozen
class Net:
    """Control points of a face in rows: along the first surface coordinate in a row, along the second from row to row.

    Parameters
    ----------
    letters : str
        Names of the surface coordinates among u, v, w.
    directions : tuple of Direction
    numbers : ndarray of int32, shape (n2, n1)
        Control points by their number in the patch.
    points : ndarray, shape (n2, n1, 3)
    weights : ndarray, shape (n2, n1)
    """

    letters: str
    directions: tuple[Direction, Direction]
    numbers: IntArray
    points: FloatArray
    weights: FloatArray

    @classmethod
    def of(cls, patch: Patch, face: str) -> Net:
        """The net of a face, in the order of its surface coordinates."""
        first, second = patch.face_directions(face)
        axis = "uvw".index(face[0])
        numbers = patch.face_points(face).reshape(second.count, first.count)
        return cls("uvwuv"[axis + 1 : axis + 3], (first, second), numbers, patch.control_points[numbers], patch.weights[numbers])

    def swapped(self) -> Net:
        """The same with the two coordinates in the other order."""
        points = np.ascontiguousarray(self.points.swapaxes(0, 1))
        return Net(self.letters[::-1], self.directions[::-1], self.numbers.T, points, self.weights.T)

    def reversed(self, axis: int) -> Net:
        """The same with a coordinate that runs the other way."""
        first, second = (direction.reversed() if k == axis else direction for k, direction in enumerate(self.directions))
        row = 1 - axis
        return Net(self.letters, (first, second), np.flip(self.numbers, row), np.flip(self.points, row), np.flip(self.weights, row))

    def turned(self) -> Iterator[Net]:
        """All eight ways to look at it: either order of the coordinates, each of them either way. One by one: mostly the first is it."""
        for swap, first, second in product((False, True), repeat=3):
            net = self.swapped() if swap else self
            net = net.reversed(0) if first else net
            yield net.reversed(1) if second else net

    @property
    def corners(self) -> FloatArray:
        """Its corners, shape (4, 3)."""
        return self.points[[0, 0, -1, -1], [0, -1, 0, -1]]


@frozen
class Misfit:
    """What keeps two nets from being one, by how much it does, and how much else was found to be the same before."""

    stage: int
    size: float
    reason: str


def misfit(one: Net, other: Net, names: tuple[str, str], near: float, alike: float) -> Misfit | None:
    """Whether and why two nets are not the same as they lie; None: they are.

    Parameters
    ----------
    one, other : Net
    names : tuple of str
        Of their bodies, for the words.
    near : float
        Distance within which control points are one.
    alike : float
        Relative difference within which knots and weights are the same.
    """
    apart = np.linalg.norm(one.corners - other.corners, axis=1)
    if apart.max() > near:
        return Misfit(0, float(apart.max()), f"corners are {_at(apart, one.corners)}")
    for axis in (0, 1):
        reason = _of_directions(one.directions[axis], other.directions[axis], names, (one.letters[axis], other.letters[axis]), alike)
        if reason:
            return Misfit(1 + axis, 0.0, reason)
    ratios = one.weights / other.weights * (other.weights[0, 0] / one.weights[0, 0])
    differ = abs(ratios - 1.0).ravel()
    if differ.max() > alike:
        place = ", ".join(f"{x:g}" for x in one.points.reshape(-1, 3)[np.argmax(differ)])
        return Misfit(
            3, float(differ.max()), f"weights, over that of a corner, differ by up to {differ.max():.3g} of their size (at {place})"
        )
    apart = np.linalg.norm(one.points - other.points, axis=-1).ravel()
    return Misfit(4, float(apart.max()), f"control points are {_at(apart, one.points.reshape(-1, 3))}") if apart.max() > near else None


def _at(apart: FloatArray, points: FloatArray) -> str:
    """How far apart points are, and where most."""
    return f"up to {apart.max():.3g} apart (at {', '.join(f'{x:g}' for x in points[np.argmax(apart)])})"


def _of_directions(one: Direction, other: Direction, names: tuple[str, str], along: tuple[str, str], alike: float) -> str:
    """What is different between two directions; empty: nothing."""
    for word, of_one, of_other in (
        ("family {}", one.family, other.family),
        ("order {}", one.order, other.order),
        ("{} elements", one.elements, other.elements),
        ("{} control points", one.count, other.count),
    ):
        if of_one != of_other:
            return f"{names[0]} has {word.format(of_one)} along {along[0]}, {names[1]} {word.format(of_other)} along {along[1]}"
    first, second = ((d.knots - d.knots[0]) / (d.knots[-1] - d.knots[0]) for d in (one, other))
    differ = float(abs(first - second).max())
    words = f"knots of {names[0]} along {along[0]} and those of {names[1]} along {along[1]} differ by up to {differ:.3g} of their range"
    return words if differ > alike else ""
