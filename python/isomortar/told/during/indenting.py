"""How much further contact would press its bodies in, were their elements short where it is: what these keep back."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from isomortar._bindings import surface_functions
from isomortar.errors import InputError, KernelError
from isomortar.geometry.patch import FloatArray, opposite
from isomortar.model.contrasts import element_lengths
from isomortar.model.enforcement.face import SlaveFace
from isomortar.model.entities import Body, Face, Motion, Problem, Support
from isomortar.model.pairs import Pair
from isomortar.model.sheet import Sheet
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.timing import Ledger
from isomortar.told.during.extent import extent, mirrored_ends
from isomortar.told.during.giving_way import deformed_by
from isomortar.told.during.normal_forces import normal_forces
from isomortar.told.during.raising import finer

#: Elements are cut until they are shorter than the contact's width over so many, and beside it than so much of how far away they are, too.
PARTS, GROWS = 3.0, 0.7
#: Share of the shortest element that a contact is taken to be wide at the least: forces at single points have no width.
NARROWEST = 0.25
#: Entries of the stiffness of a body so cut, blocks of 3 x 3, up to which it is computed: that takes about a second.
MOST = 800_000


def further(equilibrium: Equilibrium, balance: Balance, number: int, places: Sequence[tuple[Face, FloatArray]]) -> FloatArray:
    """How much further a contact would press in its sides by short elements, in the mean over its force (theory 9.26).

    Parameters
    ----------
    equilibrium : Equilibrium
    balance : Balance
    number : int
        Of the contact.
    places : sequence of Face and ndarray, shape (points, 2)
        Its sides, with coordinates of the slave's quadrature points, or of their feet.

    Returns
    -------
    ndarray, shape (sides,)
        Not a number of what is not known: of sides of several faces, of bodies that are too large for it, or folded.
    """
    forces = normal_forces(equilibrium, balance, number)[0]
    acting = np.any(forces != 0.0, axis=1)
    gone = [_further(equilibrium, balance, place, at[acting], forces[acting]) for place, at in places]
    return np.array(gone) / float(np.linalg.norm(forces, axis=1).sum())


def coordinates_of_slave(pair: Pair, equilibrium: Equilibrium) -> FloatArray:
    """Surface coordinates of a slave's quadrature points, shape (points, 2).

    Functions that are not rational make them of Greville's abscissae; rational ones do so of these over the weights.
    """
    face = SlaveFace(pair.contact, equilibrium.problem, equilibrium.numbering)
    sheet = Sheet.of(equilibrium.problem, pair.contact.slave)
    weights = np.ones(len(face.point))
    weights[face.within] = sheet.patch.weights[sheet.patch.face_points(sheet.face)]
    nodes, (first, second) = pair.slave.shape.nodes, sheet.directions
    places = face.control_places[nodes]
    by_node = places.reshape(len(nodes), second.order + 1, first.order + 1, 2)
    for axis, line in enumerate((by_node[..., 0], np.swapaxes(by_node[..., 1], 1, 2))):
        if sheet.closed[axis]:  # control points on a seam, which begin the face, end its last elements
            line[..., -1][line[..., -1] <= line[..., 0]] = sheet.directions[axis].boundaries[-1]
    by_point = (np.repeat(of, pair.slave.per_element, axis=0) for of in (places, weights[nodes]))
    (of_points, of_weights), values = by_point, pair.slave.shape.values
    shares = values / of_weights
    found = np.einsum("qa,qai->qi", shares, of_points) / shares.sum(axis=1)[:, None]
    bounds = np.array([direction.boundaries[[0, -1]] for direction in sheet.directions])
    return np.clip(found, bounds[:, 0], bounds[:, 1])


def _further(equilibrium: Equilibrium, balance: Balance, place: Face, at: FloatArray, forces: FloatArray) -> float:
    """Work that forces at coordinates of a face would do more by elements that are short where these are."""
    problem, body = equilibrium.problem, equilibrium.problem.body(place.body)
    if body.rigid:
        return 0.0
    if len(place.faces) > 1 or body.raised:
        return np.nan
    own = equilibrium.numbering.of_patch(body.name, balance.positions)
    as_it_is = replace(body, patch=replace(body.patch, control_points=own))
    cut = cut_under(problem, as_it_is, place, at, np.linalg.norm(forces, axis=1))
    if math.prod(d.count * (2 * d.order + 1) - d.order * (d.order + 1) for d in cut.patch.directions) > MOST:
        return np.nan
    try:
        was, would = (_work(problem, one, place, at, forces) for one in (as_it_is, cut))
    except (InputError, KernelError):
        return np.nan
    return max(0.0, would - was)


def cut_under(problem: Problem, body: Body, place: Face, at: FloatArray, forces: FloatArray) -> Body:
    """A body whose elements are short where forces, shape (k,), are on a face of it, at coordinates of that, shape (k, 2)."""
    sheet, share, patch = Sheet.of(problem, place), forces / forces.sum(), body.patch
    ends = [np.append(0.0, np.cumsum(lengths)) for lengths in element_lengths(patch)]
    narrowest = np.inf
    mirrors = mirrored_ends(problem, place, sheet.letters)
    for letter, direction, closed, mirror, places in zip(sheet.letters, sheet.directions, sheet.closed, mirrors, at.T, strict=True):
        axis = "uvw".index(letter)
        middle, width = extent(places, share, direction.boundaries, ends[axis], closed, mirror)
        width = max(width, NARROWEST * float(np.diff(ends[axis]).min()))
        where = (middle - 0.5 * width, middle + 0.5 * width)
        patch = finer(patch, axis, 0, cuts(direction.boundaries, ends[axis], where, width, closed))[1]
        narrowest = min(narrowest, width)
    axis = "uvw".index(place.face[0])
    surface = float(ends[axis][-int(place.face[1])])
    across = cuts(patch.directions[axis].boundaries, ends[axis], (surface, surface), narrowest, False)
    return replace(body, patch=finer(patch, axis, 0, across)[1])


def cuts(bounds: FloatArray, ends: FloatArray, where: tuple[float, float], width: float, closed: bool) -> FloatArray:
    """Parameters at which elements with bounds are cut, whose ends are at lengths, so that they are short from one of these to another."""
    found, todo = list[float](), [(a, b) for a, b in pairwise(bounds)]
    while todo:
        low, high = todo.pop()
        start, end = np.interp([low, high], bounds, ends)
        shifts = (-ends[-1], 0.0, ends[-1]) if closed else (0.0,)
        away = min(max(0.0, where[0] + shift - end, start - where[1] - shift) for shift in shifts)
        if end - start > width / PARTS + GROWS * away:
            middle = 0.5 * (low + high)
            found.append(middle)
            todo += [(low, middle), (middle, high)]
    return np.array(sorted(found))


def _work(problem: Problem, body: Body, place: Face, at: FloatArray, forces: FloatArray) -> float:
    """Work of forces at coordinates of a face of a body that is free of strain and held at the opposite face, and on planes of symmetry."""
    still = tuple(Motion() for _ in problem.stages)
    held = Support("opposite", Face(body.name, opposite(place.face)), still)
    mirrors = tuple(s for s in problem.supports if s not in problem.given_supports and s.place.body == body.name)
    alone = replace(problem, bodies=(body,), contacts=(), glue=(), loads=(), supports=(held, *mirrors))
    of = Equilibrium(alone, Ledger())
    sheet = Sheet.of(alone, place)
    nodes, functions = surface_functions(*sheet.arrays(of.numbering), np.ascontiguousarray(at))
    points = sheet.points(of.numbering)[sheet.patch.face_points(sheet.face)]
    on_points = np.zeros_like(of.numbering.reference)
    np.add.at(on_points, points[nodes], functions[:, 0, :, None] * forces[:, None, :])
    return float(np.sum(on_points * deformed_by(on_points, of, of.numbering.reference)))
