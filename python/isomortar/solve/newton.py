"""Newton's method within a load increment: the loop that all ways of enforcing contact share."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import count
from typing import Generic, TypeVar

import numpy as np

from isomortar._frozen import frozen
from isomortar.errors import ConvergenceError, FoldedElementError, LostProjectionError, SingularSystemError
from isomortar.geometry.patch import FloatArray
from isomortar.model import constants
from isomortar.model.settings import SolverSettings
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.record import IterationRecord, State
from isomortar.solve.scales import Scales
from isomortar.solve.trail import Trail, states

#: Notes of iterations that were solved with factors of an earlier tangent, and with those of an earlier tangent of the bodies.
KEPT_FACTORS, KEPT_BODIES = "kept factors", "kept bodies"
#: Note of one whose tangent had that closed anew which loads close first.
CLOSED_ANEW = "closed anew"
#: Note of one whose tangent held loose bodies a little where they are.
STEADIED = "steadied"


@frozen
class Iterate:
    """Forces at the positions of one iteration, and their relative residual."""

    balance: Balance
    residual: float

    @cached_property
    def merit(self) -> float:
        """What an update should make smaller."""
        return self.residual

    @property
    def left(self) -> str:
        """What is left to solve, in words."""
        return f"a relative residual of {self.residual:.2e}"

    @property
    def left_by_setting(self) -> dict[str, float]:
        """What is left to solve, by the setting that says how much may be."""
        return {"newton_tolerance": self.residual}

    @property
    def states(self) -> bytes:
        """The states of all constraints, to compare with."""
        return states(self.balance)


Iterated = TypeVar("Iterated", bound=Iterate)
Corrected = TypeVar("Corrected")


@frozen
class Converged(Generic[Iterated]):
    """What a Newton loop came to: its last iterate, its iterations, its observed order of convergence."""

    iterate: Iterated
    log: tuple[IterationRecord, ...]
    order: float


@dataclass
class _Loop(Generic[Iterated]):
    """What a Newton loop has yet to do, and what it has used up.

    Parameters
    ----------
    prescribed : ndarray, shape (control points, 3), or None
        Increment of the prescribed positions, for the first tangent; None: there they are.
    seeks_hold : bool
        Whether loose bodies are held a little until contact holds them (theory 6.9).
    tangents, closings, steadied : int
        How many tangents there were; of them those that had closed anew what loads close first, and those that held loose bodies.
    led : tuple of Iterate, or None
        From where to where the last tangent led, if it tells what the bodies' part of it is good for.
    """

    prescribed: FloatArray | None
    seeks_hold: bool
    tangents: int = 0
    closings: int = 0
    steadied: int = 0
    led: tuple[Iterated, Iterated] | None = None

    @property
    def moves(self) -> bool:
        """Whether supports have yet to move."""
        return self.tangents == 0 and self.prescribed is not None and bool(np.any(self.prescribed))


class Newton(ABC, Generic[Iterated, Corrected]):
    """Newton's method for one load increment; what its unknowns are, and how an update is shortened, say the methods of contact.

    Factors are kept for as long as solves with them leave a small share of what there was: at the end of a loop, and from one loop of an
    increment to the next, the tangent changes little, and its factors are by far the dearest part of a solve. Those of the bodies are
    kept within a loop where contact alone changes much.

    Parameters
    ----------
    equilibrium : Equilibrium
    start : State
        Last converged state: slips count from it.
    scales : Scales
        What the residual is measured against.
    seeks_hold : bool
        Whether bodies that begin without contact are helped to find what will hold them (theory 6.9).
    """

    def __init__(self, equilibrium: Equilibrium, start: State, scales: Scales, seeks_hold: bool) -> None:
        self._equilibrium, self._start, self._scales, self._seeks_hold = equilibrium, start, scales, seeks_hold
        self._settings = equilibrium.problem.settings
        self._keeps = "keeping" in self._settings.measures
        self._factorised, self._made_at = False, start.positions
        self._loads_closed: list[bool] = []  # which pairs loads closed first

    def solve(
        self, iterate: Iterated, prescribed: FloatArray | None, observe: Callable[[IterationRecord], None], notes: tuple[str, ...] = ()
    ) -> Converged[Iterated]:
        """Iterate until forces are in balance.

        Parameters
        ----------
        iterate : Iterate
            Where the iteration starts.
        prescribed : ndarray, shape (control points, 3), or None
            Increment of the prescribed positions, which enters the first solve with a tangent of its own; None: there they are.
        observe : callable
            Gets the record of every iteration.
        notes : tuple of str
            What acted where the iteration starts.

        Raises
        ------
        ConvergenceError, FoldedElementError, LostProjectionError, SingularSystemError
        """
        loop = _Loop[Iterated](prescribed, self._seeks_hold and (any(self._loads_closed) or not iterate.balance.active))
        keep, log = self._keeps and self._factorised and not loop.moves, list[IterationRecord]()
        self._trail = Trail()
        for iteration in count():
            self._trail.add(iterate.balance, iterate.merit)
            log.append(_record(iteration, iterate, notes))
            observe(log[-1])
            if self._converged(iterate) and not loop.moves and STEADIED not in notes:
                reopened = self._reopened(iterate)
                if reopened is iterate:
                    self._have_factors(iterate)
                    return Converged(iterate, tuple(log), observed_order(log, self._round_off(iterate.balance)))
                iterate, keep = reopened, False
            following, notes = self._by_kept_factors(iterate) if keep else None, (KEPT_FACTORS,)
            if following is None:
                if self._spent(loop.tangents) or not np.isfinite(iterate.merit) or self._trail.circles:
                    break
                iterate, following, notes = self._by_new_factors(iterate, iteration, loop, keep)
            keep = self._keeps and STEADIED not in notes and self._serve(iterate, following)
            iterate = following
        return self._given_up(iterate, tuple(log))

    def _spent(self, tangents: int) -> bool:
        """Whether a loop has had its tangents; it has more of them while a front of contact or slip gets on (theory 6.11)."""
        most = self._settings.max_iterations
        return tangents >= most and (tangents >= constants.MOST_TANGENTS * most or not self._trail.advances)

    def _by_new_factors(
        self, iterate: Iterated, iteration: int, loop: _Loop[Iterated], kept: bool
    ) -> tuple[Iterated, Iterated, tuple[str, ...]]:
        """The iterate, the next one by another tangent, and what acted; loose bodies may be held in it a little (theory 6.9).

        `kept`: factors were kept that did not serve.
        """
        keep_bodies = not kept and self._bodies_serve(loop.led)  # nor a part of factors that did not serve
        opened = loop.tangents > 0 and loop.closings < constants.MAX_CLOSINGS and self._opened(iterate)
        if opened:
            iterate, keep_bodies = self._closed_anew(iterate), False
        steady = loop.seeks_hold and loop.steadied < constants.MAX_STEADIED and self._finds_hold(iterate, loop.moves)
        with self._equilibrium.steadied(steady):
            prescribed = None if loop.tangents else loop.prescribed
            iterate, following, notes = self._by_tangent(iterate, prescribed, iteration, keep_bodies)
        loop.tangents, loop.closings, loop.steadied = loop.tangents + 1, loop.closings + opened, loop.steadied + steady
        loop.led = None if steady else (iterate, following)
        return iterate, following, ((CLOSED_ANEW,) if opened else ()) + ((STEADIED,) if steady else ()) + notes

    def _given_up(self, iterate: Iterated, log: tuple[IterationRecord, ...]) -> Converged[Iterated]:
        """What a loop comes to whose tangents are used up, or that goes round in a circle.

        Raises
        ------
        ConvergenceError
        """
        circle = ", going round in a circle" if self._trail.circles else ""
        why = self._too_tight(iterate) or circle + self._trail.toggling(self._equilibrium.pairs)
        raise ConvergenceError(f"Newton's method stopped at {iterate.left} after {log[-1].iteration} iterations{why}")

    def _too_tight(self, iterate: Iterated) -> str:
        """Which tolerances ask for more digits than round-off leaves, as a part of a sentence; empty: what is left is more than that."""
        default, left = SolverSettings(), iterate.left_by_setting
        if not all(value <= getattr(default, name) for name, value in left.items()):
            return ""
        missed = [f"solver.{name} = {getattr(default, name):g}" for name, value in left.items() if value > getattr(self._settings, name)]
        return f", which is next to round-off: take {' and '.join(missed)}, the default"

    def _have_factors(self, iterate: Iterated) -> None:
        """Factors for who asks whether it is stable, where those there are, if any, are of where an increment began (theory 5.26)."""
        way = iterate.balance.positions - self._start.positions
        stale = self._equilibrium.ends_stage and np.linalg.norm(
            iterate.balance.positions - self._made_at
        ) > constants.STALE * np.linalg.norm(way)
        if stale or not self._equilibrium.was_solved:
            with suppress(FoldedElementError, LostProjectionError, SingularSystemError):
                self._correct(iterate, None, False)
                self._made_at = iterate.balance.positions

    def _nearest(self, positions: FloatArray, penalties: Sequence[float | Scales]) -> list[FloatArray | None]:
        """Pressures that close what loads close first, from some positions on; None of pairs that they do not close (theory 6.8)."""
        closed = self._equilibrium.closed(replace(self._start, positions=positions), penalties, self._seeks_hold)
        self._loads_closed = [pressure is not None for pressure in closed]
        return closed

    def _opened(self, iterate: Iterated) -> bool:
        """Whether loads closed something and all is open again, so that there is no tangent."""
        return any(self._loads_closed) and not iterate.balance.active

    def _finds_hold(self, iterate: Iterated, moves: bool) -> bool:
        """Whether bodies that begin without contact have yet to find what holds them: what loads press on something has (theory 6.9)."""
        pressed = self._equilibrium.pulled and iterate.balance.active
        return not pressed and (moves or iterate.merit > constants.STEADIED_ABOVE)

    @abstractmethod
    def _closed_anew(self, iterate: Iterated) -> Iterated:
        """The same positions with that closed, without friction, which is nearest there (theory 6.8)."""

    def _converged(self, iterate: Iterated) -> bool:
        """Whether forces are in balance and the contact conditions are met (theory 5.6, 6.6)."""
        return all(value <= getattr(self._settings, name) for name, value in iterate.left_by_setting.items())

    def _reopened(self, iterate: Iterated) -> Iterated:
        """A converged iterate with the conditions that it calls for in addition; itself, where there are none."""
        return iterate

    @abstractmethod
    def _correct(self, iterate: Iterated, prescribed: FloatArray | None, keep_bodies: bool) -> tuple[Iterated, Corrected, tuple[str, ...]]:
        """Newton's correction by a tangent of its own, what it corrects, and what acted; the first one has the prescribed increment.

        With `keep_bodies` the bodies' tangent stays as it was.
        """

    @abstractmethod
    def _correct_again(self, iterate: Iterated) -> Corrected:
        """Correction by the factors of the last tangent."""

    @abstractmethod
    def _moved(self, iterate: Iterated, correction: Corrected, share: float) -> Iterated:
        """An iterate with a share of a correction."""

    @abstractmethod
    def _update(self, iterate: Iterated, correction: Corrected, iteration: int) -> tuple[Iterated, tuple[str, ...]]:
        """The next iterate, by the whole correction or a share of it, and what acted."""

    def _serve(self, iterate: Iterated, following: Iterated) -> bool:
        """Whether factors that led from one iterate to the next are good enough for another solve (theory 6.6)."""
        return following.merit <= _may_leave(iterate, following) * iterate.merit

    def _bodies_serve(self, led: tuple[Iterated, Iterated] | None) -> bool:
        """Whether the bodies' part of factors that led from one iterate to another is good enough for another tangent (theory 5.24)."""
        if led is None or not self._keeps:
            return False
        before, after = led
        return self._equilibrium.left_by_bodies(before.balance, after.balance) <= _may_leave(before, after)

    def _by_tangent(
        self, iterate: Iterated, prescribed: FloatArray | None, iteration: int, keep_bodies: bool
    ) -> tuple[Iterated, Iterated, tuple[str, ...]]:
        """The iterate, the next one by its tangent, and what acted; where that of the bodies was kept and leads nowhere, by one anew."""
        try:
            iterate, correction, predicted = self._correct(iterate, prescribed, keep_bodies)
            self._factorised = True
            self._made_at = self._made_at if keep_bodies else iterate.balance.positions
            following, shortened = self._update(iterate, correction, iteration)
        except (FoldedElementError, LostProjectionError, SingularSystemError):
            if not keep_bodies:
                raise
            return self._by_tangent(iterate, prescribed, iteration, False)
        return iterate, following, predicted + shortened + ((KEPT_BODIES,) if keep_bodies else ())

    def _by_kept_factors(self, iterate: Iterated) -> Iterated | None:
        """The next iterate with the factors of an earlier tangent; None if these do not serve."""
        try:
            following = self._moved(iterate, self._correct_again(iterate), 1.0)
        except (FoldedElementError, LostProjectionError, SingularSystemError):
            return None
        return following if self._serve(iterate, following) else None

    def _residual(self, balance: Balance, multiplied: FloatArray | float = 0.0) -> float:
        """Residual at the free unknowns of a body relative to its internal forces, of the body where that is largest (theory 5.6).

        Forces count for no less than what makes round-off pass `newton_tolerance`: while a body moves rigidly, they are nothing else.
        Of what is `multiplied` by penalties no more than a share of forces is left (theory 7.7).
        """
        measures = self._equilibrium.measures
        sizes = measures.sizes(balance.internal, balance.total, balance.unbalanced)
        unknown = np.maximum(self._scales.round_off, np.minimum(multiplied, constants.MOST_UNKNOWN * sizes))
        forces = np.maximum(sizes, unknown / self._settings.newton_tolerance)
        residual = measures.free_norms(balance.unbalanced)
        return float(np.max(np.divide(residual, forces, out=np.zeros_like(residual), where=residual != 0.0)))  # a body with nothing free: 0

    def _round_off(self, balance: Balance) -> float:
        """Round-off of the relative residual, of the bodies that have forces above it (theory 8.4)."""
        forces = self._equilibrium.measures.norms(balance.internal)
        loaded = forces > self._scales.round_off
        return float(np.max(self._scales.round_off[loaded] / forces[loaded], initial=0.0))


