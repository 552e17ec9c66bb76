"""Contact whose points are at the master already, and whose constraints are averages that are still apart: nothing bears there."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.errors import LostProjectionError
from isomortar.solve.contact import PairMechanics
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.feet import gaps
from isomortar.solve.free_motions import free_motions
from isomortar.solve.record import ContactState, State
from isomortar.solve.resting import mean_heights, next_to_nothing

#: Share of how far averages are apart that points are apart at the most, where the averages alone keep contact from bearing.
TOUCHES = 0.1


def averages_apart(equilibrium: Equilibrium, state: State) -> Iterator[str]:
    """Sentences, without a capital, on contacts of bodies that can move freely.

    Parameters
    ----------
    equilibrium : Equilibrium
    state : State
        Where the last load increment ended that converged.
    """
    numbering = equilibrium.numbering
    motions = free_motions(equilibrium.problem, numbering, equilibrium.supports, state.positions)
    free = {body.name for motion in motions for body in numbering.pieces[motion.piece]}
    for pair, begun in zip(equilibrium.pairs, state.contacts, strict=True):
        apart = _apart(pair, state, begun) if free & pair.pair.contact.bodies else 0.0
        if apart:
            contact = pair.pair.contact
            yield (
                f"contact {contact.name!r}: points of the slave touch its master, but its constraints are averages over elements, of which "
                f"the nearest is {apart:.2g} apart, and bear nothing before that is gone. Refine {contact.slave.words} where it touches "
                f"(bodies.{contact.slave.body}.mesh.elements)"
            )


def _apart(pair: PairMechanics, state: State, begun: ContactState) -> float:
    """How far the nearest average of an open pair is from a master that its points touch; 0 where it is not so."""
    try:
        kinematics = pair.kinematics(state.positions, begun)
    except LostProjectionError:
        return 0.0
    apart = -float(mean_heights(kinematics.control).max())
    if np.any(begun.pressure != 0.0) or not next_to_nothing(pair) < apart < np.inf:
        return 0.0
    found = kinematics.projections.found > 0
    return apart if gaps(pair.pair, state.positions, kinematics.projections)[found].max() > -TOUCHES * apart else 0.0
