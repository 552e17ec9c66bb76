"""Patterns of a contact pair: they grow as slave elements reach new master elements, and stand otherwise."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from isomortar._bindings import Pattern, Projections
from isomortar._frozen import frozen
from isomortar.geometry.patch import IntArray
from isomortar.model.pairs import Pair
from isomortar.model.pattern import pattern_of, rows_of


@frozen
class ContactPatterns:
    """Patterns of constraint rows, of the multipliers' derivatives, and of the contact tangent."""

    rows: Pattern
    wide: Pattern
    tangent: Pattern


class Reach:
    """Which control points the constraint rows of a pair reach.

    `update` keeps the patterns while everything needed is in them; else it rebuilds them, with what the same load increment
    needed before, so that Newton's iterations do not trade one pattern for another. The next increment begins with none: what an
    earlier one needed would change the order of elimination, and a run that is resumed would differ in its last bits.
    A `condensed` tangent couples all that the rows of a constraint reach; else it couples the control points of an element alone.
    """

    def __init__(self, pair: Pair, summed: bool, condensed: bool) -> None:
        self._pair = pair
        self._condensed = condensed
        self._summed = summed
        self._touched = np.zeros(0, dtype=np.int64)
        self._active = np.zeros(pair.slave.test.count, dtype=bool)
        self._fresh = True
        self.patterns: ContactPatterns | None = None

    def begin(self) -> None:
        """Begin a load increment: forget what earlier ones needed."""
        self._fresh, self.patterns = True, None

    def update(self, projections: Projections, state: IntArray) -> ContactPatterns:
        """The patterns for the given projections and states of the constraints."""
        active = state > 0
        touched = self._touched_elements(projections, active)
        if self.patterns is not None and not np.any(active & ~self._active) and _is_part(touched, self._touched):
            return self.patterns
        if not self._fresh:
            active, touched = active | self._active, np.union1d(touched, self._touched)
        self._fresh, self._active, self._touched = False, active, touched
        self.patterns = self._build(active, touched)
        return self.patterns

    def _touched_elements(self, projections: Projections, active: np.ndarray) -> np.ndarray:
        """Pairs of a slave element with an active constraint and a master element that it projects on, as one number."""
        pair = self._pair
        if pair.master_reach is None:
            return np.zeros(0, dtype=np.int64)
        element = np.repeat(np.arange(pair.slave.elements), pair.slave.per_element)
        counts = (projections.found > 0) & np.any(active[pair.slave.test.nodes], axis=1)[element]
        meets = [(element[counts], projections.element[counts])]
        if pair.contact.averaged:  # slips are measured from where the foot was
            counts &= projections.slips > 0
            origin = projections.origin[counts]
            before = [np.searchsorted(bounds[1:-1], xi, side="right") for bounds, xi in zip(pair.master_boundaries, origin.T, strict=True)]
            meets.append((element[counts], np.column_stack(before)))
        elements, places = (np.concatenate(parts).astype(np.int64) for parts in zip(*meets, strict=True))
        return np.unique(elements * pair.master_reach.shape[0] + places[:, 0] + pair.master_elements[0] * places[:, 1])

    def _build(self, active: np.ndarray, touched: np.ndarray) -> ContactPatterns:
        pair = self._pair
        reach = pair.slave_reach
        if pair.master_reach is not None:
            elements, masters = np.divmod(touched, pair.master_reach.shape[0])
            shape = (pair.slave.elements, pair.master_reach.shape[0])
            meets = sparse.csr_array((np.ones(len(touched), dtype=np.int32), (elements, masters)), shape=shape)
            reach = reach + meets @ pair.master_reach
        rows = rows_of(pair.elements_of_point, active) @ reach
        wide = rows_of(pair.neighbour_matrix, active) @ rows if self._summed else rows
        if self._condensed:
            tangent = rows.T.tocsr() @ wide
        else:
            members = rows_of(reach, np.any(active[pair.slave.test.nodes], axis=1))
            tangent = members.T.tocsr() @ members
        return ContactPatterns(pattern_of(rows), pattern_of(wide), pattern_of(tangent))


def _is_part(some: np.ndarray, of: np.ndarray) -> bool:
    """Whether all of some sorted numbers are among others, sorted too."""
    return not len(some) or (len(of) > 0 and bool(np.all(of[np.minimum(np.searchsorted(of, some), len(of) - 1)] == some)))
