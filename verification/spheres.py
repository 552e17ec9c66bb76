"""Bodies with a spherical or cylindrical underside for contact as Hertz's: exact, graded towards the contact at the origin.

All come from the stereographic image of the plane, which rational functions of order 2 hold exactly. Their columns are vertical up to a
flat top. Order 1 can not hold a sphere: its control points lie on it, as those of Lagrange elements do.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline

from isomortar.geometry.patch import Direction, Family, FloatArray, Patch

_LINE = Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))
#: A quarter of a circle, as the control points and weights of one element.
_QUARTER = Direction("N", 2, np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0]))
_QUARTER_POINTS = np.array([[1.0, 0.0, 1.0], [np.sqrt(0.5), np.sqrt(0.5), np.sqrt(0.5)], [0.0, 1.0, 1.0]])


@dataclass(frozen=True)
class Cap:
    """A body with a spherical underside, and its elements.

    Parameters
    ----------
    radius, width, height : float
        Of the sphere or cylinder; of the body, in the plane that is projected from; of its top.
    fine : float
        Extent of the uniform elements around the axis, and about half of their depth.
    elements, growing : int
        Uniform elements over `fine`; elements beyond, each longer than the one before by the same factor.
    """

    radius: float
    width: float
    height: float
    fine: float
    elements: int
    growing: int

    def revolved(self, kind: str, below: bool = False) -> Patch:
        """A quarter of a body of revolution; u, v, w run along radius, angle (one exact element) and height.

        Radial functions are as many control points round the axis, so that a solution with that symmetry costs as in the plane.
        """
        radial, upward = self._radial(kind), self._upward(kind, below)
        grid = np.einsum("ab,jc->abjc", np.ones((radial.count, upward.count)), np.ones((3, 4)))
        s, t = np.meshgrid(radial.greville, self._share(upward, below), indexing="ij")
        x, _, z, weight = self._column(s, 0.0 * s, t)
        cosine, sine, arc = _QUARTER_POINTS.T
        for component, values in enumerate((np.multiply.outer(x, cosine), np.multiply.outer(x, sine))):
            grid[..., component] = values
        grid[..., 2], grid[..., 3] = np.multiply.outer(-z if below else z, arc), np.multiply.outer(weight, arc)
        return fitted((radial, _QUARTER, upward), np.moveaxis(grid, 2, 1), (0, 2))

    def block(self, kind: str, below: bool = False, half: bool = False) -> Patch:
        """The body over the square -width <= x, y <= width, or its half above y = 0; u, v, w run along x, y, z. Nowhere singular."""
        across, upward = self._across(kind), self._upward(kind, below)
        beside = self._radial(kind) if half else across
        x, y, z, weight = self._column(*np.meshgrid(across.greville, beside.greville, self._share(upward, below), indexing="ij"))
        return fitted((across, beside, upward), np.stack([x, y, -z if below else z, weight], axis=-1), (0, 1, 2))

    def cylinder(self, kind: str, length: float, below: bool = False) -> Patch:
        """The body over -width <= x <= width with a cylinder about the y-axis in place of the sphere, one element long."""
        across, upward = self._across(kind), self._upward(kind, below)
        s, t = np.meshgrid(across.greville, self._share(upward, below), indexing="ij")
        x, y, z, weight = self._column(s, 0.0 * s, t)
        ends = [np.stack([x, y + end * weight, -z if below else z, weight], axis=-1) for end in (0.0, length)]
        return fitted((across, _LINE, upward), np.stack(ends, axis=1), (0, 2))

    def _across(self, kind: str) -> Direction:
        along = graded(self.width, self.fine, self.elements, self.growing)
        return direction(kind, np.concatenate([-along[:0:-1], along]))

    def _radial(self, kind: str) -> Direction:
        return direction(kind, graded(self.width, self.fine, self.elements, self.growing))

    def _upward(self, kind: str, below: bool) -> Direction:
        depth = graded(1.0, self.fine / self.height, self.elements // 2, self.growing)
        return direction(kind, 1.0 - depth[::-1] if below else depth)

    def _share(self, upward: Direction, below: bool) -> FloatArray:
        """Shares of the way from the sphere to the top; a body below the plane is the mirror image with its top first."""
        return 1.0 - upward.greville if below else upward.greville

    def _column(self, x: FloatArray, y: FloatArray, t: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Weighted coordinates and weights over points of the plane, a share t of the way from the sphere to the top."""
        square, scale = x**2 + y**2, 4.0 * self.radius**2
        weight = 1.0 + square / scale
        return x, y, (1.0 - t) * 2.0 * self.radius * square / scale + t * self.height * weight, weight


def graded(length: float, fine: float, elements: int, growing: int) -> FloatArray:
    """Element boundaries from 0 to `length`: equal ones up to `fine`, then in geometric progression."""
    step = fine / elements
    low, high = 1.0, 1e3
    for _ in range(60):  # halving of the factor's logarithm
        factor = np.sqrt(low * high)
        beyond = fine + step * np.cumsum(factor ** np.arange(1, growing + 1))
        low, high = (factor, high) if beyond[-1] < length else (low, factor)
    beyond[-1] = length
    return np.concatenate([np.linspace(0.0, fine, elements + 1), beyond])


def direction(kind: str, boundaries: FloatArray) -> Direction:
    """Direction of a discretisation with the given element boundaries."""
    family: Family = "L" if kind[0] == "L" else "N"
    order = int(kind[1:])
    ends = (order if family == "N" else 0,) * 2
    return Direction(family, order, np.pad(boundaries, ends, mode="edge"))


def fitted(directions: tuple[Direction, Direction, Direction], grid: FloatArray, axes: Sequence[int]) -> Patch:
    """Patch through weighted points and weights, shape (n1, n2, n3, 4), given at the nodes of some axes, coefficients of the others.

    B-splines of order 2 and more reproduce polynomials up to their order; order 1 and Lagrange elements take the points themselves.
    """
    exact = [axis for axis in axes if directions[axis].family == "N" and directions[axis].order > 1]
    for axis in exact:
        line = directions[axis]
        matrix = BSpline.design_matrix(line.greville, line.knots, line.order).toarray()
        grid = np.moveaxis(np.tensordot(np.linalg.inv(matrix), grid, axes=(1, axis)), 0, axis)
    weights = grid[..., 3]
    points = (grid[..., :3] / weights[..., None]).reshape((-1, 3), order="F")
    # Where points are interpolated only the ratios of the weights along the other axes mean anything.
    first = tuple(slice(None) if axis in axes and axis not in exact else slice(0, 1) for axis in range(3))
    return Patch(directions, points, (weights / weights[first]).ravel(order="F"))
