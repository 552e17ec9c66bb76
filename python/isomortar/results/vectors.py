"""Slip and friction of a slave face as vectors in space (theory 8.6)."""

from __future__ import annotations

import numpy as np

from isomortar import _bindings
from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model.enforcement import METHODS, SlaveFace
from isomortar.model.entities import Contact, Problem, RigidPlane, unit
from isomortar.model.numbering import Numbering
from isomortar.model.pairs import Pair
from isomortar.model.sheet import Sheet
from isomortar.solve.record import ContactState, StepResult


@frozen
class FootPlaces:
    """Where the slave quadrature points of a contact stand on its master: coordinates, shape (q, 2), and 1 where there is a foot, (q,)."""

    places: FloatArray
    found: IntArray


@frozen
class ContactVectors:
    """By control point of a slave face, each of shape (n, 3), zero where it is open.

    `slip`: way of the slave on the master within the load step, the mean around the control point; NaN: nobody kept where it began.
    `traction`: friction on the slave, force per area in the reference configuration.
    """

    slip: FloatArray
    traction: FloatArray


def contact_vectors(problem: Problem, result: StepResult, before: StepResult | None) -> list[ContactVectors]:
    """Those of every contact pair at the end of a load step (theory 8.6).

    Parameters
    ----------
    problem : Problem
    result : StepResult
    before : StepResult or None
        The load step before it; None where it is not kept. The first one begins at rest.
    """
    numbering, vectors = Numbering(problem), []
    for number, contact in enumerate(problem.contacts):
        pair = Pair(contact, problem, numbering)
        state, positions = result.state.contacts[number], result.state.positions
        begun = _at_rest(pair, numbering) if result.step == 1 else None if before is None else _feet(before.state.contacts[number])
        slave = SlaveFace(contact, problem, numbering)
        acts = (result.contacts[number].status > 0)[:, None]
        by_control = METHODS[contact.enforcement](slave).on_control_points
        slip = _slip(pair, problem, positions, _feet(state), begun)
        traction = -np.einsum("na,nca->nc", state.traction, _mean(pair, _dual(pair, problem, positions, _feet(state)), state.projected))
        vectors.append(ContactVectors(*(by_control(np.where(acts, values, 0.0))[slave.within] for values in (slip, traction))))
    return vectors


def _feet(state: ContactState) -> FootPlaces:
    return FootPlaces(state.projection, state.projected)


def _at_rest(pair: Pair, numbering: Numbering) -> FootPlaces:
    """Feet in the reference configuration, where slips begin (theory 3.20)."""
    count = len(pair.slave.area)
    nowhere = np.zeros((count, 2)), np.zeros(count, dtype=np.int32)
    projections = _bindings.project_points(pair.slave, pair.master, numbering.reference, *nowhere)
    return FootPlaces(projections.xi, projections.followed)


def _slip(pair: Pair, problem: Problem, positions: FloatArray, feet: FootPlaces, begun: FootPlaces | None) -> FloatArray:
    """Means of the way of the feet on the master as it is now, by constraint, shape (n, 3) (theory 8.6)."""
    if begun is None:
        return np.full((pair.slave.test.count, 3), np.nan)
    now, then = (_master_at(pair.contact, problem, positions, places)[0] for places in (feet.places, begun.places))
    return _mean(pair, now - then, feet.found * begun.found)


def _dual(pair: Pair, problem: Problem, positions: FloatArray, feet: FootPlaces) -> FloatArray:
    """Dual basis of tractions at slave quadrature points, shape (q, 3, 2); along averaged normals the slave's own (theory 8.6)."""
    if pair.contact.averaged:
        slave = pair.slave
        local = positions[slave.point][np.repeat(slave.shape.nodes, slave.per_element, axis=0)]
        tangents = np.einsum("qda,qac->qcd", slave.slopes, local)
    else:
        tangents = _master_at(pair.contact, problem, positions, feet.places)[1]
    return np.swapaxes(np.linalg.pinv(tangents), 1, 2)


def _master_at(contact: Contact, problem: Problem, positions: FloatArray, places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Points of a master at its coordinates, shape (q, 3), and tangents, shape (q, 3, 2) (theory 2.4, 3.4)."""
    if isinstance(contact.master, RigidPlane):
        return _plane_at(contact.master, places)
    sheet, numbering = Sheet.of(problem, contact.master), Numbering(problem)
    nodes, functions = _bindings.surface_functions(*sheet.arrays(numbering), np.ascontiguousarray(places))
    net = sheet.points(numbering)[sheet.patch.face_points(sheet.face)]
    point, first, second = np.einsum("qda,qac->dqc", functions[:, :3], positions[net[nodes]])
    return point, np.stack([first, second], axis=-1)


def _plane_at(plane: RigidPlane, places: FloatArray) -> tuple[FloatArray, FloatArray]:
    normal = unit(plane.normal)
    first = np.asarray(plane.tangent) - (plane.tangent @ normal) * normal
    first /= np.linalg.norm(first)
    tangents = np.stack([first, np.cross(normal, first)], axis=-1)
    return np.asarray(plane.point) + places @ tangents.T, np.broadcast_to(tangents, (len(places), 3, 2))


def _mean(pair: Pair, values: FloatArray, found: IntArray) -> FloatArray:
    """Means of values at the slave quadrature points that are found, with the constraints' weights, shape (n, ...) (theory 4.1, 8.6)."""
    test = pair.slave.test
    shares = test.values * (pair.slave.area * (found > 0))[:, None]
    nodes = np.repeat(test.nodes, pair.slave.per_element, axis=0)
    flat = np.where(found > 0, values.reshape(len(values), -1).T, 0.0).T
    weight, sums = np.zeros(test.count), np.zeros((test.count, flat.shape[1]))
    np.add.at(weight, nodes, shares)
    np.add.at(sums, nodes, shares[:, :, None] * flat[:, None, :])
    known = weight > 0.0
    return np.where(known[:, None], sums / np.where(known, weight, 1.0)[:, None], 0.0).reshape(-1, *values.shape[1:])
