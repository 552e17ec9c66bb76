"""Slave points that are inside a master although their contact is open: its constraints are too coarse to see them."""

from __future__ import annotations

import numpy as np

from isomortar.model import constants
from isomortar.solve.contact import PutOff
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.feet import gaps


class Unseen:
    """The largest depth at which slave points of each contact were while no constraint of it was active.

    Attributes
    ----------
    depths : dict
        By name of contact; none where all points were outside, but for round-off.
    """

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._equilibrium = equilibrium
        self.depths = dict[str, float]()

    def after_step(self, balance: Balance) -> None:
        """Look at the contacts that are open, and in reach, at the end of a load step."""
        for number, contact in enumerate(self._equilibrium.problem.contacts):
            kinematics = balance.kinematics[number]
            if isinstance(kinematics, PutOff) or np.any(balance.responses[number].state):
                continue
            depth = float(gaps(self._equilibrium.pairs[number].pair, balance.positions, kinematics.projections).max(initial=0.0))
            if depth > constants.CLEAR * float(np.abs(balance.positions).max()):
                self.depths[contact.name] = max(depth, self.depths.get(contact.name, 0.0))
