"""Bodies that loads push on until friction bears all that it can: beyond that they slide, and no place is one of rest."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Contact
from isomortar.model.glue import named
from isomortar.solve.contact import PairMechanics
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.free_motions import loaded_motions
from isomortar.solve.metric import traction_norms
from isomortar.solve.record import ContactState, State
from isomortar.told.after.more_friction import more_friction
from isomortar.told.borne import round_off

#: Share of what friction can bear above which a body is about to slide: what the last load increment before adds is less than the rest.
ALL = 0.9
#: Friction holds a body where at least this share of it acts along rigid motions that supports leave: where it is squeezed only, none does.
HOLDS = 0.1


def sliding(equilibrium: Equilibrium, state: State) -> Iterator[tuple[set[int], str]]:
    """Pieces and sentences, without a capital, on bodies that friction alone keeps from going along with their loads, and has no more.

    Parameters
    ----------
    equilibrium : Equilibrium
    state : State
        Where the last load increment ended that converged.
    """
    found = loaded_motions(equilibrium.problem, equilibrium.numbering, equilibrium.supports, state.positions)
    for number, piece in enumerate(equilibrium.numbering.pieces):
        motions = [motion.displacement for motion in found if motion.piece == number]
        names = {body.name for body in piece}
        pairs = [
            (pair, begun)
            for pair, begun in zip(equilibrium.pairs, state.contacts, strict=True)
            if pair.pair.contact.bodies & names and begun.pressure.max(initial=0.0) > round_off(equilibrium.problem, pair.pair.contact)
        ]
        if not motions or not pairs:
            continue
        borne = float(sum(_borne(pair, state.positions, begun) for pair, begun in pairs))
        limits = [_limits(pair, state.positions, begun) for pair, begun in pairs]
        most = float(sum(parts.sum() for _, _, parts in limits))
        friction = np.sum([_friction(pair, state.positions, begun) for pair, begun in pairs], axis=0)
        along = np.linalg.norm(np.einsum("mij,ij->m", np.stack(motions), friction))
        if borne > ALL * most and along > HOLDS * np.linalg.norm(friction, axis=1).sum():
            contacts = " and ".join(repr(pair.pair.contact.name) for pair, _ in pairs)
            yield (
                {number},
                (
                    f"friction of contact {contacts} bears {100.0 * borne / most:.0f} % of what it can by then, and nothing else keeps "
                    f"{named(piece, piece[0].name)} from going along with its loads: beyond that it slides, and is nowhere at rest. Take "
                    f"smaller loads or {more_friction(limits)}, or hold or move it by a support"
                ),
            )


def _borne(pair: PairMechanics, positions: FloatArray, state: ContactState) -> float:
    """Sum of the sizes of a pair's tractions, as a force."""
    control = pair.kinematics(positions, state).control
    return float(control.weight @ traction_norms(control, state.traction))


def _limits(pair: PairMechanics, positions: FloatArray, state: ContactState) -> tuple[Contact, FloatArray, FloatArray]:
    """What a pair's tractions can be at most, as tractions and as forces."""
    largest = pair.radius(state.pressure)
    return pair.pair.contact, largest, pair.kinematics(positions, state).control.weight * largest


def _friction(pair: PairMechanics, positions: FloatArray, state: ContactState) -> FloatArray:
    """Forces of a pair's tractions alone on all control points, shape (control points, 3)."""
    forces = np.zeros_like(positions)
    tractions = replace(state, pressure=np.zeros_like(state.pressure))
    pair.add_forces(positions, pair.kinematics(positions, state), pair.bearing(tractions), forces)
    return forces
