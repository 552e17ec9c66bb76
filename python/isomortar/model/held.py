"""What supports hold of a contact's constraints: multipliers that could do nothing there, and what is left of the others.

On a rigid plane there are as many multipliers as components of what its constraints stand for. For each component that is prescribed one is
redundant: the support takes its force. It is the pressure where the normal is held, else the traction along what is held. A support that
has moved along the plane is another matter: there slip is prescribed, and the traction is that of sliding.

A master's face keeps its multipliers, but where it is held like the slave: on a symmetry plane of both, and in plane strain. There
the traction across the edge of the master's face is zero. Beside a rigid body what is held at all may repeat other conditions.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np

from isomortar._arrays import Control, Pattern
from isomortar._codes import FirstRow
from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model import constants
from isomortar.model.entities import RigidPlane, unit
from isomortar.model.pairs import Pair
from isomortar.model.supports import BoolArray, Supports


@frozen
class Held:
    """What supports hold of the constraints of a pair in one load increment.

    Attributes
    ----------
    bears : ndarray of int32, shape (test functions,)
        0 where supports hold the normal, which leaves nothing to the pressure as long as the neighbours keep the slave out of
        the master; else 1.
    free : ndarray, shape (test functions, 2, 2)
        Symmetric projections of covariant tractions that leave nothing along what is held.
    pushed : ndarray, shape (test functions, 2)
        Directions in which supports push along the plane in this increment: unit vectors, or zero.
    rests : ndarray of bool, shape (test functions,)
        Where supports that hold the normal have them just touch a rigid plane, or hold anything beside a rigid body, or plates take control
        points along the normal: if they bear, their conditions may follow from the others'.
    still : ndarray of int32, shape (test functions,)
        1 where supports that have moved prescribe every direction along a rigid plane, here and round about, and move none of it in this
        increment: slips and balance tell nothing of the traction, which stays as it is, as far as friction bears it.
    moved : ndarray of bool, shape (test functions,)
        Where a component along the plane is prescribed, and by now has moved, or any beside a rigid body: slips there are given, so that
        they tell nothing of the traction along it while that sticks, nor of the one across while it slips. Or where plates take control
        points along the plane: of one slip several tractions are not told.
    idle : ndarray of bool, shape (test functions,)
        Where supports hold a control point wholly, and an edge of the master that it is on: it bears nothing, however deep it is.
    """

    bears: IntArray
    free: FloatArray
    pushed: FloatArray
    rests: BoolArray
    still: IntArray
    moved: BoolArray
    idle: BoolArray

    @cached_property
    def _limited(self) -> IntArray:
        """Test functions whose tractions are not free."""
        return np.flatnonzero(np.any(self.free != np.eye(2), axis=(1, 2))).astype(np.int32)

    def mirrored(self, control: Control) -> Control:
        """Control quantities as they are with mirror images of both sides beyond what is held (theory 4.11)."""
        at = self._limited
        if not at.size:
            return control
        slip, metric = control.slip.copy(), control.metric.copy()
        free, taken = self.free[at], np.eye(2) - self.free[at]
        slip[at] = np.einsum("nab,nb->na", free, slip[at])
        whole = metric[at][:, [[0, 1], [1, 2]]]
        metric[at] = (free @ whole @ free + taken @ whole @ taken)[:, [0, 0, 1], [0, 1, 1]]
        return replace(control, slip=slip, metric=metric)

    def mirror(self, rows: FloatArray, pattern: Pattern) -> None:
        """The same of the slips' derivatives, in place; `rows`, shape (blocks, kinds, 3), with the blocks of a pattern.

        The metrics' need none: where a slip is nothing, no traction depends on what couples it to the other one.
        """
        first = FirstRow.SLIP - 1
        for free, i in zip(self.free[self._limited], self._limited, strict=True):
            slips = rows[pattern.start[i] : pattern.start[i + 1], first : first + 2]
            slips[:] = free @ slips


def nothing_held(pair: Pair) -> Held:
    """All multipliers are free."""
    n = pair.slave.test.count
    rests, moved, idle = np.zeros((3, n), dtype=np.bool_)
    still = np.zeros(n, dtype=np.int32)
    return Held(np.ones(n, dtype=np.int32), np.tile(np.eye(2), (n, 1, 1)), np.zeros((n, 2)), rests, still, moved, idle)


def held_by(supports: Supports, pair: Pair, start: FloatArray, time: float) -> Held:
    """What supports hold of a pair in the increment from positions `start` to a load time (theory 4.11, 4.12)."""
    held = nothing_held(pair)
    if isinstance(pair.contact.master, RigidPlane):
        _beside_plane(held, supports, pair, start, time)
    else:
        _beside_surface(held, pair, start, supports.held & ~supports.moved(time))
        if pair.rigid_master:  # which way its normals go is known where feet are found: whatever is held may be what they press along
            held.rests[:] = held.moved[:] = pair.all_carriers(supports.held | supports.together).any(axis=1)
        else:
            _at_held_edge(held, supports, pair, start, time)
    return held


def _beside_plane(held: Held, supports: Supports, pair: Pair, start: FloatArray, time: float) -> None:
    """A rigid plane: what is held is the direction of its coordinates, or the normal."""
    assert isinstance(pair.contact.master, RigidPlane)
    tangents, normal = _axes(pair.contact.master)
    increment = pair.at_tests(supports.increment(start, time))
    all_held, all_moved = pair.all_carriers(supports.held), pair.all_carriers(supports.moved(time))
    heights = (pair.at_tests(start) + increment - pair.contact.master.point) @ normal
    given = np.zeros(len(heights), dtype=np.bool_)
    for i in np.flatnonzero(all_held.any(axis=1)):
        prescribed, moved = all_held[i], all_moved[i]
        held.bears[i] = int(np.linalg.norm(normal[~prescribed]) >= constants.NO_PART)
        held.rests[i] = not held.bears[i] and abs(heights[i]) <= constants.NO_PART * np.ptp(start, axis=0).max()
        directions, sizes, _ = np.linalg.svd(tangents[prescribed & ~moved].T, full_matrices=False)
        taken = directions[:, sizes > constants.NO_PART]
        held.free[i] -= taken @ taken.T
        along = held.free[i] @ (increment[i] @ tangents)
        held.pushed[i] = along / (np.linalg.norm(along) or 1.0)
        held.moved[i] = bool(np.any(np.linalg.norm(tangents[prescribed & moved], axis=1) > constants.NO_PART))
        given[i] = np.all(np.linalg.norm(tangents[~prescribed], axis=1) <= constants.NO_PART)
    along = pair.all_carriers(supports.together)
    pressed = np.linalg.norm(along * normal, axis=1) > constants.NO_PART
    held.rests[:] |= pressed & ~pressed.all()  # of a whole face no pressure is told
    held.moved[:] |= np.any(along[:, :, None] & (np.abs(tangents) > constants.NO_PART), axis=(1, 2))
    alone = pair.neighbour_matrix @ (~given).astype(np.int32) == 0
    held.still[:] = given & alone & held.moved & ~np.any(held.pushed, axis=1)


def _beside_surface(held: Held, pair: Pair, start: FloatArray, still: BoolArray) -> None:
    """A master's face: what is held is the coordinate across an edge in whose plane, or slice, supports hold both sides."""
    size = np.ptp(start, axis=0).max()
    own, places = pair.all_carriers(still), pair.at_tests(start)
    slice_ = np.all(still[pair.master_face], axis=0)
    for across, edge in pair.master_edges:
        for component in np.flatnonzero(np.all(still[edge], axis=0)):
            place = start[edge, component]
            if np.ptp(place) > constants.NO_PART * size:
                continue
            coordinate = _slave_coordinate(pair, start, int(component)) if pair.contact.averaged else across
            same = slice_[component] | (np.abs(places[:, component] - place[0]) <= constants.NO_PART * size)
            held.free[own[:, component] & same, :, coordinate] = 0.0
            held.free[own[:, component] & same, coordinate, :] = 0.0


