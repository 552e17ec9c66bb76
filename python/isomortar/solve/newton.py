"""Newton's method for the positions, with the multipliers of one augmentation held."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import count

import numpy as np

from isomortar._bindings import Law
from isomortar.errors import ConvergenceError, FoldedElementError, LostProjectionError
from isomortar.geometry.patch import FloatArray
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.record import IterationRecord, State
from isomortar.solve.scales import Scales

#: Factors are kept as long as a solve leaves at most this share of the residual.
KEPT_SHARE = 0.2
#: Iterations that find the active set: before, states may return and what is left may grow without an update being halved.
CYCLE_FREE = 5
#: How often an update is halved.
MAX_HALVINGS = 5
#: Note of an iteration that was solved with factors of an earlier tangent.
KEPT_FACTORS = "kept factors"


def relative_residual(equilibrium: Equilibrium, balance: Balance, scales: Scales) -> float:
    """Residual at the free unknowns of a body relative to its internal forces, of the body where that is largest (theory 5.6).

    Forces count for no less than what makes round-off pass `newton_tolerance`: while a body moves rigidly, they are nothing else.
    """
    floor = scales.round_off / equilibrium.problem.settings.newton_tolerance
    measures = equilibrium.measures
    residual, forces = measures.free_norms(balance.total), np.maximum(measures.norms(balance.internal), floor)
    return float(np.max(np.divide(residual, forces, out=np.zeros_like(residual), where=residual != 0.0)))  # a body with nothing free: zero


def residual_round_off(equilibrium: Equilibrium, balance: Balance, scales: Scales) -> float:
    """Round-off of the relative residual, of the bodies that have forces above it (theory 8.4)."""
    forces = equilibrium.measures.norms(balance.internal)
    loaded = forces > scales.round_off
    return float(np.max(scales.round_off[loaded] / forces[loaded], initial=0.0))


@dataclass(frozen=True)
class _Iterate:
    """Forces at the positions of one iteration, and their relative residual."""

    balance: Balance
    residual: float


class PositionSolver:
    """Newton's method for the positions of one load increment.

    Factors are kept for as long as solves with them leave a small share of the residual: from one augmentation to the next, and at the
    end of a Newton loop, the tangent changes little, and its factors are by far the dearest part of a solve.

    Parameters
    ----------
    start : State
        Last converged state: slips count from it.
    scales : Scales
        What the residual is measured against.
    """

    def __init__(self, equilibrium: Equilibrium, start: State, scales: Scales) -> None:
        self._equilibrium, self._start, self._scales = equilibrium, start, scales
        self._factorised = False

    def solve(
        self, positions: FloatArray, prescribed: FloatArray, laws: Sequence[Law], report: Callable[[IterationRecord], None]
    ) -> Balance:
        """Positions in balance with the laws.

        Parameters
        ----------
        positions : ndarray, shape (control points, 3)
            Where the iteration starts.
        prescribed : ndarray, shape (control points, 3)
            Increment of the prescribed positions, which enters the first linear solve.
        report : callable
            Gets the record of every iteration.

        Raises
        ------
        ConvergenceError, FoldedElementError, LostProjectionError, SingularSystemError
        """
        settings = self._equilibrium.problem.settings
        moves = bool(np.any(prescribed))
        keeps = "keeping" in settings.measures
        keep = keeps and self._factorised and not moves
        iterate, notes = self._evaluate(positions, laws), tuple[str, ...]()
        tangents = 0
        for iteration in count():
            balance = iterate.balance
            report(IterationRecord(iteration, iterate.residual, balance.active, balance.active - balance.slipping, balance.slipping, notes))
            if iterate.residual <= settings.newton_tolerance and not moves:
                return balance
            following, notes = self._by_kept_factors(iterate, laws) if keep else None, (KEPT_FACTORS,)
            if following is None:
                if tangents == settings.max_iterations or not np.isfinite(iterate.residual):
                    break
                correction = self._equilibrium.correction(balance, laws, prescribed if moves else np.zeros_like(prescribed))
                following, notes = self._update(iterate, laws, correction, iteration)
                self._factorised, moves = True, False
                tangents += 1
            keep = keeps and following.residual <= KEPT_SHARE * iterate.residual
            iterate = following
        raise ConvergenceError(f"Newton's method stopped at a relative residual of {iterate.residual:.2e} after {iteration} iterations")

    def _evaluate(self, positions: FloatArray, laws: Sequence[Law]) -> _Iterate:
        balance = self._equilibrium.balance(positions, self._start, laws)
        return _Iterate(balance, relative_residual(self._equilibrium, balance, self._scales))

    def _update(self, iterate: _Iterate, laws: Sequence[Law], correction: FloatArray, iteration: int) -> tuple[_Iterate, tuple[str, ...]]:
        """The next iterate: the full update; late, where that leaves more of the residual than before, one halved until it leaves less.

        A narrow cone is next to a kink: full updates go from one side of it to the other and back. If halving does not help either, the
        full update it is.
        """
        whole = self._evaluate(iterate.balance.positions + correction, laws)
        late = iteration >= CYCLE_FREE and "halving" in self._equilibrium.problem.settings.measures
        if not late or whole.residual < iterate.residual:
            return whole, ()
        for halving in range(1, MAX_HALVINGS + 1):
            following = self._evaluate(iterate.balance.positions + 0.5**halving * correction, laws)
            if following.residual < iterate.residual:
                return following, (f"halved {halving} times: residual",)
        return whole, ()

    def _by_kept_factors(self, iterate: _Iterate, laws: Sequence[Law]) -> _Iterate | None:
        """The next iterate with the factors of an earlier tangent; None if these leave too much of the residual."""
        correction = self._equilibrium.kept_correction(iterate.balance)
        try:
            following = self._evaluate(iterate.balance.positions + correction, laws)
        except (FoldedElementError, LostProjectionError):
            return None
        return following if following.residual <= KEPT_SHARE * iterate.residual else None


def observed_order(log: Sequence[IterationRecord], round_off: float) -> float:
    """Observed order of convergence of one Newton loop; NaN where it can not be told (theory 8.4).

    The order q solves r_(k+1) = C r_k^q over three successive residuals. Taken are the last three that fall, with unchanged numbers of
    active and slipping control points and nothing else acting, and that are not at round-off: at order two the third would be
    r_1^3 / r_0^2, and must then still be above `round_off`. (A slower convergence is above it as well, so that none is left out for it.)
    """
    for first, second, third in zip(log[-3::-1], log[-2:0:-1], log[:1:-1], strict=True):
        a, b, c = first.residual, second.residual, third.residual
        steady = (first.active, first.slip) == (second.active, second.slip) == (third.active, third.slip)
        undisturbed = not (first.notes or second.notes or third.notes)
        if steady and undisturbed and a > b > c > 0.0 and b**3 / a**2 > round_off:
            return float(np.log(c / b) / np.log(b / a))
    return float("nan")
