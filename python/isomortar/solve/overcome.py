"""Loads that friction cannot bear, judged by themselves: where they grow in proportion no increment converges that would tell."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from isomortar.errors import LostProjectionError
from isomortar.geometry.patch import FloatArray
from isomortar.model import constants
from isomortar.model.glue import named
from isomortar.model.rank import extent, motions_left
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.limit_load import Touch, along_contact, least_resisted, pressed_bed, touches_of
from isomortar.solve.more_friction import more_friction
from isomortar.solve.record import State
from isomortar.solve.touching import displacement

#: Share of what friction can bear from which on it is told of: pressures are those below a rigid body, which moments notice.
ALL = 0.9
#: Loads of more than so many times what friction can bear: a body that rolls, of which something else is to be said.
ROLLS = 1e6
#: A motion is a turn where the body's ends go this share of its way apart.
TURNS = 0.01
#: Bodies go along where they go this share of the farthest one's way.
GOES = 0.1


@dataclass(frozen=True)
class _Motion:
    """A rigid motion that supports leave a piece: along axes and about them by its size, shape (6,); as displacements of all points."""

    piece: int
    amounts: FloatArray
    displacement: FloatArray


def overcome(equilibrium: Equilibrium, state: State) -> Iterator[str]:
    """Sentences, without a capital, on bodies whose loads friction cannot bear at the pressures that hold them otherwise (theory 9.11).

    Parameters
    ----------
    equilibrium : Equilibrium
        Its loads are those at the end of the increment that was begun last.
    state : State
        Where the last load increment ended that converged.
    """
    motions = _motions(equilibrium, state.positions)
    works = np.array([_work(equilibrium, state.positions, motion) for motion in motions])
    try:
        touches = touches_of(equilibrium.pairs, state, [motion.displacement for motion in motions]) if np.any(works) else []
    except LostProjectionError:
        return
    along = along_contact(touches)
    bed = pressed_bed(touches, works, along) if along.size else None
    if bed is None:
        return
    limits = [touch.limits(bed) for touch in touches]
    way = least_resisted(touches, limits, along, works)
    borne = np.array([limit @ touch.lengths(way) for touch, limit in zip(touches, limits, strict=True)])
    if 1.0 / ROLLS < borne.sum() < 1.0 / ALL:
        resist = [k for k, part in enumerate(borne) if part > constants.IN_THE_WAY * borne.sum()]
        more = more_friction([(touches[k].pair.pair.contact, limits[k], limits[k] * touches[k].lengths(way)) for k in resist])
        yield from _said(equilibrium, [touches[k] for k in resist], motions, way, float(borne.sum()), more)


def _motions(equilibrium: Equilibrium, positions: FloatArray) -> list[_Motion]:
    """The rigid motions that supports leave all bodies where these are, if loads act."""
    numbering, stage = equilibrium.numbering, equilibrium.supports.stage
    return [
        _Motion(k, amounts, displacement(numbering, piece, amounts, positions))
        for k, piece in enumerate(numbering.pieces if equilibrium.motions else ())
        for amounts in motions_left(equilibrium.problem, piece, stage)
    ]


def _work(equilibrium: Equilibrium, positions: FloatArray, motion: _Motion) -> float:
    """Work of all loads, and of the forces and moments of plates, on a motion."""
    supports, time = equilibrium.supports, equilibrium.time
    work = float(np.sum(sum(equilibrium.loads.forces(positions, time), supports.fading(time)) * motion.displacement))
    piece, (shift, turn) = equilibrium.numbering.pieces[motion.piece], motion.amounts.reshape(2, 3)
    (centre, size), bodies = extent(piece), {body.name for body in piece}
    for plate in supports.plates:
        if equilibrium.problem.supports[plate.support].place.body in bodies:
            goes = shift + np.cross(turn, plate.centre - centre) / size
            work += supports.factor(plate, time) * float(plate.force @ goes + plate.moment * (plate.axis @ turn) / size)
    return work


def _said(
    equilibrium: Equilibrium, touches: Sequence[Touch], motions: Sequence[_Motion], way: FloatArray, borne: float, more: str
) -> Iterator[str]:
    """On the bodies that go on a way on which loads do unit work; friction bears some of that at most, and what lets it bear more."""
    pieces, images = equilibrium.numbering.pieces, equilibrium.problem.images
    goes = np.zeros((len(pieces), 6))
    for share, motion in zip(way, motions, strict=True):
        goes[motion.piece] += share * motion.amounts
    lengths = np.linalg.norm(goes, axis=1)
    bodies = " and ".join(named(pieces[k], pieces[k][0].name) for k in np.flatnonzero(lengths > GOES * lengths.max()))
    shift, turn = goes[np.argmax(lengths)].reshape(2, 3)
    turns = np.linalg.norm(turn) > TURNS * np.linalg.norm(shift)
    if turns and not all(touch.is_face for touch in touches):
        return
    rates = turn / extent(pieces[np.argmax(lengths)])[1] if turns else shift
    far = float(np.linalg.norm(rates))
    along = ", ".join(f"{value:g}" for value in np.round(rates / far, 2) + 0.0)
    contacts = " and ".join(repr(touch.pair.pair.contact.name) for touch in touches)
    yield (
        f"loads {'turn' if turns else 'push'} {bodies} {'about an axis ' if turns else ''}along ({along}) by {images / far:.3g} by then, "
        f"where friction of contact {contacts} can bear about {images * borne / far:.3g} at the pressures that hold it otherwise, and "
        f"nothing else does: beyond that it slides, and is nowhere at rest. Take {more}, or less load that way, or hold or move it "
        "by a support"
    )
