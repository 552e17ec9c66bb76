"""Contacts on adjoining faces of a body: what sticks to both masters at the edge between them leans on either one."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import ContactResult, StepResult


class Sharing:
    """Warnings of contacts that share their forces in any way; each is given once two contacts."""

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._pairs: list[tuple[int, int, str, NDArray[np.intp], NDArray[np.intp]]] = []
        for (i, one), (j, other) in combinations(enumerate(equilibrium.pairs), 2):
            if not (one.friction.acts or other.friction.acts):
                continue
            names = f"contacts {one.pair.contact.name!r} and {other.pair.contact.name!r}"
            _, mine, theirs = np.intersect1d(one.pair.slave.point, other.pair.slave.point, return_indices=True)
            if one.pair.contact.slave != other.pair.contact.slave and mine.size:
                self._pairs.append((i, j, names, mine, theirs))

    def after_step(self, result: StepResult) -> Iterator[str]:
        """Warnings that the end of a load step gives rise to."""
        for entry in list(self._pairs):
            i, j, names, mine, theirs = entry
            count = _stuck(result.contacts[i], mine, result.contacts[j], theirs)
            if count:
                self._pairs.remove(entry)
                yield (
                    f"{names}, load step {result.step}: {count} slave control points at the edge between them bear on both and stick. How "
                    "the two share the forces there is left open (their sum is not). Refine towards that edge, or take friction from one"
                )


def _stuck(one: ContactResult, mine: NDArray[np.intp], other: ContactResult, theirs: NDArray[np.intp]) -> int:
    """How many control points are active in both contacts and stick in one."""
    states = np.stack([one.status[mine], other.status[theirs]])
    return int(np.count_nonzero(np.all(states > 0, axis=0) & np.any(states == 1, axis=0)))
