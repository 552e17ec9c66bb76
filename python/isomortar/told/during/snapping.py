"""Plates that a moment lets turn far within one load increment: to another equilibrium than the one they came along, maybe."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.errors import ConvergenceError
from isomortar.geometry.patch import FloatArray
from isomortar.model import constants
from isomortar.solve.equilibrium import Equilibrium


class Snapping:
    """What is asked of the turns of plates in a load increment; each support is told of once."""

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._equilibrium = equilibrium
        self._snapped = dict[str, float]()
        self._told = set[str]()

    def look(self, before: FloatArray, after: FloatArray, share: float) -> None:
        """Look at the turns of an increment, a share of the longest one, from positions to others.

        Raises
        ------
        ConvergenceError
            A plate has turned farther than supports do in one increment (theory 5.2), and a shorter one may show which way it goes.
        """
        supports = self._equilibrium.supports
        for plate in (plate for plate in supports.plates if plate.across):
            way = np.degrees(plate.angle(after) - plate.angle(before))
            turned = float((way + 180.0) % 360.0 - 180.0)
            if abs(turned) <= constants.LARGEST_TURN:
                continue
            name = self._equilibrium.problem.supports[plate.support].name
            if share > constants.SHORT_OF_SNAPPING:
                raise ConvergenceError(f"support {name!r} turns by {turned:.0f} degrees in one increment, maybe past an equilibrium")
            self._snapped[name] = turned

    def after_step(self, step: int) -> Iterator[str]:
        """Warnings that the end of a load step gives rise to."""
        for name, turned in self._snapped.items():
            if name not in self._told:
                self._told.add(name)
                yield (
                    f"support {name!r}, load step {step}: its moment lets it turn by {turned:.0f} degrees at once, however short the load "
                    "increment: there is no equilibrium beside the one it came from, and this is one of those farther away. Hold its turn "
                    "in a stage before, until its body is in contact, if that is not meant"
                )
