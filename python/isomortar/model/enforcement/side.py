"""What a method of enforcement gives: the slave side's tables, and what its constraints stand for."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property

import numpy as np
from scipy import sparse

from isomortar._bindings import FunctionArrays, SlaveArrays
from isomortar._frozen import frozen
from isomortar.errors import InputError
from isomortar.geometry.patch import Direction, FloatArray, IntArray
from isomortar.model import constants
from isomortar.model.enforcement.face import SlaveFace


@frozen(eq=False)
class SlaveSide(ABC):
    """The slave side of a contact.

    Attributes
    ----------
    arrays : SlaveArrays
    carriers : csr_array, shape (constraints, slave control points)
        Whose motion each constraint constrains: its own control point's (mortar), or that of the functions at its point.
    places : ndarray, shape (constraints, 2)
        Where on the face, by its coordinates, each constraint is: where its control point belongs (mortar), or at its point.
    """

    arrays: SlaveArrays
    carriers: sparse.csr_array
    places: FloatArray

    @abstractmethod
    def on_control_points(self, values: FloatArray) -> FloatArray:
        """Control values of a field that is drawn, from the constraints' values, shape (n, ...)."""

    @property
    @abstractmethod
    def nearest(self) -> IntArray:
        """The constraint that is nearest to where each control point belongs, by the face's coordinates, shape (n,)."""


@frozen(eq=False)
class PointSide(SlaveSide):
    """A slave side with constraints at points.

    Attributes
    ----------
    area : ndarray, shape (constraints,)
        Reference area that each point stands for.
    control_places : ndarray, shape (slave control points, 2)
        Where control points belong.
    """

    area: FloatArray
    control_places: FloatArray

    def on_control_points(self, values: FloatArray) -> FloatArray:
        """Means of the constraints' values (theory 10.8), shape (n, ...).

        A constant stays what it is, and so does the resultant. A function that is zero at all constraints takes the nearest one's value.
        """
        shares = sparse.csr_array(self.carriers.T.multiply(self.area))
        total = shares.sum(axis=1)
        known = total > constants.NO_SHARE * total.max()
        means = (shares @ values.reshape(len(values), -1)) / np.where(known, total, 1.0)[:, None]
        means[~known] = values.reshape(len(values), -1)[self.nearest[~known]]
        return np.asarray(means.reshape(-1, *values.shape[1:]))

    @cached_property
    def nearest(self) -> IntArray:
        """The constraint that is nearest to where each control point belongs, by the face's coordinates, shape (n,)."""
        from scipy.spatial import cKDTree

        return np.asarray(cKDTree(self.places).query(self.control_places)[1], dtype=np.int32)


def pointwise(face: SlaveFace, coordinates: FloatArray, area: FloatArray) -> PointSide:
    """Constraints at points of a face, each with an area (theory 10.2): a test function of its own, and a quadrature point as an element.

    On a C0 line there is such a point in each of the elements that meet there, and they share the area.

    Raises
    ------
    InputError
        An area is not positive.
    """
    if not np.all(area > 0.0):
        worst = int(np.argmin(area))
        contact, where = face.contact, ", ".join(f"{c:.4g}" for c in coordinates[worst])
        raise InputError(
            f"is {contact.enforcement!r}, but its point at ({where}) of {contact.slave.words} has an area of "
            f'{area[worst]:.3g}: pressure there would pull; take "mortar", or a mesh that is less graded',
            f"contacts.{contact.name}.enforcement",
        )
    seen, constraint = _from_all_sides(face, coordinates)
    nodes, values, slopes = face.at(seen)
    shape = FunctionArrays(nodes, values, len(face.point))
    test = FunctionArrays(constraint[:, None], np.ones((len(constraint), 1)), len(area))
    shared = (area / np.bincount(constraint))[constraint]
    arrays = SlaveArrays(shape, test, shared, face.point, slopes, face.outward)
    return PointSide(arrays, functions_at(face, coordinates), coordinates, area, face.control_places)


def _from_all_sides(face: SlaveFace, coordinates: FloatArray) -> tuple[FloatArray, IntArray]:
    """Points once for each element that meets there with tangents of its own, and whose points they are."""
    seen, point = coordinates, np.arange(len(coordinates), dtype=np.int32)
    for axis, (direction, closed) in enumerate(zip(face.directions, face.closed, strict=True)):
        place, other = _both_sides(direction, closed, seen[:, axis])
        twice = np.flatnonzero(np.isfinite(other))
        seen = np.concatenate([seen, seen[twice]])
        seen[:, axis] = np.concatenate([place, other[twice]])
        point = np.concatenate([point, point[twice]])
    order = np.argsort(point, kind="stable")
    return seen[order], point[order]


def _both_sides(direction: Direction, closed: bool, at: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Coordinates as they are seen from the element after a C0 line and from that before it; NaN where they are on none.

    Where a face meets itself, its start is on one, and the element before is the last.
    """
    start, *_, end = direction.boundaries
    near = constants.ON_A_LINE * np.diff(direction.boundaries).min()
    place, other = at.copy(), np.full(len(at), np.nan)
    for line in direction.c0_lines:
        on = np.abs(at - line) <= near
        place[on], other[on] = line, np.nextafter(line, start)
    if closed:
        other[at <= start + near] = end
    return place, other


def functions_at(face: SlaveFace, coordinates: FloatArray) -> sparse.csr_array:
    """Values of the slave's functions at points of its face, shape (points, slave control points); zeros are left out."""
    nodes, values, _ = face.at(coordinates)
    rows = np.repeat(np.arange(len(nodes)), nodes.shape[1])
    matrix = sparse.csr_array((values.ravel(), (rows, nodes.ravel())), shape=(len(nodes), len(face.point)))
    matrix.eliminate_zeros()
    return matrix


def open_ends(abscissae: FloatArray, closed: bool) -> FloatArray:
    """The abscissae, without the last where it is the same place as the first."""
    return abscissae[:-1] if closed else abscissae
