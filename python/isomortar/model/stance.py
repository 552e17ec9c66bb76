"""How the two sides of a contact stand to each other before anything moves: facing, apart, or in each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.faces import Cells, cells
from isomortar.geometry.nearest import nearest, product
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Contact, Face, Problem, RigidPlane, unit
from isomortar.model.remembered import remembered
from isomortar.model.sheet import Sheet

#: Faces whose outward normals include more than about 96 degrees face each other.
FACING = -0.1
#: Normals of a face that are compared each with each.
SOME = 400


@frozen
class Stance:
    """A contact pair in the reference configuration, by cells of its faces.

    Parameters
    ----------
    slave_area, master_area : float
        Areas of the faces; a plane has an infinite one.
    cosine : float
        Smallest cosine between outward normals of slave and master, wherever they are: -1 where parts of them face each other.
    depth : float
        By how much parts of the slave that face the master are inside it at most; 0 where they are not.
    gap : float
        Smallest distance between slave and master; 0 where they touch or overlap.
    thickness : float
        What the slave would have to pass through: the thinner body, there.
    behind : bool
        The middle of the slave's body lies behind a plane.
    towards : ndarray, shape (3,)
        From slave to master, where they are nearest.
    faces : bool
        Whether some of the slave faces the master, and not only an edge of that.
    """

    slave_area: float
    master_area: float
    cosine: float
    depth: float
    gap: float
    thickness: float
    behind: bool
    towards: FloatArray
    faces: bool


@remembered
def stance(problem: Problem, contact: Contact) -> Stance:
    """How a pair stands."""
    sheet = Sheet.of(problem, contact.slave)
    slave = cells(sheet.patch, sheet.face)
    if isinstance(contact.master, RigidPlane):
        return _on_plane(np.concatenate([body.patch.control_points for body in sheet.bodies]), slave, contact.master)
    return _on_face(slave, _cells_of(problem, contact.master))


def _cells_of(problem: Problem, place: Face) -> Cells:
    sheet = Sheet.of(problem, place)
    return cells(sheet.patch, sheet.face)


def _on_plane(points: FloatArray, slave: Cells, plane: RigidPlane) -> Stance:
    normal = unit(plane.normal)
    heights = (points - plane.point) @ normal
    thickness = np.full(len(slave.areas), np.ptp(heights))
    cosines = slave.normals @ normal
    above = (slave.centres - plane.point) @ normal
    depth, thick = _deepest(cosines, above, thickness)
    gap = max(float(above.min()), 0.0)
    return Stance(
        float(slave.areas.sum()), np.inf, float(cosines.min()), depth, gap, thick, bool(heights.max() + heights.min() < 0.0), -normal, True
    )


def _on_face(slave: Cells, master: Cells) -> Stance:
    """By the slave's cells; where none of their middles is over the master, as of a slave far larger than that, by the master's."""
    found, none = _by_cells(slave, master)
    if not none:
        return found
    back, none = _by_cells(master, slave)
    if none or not back.faces:
        return found
    return replace(back, slave_area=found.slave_area, master_area=found.master_area, towards=-back.towards)


def _by_cells(slave: Cells, master: Cells) -> tuple[Stance, bool]:
    """How the cells of one face stand to the nearest ones of another, and whether none of them is over it."""
    found = nearest(slave.centres, master.centres)
    normals, arms = master.normals[found], slave.centres - master.centres[found]
    distances = np.linalg.norm(arms, axis=1)
    cosines = np.einsum("ij,ij->i", slave.normals, normals)
    heights = np.einsum("ij,ij->i", arms, normals)
    beside = np.linalg.norm(arms - heights[:, None] * normals, axis=1) > np.sqrt(2.0 * master.areas[found])
    thickness = np.minimum(slave.thickness, master.thickness[found])
    over = ~beside & ~master.beyond(found, arms)
    depth, thick = _deepest(cosines, np.where(over, heights, np.inf), thickness)
    cosine = float(product(_some(slave.normals), _some(master.normals).T).min())
    apart = np.where(beside, distances - np.sqrt(2.0 * master.areas[found]), heights)
    closest = int(np.argmin(np.where(cosines < FACING, apart, np.inf)))
    gap = 0.0 if depth > 0.0 else max(float(apart.min()), 0.0)
    faces = bool(np.any(~beside & (cosines < FACING) & ~master.outermost((False, False))[found]))
    areas = float(slave.areas.sum()), float(master.areas.sum())
    return Stance(*areas, cosine, depth, gap, thick, False, -normals[closest], faces), not over.any()


def _some(normals: FloatArray) -> FloatArray:
    """Some hundreds of normals, spread over the face."""
    return normals[:: max(1, len(normals) // SOME)]


def _deepest(cosines: FloatArray, heights: FloatArray, thickness: FloatArray) -> tuple[float, float]:
    """Largest depth of cells that face the master, and the thickness there."""
    depths = np.where(cosines < FACING, -heights, -np.inf)
    deepest = int(np.argmax(depths))
    return max(float(depths[deepest]), 0.0), float(thickness[deepest])
