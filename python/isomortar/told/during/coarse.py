"""Meshes that are too coarse for a contact, on either side of it: what is told of them at the end of each stage."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from isomortar.solve.contact import PutOff
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.record import ContactState
from isomortar.told.borne import Borne
from isomortar.told.during.between_points import between_points
from isomortar.told.during.beyond_edges import beyond_edges
from isomortar.told.during.giving_way import Yields, giving_way
from isomortar.told.during.long_elements import LongElementsLook
from isomortar.told.during.narrow import areas, bearing
from isomortar.told.during.softness import pressed_in

#: Share of the largest force of a contact below which it opens, or hardly begins: its last row is no fault of the mesh.
LIGHT = 0.1


class Coarse:
    """Warnings of contacts whose meshes are too coarse for them at the end of a stage; one a contact.

    What bore when the computation begins, or goes on, counts as borne before.
    """

    def __init__(self, equilibrium: Equilibrium, states: Sequence[ContactState]) -> None:
        self._equilibrium, self._problem = equilibrium, equilibrium.problem
        self._watched = dict(enumerate(equilibrium.pairs))
        self._areas = [areas(mechanics.pair, mechanics.pair.slave.area) for mechanics in equilibrium.pairs]
        self._largest = np.array([state.pressure @ area for state, area in zip(states, self._areas, strict=True)])
        self._borne = Borne(self._problem, states)
        self._looks = (bearing, between_points, beyond_edges, LongElementsLook())  # the first that finds something tells

    def after_step(self, balance: Balance, step: int, ends: bool) -> Iterator[str]:
        """Warnings that the end of a load step gives rise to, if it `ends` a stage: all contact of round bodies is narrow at first."""
        self._borne.see(response.pressure for response in balance.responses)
        for number in list(self._watched):
            if isinstance(balance.kinematics[number], PutOff):
                continue
            pressure = balance.responses[number].pressure
            force = float(pressure @ self._areas[number])
            self._largest[number] = max(force, self._largest[number])
            bears = self._borne.more_than_nothing(number, float(np.abs(pressure).max(initial=0.0)))
            if not ends or not bears or force <= LIGHT * self._largest[number]:
                continue
            sentence = self._sentence(balance, number, step)
            if sentence:
                del self._watched[number]
                yield sentence

    def _sentence(self, balance: Balance, number: int, step: int) -> str:
        """What is told of a contact; empty: nothing. How far it moves its bodies is asked where something would be told of deep ones."""
        equilibrium = self._equilibrium
        pair, projections = equilibrium.pairs[number].pair, balance.kinematics[number].projections
        pressure = abs(pair.field(balance.responses[number].pressure)) * (projections.found > 0)
        deep = Yields(pressed_in(equilibrium, pair, projections, pressure), np.zeros(2))
        as_they_are: Yields | None = None
        for look in self._looks:
            found = look(equilibrium, balance, number, deep)
            if found is not None and found.is_told:
                as_they_are = as_they_are or replace(deep, ways=giving_way(equilibrium, balance, number))
                found = replace(found, yields=as_they_are)
                if found.is_told:
                    return found.sentence(self._problem, pair.contact, step)
        return ""
