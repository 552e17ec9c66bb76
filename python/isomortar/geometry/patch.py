"""Volume patches: tensor products of three directions, each NURBS (``N``) or nodal Lagrange (``L``)."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property, reduce
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from isomortar._frozen import frozen
from isomortar.errors import InputError

Family = Literal["N", "L"]
#: Directions in which a body meets itself: one, or two of a torus.
Closed = Literal["u", "v", "w", "uv", "uw", "vw"]
FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int32]

#: Largest orders that the kernel evaluates, by family.
MAX_ORDER: dict[Family, int] = {"N": 10, "L": 4}

#: Faces of a patch: first and last parametric value of direction u, v, w.
FACES = ("u0", "u1", "v0", "v1", "w0", "w1")

#: Knots and weights within this power of two of one are taken as they are.
_USUAL = 64
#: Share of the heaviest control point's weight below which one moves nothing but itself: its functions are round-off of the others.
_LIGHTEST = float(np.finfo(np.float64).eps)
#: Share of a direction's range below which no knot span may be: seen from the other end (`Direction.reversed`) it would be none.
_SHORTEST = float(np.finfo(np.float64).eps)


def _usual(values: ArrayLike) -> FloatArray:
    """Values of which ratios alone count, of a usual size: those far from it are divided by a power of two, which changes no bit."""
    array = np.ascontiguousarray(values, dtype=np.float64)
    power = int(np.frexp(np.max(np.abs(array), initial=0.0))[1])
    return np.ldexp(array, -power) if abs(power) > _USUAL else array


def opposite(face: str) -> str:
    """The face at the other end of the same direction."""
    return face[0] + "10"[int(face[1])]


@frozen
class Direction:
    """One parametric direction of a patch.

    Parameters
    ----------
    family : {"N", "L"}
        B-spline (rational with the patch's weights), or nodal Lagrange between element boundaries.
    order : int
        Polynomial order.
    knots : ndarray, shape (k,)
        ``N``: the full open knot vector. ``L``: the element boundaries; each element has ``order + 1``
        equally spaced nodes and shares one with its neighbour. In any unit: where the largest is beyond 2^64, or below
        2^-64, they are divided by a power of two.

    Raises
    ------
    InputError
        Knots not sorted or not finite, wrong multiplicity, order out of range.
    """

    family: Family
    order: int
    knots: FloatArray

    def __post_init__(self) -> None:
        knots = _usual(self.knots)
        object.__setattr__(self, "knots", knots)
        if self.family not in MAX_ORDER:
            raise InputError(f"family is {self.family!r}; allowed: 'N' (NURBS), 'L' (Lagrange)", "family")
        if not 1 <= self.order <= MAX_ORDER[self.family]:
            raise InputError(f"order is {self.order}; allowed for {self.family}: 1 to {MAX_ORDER[self.family]}", "order")
        if knots.ndim != 1 or not np.all(np.isfinite(knots)):
            raise InputError("must be one list of finite numbers", "knots")
        if self.family == "N":
            self._check_open_knot_vector(knots)
        elif len(knots) < 2 or np.any(np.diff(knots) <= 0):
            raise InputError("element boundaries of a Lagrange direction must increase strictly (at least two)", "knots")
        spans = np.diff(self.boundaries)
        if spans.min() < _SHORTEST * spans.sum():
            share = f"{spans.min() / spans.sum():.3g}"
            raise InputError(
                f"has a knot span of {share} of its range; allowed: {_SHORTEST:.2g} or more, for double precision, or the same knot",
                "knots",
            )

    def _check_open_knot_vector(self, knots: FloatArray) -> None:
        p = self.order
        if len(knots) < 2 * (p + 1):
            raise InputError(f"has {len(knots)} values; order {p} needs at least {2 * (p + 1)}", "knots")
        if np.any(np.diff(knots) < 0):
            where = int(np.argmax(np.diff(knots) < 0)) + 1
            raise InputError(f"must not decrease, but value {where} ({knots[where]:g}) is below the one before it", "knots")
        if any(np.count_nonzero(knots == end) != p + 1 for end in (knots[0], knots[-1])):
            raise InputError(f"must be open: first and last value repeated order + 1 = {p + 1} times", "knots")
        _, multiplicity = np.unique(knots[p + 1 : -p - 1], return_counts=True)
        if np.any(multiplicity > p):
            raise InputError(f"an inner knot is repeated more than order = {p} times: the body would come apart there", "knots")

    @property
    def count(self) -> int:
        """Number of control points along the direction."""
        return len(self.knots) - self.order - 1 if self.family == "N" else self.order * (len(self.knots) - 1) + 1

    @cached_property
    def boundaries(self) -> FloatArray:
        """Element boundaries: the distinct knots, shape (elements + 1,)."""
        return self.knots[np.append(True, np.diff(self.knots) > 0.0)]

    @property
    def elements(self) -> int:
        """Number of elements: non-empty knot spans."""
        return len(self.boundaries) - 1

    @property
    def c0_lines(self) -> FloatArray:
        """Boundaries between elements where functions are only continuous (theory 2.9), shape (lines,)."""
        return self.boundaries[1:-1][np.diff(self.first_points) >= self.order]

    @property
    def kinks(self) -> bool:
        """Whether there are C0 lines."""
        return len(self.c0_lines) > 0

    @property
    def first_points(self) -> NDArray[np.intp]:
        """Number of the first control point of each element, which has `order + 1` of them, shape (elements,)."""
        if self.family == "L":
            return np.arange(self.elements) * self.order
        return np.flatnonzero(np.diff(self.knots) > 0) - self.order

    @property
    def greville(self) -> FloatArray:
        """Where each function belongs, shape (count,): means of its inner knots (Greville's abscissae), or its node."""
        if self.family == "L":
            return self.subdivided(self.order)
        return np.array([self.knots[i + 1 : i + self.order + 1].mean() for i in range(self.count)])

    def reversed(self) -> Direction:
        """The same direction, run through from its end."""
        return Direction(self.family, self.order, self.knots[0] + self.knots[-1] - self.knots[::-1])

    def subdivided(self, parts: int) -> FloatArray:
        """Element boundaries of elements cut into equal parts each, shape (parts * elements + 1,)."""
        inside = self.boundaries[:-1, None] + np.diff(self.boundaries)[:, None] * (np.arange(parts) / parts)
        return np.append(inside, self.boundaries[-1])


@frozen
class Patch:
    """A volume patch.

    Parameters
    ----------
    directions : tuple of three Direction
    control_points : ndarray, shape (n1*n2*n3, 3)
        First direction fastest: number = i1 + n1 (i2 + n2 i3). Lengths in the unit of the scene.
    weights : ndarray, shape (n1*n2*n3,)
        Positive, same numbering; not multiplied into the control points. In any unit, as knots are.

    Raises
    ------
    InputError
        Wrong counts, NaN, weights that are not positive, or too light to count beside the others.
    """

    directions: tuple[Direction, Direction, Direction]
    control_points: FloatArray
    weights: FloatArray

    def __post_init__(self) -> None:
        points = np.ascontiguousarray(self.control_points, dtype=np.float64)
        weights = _usual(self.weights)
        object.__setattr__(self, "control_points", points)
        object.__setattr__(self, "weights", weights)
        wanted = int(np.prod(self.shape))
        shape = " x ".join(str(n) for n in self.shape)
        if points.shape != (wanted, 3):
            message = f"shape is {points.shape}; knots and orders ask for {shape} = {wanted} points of 3 coordinates"
            raise InputError(message, "control_points")
        if weights.shape != (wanted,):
            raise InputError(f"has {weights.size} values; knots and orders ask for {shape} = {wanted}", "weights")
        if not np.all(np.isfinite(points)):
            raise InputError(f"point {int(np.argmin(np.isfinite(points).all(axis=1)))} is not finite", "control_points")
        if not np.all(np.isfinite(weights) & (weights > 0)):
            where = int(np.argmin(np.isfinite(weights) & (weights > 0)))
            raise InputError(f"weight {where} is {weights[where]:g}; weights must be positive and finite", "weights")
        if weights.min() < _LIGHTEST * weights.max():
            where, share = int(np.argmin(weights)), weights.min() / weights.max()
            message = f"weight {where} is {share:.1e} of the largest; allowed: {_LIGHTEST:.1e} of it or more, for double precision"
            raise InputError(message, "weights")

    @property
    def shape(self) -> tuple[int, int, int]:
        """Numbers of control points by direction."""
        return self.directions[0].count, self.directions[1].count, self.directions[2].count

    def face_points(self, face: str) -> IntArray:
        """Numbers of the control points on a face.

        The surface coordinates of a face are the two other directions in cyclic order
        (w: (u, v); v: (w, u); u: (v, w)); the first of them runs fastest.

        Returns
        -------
        ndarray of int32, shape (m1*m2,)
        """
        axis, end = "uvw".index(face[0]), int(face[1])
        numbers = np.arange(np.prod(self.shape), dtype=np.int32).reshape(self.shape, order="F")
        layer = np.take(numbers, 0 if end == 0 else -1, axis=axis)
        if face[0] == "v":  # the two others in cyclic order are (w, u), np.take leaves (u, w)
            layer = layer.T
        return layer.ravel(order="F")

    def common_points(self, faces: Iterable[str]) -> IntArray:
        """Numbers of the control points that are on all of some faces, ascending: of a face, an edge or a corner."""
        return reduce(np.intersect1d, map(self.face_points, faces), np.arange(np.prod(self.shape), dtype=np.int32))

    def face_directions(self, face: str) -> tuple[Direction, Direction]:
        """The two surface directions of a face, in the order of its surface coordinates."""
        axis = "uvw".index(face[0])
        return self.directions[(axis + 1) % 3], self.directions[(axis + 2) % 3]
