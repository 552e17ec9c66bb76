"""Slave points that went through their master: it is thin, and increments are long for it, or constraints do not feel the points."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from isomortar.errors import LostProjectionError, PassedThroughError
from isomortar.geometry.faces import cells
from isomortar.model import constants
from isomortar.model.entities import Face
from isomortar.solve.contact import PairMechanics
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.feet import gaps, slave_points
from isomortar.solve.record import State

#: Share of the master's thickness that points are inside it from which on constraints do not feel them: of narrow contacts that were given
#: up it was more than 0.99, of those whose first increment was longer than their master is thick round-off.
INSIDE = 0.5


def passed_through(equilibrium: Equilibrium, state: State, error: Exception) -> Iterator[str]:
    """Sentences, without a capital, on the contact whose point has passed through its master, if that ended a load step.

    Parameters
    ----------
    equilibrium : Equilibrium
    state : State
        Where the last load increment ended that converged.
    error : Exception
        Why the next one did not.
    """
    if not isinstance(error, PassedThroughError):
        return
    for number, pair in enumerate(equilibrium.pairs):
        contact = pair.pair.contact
        if not str(error).startswith(f"contact {contact.name!r}: ") or not isinstance(contact.master, Face):
            continue
        thick, depth = _thickness(equilibrium, state, pair, error.place), _depth(pair, state, number)
        if depth > INSIDE * thick:
            yield (
                f"contact {contact.name!r}: points of the slave are {depth:.2g} deep by then in its master, which is {thick:.2g} thick "
                f"there: they are between its constraints, which do not feel them. Refine {contact.slave.words} where it touches "
                f"(bodies.{contact.slave.body}.mesh.elements)"
            )
        else:
            cuts = equilibrium.problem.settings.max_cuts
            often = f", or let increments be halved more often than solver.max_cuts = {cuts}" if cuts < constants.MOST_CUTS else ""
            yield (
                f"contact {contact.name!r}: its master is {thick:.2g} thick there, and a step of the iteration goes through it in the "
                f"shortest increment. Take more load steps{often}"
            )


def _thickness(equilibrium: Equilibrium, state: State, pair: PairMechanics, place: int) -> float:
    """How thick the master's body is where it is nearest to a slave point."""
    contact, point = pair.pair.contact, slave_points(pair.pair, state.positions)[place]
    found = [(np.inf, np.inf)]
    for face in contact.master.faces if isinstance(contact.master, Face) else ():
        patch = equilibrium.problem.body(face.body).patch
        here = cells(replace(patch, control_points=equilibrium.numbering.of_patch(face.body, state.positions)), face.face)
        away = np.linalg.norm(here.centres - point, axis=1)
        found.append((float(away.min()), float(here.thickness[np.argmin(away)])))
    return min(found)[1]


def _depth(pair: PairMechanics, state: State, number: int) -> float:
    """How far the deepest slave point is inside its master."""
    try:
        kinematics = pair.kinematics(state.positions, state.contacts[number])
    except LostProjectionError:
        return 0.0
    return float(gaps(pair.pair, state.positions, kinematics.projections).max(initial=0.0))
