"""Contacts on adjoining faces of a body: what sticks to both masters at the edge between them leans on either one."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from isomortar._codes import PointState
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import StepResult


class Sharing:
    """Warnings of contacts that share their forces in any way; each is given once two contacts."""

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._carriers = [pair.pair.carriers for pair in equilibrium.pairs]
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
            count = _stuck(self._states(result, i)[mine], self._states(result, j)[theirs])
            if count:
                self._pairs.remove(entry)
                yield (
                    f"{names}, load step {result.step}: {count} slave control points at the edge between them bear on both and stick. How "
                    "the two share the forces there is left open (their sum is not). Refine towards that edge, or take friction from one"
                )

    def _states(self, result: StepResult, k: int) -> NDArray[np.bool_]:
        """Whether conditions of a contact act at its slave control points, and whether one of them sticks, shape (n, 2)."""
        status = result.contacts[k].status
        marks = np.column_stack([status > 0, status == PointState.STICK]).astype(np.float64)
        return np.asarray(abs(self._carriers[k].T) @ marks != 0.0)


def _stuck(one: NDArray[np.bool_], other: NDArray[np.bool_]) -> int:
    """How many control points are active in both contacts and stick in one."""
    return int(np.count_nonzero(one[:, 0] & other[:, 0] & (one[:, 1] | other[:, 1])))
