"""Slave points that leave the master under load: what they carried is gone from one load step to the next."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model.pairs import Pair
from isomortar.model.shares import percent
from isomortar.model.supports import BoolArray
from isomortar.solve.record import ContactResult, ContactState
from isomortar.told.during.advice import FAR

#: Share of a contact's force, load steps together, from which on it is told that points which carried it have left: jumps of less are
#: smaller than what meshes leave of forces.
CARRIED = 0.01


class Leaving:
    """Warnings of slave points that leave the master and carried something; each is given once a contact.

    A point carried what the field of pressures was there when the load step began, or, if that is next to nothing, what it is when it ends:
    functions of control points that are still on the master go on over its edge. What is open may leave.

    Parameters
    ----------
    pairs : sequence of Pair
    states : sequence of ContactState
        Those of the contacts when the computation begins, or goes on.
    """

    def __init__(self, pairs: Sequence[Pair], states: Sequence[ContactState]) -> None:
        self._pairs, self._before = list(pairs), list(states)
        self._points = np.zeros(len(self._pairs), dtype=np.int64)
        self._shares = np.zeros(len(self._pairs))
        self._told = np.zeros(len(self._pairs), dtype=np.bool_)

    def after_step(self, step: int, results: Sequence[ContactResult], states: Sequence[ContactState]) -> Iterator[str]:
        """Warnings that the end of a load step gives rise to."""
        began, self._before = self._before, list(states)
        for number, (pair, result, before, after) in enumerate(zip(self._pairs, results, began, states, strict=True)):
            left = (before.projected > 0) & (after.projected == 0)
            if self._told[number] or not result.active or not left.any():
                continue
            carried = [_shares(pair, state, left) * left for state in (before, after)]
            self._points[number] += np.count_nonzero(np.any(carried, axis=0))
            did, does = (float(share.sum()) for share in carried)
            self._shares[number] += did if did > CARRIED else max(did, does)
            if self._shares[number] > CARRIED:
                self._told[number] = True
                yield _sentence(pair, int(self._points[number]), float(self._shares[number]), step)


def _shares(pair: Pair, state: ContactState, left: BoolArray) -> FloatArray:
    """Share of the normal force that acts at each slave point, shape (points,), those that have `left` as if they had a foot.

    There a field of coefficients that oscillate, as little is over them, counts up to what it reaches elsewhere.
    """
    on = state.projected > 0
    field = np.maximum(pair.field(state.pressure), 0.0)
    forces = pair.slave.area * np.minimum(field, field[on].max(initial=0.0)) * (on | left)
    whole = float(forces.sum())
    return np.asarray(forces / whole) if whole > 0.0 else np.zeros_like(forces)


def _sentence(pair: Pair, points: int, share: float, step: int) -> str:
    """What is said of points that carried so much."""
    return (
        f"contact {pair.contact.name!r}, load step {step}: {points} slave quadrature points have left the master"
        f"{FAR if pair.contact.averaged else ''}; what they carried, about {percent(min(share, 1.0))} of the contact's force, is gone in a "
        "jump. Use a larger master or smaller load steps"
    )
