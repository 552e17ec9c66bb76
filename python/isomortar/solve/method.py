"""What every method of enforcing contact has in common: it takes a load increment from one converged state to the next."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.newton import KEPT_FACTORS
from isomortar.solve.record import AugmentationRecord, Observer, State

#: Depth inside its master, as a share of the bodies' size, from which a control point that supports hold along the normal bears on it.
SUNK = 1e-6


@dataclass(frozen=True)
class Increment:
    """Balance at the end of the increment, the log of its augmentations (monolithic: one), Newton's observed orders."""

    balance: Balance
    augmentations: tuple[AugmentationRecord, ...]
    orders: tuple[float, ...]

    @property
    def iterations(self) -> int:
        """Linear solves of the longest Newton loop."""
        return max(len(record.iterations) - 1 for record in self.augmentations)

    @property
    def tangents(self) -> int:
        """Tangents of the Newton loop with the most of them."""
        loops = (record.iterations[1:] for record in self.augmentations)
        return max(sum(KEPT_FACTORS not in iteration.notes for iteration in loop) for loop in loops)


class Method(ABC):
    """A way of solving load increments."""

    def __init__(self, equilibrium: Equilibrium, observer: Observer) -> None:
        self._equilibrium = equilibrium
        self._settings = equilibrium.problem.settings
        self._observer = observer

    @abstractmethod
    def advance(self, start: State, time: float, step: int) -> Increment:
        """Solve the increment from a converged state to a load time.

        Raises
        ------
        ConvergenceError, FoldedElementError, LostProjectionError, SingularSystemError
            The increment has to be cut.
        """

    def _bear(self, balance: Balance) -> bool:
        """Whether control points that supports hold along the normal have ended inside their master, and now bear on it."""
        depth = SUNK * self._equilibrium.numbering.size
        return any(pair.bear(k, depth) for pair, k in zip(self._equilibrium.pairs, balance.kinematics, strict=True))
