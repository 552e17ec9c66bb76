"""A slave face in the reference configuration: what the tables of every method of enforcement are made of."""

from __future__ import annotations

import numpy as np

from isomortar import _bindings
from isomortar._bindings import FaceArrays
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model.entities import Contact, Face, Problem
from isomortar.model.numbering import Numbering
from isomortar.model.sheet import Sheet


def grid(first: FloatArray, second: FloatArray) -> FloatArray:
    """Pairs of abscissae of the two directions, the first fastest, shape (points, 2)."""
    return np.stack(np.meshgrid(first, second), axis=-1).reshape(-1, 2)


class SlaveFace:
    """A slave face.

    Attributes
    ----------
    contact : Contact
    directions : tuple of Direction
    closed : tuple of bool
        Along which directions the face meets itself.
    point : ndarray of int32, shape (n,)
        Global numbers of its control points; one that the face meets twice counts once.
    within : ndarray of int32, shape (control points of the face,)
        Their numbers among these.
    control_places : ndarray, shape (n, 2)
        Where control points belong on the face: at Greville's abscissae; of a point that the face meets twice the first.
    reference : ndarray, shape (control points of all bodies, 3)
    master : FaceArrays or None
        The master's face; None for a rigid plane.
    lines : tuple of ndarray
        Its knot lines by direction; none of a rigid plane.
    outward : int
        Sign of the product of the tangents that points out of the body.
    """

    def __init__(self, contact: Contact, problem: Problem, numbering: Numbering) -> None:
        self.contact = contact
        sheet = Sheet.of(problem, contact.slave)
        self._patch, self._axis, self._end = sheet.arrays(numbering)
        self.reference = numbering.reference
        self.master: FaceArrays | None = None
        self.lines: tuple[FloatArray, ...] = ()
        if isinstance(contact.master, Face):
            master = Sheet.of(problem, contact.master)
            self.master = FaceArrays(*master.arrays(numbering))
            self.lines = tuple(direction.boundaries for direction in master.directions)
        self.directions, self.closed, self.outward = sheet.directions, sheet.closed, sheet.outward
        points = self._patch.point[sheet.patch.face_points(sheet.face)]
        found, first = np.unique(points, return_index=True)
        order = np.argsort(first)
        number = np.empty(len(order), dtype=np.int32)
        number[order] = np.arange(len(order), dtype=np.int32)
        self.point: IntArray = np.ascontiguousarray(found[order])
        self.within: IntArray = number[np.searchsorted(found, points)]
        self.control_places = np.zeros((len(order), 2))
        self.control_places[self.within[::-1]] = grid(*(direction.greville for direction in self.directions))[::-1]

    def gauss(self) -> tuple[IntArray, FloatArray, FloatArray, FloatArray]:
        """Tables at the contact's Gauss points: control points by element, values, derivatives, reference areas."""
        nodes, values, slopes, area = _bindings.slave_tables(self._patch, self._axis, self._end, self.contact.quadrature, self.reference)
        return np.ascontiguousarray(self.within[nodes]), values, slopes, area

    def at(self, coordinates: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
        """Control points of the functions, their values and derivatives at coordinates of shape (m, 2)."""
        nodes, functions = _bindings.surface_functions(self._patch, self._axis, self._end, np.ascontiguousarray(coordinates))
        return np.ascontiguousarray(self.within[nodes]), np.ascontiguousarray(functions[:, 0]), np.ascontiguousarray(functions[:, 1:3])

    def areas(self, nodes: IntArray, slopes: FloatArray) -> FloatArray:
        """Reference area per parameters of tables at some points, shape (m,)."""
        first, second = np.einsum("mal,mlx->amx", slopes, self.reference[self.point[nodes]])
        return np.asarray(np.linalg.norm(np.cross(first, second), axis=1))
