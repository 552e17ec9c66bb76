"""What every method of enforcing contact has in common: it takes a load increment from one converged state to the next."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import TypeVar

import numpy as np

from isomortar._bindings import Law
from isomortar._frozen import frozen
from isomortar.errors import ConvergenceError, FoldedElementError, LostProjectionError, SingularSystemError
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.newton import KEPT_FACTORS
from isomortar.solve.record import AugmentationRecord, IterationRecord, Observer, State

#: What a load increment may fail by: a shorter one, or another way to its end, may come through.
FAILURES = (ConvergenceError, FoldedElementError, LostProjectionError, SingularSystemError)
_Found = TypeVar("_Found")


@frozen
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

    def _seeking_hold(self, start: State, solve: Callable[[bool], _Found]) -> _Found:
        """What a way of solving finds without help, or else while bodies seek what will hold them, if contact may (theory 6.9).

        With help it is called with True. What it fails by without is what is told.
        """
        try:
            return solve(False)
        except FAILURES:
            if not self._equilibrium.contact_may_hold(start):
                raise
            with suppress(*FAILURES):
                return solve(True)
            raise


def augmentation_record(
    number: int, laws: Sequence[Law], changes: tuple[float, float], log: tuple[IterationRecord, ...]
) -> AugmentationRecord:
    """What is recorded of an augmentation: penalties are those of the first pair."""
    penalties = laws[0].penalties if laws else np.zeros(2)
    return AugmentationRecord(number, float(penalties[0]), float(penalties[1]), *changes, log)
