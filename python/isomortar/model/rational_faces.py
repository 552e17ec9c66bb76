"""How well the points of a contact integrate the functions of its slave, where weights differ much."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import sparse

from isomortar.geometry.patch import FloatArray
from isomortar.model.enforcement.face import SlaveFace
from isomortar.model.enforcement.subcells import Subcells
from isomortar.model.entities import Contact, Problem
from isomortar.model.layers import LinePoints, in_layers, unlike
from isomortar.model.lines import functions_along, quotient
from isomortar.model.numbering import Numbering
from isomortar.model.rational import MOST_ALONG, QUADRATURE_TOLD
from isomortar.model.shares import percent
from isomortar.model.sheet import Sheet


def pressure_error(problem: Problem, contact: Contact) -> float:
    """The most that a uniform pressure is off by a contact's points (theory 9.14), relative; 0 where weights hardly differ."""
    sheet = Sheet.of(problem, contact.slave)
    if not unlike(sheet.directions, _weights(sheet)):
        return 0.0
    face = SlaveFace(contact, problem, Numbering(problem))
    nodes, values, _, area = Subcells(face).gauss() if contact.subcells else face.gauss()
    row = np.repeat(np.arange(len(values)), values.shape[1])
    column = np.repeat(nodes, len(values) // len(nodes), axis=0).ravel()
    functions = sparse.csr_array((values.ravel(), (row, column)), shape=(len(values), len(face.point)))
    better = np.zeros(len(face.point))
    np.add.at(better, face.within, _in_layers(sheet))
    return _error(functions, area, better)


def too_few_points_of(problem: Problem, contact: Contact, error: float) -> str:
    """A sentence on a contact whose pressures are off by an error, with numbers of points that leave none that is told."""
    sheet = Sheet.of(problem, contact.slave)
    weights = _weights(sheet)
    enough = _points_enough(sheet, contact.quadrature)
    cure = f"Take contacts.{contact.name}.quadrature = {list(enough)}, or bring" if enough else "Bring"
    return (
        f"contact {contact.name!r}: weights of its slave {contact.slave.words}, from {weights.min():g} to {weights.max():g}, differ too "
        f"much for {' x '.join(map(str, contact.quadrature))} quadrature points: pressures are off by up to {percent(error)}. {cure} the "
        "weights nearer to each other"
    )


def _weights(sheet: Sheet) -> FloatArray:
    """Weights of the control points of a face."""
    return np.asarray(sheet.patch.weights[sheet.patch.face_points(sheet.face)])


def _points_enough(sheet: Sheet, rule: tuple[int, int]) -> tuple[int, int] | None:
    """Numbers of points of whole elements that doubling finds to leave no error that is told; None: more than are tried."""
    better = _in_layers(sheet)
    while max(rule) <= MOST_ALONG:
        lines = [LinePoints.of(direction.boundaries, points) for direction, points in zip(sheet.directions, rule, strict=True)]
        if _error(*_tables(sheet, lines), better) <= QUADRATURE_TOLD:
            return rule
        rule = 2 * rule[0], 2 * rule[1]
    return None


def _error(functions: sparse.csr_array, area: FloatArray, better: FloatArray) -> float:
    """The most that the field of a pressure of one is off, where points integrate it and forces are whole integrals."""
    from scipy.sparse.linalg import splu

    try:
        off = splu(sparse.csc_array((functions.T * area) @ functions)).solve(better - functions.T @ area)
    except RuntimeError:  # singular: too few points to tell functions apart, of which there is another word
        return 0.0
    return float(np.abs(functions @ off).max())


def _in_layers(sheet: Sheet) -> FloatArray:
    """Areas of the control points of a face, whatever the weights."""
    functions, area = _tables(sheet, in_layers(sheet.directions, _weights(sheet)))
    return np.asarray(functions.T @ area)


def _tables(sheet: Sheet, lines: Sequence[LinePoints]) -> tuple[sparse.csr_array, FloatArray]:
    """Functions of a face at places, shape (places, control points of the face), and reference areas of these."""
    here = sheet.patch.face_points(sheet.face)
    points, weights = sheet.patch.control_points[here], _weights(sheet)
    (u, du), (v, dv) = (functions_along(direction, line.places) for direction, line in zip(sheet.directions, lines, strict=True))
    net = np.column_stack([(points - points.mean(axis=0)) * weights[:, None], weights])
    value, first, second = (sparse.kron(b, a) @ net for a, b in ((u, v), (du, v), (u, dv)))
    area = np.linalg.norm(np.cross(quotient(first, value), quotient(second, value)), axis=-1)
    functions = sparse.csr_array(sparse.kron(v, u).multiply(weights).multiply(1.0 / value[:, 3:]))
    return functions, area * np.outer(lines[1].weights, lines[0].weights).ravel()
