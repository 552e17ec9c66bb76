"""Bodies on their way to a contact by loads alone: nothing bears them until they touch, or says where they are."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.errors import LostProjectionError
from isomortar.geometry.patch import FloatArray
from isomortar.model.glue import named
from isomortar.solve.contact import PairMechanics
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.free_motions import loaded_motions
from isomortar.solve.record import ContactState, State
from isomortar.solve.resting import mean_heights
from isomortar.told.after.load_work import load_works

#: What loads do to a body on its way, and what helps: as they move it, or balance each other and deform it, as pressure in a tube.
DRIVEN = (
    "and its loads move it until something bears it: smaller increments make that way no shorter. Bring it into contact by the motion of a "
    "support first, in a stage of its own, or begin nearer"
)
BALANCED = (
    "and its loads balance each other: nothing says where it goes before it touches. Hold it by a support, begin nearer, or with a load "
    "that closes the gap at once"
)
#: Share of a slave face's size within which its constraints stand at their master: what is as near has no way to go.
NEAR = 0.01


def on_the_way(equilibrium: Equilibrium, state: State) -> Iterator[tuple[set[int], str]]:
    """Pieces and sentences, without a capital, on bodies that supports leave to their loads and that are apart from all others.

    Parameters
    ----------
    equilibrium : Equilibrium
    state : State
        Where the last load increment ended that converged.
    """
    motions = loaded_motions(equilibrium.problem, equilibrium.numbering, equilibrium.supports, state.positions)
    works = load_works(equilibrium, state.positions, motions)
    driven = {motion.piece for motion, work in zip(motions, works, strict=True) if work != 0.0}
    bodies = {load.body for load in equilibrium.problem.loads}
    pieces = {k: piece for k, piece in enumerate(equilibrium.numbering.pieces) if not bodies.isdisjoint(body.name for body in piece)}
    contacts = zip(equilibrium.pairs, state.contacts, strict=True) if motions else ()
    near = {name for pair, begun in contacts if _is_near(pair, state.positions, begun) for name in pair.pair.contact.bodies}
    for number in sorted(driven | {motion.piece for motion in motions if motion.piece in pieces}):
        piece = equilibrium.numbering.pieces[number]
        if near.isdisjoint(body.name for body in piece):
            yield {number}, f"{named(piece, piece[0].name)} touches nothing where that begins, {DRIVEN if number in driven else BALANCED}"


def _is_near(pair: PairMechanics, positions: FloatArray, begun: ContactState) -> bool:
    """Whether a pair bears, or stands so near that there is next to no way to go; one that has passed through its master does not wait."""
    try:
        heights = mean_heights(pair.kinematics(positions, begun).control)
    except LostProjectionError:
        return True
    return bool(np.any(begun.pressure != 0.0) or np.any(heights > -NEAR * np.sqrt(pair.pair.area)))