def _at_held_edge(held: Held, supports: Supports, pair: Pair, start: FloatArray, time: float) -> None:
    """Constraints of control points that supports hold wholly, on an edge of the master that they hold, too, before and after."""
    own = pair.all_carriers(supports.held).all(axis=1)
    edges = [edge for _, edge in pair.master_edges if np.all(supports.held[edge])]
    if not edges or not own.any():
        return
    end = start + supports.increment(start, time)
    for edge in edges:
        held.idle[own] |= np.all([_on_line(pair.at_tests(places)[own], places[edge]) for places in (start, end)], axis=0)
    held.bears[held.idle] = 0


def _on_line(places: FloatArray, line: FloatArray) -> BoolArray:
    """Which places are on the line through some points, one after the other."""
    ways = np.diff(line, axis=0)
    squares, arms = np.square(ways).sum(axis=1), places[:, None] - line[:-1]
    shares = np.divide(np.einsum("psi,si->ps", arms, ways), squares, out=np.zeros(arms.shape[:2]), where=squares > 0.0)
    apart = np.linalg.norm(arms - np.clip(shares, 0.0, 1.0)[..., None] * ways, axis=2).min(axis=1)
    return np.asarray(apart <= constants.NO_PART * np.ptp(line, axis=0).max())


def _slave_coordinate(pair: Pair, start: FloatArray, component: int) -> int:
    """The coordinate of the slave, whose basis tractions along averaged normals have, that goes along a component most."""
    values = start[pair.slave.point, component][pair.slave.shape.nodes]
    slopes = pair.slave.slopes.reshape(pair.slave.elements, pair.slave.per_element, 2, -1)
    return int(np.argmax(np.square(np.einsum("eqal,el->eqa", slopes, values)).sum(axis=(0, 1))))


def _axes(plane: RigidPlane) -> tuple[FloatArray, FloatArray]:
    """Unit vectors along the plane's coordinates, shape (3, 2), and its unit normal, shape (3,)."""
    normal = unit(plane.normal)
    first = unit(tuple(np.asarray(plane.tangent) - normal @ plane.tangent * normal))
    return np.column_stack([first, np.cross(normal, first)]), normal
