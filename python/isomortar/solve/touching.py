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

    def closed(
        self, pairs: Sequence[PairMechanics], start: State, time: float, penalties: Sequence[float | Scales], rests: bool
    ) -> list[FloatArray | None]:
        """Pressures whose trials are above zero where pairs close first (theory 6.8); None of other pairs, and of those that bear.

        Loads close them, or what stands on both sides of a body.

        With scales in its place a penalty is that of `PairMechanics.parameters`. If a body `rests`, the next constraints begin with those
        that it comes to first, where it would turn about these alone.
        """
        bear = _bear(start)
        motions = [] if all(bear) else self._motions(start.positions)
        left = self._left(start.positions, time) if motions else np.zeros(0)
        ways = self._ways(motions, left, _bodies(pairs, bear))
        if not ways:
            return [None] * len(pairs)
        approaches = [_approach(pair, start.positions, contact, ways) for pair, contact in zip(pairs, start.contacts, strict=True)]
        begun = self._begun(pairs, approaches, bear)
        near = [approach.near for approach in approaches]
        if rests and any(begun):
            near = self._rested(pairs, start, near, begun, motions, left)
        found: list[FloatArray | None] = []
        for pair, approach, begins, closed, penalty in zip(pairs, approaches, begun, near, penalties, strict=True):
            size = float(pair.parameters(approach.control, penalty)[0]) if isinstance(penalty, Scales) else penalty
            least = next_to_nothing(pair)
            found.append(np.where(closed, size * np.maximum(least, least - mean_heights(approach.control)), 0.0) if begins else None)
        return found

    def may_hold(self, pairs: Sequence[PairMechanics], start: State) -> bool:
        """Whether contact that is closed everywhere would hold all that supports leave free, of which some bears nothing (theory 6.9)."""
        free, borne = self._motions(start.positions), _bodies(pairs, _bear(start))
        if all(borne & self._names(motion.piece) for motion in free):
            return False
        motions = _displacements(free)
        return hold_all(rates(pair, start.positions, contact, motions) for pair, contact in zip(pairs, start.contacts, strict=True))

    def _names(self, piece: int) -> set[str]:
        """Bodies of a piece, by its number."""
        return {body.name for body in self._numbering.pieces[piece]}

    def _ways(self, motions: list[FreeMotion], left: FloatArray, borne: set[str]) -> list[tuple[set[str], FloatArray]]:
        """Bodies, and a way that each goes: as loads move it by what they leave, or any way to and fro if none does (theory 6.8).

        Where no loads act, those alone that no contact bears: supports press the others on what they are on.
        """
        found: list[tuple[set[str], FloatArray]] = []
        for piece in sorted({motion.piece for motion in motions}):
            if not self.pulled and borne & self._names(piece):
                continue
            own = _displacements([motion for motion in motions if motion.piece == piece])
            works = -np.einsum("mij,ij->m", own, left)
            way = np.tensordot(works, own, 1)
            driven = not self._turning and np.abs(works).max() > constants.NO_PART * np.abs(left).sum()
            ways = way[None] / np.abs(way).max() if driven else np.stack([own, -own], axis=1).reshape(-1, *left.shape)
            found += [(self._names(piece), one) for one in ways]
        return found

    def _begun(self, pairs: Sequence[PairMechanics], approaches: Sequence[_Approach], bear: Sequence[bool]) -> list[bool]:
        """Which pairs begin: those that bodies come to first (theory 6.8)."""
        first = np.min([approach.distances for approach in approaches], axis=0)
        if not self.pulled:  # nothing presses a body on what it may go away from: something has to stand on both of its sides
            room = first.reshape(-1, 2).sum(axis=1).repeat(2)
            first = np.where(room <= constants.BETWEEN * np.sqrt(max(pair.pair.area for pair in pairs)), first, -np.inf)
        reached = [approach.distances <= first + next_to_nothing(pair) for pair, approach in zip(pairs, approaches, strict=True)]
        return [
            bool(np.any(near & np.isfinite(approach.distances))) and not bears
            for near, approach, bears in zip(reached, approaches, bear, strict=True)
        ]

    def _rested(
        self,
        pairs: Sequence[PairMechanics],
        start: State,
        near: Sequence[BoolArray],
        begun: Sequence[bool],
        motions: Sequence[FreeMotion],
        left: FloatArray,
    ) -> list[BoolArray]:
        """What bears of each pair or begins, with the next constraints where bodies would turn about that alone (theory 6.8)."""
        ways = _displacements(motions)
        works = np.zeros(len(ways)) if self._turning else -np.einsum("mij,ij->m", ways, left)
        parts = zip(pairs, start.contacts, near, begun, strict=True)
        return rested([foothold(pair, start.positions, contact, closed, begins, ways) for pair, contact, closed, begins in parts], works)


def _bear(start: State) -> list[bool]:
    """Which pairs bear something."""
    return [bool(np.any(contact.pressure != 0.0)) for contact in start.contacts]


def _bodies(pairs: Sequence[PairMechanics], bear: Sequence[bool]) -> set[str]:
    """Bodies that a pair is between which bears something."""
    return set[str]().union(*(pair.pair.contact.bodies for pair, bears in zip(pairs, bear, strict=True) if bears))


def _displacements(motions: Sequence[FreeMotion]) -> FloatArray:
    """What motions do to all control points, shape (motions, control points, 3)."""
    return np.stack([motion.displacement for motion in motions])


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
