"""What contacts bear: more than round-off of their bodies' coordinates, and more than balance leaves open."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Contact, Face, Problem, RigidPlane
from isomortar.model.glue import pieces
from isomortar.model.sheet import Sheet
from isomortar.solve.record import ContactState

#: Share of the modulus of a contact's softest body up to which pressures are round-off of its coordinates.
NO_PRESSURE = 1e-12


class Borne:
    """The highest pressure so far that acts on bodies of each contact, and which contacts bear anything beside it.

    Parameters
    ----------
    problem : Problem
    states : sequence of ContactState
        Those of the contacts when the computation begins, or goes on.
    """

    def __init__(self, problem: Problem, states: Sequence[ContactState]) -> None:
        self._round_off = [round_off(problem, contact) for contact in problem.contacts]
        self._tolerance = problem.settings.newton_tolerance
        bodies = [_bodies(problem, contact) for contact in problem.contacts]
        self._shared = np.array([bool(one & other) for one in bodies for other in bodies]).reshape(2 * (len(bodies),))
        self._highest = np.zeros(len(bodies))
        self.see(state.pressure for state in states)

    def see(self, pressures: Iterable[FloatArray]) -> None:
        """Those of the constraints of all contacts at the end of a load step."""
        highest = np.array([np.abs(pressure).max(initial=0.0) for pressure in pressures])
        self._highest = np.maximum(self._highest, np.max(self._shared * highest, axis=1, initial=0.0))

    def more_than_nothing(self, number: int, pressure: float) -> bool:
        """Whether a pressure of that contact is neither round-off nor what balance leaves open."""
        return pressure > max(self._round_off[number], self._tolerance * self._highest[number])


def round_off(problem: Problem, contact: Contact) -> float:
    """Pressure up to which a contact bears nothing, by the modulus of the softest body of both sides."""
    moduli = [body.modulus for side in _sides(contact) for body in Sheet.of(problem, side).bodies if not body.rigid]
    return NO_PRESSURE * min(moduli, default=0.0)


def _bodies(problem: Problem, contact: Contact) -> set[str]:
    """Names of the bodies of both sides, and of all that is glued to them: balance is measured by these (theory 5.6)."""
    names = {name for name in contact.bodies if not problem.body(name).rigid}
    return {body.name for piece in pieces(problem) if any(body.name in names for body in piece) for body in piece}


def _sides(contact: Contact) -> list[Face]:
    return [contact.slave, *([] if isinstance(contact.master, RigidPlane) else [contact.master])]
