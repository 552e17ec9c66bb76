"""What loose bodies come to first, by loads or between others: without contact there is no tangent to begin with, so it begins as closed.

See theory 6.8.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from isomortar._bindings import Control
from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.model import constants
from isomortar.model.entities import Problem
from isomortar.model.loads import Loads
from isomortar.model.numbering import Numbering
from isomortar.model.supports import BoolArray, Supports
from isomortar.solve.contact import PairMechanics
from isomortar.solve.free_motions import FreeMotion, free_motions
from isomortar.solve.record import ContactState, State
from isomortar.solve.resting import foothold, hold_all, mean_heights, next_to_nothing, rates, rested
from isomortar.solve.scales import Scales


@frozen
class _Approach:
    """A pair by each of some ways: its control quantities, its nearest constraints, and how far bodies go until these close."""

    control: Control
    near: BoolArray
    distances: FloatArray


class Touching:
    """Ways that bodies go by themselves, as the supports of a stage leave them.

    Parameters
    ----------
    problem : Problem
    numbering : Numbering
    supports : Supports
    loads : Loads

    Attributes
    ----------
    pulled : bool
        Whether loads act, or supports with a force.
    """

    def __init__(self, problem: Problem, numbering: Numbering, supports: Supports, loads: Loads) -> None:
        self._problem, self._numbering, self._supports, self._loads = problem, numbering, supports, loads
        self.pulled = bool(problem.loads or supports.plates)

    @property
    def _turning(self) -> bool:
        """Whether moments turn plates, whose work on motions is not told."""
        return any(plate.across for plate in self._supports.plates)

    def _motions(self, positions: FloatArray) -> list[FreeMotion]:
        return free_motions(self._problem, self._numbering, self._supports, positions)

    def _left(self, positions: FloatArray, time: float) -> FloatArray:
        """What loads leave out of balance without contact, shape (control points, 3)."""
        return self._supports.unbalanced(-sum(self._loads.forces(positions, time), np.zeros_like(positions)), positions, time)

    def _ways(self, positions: FloatArray, time: float, borne: set[str]) -> list[tuple[set[str], FloatArray]]:
        """Bodies, and a way that each goes to a load time: as loads move it, or any way to and fro if none does (theory 6.8).

        Where no loads act, those alone that no contact bears: supports press the others on what they are on.
        """
        motions = self._motions(positions)
        if not self.pulled:
            held = {number for number, piece in enumerate(self._numbering.pieces) if borne & {body.name for body in piece}}
            motions = [motion for motion in motions if motion.piece not in held]
        if not motions:
            return []
        left = self._left(positions, time)
        found: list[tuple[set[str], FloatArray]] = []
        for number, piece in enumerate(self._numbering.pieces):
            own = np.reshape([motion.displacement for motion in motions if motion.piece == number], (-1, *positions.shape))
            works = -np.einsum("mij,ij->m", own, left)
            way = np.tensordot(works, own, 1)
            driven = not self._turning and np.abs(works).max(initial=0.0) > constants.NO_PART * np.abs(left).sum()
            ways = way[None] / np.abs(way).max() if driven else np.stack([own, -own], axis=1).reshape(-1, *positions.shape)
            found += [({body.name for body in piece}, one) for one in ways]
        return found

    def closed(
        self, pairs: Sequence[PairMechanics], start: State, time: float, penalties: Sequence[float | Scales], rests: bool
    ) -> list[FloatArray | None]:
        """Pressures whose trials are above zero where pairs close first (theory 6.8); None of other pairs, and of those that bear.

        Loads close them, or what stands on both sides of a body.

        With scales in its place a penalty is that of `PairMechanics.parameters`. If a body `rests`, the next constraints begin with those
        that it comes to first, where it would turn about these alone.
        """
        approaches, begun = self._begun(pairs, start, time)
        if not any(begun):
            return [None] * len(pairs)
        near = self._rested(pairs, start, time, approaches, begun) if rests else [approach.near for approach in approaches]
        found: list[FloatArray | None] = []
        for pair, approach, begins, closed, penalty in zip(pairs, approaches, begun, near, penalties, strict=True):
            size = float(pair.parameters(approach.control, penalty)[0]) if isinstance(penalty, Scales) else penalty
            least = next_to_nothing(pair)
            found.append(np.where(closed, size * np.maximum(least, least - mean_heights(approach.control)), 0.0) if begins else None)
        return found

    def may_hold(self, pairs: Sequence[PairMechanics], start: State) -> bool:
        """Whether contact that is closed everywhere would hold all that supports leave free, of which some bears nothing (theory 6.9)."""
        bear = [pair.pair.contact.bodies for pair, contact in zip(pairs, start.contacts, strict=True) if np.any(contact.pressure != 0.0)]
        borne = set[str]().union(*bear)
        free = self._motions(start.positions)
        if all(borne & {body.name for body in self._numbering.pieces[motion.piece]} for motion in free):
            return False
        motions = np.stack([motion.displacement for motion in free])
        return hold_all(rates(pair, start.positions, contact, motions) for pair, contact in zip(pairs, start.contacts, strict=True))

    def _begun(self, pairs: Sequence[PairMechanics], start: State, time: float) -> tuple[list[_Approach], list[bool]]:
        """How pairs stand, and which of them begin: those that bodies come to first."""
        bear = [pair.pair.contact.bodies for pair, contact in zip(pairs, start.contacts, strict=True) if np.any(contact.pressure != 0.0)]
        borne = set[str]().union(*bear)
        ways = [] if len(bear) == len(pairs) else self._ways(start.positions, time, borne)
        if not ways:
            return [], []
        both = list(zip(pairs, start.contacts, strict=True))
        approaches = [_approach(pair, start.positions, contact, ways) for pair, contact in both]
        first, size = np.min([approach.distances for approach in approaches], axis=0), np.sqrt(max(pair.pair.area for pair in pairs))
        if not self.pulled:  # nothing presses a body on what it may go away from: something has to stand on both of its sides
            room = first.reshape(-1, 2).sum(axis=1).repeat(2)
            first = np.where(room <= constants.BETWEEN * size, first, -np.inf)
        begun = []
        for (pair, contact), approach in zip(both, approaches, strict=True):
            reached = np.isfinite(approach.distances) & (approach.distances <= first + next_to_nothing(pair))
            begun.append(bool(reached.any()) and not np.any(contact.pressure != 0.0))
        return approaches, begun

    def _rested(
        self, pairs: Sequence[PairMechanics], start: State, time: float, approaches: Sequence[_Approach], begun: Sequence[bool]
    ) -> list[BoolArray]:
        """What bears of each pair or begins, with the next constraints where bodies would turn about that alone."""
        motions = np.stack([motion.displacement for motion in self._motions(start.positions)])
        works = -np.einsum("mij,ij->m", motions, self._left(start.positions, time))
        feet = [
            foothold(pair, start.positions, contact, approach.near, begins, motions)
            for pair, contact, approach, begins in zip(pairs, start.contacts, approaches, begun, strict=True)
        ]
        return rested(feet, np.zeros_like(works) if self._turning else works)


def _approach(pair: PairMechanics, positions: FloatArray, start: ContactState, ways: Sequence[tuple[set[str], FloatArray]]) -> _Approach:
    """Of a pair; one that bears is where it stands (theory 6.8)."""
    control, least = pair.kinematics(positions, start).control, next_to_nothing(pair)
    heights = mean_heights(control)
    bears = start.pressure != 0.0
    near = np.isfinite(heights) & (bears if bears.any() else heights >= heights.max() - least)
    distances = np.full(len(ways), np.inf)
    for k, (bodies, way) in enumerate(ways):
        if pair.pair.contact.bodies & bodies:
            rates = (mean_heights(pair.kinematics(positions + least * way, start).control)[near] - heights[near]) / least
            closes = rates > constants.IN_THE_WAY
            distances[k] = np.min(-heights[near][closes] / rates[closes], initial=np.inf)
    return _Approach(control, near, distances)
