"""What acts on a body, on the same body of a higher order: loads anew, and forces as what is spread along it, or at an end."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray, Patch
from isomortar.geometry.refinement import homogeneous
from isomortar.geometry.splines import Spline
from isomortar.model.entities import Body, Face, Problem
from isomortar.model.glue import shared_directions
from isomortar.model.loads import Loads
from isomortar.model.numbering import Numbering
from isomortar.model.supports import BoolArray
from isomortar.solve.equilibrium import Equilibrium
from isomortar.told.during.acting import Acting
from isomortar.told.during.raising import Finer, along_axis, raised

#: Length of a difference over a direction's, by which its lines' speed is found: what curves within it and round-off are below 1e-6.
STEP = 1e-5


@frozen
class AtEnds:
    """Ends of a body's directions across which something acts, by component, each shape (3, 2, 3): it acts on no other points.

    Attributes
    ----------
    contact, held : ndarray of bool
        Contact on the faces there, and supports of faces, edges and corners. What they exert on another face is spread along that.
    """

    contact: BoolArray
    held: BoolArray


def carried(before: Body, acts: Acting, along: Sequence[int], more: Finer, at_ends: AtEnds) -> FloatArray:
    """Forces of contact and supports on a body's patch as those on the one of a higher order, but for loads (theory 9.23)."""
    patch, contact, held = before.patch, acts.contact, acts.held
    for axis in along:
        matrix, finer = raised(patch, axis, more)
        spread = _spreading(matrix, _masses(finer, axis), "uvw"[axis] in (before.closed or ""))
        contact = _on_finer(contact, spread, at_ends.contact[axis], patch, finer, axis)
        held, patch = _on_finer(held, spread, at_ends.held[axis], patch, finer, axis), finer
    return contact + held


def _on_finer(forces: FloatArray, spread: FloatArray, stays: BoolArray, before: Patch, after: Patch, along: int) -> FloatArray:
    """Forces on a finer patch: spread along a direction but for the components that stay at its ends, shape (2, 3)."""
    found = []
    for component in range(3):
        matrix = spread.copy()
        for end in np.flatnonzero(stays[:, component]):
            matrix[:, -end] = np.eye(len(matrix))[:, -end]
        found.append(_on(matrix, before, after, along, forces[:, component : component + 1]))
    return np.hstack(found)


def at_ends(problem: Problem, stage: int, piece: Sequence[Body], body: Body) -> AtEnds:
    """What acts at ends of a body's directions in a stage; of what is glued to the body it may be either end.

    On a body of two orders what keeps the lower one, which may be anywhere, is not told from supports.
    """
    held = np.full((3, 2, 3), body.raised is not None)
    names, contact = {one.name for one in piece}, np.zeros_like(held)
    for support in problem.supports:
        if support.place.body in names and support.holds(stage):
            components = range(3) if support.moment is not None else support.carried
            for name in support.place.meeting:
                axes, ends = _ends(problem, body, Face(support.place.body, name))
                held[np.ix_(axes, ends, list(components))] = True
    sides = [side for pair in problem.contacts for side in (pair.slave, pair.master) if isinstance(side, Face)]
    for face in (face for side in sides for face in side.faces if face.body in names):
        axes, ends = _ends(problem, body, face)
        contact[np.ix_(axes, ends)] = True
    return AtEnds(contact, held)


def _ends(problem: Problem, body: Body, face: Face) -> tuple[list[int], list[int]]:
    """Directions of a body that go across a face, of it or of what is glued to it, and at which of their ends the face is."""
    places = next(places for places in shared_directions(problem) if (face.body, face.face[0]) in places)
    return ["uvw".index(letter) for name, letter in places if name == body.name], [int(face.face[1])] if face.body == body.name else [0, 1]


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
