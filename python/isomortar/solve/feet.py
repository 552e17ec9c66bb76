"""Feet on the master under slave points that carry pressure: they have to follow their points, and with friction to slip.

A point that is open may have any foot, also one of many that are as near: of such a point the distance alone counts.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar import _bindings
from isomortar._bindings import Projections, Response, SlaveArrays
from isomortar._codes import Status
from isomortar.errors import LostProjectionError
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Contact, Problem
from isomortar.model.numbering import Numbering
from isomortar.model.pairs import Pair

#: Doubts with friction alone: the kernel's about a foot on a C0 line, and one of ours beside a pole.
_NO_SLIP, _SLIPS_AT_POLE = int(Status.NO_SLIP), -1
#: By the kernel's status: what is the matter with a foot, and what to do.
_DOUBTS = {
    Status.LOST_PROJECTION: (
        "the search for its nearest point on the master does not settle, as near a centre of curvature. "
        "Take smaller load steps, or a master whose centres of curvature are farther away"
    ),
    Status.DEGENERATE_SURFACE: (
        "other points of the master are as near as the nearest one, as from a ring's axis: it has no direction to press in. "
        "Keep the slave nearer to the master than its centres of curvature, or take a master that is less hollow"
    ),
    _NO_SLIP: "its nearest point is on a C0 line of the master, and slips have no measure there: the element beside it has its centre of "
    "curvature nearer. Set friction = 0, without cohesion, or take a master that is less hollow beside its lines",
    _SLIPS_AT_POLE: "its nearest point is in an element of the master that ends at a pole, an edge that is one point, where slips have no "
    "coordinates. Take more elements of the master towards it, or a mesh without a pole there, or set friction = 0, without cohesion",
}


class Feet:
    """What is asked of the feet of a contact pair.

    Parameters
    ----------
    pair : Pair
    origin : ndarray, shape (3,)
        Where the coordinates of positions count from, in those that messages name.
    """

    def __init__(self, pair: Pair, origin: FloatArray) -> None:
        self._pair, self._origin = pair, origin
        self._slips, self._poles = pair.contact.friction_law.acts, pole_elements(pair)

    def check(self, positions: FloatArray, projections: Projections, response: Response) -> None:
        """Refuse feet that do not follow their points, or cannot slip, under active constraints.

        Raises
        ------
        LostProjectionError
            Naming contact, point, place and gap.
        """
        doubt = projections.doubt
        if self._slips and self._poles:
            doubt = np.where(beside_poles(self._pair, projections) & (doubt == 0), _SLIPS_AT_POLE, doubt)
        if not self._slips:
            doubt = np.where(doubt == _NO_SLIP, 0, doubt)
        if not doubt.any():
            return
        active = np.any(response.state[self._pair.slave.test.nodes] > 0, axis=1)
        bad = np.flatnonzero((doubt != 0) & np.repeat(active, self._pair.slave.per_element))
        if bad.size:
            q = int(bad[0])
            raise LostProjectionError(
                f"contact {self._pair.contact.name!r}: slave quadrature point {q} at {self._place(positions, q)}, with a gap of "
                f"{gaps(self._pair, positions, projections)[q]:.3g}, is where contact acts, but {_DOUBTS[int(doubt[q])]}", q
            )  # fmt: skip

    def named(self, error: LostProjectionError, positions: FloatArray) -> LostProjectionError:
        """An error of the kernel's projection with the contact, and the place of its slave point, in its words."""
        where = f", at {self._place(positions, error.place)}" if np.isfinite(positions).all() else ""
        return type(error)(f"contact {self._pair.contact.name!r}: {error}{where}", error.place)

    def _place(self, positions: FloatArray, q: int) -> str:
        point = slave_points(self._pair, positions)[q]
        point[np.abs(point) <= 1e-12 * np.abs(positions).max()] = 0.0  # round-off is no place
        return "({:.4g}, {:.4g}, {:.4g})".format(*(point + self._origin))


def closest_depths(problem: Problem, contact: Contact, positions: FloatArray) -> FloatArray:
    """How deep a contact's slave points are in its master by closest points, shape (points,), whatever its projection.

    Below zero before the master; not a number beside it. Along averaged normals feet are found up to a depth and a distance alone.
    """
    pair = Pair(replace(contact, projection="closest"), problem, Numbering(problem))
    none = np.zeros(len(pair.slave.area), dtype=np.int32)
    closest = _bindings.project_points(pair.slave, pair.master, positions, np.zeros((len(none), 2)), none)
    return np.where(closest.found > 0, gaps(pair, positions, closest), np.nan)


def gaps(pair: Pair, positions: FloatArray, projections: Projections) -> FloatArray:
    """Gap of each slave quadrature point, shape (points,): negative where it is open, 0 without a foot.

    The kernel gives averages: here each point is the only one of a control point of its own.
    """
    slave, everywhere = point_by_point(pair, positions)
    return _bindings.control_quantities(slave, pair.master, everywhere, projections).gap


def point_by_point(pair: Pair, positions: FloatArray) -> tuple[SlaveArrays, FloatArray]:
    """A slave whose quadrature points are control points of their own, and positions of all control points with these after them."""
    points = slave_points(pair, positions)
    slave = SlaveArrays.of_points(np.arange(len(positions), len(positions) + len(points), dtype=np.int32))
    return slave, np.vstack([positions, points])


def slave_points(pair: Pair, positions: FloatArray) -> FloatArray:
    """Positions of the slave quadrature points, shape (points, 3)."""
    nodes = np.repeat(pair.slave.shape.nodes, pair.slave.per_element, axis=0)
    points: FloatArray = np.einsum("qa,qai->qi", pair.slave.shape.values, positions[pair.slave.point[nodes]])
    return points


def beside_poles(pair: Pair, projections: Projections) -> np.ndarray:
    """Which slave quadrature points have their feet in elements of the master that end at an edge that is one control point."""
    beside = np.zeros(len(projections.found), dtype=np.bool_)
    for direction, element in pole_elements(pair):
        beside |= (projections.element[:, direction] == element) & (projections.found > 0)
    return beside


def pole_elements(pair: Pair) -> list[tuple[int, int]]:
    """Direction of the master, and element along it, of each of its edges that is one control point."""
    ends = [0 if number % 2 == 0 else pair.master_elements[direction] - 1 for number, (direction, _) in enumerate(pair.master_edges)]
    edges = zip(pair.master_edges, ends, strict=True)
    return [(direction, end) for (direction, points), end in edges if np.all(points == points[0])]
