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
    parts = [_parts(equilibrium, positions, motion) for motion in motions]
    works = np.array([part.sum() for part in parts])
    pieces, largest = np.array([motion.piece for motion in motions], dtype=np.int64), np.zeros(len(equilibrium.numbering.pieces))
    np.maximum.at(largest, pieces, [np.abs(part).sum() for part in parts])
    return np.where(np.abs(works) > constants.NO_PART * largest[pieces], works, 0.0)


def _parts(equilibrium: Equilibrium, positions: FloatArray, motion: FreeMotion) -> FloatArray:
    """The work on a motion of the force on each control point, and of each plate's force and moment."""
    supports, time = equilibrium.supports, equilibrium.time
    forces = sum(equilibrium.loads.forces(positions, time), supports.fading(time))
    parts = [np.ravel(forces * motion.displacement)]
    piece, (shift, turn) = equilibrium.numbering.pieces[motion.piece], motion.amounts.reshape(2, 3)
    (centre, size), bodies = extent(piece), {body.name for body in piece}
    for plate in supports.plates:
        if equilibrium.problem.supports[plate.support].place.body in bodies:
            there = supports.centre(equilibrium.problem.supports[plate.support], time, positions)
            goes = shift + np.cross(turn, there - centre) / size
            parts.append(supports.factor(plate, time) * np.append(plate.force * goes, plate.moment * (plate.axis @ turn) / size))
    return np.concatenate(parts)
