"""Loads that friction cannot bear, judged by themselves: where they grow in proportion no increment converges that would tell."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import compress

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.model import constants
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.free_motions import FreeMotion, direction, going
from isomortar.solve.record import State
from isomortar.told.after.limit_load import Touch, along_contact, groups_of, least_resisted, pressed_bed
from isomortar.told.after.load_work import borne_loads
from isomortar.told.after.more_friction import more_friction

#: Share of what friction can bear from which on it is told of: pressures are those below a rigid body, which moments notice.
ALL = 0.9
#: Loads of more than so many times what friction can bear: a body that rolls, of which something else is to be said.
ROLLS = 1e6


@frozen
class _Slide:
    """The way on which friction resists bodies that touch least, what it can bear at each constraint, and by contact of the work on it."""

    touches: list[Touch]
    motions: list[FreeMotion]
    way: FloatArray
    limits: list[FloatArray]
    borne: FloatArray


def overcome(equilibrium: Equilibrium, state: State) -> Iterator[tuple[set[int], str]]:
    """Pieces and sentences, without a capital, on bodies whose loads friction cannot bear at the pressures that hold them (theory 9.11).

    Parameters
    ----------
    equilibrium : Equilibrium
        Its loads are those at the end of the increment that was begun last.
    state : State
        Where the last load increment ended that converged.
    """
    motions, works, touches = borne_loads(equilibrium, state)
    if not touches:
        return
    for mine, near in groups_of(touches, np.array([motion.piece for motion in motions])):
        slide = _slide(near, works[mine], list(compress(motions, mine)))
        if slide is None or _holds(slide.touches, state, equilibrium, slide.way):
            continue
        resist = [k for k, part in enumerate(slide.borne) if part > constants.IN_THE_WAY * slide.borne.sum()]
        slips = [(slide.touches[k], slide.limits[k]) for k in resist]
        more = more_friction([(touch.pair.pair.contact, limit, limit * touch.lengths(slide.way)) for touch, limit in slips])
        said = _said(equilibrium, [touch for touch, _ in slips], slide.motions, slide.way, float(slide.borne.sum()), more)
        yield from (({motion.piece for motion in slide.motions}, sentence) for sentence in said)


def _slide(touches: list[Touch], works: FloatArray, motions: list[FreeMotion]) -> _Slide | None:
    """Of bodies that touch; None: friction bears their loads, or beds do not, or nothing resists these."""
    along = along_contact(touches)
    bed = pressed_bed(touches, works, along) if along.size else None
    if bed is None:
        return None
    limits = [touch.limits(bed) for touch in touches]
    way = least_resisted(touches, limits, along, works)
    borne = np.array([limit @ touch.lengths(way) for touch, limit in zip(touches, limits, strict=True)])
    return _Slide(touches, motions, way, limits, borne) if 1.0 / ROLLS < borne.sum() < 1.0 / ALL else None


def _holds(touches: Sequence[Touch], state: State, equilibrium: Equilibrium, way: FloatArray) -> bool:
    """Whether friction at the pressures that contacts had before, as those that motions of supports make, bears the loads."""
    begun = dict(zip(equilibrium.pairs, state.contacts, strict=True))
    borne = [float(touch.pair.radius(begun[touch.pair].pressure)[touch.near] @ touch.lengths(way)) for touch in touches]
    return sum(borne) > 1.0 / ALL


def _said(
    equilibrium: Equilibrium, touches: Sequence[Touch], motions: Sequence[FreeMotion], way: FloatArray, borne: float, more: str
) -> Iterator[str]:
    """On the bodies that go on a way on which loads do unit work; friction bears some of that at most, and what lets it bear more."""
    goes, images = going(equilibrium.numbering, motions, way), equilibrium.problem.images
    if goes.turns and not all(touch.is_face for touch in touches):
        return
    rates = goes.turn if goes.turns else goes.shift
    far = float(np.linalg.norm(rates))
    contacts = " and ".join(repr(touch.pair.pair.contact.name) for touch in touches)
    yield (
        f"loads {'turn' if goes.turns else 'push'} {goes.bodies} {'about an axis ' if goes.turns else ''}along ({direction(rates)}) by "
        f"{images / far:.3g} by then, where friction of contact {contacts} can bear about {images * borne / far:.3g} at the pressures that "
        f"hold it otherwise, and nothing else does: beyond that it slides, and is nowhere at rest. Take {more}, or less load that "
        "way, or hold or move it by a support"
    )
