"""Contact pairs as the kernel reads them: slave tables, master arrays, and who can bear on whom."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from isomortar._bindings import AveragedFaceArrays, FaceArrays, MasterArrays, Pattern, PlaneArrays
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model import constants
from isomortar.model.enforcement import slave_side
from isomortar.model.entities import Contact, Problem, RigidPlane
from isomortar.model.mirrors import Edges, mirrors_at
from isomortar.model.numbering import Numbering
from isomortar.model.pattern import elements_about, incidence, pattern_of, surface_element_points
from isomortar.model.sheet import Sheet


class Pair:
    """One contact pair.

    Attributes
    ----------
    contact : Contact
    slave : SlaveArrays
        Tables of the slave side, from the reference configuration, by the contact's method of enforcement.
    carriers : csr_array, shape (test functions, slave control points)
        The slave's functions at what each constraint stands for.
    places : ndarray, shape (test functions, 2)
        Where on the slave face, by its coordinates, each constraint is.
    master : MasterArrays
    area : float
        Area of the slave face in the reference configuration.
    elements_of_point : csr_array, shape (test functions, slave elements)
    slave_reach : csr_array, shape (slave elements, control points)
        Control points of each slave element.
    master_reach : csr_array or None, shape (master elements, control points)
        Control points that a foot in each master element depends on, those that turn its normals too; None for a rigid plane.
    master_elements : tuple of int
        Numbers of the master's elements by direction; zeros of a rigid plane.
    master_boundaries : tuple of ndarray
        Bounds of the master's elements by direction; none of a rigid plane.
    master_face : ndarray of int
        Control points of the master's face; none of a rigid plane.
    rigid_master : bool
        Whether the master is a face of a rigid body.
    master_edges : list of (int, ndarray of int)
        For each edge of that face the surface coordinate that runs across it, and its control points.
    neighbour_matrix, neighbours : csr_array, Pattern
        Test functions that share an element.
    pieces : ndarray of int
        Numbers of the pieces that its deformable bodies belong to.
    softest : ndarray
        Modulus of the softest of these bodies over the largest one in each of the pieces.
    """

    def __init__(self, contact: Contact, problem: Problem, numbering: Numbering) -> None:
        self.contact = contact
        side = slave_side(contact, problem, numbering)
        self.slave, self.carriers, self.places = side.arrays, side.carriers, side.places
        self.area = float(self.slave.area.sum())
        members = incidence(self.slave.test.nodes, self.slave.test.count)
        self.elements_of_point = sparse.csr_array(members.T)
        self.slave_reach = incidence(self.slave.point[self.slave.shape.nodes], numbering.count)
        self.master_reach, self.rigid_master = None, False
        self.master_face: IntArray = np.zeros(0, dtype=np.int32)
        self.master_edges: Edges = []
        self.master_elements = (0, 0)
        self.master_boundaries: tuple[FloatArray, ...] = ()
        if isinstance(contact.master, RigidPlane):
            self.master: MasterArrays = _plane_arrays(contact.master)
        else:
            sheet = Sheet.of(problem, contact.master)
            patch, face, points = sheet.patch, sheet.face, sheet.points(numbering)
            self.master_reach = incidence(surface_element_points(patch, face, points), numbering.count)
            if contact.averaged:
                self.master_reach = sparse.csr_array(elements_about(patch, face, points) @ self.master_reach)
            directions = sheet.directions
            self.master_boundaries = (directions[0].boundaries, directions[1].boundaries)
            self.master_elements = (directions[0].elements, directions[1].elements)
            grid = points[patch.face_points(face)].reshape(directions[1].count, -1)
            self.master_face = grid.ravel()
            self.rigid_master = sheet.rigid
            self.master_edges = [(0, grid[:, 0]), (0, grid[:, -1]), (1, grid[0]), (1, grid[-1])]
            self.master = _face_arrays(contact, sheet, numbering, mirrors_at(problem, numbering, self.master_edges))
        self.neighbour_matrix = sparse.csr_array(self.elements_of_point @ self.elements_of_point.T)
        self.neighbours: Pattern = pattern_of(self.neighbour_matrix)
        names = contact.bodies & {body.name for body in problem.deformable}
        meeting = [k for k, piece in enumerate(numbering.pieces) if any(body.name in names for body in piece)]
        self.pieces: IntArray = np.array(meeting, dtype=np.int32)
        stiffest = np.array([max(body.modulus for body in numbering.pieces[k]) for k in meeting])
        self.softest: FloatArray = min(problem.body(name).modulus for name in names) / stiffest

    def field(self, control_values: FloatArray) -> FloatArray:
        """A field at the quadrature points from its control values, shape (points, ...)."""
        test = self.slave.test
        element = np.repeat(np.arange(self.slave.elements), self.slave.per_element)
        return np.einsum("qa,qa...->q...", test.values, control_values[test.nodes[element]])

    def at_tests(self, positions: FloatArray) -> FloatArray:
        """Where the constraints belong, given positions (or increments) of all control points, shape (test functions, 3)."""
        return np.asarray(self.carriers @ positions[self.slave.point])

    def some_carriers(self, marks: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Which constraints stand for a marked control point, shape (test functions,); `marks` is of all control points."""
        some: NDArray[np.bool_] = abs(self.carriers) @ marks[self.slave.point].astype(np.float64) != 0.0
        return some

    def all_carriers(self, marks: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Which components of what a constraint stands for are all marked, shape (test functions, 3); `marks` is of all control points."""
        missing: NDArray[np.bool_] = abs(self.carriers) @ (~marks[self.slave.point]).astype(np.float64) == 0.0
        return missing


def _plane_arrays(plane: RigidPlane) -> PlaneArrays:
    return PlaneArrays(*(np.array(vector, dtype=np.float64) for vector in (plane.point, plane.normal, plane.tangent)))


def _face_arrays(contact: Contact, sheet: Sheet, numbering: Numbering, mirror: IntArray) -> FaceArrays:
    kind = AveragedFaceArrays if contact.averaged else FaceArrays
    brim = 0.0 if contact.of_averages else constants.BRIM
    return kind(*sheet.arrays(numbering), brim, mirror)
