"""A converged load increment, whatever method found it."""

from __future__ import annotations

from dataclasses import dataclass

from isomortar.solve.equilibrium import Balance
from isomortar.solve.record import AugmentationRecord


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
