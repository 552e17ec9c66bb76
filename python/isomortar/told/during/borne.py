"""What contacts bear: more than round-off of their bodies' coordinates, and more than balance leaves open."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Contact, Problem, RigidPlane
from isomortar.model.sheet import Sheet
from isomortar.solve.record import ContactState

#: Share of the modulus of a contact's softest body up to which pressures are round-off of its coordinates.
NO_PRESSURE = 1e-12


class Borne:
    """The highest pressure of all contacts so far, and which of them bear anything beside it.

    Parameters
    ----------
    problem : Problem
    states : sequence of ContactState
        Those of the contacts when the computation begins, or goes on.
    """

    def __init__(self, problem: Problem, states: Sequence[ContactState]) -> None:
        self._round_off = [_round_off(problem, contact) for contact in problem.contacts]
        self._tolerance = problem.settings.newton_tolerance
        self._highest = 0.0
        self.see(state.pressure for state in states)

    def see(self, pressures: Iterable[FloatArray]) -> None:
        """Those of the constraints of all contacts at the end of a load step."""
        self._highest = float(np.max([self._highest, *(np.abs(pressure).max(initial=0.0) for pressure in pressures)]))

    def more_than_nothing(self, number: int, pressure: float) -> bool:
        """Whether a pressure of that contact is neither round-off nor what balance leaves open."""
        return pressure > max(self._round_off[number], self._tolerance * self._highest)


def _round_off(problem: Problem, contact: Contact) -> float:
    """Pressure up to which a contact bears nothing, by the modulus of the softest body of both sides."""
    sides = [contact.slave, *([] if isinstance(contact.master, RigidPlane) else [contact.master])]
    moduli = [body.modulus for side in sides for body in Sheet.of(problem, side).bodies if not body.rigid]
    return NO_PRESSURE * min(moduli, default=0.0)
