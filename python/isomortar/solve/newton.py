"""Newton's method for the positions, with the multipliers of one augmentation held."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from isomortar._bindings import Law
from isomortar.errors import ConvergenceError
from isomortar.geometry.patch import FloatArray
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.record import IterationRecord, State

#: The residual is measured against no less than this share of the stiffness times the size of the bodies: while bodies move
#: rigidly, internal forces are round-off and no relative test would pass (formulation.md Section 5).
FORCE_FLOOR = 1e-4


def relative_residual(equilibrium: Equilibrium, balance: Balance, stiffness: float) -> float:
    """Residual at the free unknowns relative to the internal forces or their floor."""
    residual = float(np.linalg.norm(balance.total.ravel()[equilibrium.supports.free]))
    return residual / _scale(equilibrium, balance, stiffness)


def residual_round_off(equilibrium: Equilibrium, balance: Balance, stiffness: float) -> float:
    """Round-off of the relative residual: that of a force is the unit round-off times stiffness times size."""
    force = float(np.finfo(np.float64).eps) * stiffness * equilibrium.numbering.size
    return force / _scale(equilibrium, balance, stiffness)


def _scale(equilibrium: Equilibrium, balance: Balance, stiffness: float) -> float:
    return max(float(np.linalg.norm(balance.internal)), FORCE_FLOOR * stiffness * equilibrium.numbering.size)


def solve_positions(
    equilibrium: Equilibrium,
    positions: FloatArray,
    prescribed: FloatArray,
    start: State,
    laws: Sequence[Law],
    stiffness: float,
    report: Callable[[IterationRecord], None],
) -> Balance:
    """Positions in balance with the laws.

    Parameters
    ----------
    positions : ndarray, shape (control points, 3)
        Where the iteration starts.
    prescribed : ndarray, shape (control points, 3)
        Increment of the prescribed positions, which enters the first linear solve.
    start : State
        Last converged state: slips count from it.
    stiffness : float
        Largest diagonal entry of the solid tangent, for the floor of the residual's scale.
    report : callable
        Gets the record of every iteration.

    Raises
    ------
    ConvergenceError, FoldedElementError, LostProjectionError, SingularSystemError
    """
    settings = equilibrium.problem.settings
    moves = bool(np.any(prescribed))
    for iteration in range(settings.max_iterations + 1):
        balance = equilibrium.balance(positions, start, laws)
        residual = relative_residual(equilibrium, balance, stiffness)
        report(IterationRecord(iteration, residual, balance.active, balance.active - balance.slipping, balance.slipping))
        if not np.isfinite(residual):
            break
        if residual <= settings.newton_tolerance and not (moves and iteration == 0):
            return balance
        if iteration < settings.max_iterations:
            increment = prescribed if iteration == 0 else np.zeros_like(prescribed)
            positions = positions + equilibrium.correction(balance, laws, increment)
    raise ConvergenceError(f"Newton's method stopped at a relative residual of {residual:.2e} after {iteration} iterations")


def observed_order(log: Sequence[IterationRecord], round_off: float) -> float:
    """Observed order of convergence of one Newton loop; NaN where it can not be told.

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
