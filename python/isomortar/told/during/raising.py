"""Bodies of a higher order along some directions, and what acts on them then: loads anew, and forces as what is spread, or at an end."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.elevation import elevated
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.geometry.refinement import homogeneous
from isomortar.geometry.splines import Spline
from isomortar.model.entities import Body, Problem
from isomortar.model.loads import Loads
from isomortar.model.numbering import Numbering
from isomortar.solve.equilibrium import Equilibrium
from isomortar.told.during.acting import Acting

#: Length of a difference over a direction's, by which its lines' speed is found: what curves within it and round-off are below 1e-6.
STEP = 1e-5


@frozen
class Finer:
    """How many orders more a body is of, and whether each of its elements is two."""

    orders: int
    halves: bool

    def blocks(self, body: Body, along: Sequence[int]) -> int:
        """Entries of the stiffness of a body, 3 x 3 each, that is finer along some directions, but for its ends: it has no more."""
        points, couplings = 1, 1
        for axis, direction in enumerate(body.patch.directions):
            finer = axis in along
            points *= direction.count + finer * (self.orders + self.halves) * direction.elements
            couplings *= 2 * (direction.order + finer * self.orders) + 1
        return points * couplings


def raised_body(body: Body, along: Sequence[int], more: Finer) -> Body:
    """A body whose order along some directions is higher by so many, of the same shape."""
    for axis in along:
        points = tuple(count + more.orders * (k == axis) for k, count in enumerate(body.quadrature))
        body = replace(body, patch=raised(body.patch, axis, more)[1], quadrature=(points[0], points[1], points[2]))
    return body


def raised_forces(before: Body, acts: Acting, along: Sequence[int], more: Finer) -> FloatArray:
    """Forces of contact and supports on a body's patch as those on the one of a higher order, but for loads (theory 9.23)."""
    patch, contact, held = before.patch, acts.contact, acts.held
    for axis in along:
        matrix, finer = raised(patch, axis, more)
        spread = _spreading(matrix, _masses(finer, axis), "uvw"[axis] in (before.closed or ""))
        at_ends = spread.copy()
        for end in (0, -1):  # what supports exert on the faces there acts on no others
            at_ends[:, end] = np.eye(len(matrix))[:, end]
        contact, held = _on(spread, patch, finer, axis, contact), _on(at_ends, patch, finer, axis, held)
        patch = finer
    return contact + held


def loads_on(problem: Problem, bodies: Sequence[Body], now: Equilibrium, time: float) -> FloatArray:
    """Forces of loads on bodies, which are others than they are given as, where these are now, shape (control points, 3).

    Parameters
    ----------
    problem : Problem
    bodies : sequence of Body
        As loads are given on them: free of strain.
    now : Equilibrium
        Of the same bodies, where they are.
    time : float
    """
    names = {body.name for body in bodies}
    own = replace(problem, bodies=tuple(bodies), glue=now.problem.glue, loads=tuple(load for load in problem.loads if load.body in names))
    numbering = Numbering(own)
    return np.asarray(sum(Loads(own, numbering).forces(now.numbering.reference + now.origin, time), np.zeros_like(numbering.reference)))


def raised(patch: Patch, along: int, more: Finer) -> tuple[FloatArray, Patch]:
    """What control values along a direction become if that is finer, and the finer patch; where elements meet it is as smooth as it was."""
    direction = patch.directions[along]
    matrix: FloatArray = np.eye(direction.count)
    if direction.family == "L":
        nodes = direction.greville
        knots = np.repeat(direction.boundaries, direction.order)
        direction = Direction("N", direction.order, np.concatenate([knots[:1], knots, knots[-1:]]))
        matrix = np.asarray(np.linalg.inv(Spline([direction], matrix).evaluate(nodes[:, None])))
    for _ in range(more.orders):
        direction, matrix = elevated(direction, matrix, 0)
    if more.halves:
        spline = Spline([direction], matrix)
        spline.insert(0, 0.5 * (direction.boundaries[1:] + direction.boundaries[:-1]))
        direction, matrix = Direction("N", direction.order, spline.knots[0]), spline.control_points
    grid = _along(matrix, homogeneous(patch), along)
    u, v, w = (direction if axis == along else own for axis, own in enumerate(patch.directions))
    flat = grid.reshape(-1, 4, order="F")
    return matrix, Patch((u, v, w), flat[:, :3] / flat[:, 3:], flat[:, 3])


def _along(matrix: FloatArray, grid: FloatArray, along: int) -> FloatArray:
    """A matrix times a grid of values along a direction."""
    return np.moveaxis(np.tensordot(matrix, grid, (1, along)), 0, along)


def _on(matrix: FloatArray, before: Patch, after: Patch, along: int, forces: FloatArray) -> FloatArray:
    """Forces on a patch by those on the patch before and a matrix between those of a line (theory 9.23)."""
    grid = (forces / before.weights[:, None]).reshape((*before.shape, 3), order="F")
    return np.asarray(_along(matrix, grid, along).reshape(-1, 3, order="F") * after.weights[:, None])


def _spreading(matrix: FloatArray, masses: FloatArray, closes: bool) -> FloatArray:
    """Forces of a higher order along a line by those of the lower one, as of tractions that are made of its functions (theory 9.23).

    Parameters
    ----------
    matrix : ndarray, shape (functions of the higher order, functions)
        What control values become.
    masses : ndarray, shape (functions of the higher order, as many)
    closes : bool
        Whether the line's ends are one, and forces there on the first.
    """
    count, finer = matrix.shape[1] - closes, len(matrix) - closes
    lower, higher = np.eye(count), np.eye(finer)
    if closes:
        lower, higher = np.vstack([lower, lower[:1]]), np.vstack([higher, higher[:1]])
    to, products = (matrix @ lower)[:finer], higher.T @ masses @ higher
    found = np.zeros(matrix.shape)
    found[:finer, :count] = products @ to @ np.linalg.inv(to.T @ products @ to)
    return found


def _masses(patch: Patch, along: int) -> FloatArray:
    """Integrals of products of a direction's functions over the length of a patch's mean line; rational ones but for their weights."""
    direction = patch.directions[along]
    points, shares = np.polynomial.legendre.leggauss(direction.order + 1)
    starts, lengths = direction.boundaries[:-1], np.diff(direction.boundaries)
    at = (starts[:, None] + 0.5 * lengths[:, None] * (points + 1.0)).ravel()
    values = Spline([direction], np.eye(direction.count)).evaluate(at[:, None])
    near = STEP * float(lengths.sum())
    line = np.moveaxis(homogeneous(patch), along, 0).reshape(direction.count, -1, 4).mean(axis=1)
    before, after = (Spline([direction], line).evaluate((at + side * near)[:, None]) for side in (-0.5, 0.5))
    speeds = np.linalg.norm(after[:, :3] / after[:, 3:] - before[:, :3] / before[:, 3:], axis=1)
    measure = speeds / (values @ line[:, 3]) ** 2 * (lengths[:, None] * shares).ravel()
    return np.asarray(values.T @ (values * measure[:, None]))
