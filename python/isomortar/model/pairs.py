"""Contact pairs as the kernel reads them: slave tables, master arrays, and who can bear on whom."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from isomortar import _bindings
from isomortar._bindings import MasterArrays, Pattern, SlaveArrays
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model.entities import Contact, Face, Problem, RigidPlane
from isomortar.model.numbering import Numbering
from isomortar.model.pattern import incidence, pattern_of, surface_element_points


class Pair:
    """One contact pair.

    Attributes
    ----------
    contact : Contact
    slave : SlaveArrays
        Tables of the slave side, from the reference configuration.
    master : MasterArrays
    area : float
        Area of the slave face in the reference configuration.
    elements_of_point : csr_array, shape (slave control points, slave elements)
    slave_reach : csr_array, shape (slave elements, control points)
        Control points of each slave element.
    master_reach : csr_array or None, shape (master elements, control points)
        Control points of each master element; None for a rigid plane.
    master_face : ndarray of int
        Control points of the master's face; none of a rigid plane.
    master_edges : list of (int, ndarray of int)
        For each edge of that face the surface coordinate that runs across it, and its control points.
    neighbours : Pattern
        Slave control points that share an element.
    bodies : ndarray of int
        Numbers of the deformable bodies of the pair.
    softest : ndarray
        Modulus of the softest of these over that of each.
    """

    def __init__(self, contact: Contact, problem: Problem, numbering: Numbering) -> None:
        self.contact = contact
        body = problem.body(contact.slave.body)
        face, points = contact.slave.face, numbering.points[body.name]
        directions = body.patch.face_directions(face)
        elements = directions[0].elements * directions[1].elements
        local = (directions[0].order + 1) * (directions[1].order + 1)
        nodes, basis, area = _bindings.slave_tables(
            numbering.patch_arrays(body), _axis(face), int(face[1]), contact.quadrature, numbering.reference, local, elements
        )
        face_points = points[body.patch.face_points(face)]
        slave_points, first = np.unique(face_points, return_index=True)
        order = np.argsort(first)
        number = np.empty(len(order), dtype=np.int32)
        number[order] = np.arange(len(order), dtype=np.int32)
        within = number[np.searchsorted(slave_points, face_points)]
        self.slave = SlaveArrays(np.ascontiguousarray(within[nodes]), basis, area, np.ascontiguousarray(slave_points[order]))
        self.area = float(area.sum())
        self.master = _master_arrays(contact, problem, numbering)
        members = incidence(self.slave.nodes, len(self.slave.point))
        self.elements_of_point = sparse.csr_array(members.T)
        self.slave_reach = incidence(self.slave.point[self.slave.nodes], numbering.count)
        self.master_reach = None
        self.master_face: IntArray = np.zeros(0, dtype=np.int32)
        self.master_edges: list[tuple[int, IntArray]] = []
        self.master_elements = (0, 0)
        if not isinstance(contact.master, RigidPlane):
            body = problem.body(contact.master.body)
            reached = surface_element_points(body.patch, contact.master.face, numbering.points[body.name])
            self.master_reach = incidence(reached, numbering.count)
            directions = body.patch.face_directions(contact.master.face)
            self.master_elements = (directions[0].elements, directions[1].elements)
            grid = numbering.points[body.name][body.patch.face_points(contact.master.face)].reshape(directions[1].count, -1)
            self.master_face = grid.ravel()
            self.master_edges = [(0, grid[:, 0]), (0, grid[:, -1]), (1, grid[0]), (1, grid[-1])]
        self.neighbour_matrix = sparse.csr_array(self.elements_of_point @ self.elements_of_point.T)
        self.neighbours: Pattern = pattern_of(self.neighbour_matrix)
        names = {side.body for side in (contact.slave, contact.master) if isinstance(side, Face)}
        self.bodies: IntArray = np.array([k for k, body in enumerate(problem.bodies) if body.name in names], dtype=np.int32)
        moduli = np.array([problem.bodies[k].material.modulus for k in self.bodies])
        self.softest: FloatArray = moduli.min() / moduli

    @property
    def points_per_element(self) -> int:
        """Number of quadrature points of a slave element."""
        return len(self.slave.area) // len(self.slave.nodes)

    def field(self, control_values: FloatArray) -> FloatArray:
        """A field at the quadrature points from its control values, shape (points, ...)."""
        element = np.repeat(np.arange(len(self.slave.nodes)), self.points_per_element)
        return np.einsum("qa,qa...->q...", self.slave.basis, control_values[self.slave.nodes[element]])


def _axis(face: str) -> int:
    return "uvw".index(face[0]) + 1


def _master_arrays(contact: Contact, problem: Problem, numbering: Numbering) -> MasterArrays:
    if isinstance(contact.master, RigidPlane):
        vectors = np.concatenate([contact.master.point, contact.master.normal, contact.master.tangent]).astype(np.float64)
        return MasterArrays(np.zeros(11, np.int32), vectors, np.zeros(1, np.int32), np.ones(1))
    patch = numbering.patch_arrays(problem.body(contact.master.body))
    face = contact.master.face
    kind: IntArray = np.concatenate([[_axis(face), int(face[1])], patch.layout]).astype(np.int32)
    return MasterArrays(kind, patch.knots, patch.point, patch.weight)
