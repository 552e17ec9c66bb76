"""What acts on a body, on the same body of a higher order: loads anew, and forces as what is spread along it, or at an end."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from isomortar.geometry.patch import FloatArray, Patch
from isomortar.geometry.refinement import homogeneous
from isomortar.geometry.splines import Spline
from isomortar.model.entities import Body, Problem
from isomortar.model.glue import shared_directions
from isomortar.model.loads import Loads
from isomortar.model.numbering import Numbering
from isomortar.model.supports import BoolArray
from isomortar.solve.equilibrium import Equilibrium
from isomortar.told.during.acting import Acting
from isomortar.told.during.raising import Finer, along_axis, raised

#: Length of a difference over a direction's, by which its lines' speed is found: what curves within it and round-off are below 1e-6.
STEP = 1e-5


def carried(before: Body, acts: Acting, along: Sequence[int], more: Finer, at_ends: BoolArray) -> FloatArray:
    """Forces of contact and supports on a body's patch as those on the one of a higher order, but for loads (theory 9.23).

    Parameters
    ----------
    before : Body
    acts : Acting
    along : sequence of int
        Numbers of the directions.
    more : Finer
    at_ends : ndarray of bool, shape (3, 2, 3)
        What supports exert that stays at the two ends of each direction, by component: `held_at_ends`.
    """
    patch, contact, held = before.patch, acts.contact, acts.held
    for axis in along:
        matrix, finer = raised(patch, axis, more)
        spread = _spreading(matrix, _masses(finer, axis), "uvw"[axis] in (before.closed or ""))
        by_component = []
        for component in range(3):
            kept = spread.copy()
            for end in np.flatnonzero(at_ends[axis, :, component]):
                kept[:, -end] = np.eye(len(matrix))[:, -end]
            by_component.append(_on(kept, patch, finer, axis, held[:, component : component + 1]))
        contact, held, patch = _on(spread, patch, finer, axis, contact), np.hstack(by_component), finer
    return contact + held


def held_at_ends(problem: Problem, stage: int, piece: Sequence[Body], body: Body) -> BoolArray:
    """Ends of a body's directions at which supports of faces, edges and corners there act, by component, shape (3, 2, 3).

    What a support exerts on a face is spread along that, and acts on no other points than those of the face. Of what is glued to the
    body it may be either end. On a body of two orders what keeps the lower one is not told from supports.
    """
    found = np.full((3, 2, 3), body.raised is not None)
    names = {one.name for one in piece}
    for support in problem.supports:
        for face in support.place.meeting if support.place.body in names and support.holds(stage) else ():
            places = next(places for places in shared_directions(problem) if (support.place.body, face[0]) in places)
            for letter in (letter for name, letter in places if name == body.name):
                ends = [int(face[1])] if support.place.body == body.name else [0, 1]
                components = range(3) if support.moment is not None else support.carried
                found[np.ix_(["uvw".index(letter)], ends, list(components))] = True
    return found


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


def _on(matrix: FloatArray, before: Patch, after: Patch, along: int, forces: FloatArray) -> FloatArray:
    """Forces, some of their components, on a patch by those on the patch before and a matrix between those of a line (theory 9.23)."""
    count = forces.shape[1]
    grid = (forces / before.weights[:, None]).reshape((*before.shape, count), order="F")
    return np.asarray(along_axis(matrix, grid, along).reshape(-1, count, order="F") * after.weights[:, None])


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
