"""What supports hold of a contact's slave control points: multipliers that could do nothing there, and what is left of the others.

On a rigid plane there are as many multipliers as components of the slave control points. For each component that is prescribed one is
redundant: the support takes its force. It is the pressure where the normal is held, else the traction along what is held. A support that
has moved along the plane is another matter: there slip is prescribed, and the traction is that of sliding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model.entities import RigidPlane, unit
from isomortar.model.pairs import Pair
from isomortar.model.supports import Supports

#: Share of a unit vector below which it has no component in a direction.
_NOTHING = 1e-6


@dataclass(frozen=True)
class Held:
    """What supports hold of the slave control points of a pair in one load increment.

    Attributes
    ----------
    bears : ndarray of int32, shape (slave control points,)
        0 where supports hold the normal, which leaves nothing to the pressure; else 1.
    free : ndarray, shape (slave control points, 2, 2)
        Symmetric projections of covariant tractions that leave nothing along what is held.
    pushed : ndarray, shape (slave control points, 2)
        Directions in which supports push along the plane in this increment: unit vectors, or zero.
    """

    bears: IntArray
    free: FloatArray
    pushed: FloatArray


def nothing_held(pair: Pair) -> Held:
    """All multipliers are free."""
    n = len(pair.slave.point)
    return Held(np.ones(n, dtype=np.int32), np.tile(np.eye(2), (n, 1, 1)), np.zeros((n, 2)))


def held_by(supports: Supports, pair: Pair, start: FloatArray, time: float) -> Held:
    """What supports hold of a pair in the increment from positions `start` to a load time."""
    held = nothing_held(pair)
    if not isinstance(pair.contact.master, RigidPlane):
        return held
    tangents, normal = _axes(pair.contact.master)
    prescribed, moved = (mask[pair.slave.point] for mask in (supports.held, supports.moved(time)))
    increments = supports.increment(start, time)[pair.slave.point] @ tangents
    for i in np.flatnonzero(prescribed.any(axis=1)):
        if np.linalg.norm(normal[~prescribed[i]]) < _NOTHING:
            held.bears[i] = 0
            continue
        directions, sizes, _ = np.linalg.svd(tangents[prescribed[i] & ~moved[i]].T, full_matrices=False)
        taken = directions[:, sizes > _NOTHING]
        held.free[i] -= taken @ taken.T
        along = held.free[i] @ increments[i]
        held.pushed[i] = along / (np.linalg.norm(along) or 1.0)
    return held


def _axes(plane: RigidPlane) -> tuple[FloatArray, FloatArray]:
    """Unit vectors along the plane's coordinates, shape (3, 2), and its unit normal, shape (3,)."""
    normal = unit(plane.normal)
    first = unit(tuple(np.asarray(plane.tangent) - normal @ plane.tangent * normal))
    return np.column_stack([first, np.cross(normal, first)]), normal