def _may_leave(before: Iterate, after: Iterate) -> float:
    """What factors may leave that led from one iterate to another, and be kept, as a share of what there was (theory 5.24, 6.6)."""
    near = before.merit <= constants.NEAR_SOLUTION and before.states == after.states
    return constants.KEPT_SHARE if near else constants.KEPT_FAR


def _record(iteration: int, iterate: Iterate, notes: tuple[str, ...]) -> IterationRecord:
    active, slipping = iterate.balance.active, iterate.balance.slipping
    return IterationRecord(iteration, iterate.merit, active, active - slipping, slipping, notes)


def observed_order(log: Sequence[IterationRecord], round_off: float) -> float:
    """Observed order of convergence of one Newton loop; NaN where it can not be told (theory 8.4).

    The order q solves r_(k+1) = C r_k^q over three successive residuals. Taken are the last three that fall, with unchanged numbers of
    active and slipping constraints and nothing else acting, and that are not at round-off: at order two the third would be
    r_1^3 / r_0^2, and must then still be above `round_off`. (A slower convergence is above it as well, so that none is left out for it.)
    """
    for first, second, third in zip(log[-3::-1], log[-2:0:-1], log[:1:-1], strict=True):
        a, b, c = first.residual, second.residual, third.residual
        steady = (first.active, first.slip) == (second.active, second.slip) == (third.active, third.slip)
        undisturbed = not (first.notes or second.notes or third.notes)
        if steady and undisturbed and a > b > c > 0.0 and b**3 / a**2 > round_off:
            return float(np.log(c / b) / np.log(b / a))
    return float("nan")
