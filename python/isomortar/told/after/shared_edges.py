"""Contacts of adjoining faces that meet at the edge between them: what sticks there to both masters is held twice."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from isomortar.errors import LostProjectionError
from isomortar.model.entities import Contact
from isomortar.model.supports import BoolArray
from isomortar.solve.contact import PairMechanics
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import State
from isomortar.solve.resting import mean_heights, next_to_nothing


def shared_edges(equilibrium: Equilibrium, state: State) -> Iterator[str]:
    """Sentences, without a capital, on contacts that touch on the same slave control points, of which friction holds some."""
    touching = [_touching(pair, state, number) for number, pair in enumerate(equilibrium.pairs)]
    for (i, one), (j, other) in combinations(enumerate(equilibrium.pairs), 2):
        first, second = one.pair, other.pair
        _, mine, theirs = np.intersect1d(first.slave.point, second.slave.point, return_indices=True)
        count = int(np.count_nonzero(touching[i][mine] & touching[j][theirs]))
        rough = [repr(pair.pair.contact.name) for pair in (one, other) if pair.friction.acts]
        if count and rough and _adjoin(first.contact, second.contact):
            yield (
                f"contacts {first.contact.name!r} and {second.contact.name!r} touch on {count} slave control points at the edge between "
                "their faces, and what sticks to one master there is pushed along by the other one: take friction from "
                f"{' or '.join(rough)}"
            )


def _adjoin(one: Contact, other: Contact) -> bool:
    """Whether slaves are faces of a body that meet at an angle; those of bodies that are glued side by side may go on from each other."""
    return any(a.body == b.body and a.face[0] != b.face[0] for a in one.slave.faces for b in other.slave.faces)


def _touching(pair: PairMechanics, state: State, number: int) -> BoolArray:
    """Whether constraints of a pair that touch, or bear, are on its slave control points; none, where a foot is lost."""
    contact = state.contacts[number]
    try:
        heights = mean_heights(pair.kinematics(state.positions, contact).control)
    except LostProjectionError:
        return np.zeros(len(pair.pair.slave.point), dtype=bool)
    near = (contact.pressure > 0.0) | (np.isfinite(heights) & (heights >= -next_to_nothing(pair)))
    return np.asarray(abs(pair.pair.carriers.T) @ near.astype(np.float64) != 0.0)
