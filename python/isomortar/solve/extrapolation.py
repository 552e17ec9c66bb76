"""The first guess of a load increment: where it ends if all goes on as in the last one (theory 6.7)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model.supports import Supports
from isomortar.solve.contact import Multipliers, PairMechanics
from isomortar.solve.record import ContactRates, ContactState, Rates, State


def with_rates(before: State, after: State, time: float, length: float) -> State:
    """The state after an increment of some length that ended at a load time; with rates, unless a contact began or ended (theory 6.7)."""
    pairs = list(zip(before.contacts, after.contacts, strict=True))
    if any(new.pressure.any() != old.pressure.any() for old, new in pairs):
        return after
    contacts = (ContactRates((new.pressure - old.pressure) / length, (new.traction - old.traction) / length) for old, new in pairs)
    return replace(after, rates=Rates(time, (after.positions - before.positions) / length, tuple(contacts)))


def positions_ahead(start: State, rates: Rates, supports: Supports, time: float) -> FloatArray:
    """Positions at a load time, the prescribed ones where supports put them, shape (control points, 3) (theory 6.7)."""
    return supports.placed(start.positions + (time - rates.time) * rates.positions, time)


def multipliers_ahead(pair: PairMechanics, start: ContactState, rates: ContactRates, length: float) -> Multipliers:
    """Pressures and tractions of a pair after a length at their rates (theory 6.7).

    Those that no condition may tell stay, or they would go on for ever.
    """
    loose = pair.loose(start.projected)
    pressure = np.where(loose[:, 0], start.pressure, np.maximum(start.pressure + length * rates.pressure, 0.0))
    return pressure, np.where(loose[:, 1:], pair.sliding(start), start.traction + length * rates.traction)
