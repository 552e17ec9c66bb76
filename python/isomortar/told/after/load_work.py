"""Work of all loads on rigid motions of bodies, and what bears these."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from isomortar.errors import LostProjectionError
from isomortar.geometry.patch import FloatArray
from isomortar.model import constants
from isomortar.model.rank import extent
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.free_motions import FreeMotion, loaded_motions
from isomortar.solve.record import State
from isomortar.told.after.limit_load import Touch, touches_of


def borne_loads(equilibrium: Equilibrium, state: State) -> tuple[list[FreeMotion], FloatArray, list[Touch]]:
    """Rigid motions that supports leave all bodies where an increment ended, works of loads on them, and what touches, by these.

    Nothing does that is told where loads do no work, or where a foot is lost.
    """
    motions = loaded_motions(equilibrium.problem, equilibrium.numbering, equilibrium.supports, state.positions)
    works = load_works(equilibrium, state.positions, motions)
    try:
        touches = touches_of(equilibrium.pairs, state, [motion.displacement for motion in motions]) if np.any(works) else []
    except LostProjectionError:
        touches = []
    return motions, works, touches


def load_works(equilibrium: Equilibrium, positions: FloatArray, motions: Sequence[FreeMotion]) -> FloatArray:
    """Work of all loads, and of the forces and moments of plates, on each motion, shape (motions,); zero where it is round-off.

    Which is that of the piece's own loads: those of heavier ones have none in it.
    """
    works, sizes = np.array([_work(equilibrium, positions, motion) for motion in motions]).reshape(-1, 2).T
    pieces, largest = np.array([motion.piece for motion in motions], dtype=np.int64), np.zeros(len(equilibrium.numbering.pieces))
    np.maximum.at(largest, pieces, sizes)
    return np.where(np.abs(works) > constants.NO_PART * largest[pieces], works, 0.0)


def _work(equilibrium: Equilibrium, positions: FloatArray, motion: FreeMotion) -> tuple[float, float]:
    """The work on a motion of forces on control points and of plates' forces and moments, and what it would be if all went along it."""
    supports, time = equilibrium.supports, equilibrium.time
    forces = sum(equilibrium.loads.forces(positions, time), supports.fading(time))
    work = float(np.sum(forces * motion.displacement))
    size = float(np.linalg.norm(forces, axis=1) @ np.linalg.norm(motion.displacement, axis=1))
    piece, (shift, turn) = equilibrium.numbering.pieces[motion.piece], motion.amounts.reshape(2, 3)
    (centre, length), bodies = extent(piece), {body.name for body in piece}
    for plate in supports.plates:
        if equilibrium.problem.supports[plate.support].place.body in bodies:
            there = supports.centre(equilibrium.problem.supports[plate.support], time, positions)
            goes = shift + np.cross(turn, there - centre) / length
            parts = supports.factor(plate, time) * np.append(plate.force * goes, plate.moment * (plate.axis @ turn) / length)
            work, size = work + float(parts.sum()), size + float(np.abs(parts).sum())
    return work, size
