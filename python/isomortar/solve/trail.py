"""Where a Newton loop has been: states of constraints and master elements of feet, and which of them go to and fro."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

import numpy as np

from isomortar._codes import PointState
from isomortar.geometry.patch import IntArray
from isomortar.model import constants
from isomortar.solve.contact import Kinematics, PairMechanics
from isomortar.solve.equilibrium import Balance
from isomortar.solve.feet import beside_poles

#: Iterations that what goes to and fro is looked for in.
RECENT = 6


def states(balance: Balance) -> bytes:
    """The states of all constraints, to compare with."""
    return b"".join(response.state.tobytes() for response in balance.responses)


def _elements(kinematics: Sequence[Kinematics]) -> IntArray:
    """Master elements and fixed coordinates of the slave quadrature points, shape (points of all pairs, 4)."""
    places = [np.hstack([k.projections.element, k.projections.fixed]) for k in kinematics]
    return np.concatenate(places or [np.zeros((0, 4), dtype=np.int32)])


class Trail:
    """The iterates of a Newton loop.

    Attributes
    ----------
    states : list of bytes
        Their states of constraints.
    merits : list of float
        What was left to solve.
    """

    def __init__(self) -> None:
        self.states: list[bytes] = []
        self.merits: list[float] = []
        self._counts: list[tuple[int, int]] = []  # of what is active, and of what slips
        self._last: deque[tuple[Kinematics, ...]] = deque(maxlen=RECENT)
        self._sizes: list[int] = []

    def add(self, balance: Balance, merit: float) -> None:
        """Note an iterate, and what is left to solve there."""
        self.states.append(states(balance))
        self.merits.append(merit)
        self._counts.append((balance.active, balance.slipping))
        self._last.append(balance.kinematics)
        self._sizes = [response.state.size for response in balance.responses]

    @property
    def circles(self) -> bool:
        """Whether the last iterates, far from a solution, are those of one or two iterations before (theory 6.10)."""
        return any(self._repeats(period) for period in (1, 2))

    def _repeats(self, period: int) -> bool:
        """Whether they are those of so many iterations before (theory 6.10)."""
        now, before = slice(-constants.CIRCLING, None), slice(-constants.CIRCLING - period, -period)
        left, was = np.array(self.merits[now]), np.array(self.merits[before])
        if len(was) < constants.CIRCLING or self.states[now] != self.states[before]:
            return False
        return bool(left.max() > constants.NEAR_SOLUTION and np.all(np.abs(left - was) <= constants.SAME_MERIT * was))

    @property
    def advances(self) -> bool:
        """Whether more or less is active, or slips, than ever before the last iterates: a front that is not there yet (theory 6.11).

        Where as much is left as there are forces, nothing gets on, and what more iterates come to is chance. Where little is left, most
        constraints have found their states, and the others will.
        """
        before, last = np.split(np.array(self._counts[constants.ACTIVE_SET_ITERATIONS :]), [-constants.ADVANCING])
        left = np.max(self.merits[-constants.ADVANCING :])
        if not len(before) or not left < 1.0:
            return False
        return bool(
            left < constants.CLOSE or np.any(last.min(axis=0) < before.min(axis=0)) or np.any(last.max(axis=0) > before.max(axis=0))
        )

    def toggling(self, pairs: Sequence[PairMechanics]) -> str:
        """What changed to and fro in the last iterations, as a part of a sentence."""
        poles = [beside_poles(pair.pair, k.projections) for pair, k in zip(pairs, self._last[-1], strict=True)]
        by_poles = np.concatenate(poles or [np.zeros(0, dtype=np.bool_)])
        cohesive = np.repeat([pair.pair.contact.cohesion > 0.0 for pair in pairs], self._sizes)
        return toggling(self.states[-RECENT:], [_elements(k) for k in self._last], by_poles, any(pair.summed for pair in pairs), cohesive)


def toggling(seen: Sequence[bytes], visited: Sequence[IntArray], by_poles: np.ndarray, summed: bool, cohesive: np.ndarray) -> str:
    """What changed to and fro in some iterations, as a part of a sentence; `cohesive`: constraints of contacts with a cohesion."""
    states = np.array([np.frombuffer(s, dtype=np.int32) for s in seen])
    points = np.flatnonzero(np.any(states != states[0], axis=0))
    if points.size:
        hint = ' (solver.slip_sum = "local" has no jump where a neighbour becomes active)' if summed else ""
        opening = points[cohesive[points] & np.any(states[:, points] == PointState.OPEN, axis=0)]
        if opening.size:
            hint += (
                f" (at constraints {_first_few(opening)} contact opens and closes, where what a cohesion bears drops to zero in a jump: "
                "there may be no solution between. Take a lower cohesion, or none)"
            )
        return f"; constraints {_first_few(points)} change their states from iteration to iteration{hint}"
    elements = np.array(visited)
    crossing = np.flatnonzero(np.any(elements != elements[0], axis=(0, 2)))
    about = crossing[by_poles[crossing]]
    if about.size:
        return (
            f"; nearest points of slave quadrature points {_first_few(about)} go round a pole of the master: pressed in, it is a hollow "
            "vertex, and what is above one has no nearest point of its own. Press beside it, take so many quadrature points "
            "(contacts.NAME.quadrature) that none is above it, an even number in an element whose middle is, or a mesh without a pole there"
        )
    if crossing.size:
        return (
            f"; slave quadrature points {_first_few(crossing)} cross a knot line of the master from iteration to iteration, where a master "
            "of order 1 or of Lagrange elements has a kink, and the curvature of one of order 2 jumps (not so NURBS of order 3 and more)"
        )
    return ""


def _first_few(numbers: np.ndarray) -> str:
    return ", ".join(str(int(i)) for i in numbers[:10]) + (", ..." if len(numbers) > 10 else "")
