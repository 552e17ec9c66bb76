"""Where the projections of a load increment start: at the last converged feet, or on a C0 line that a foot jumps across to and fro.

Over a valley of the master the nearest point jumps from face to face, and with it the normal: pressure holds a slave point there, on
the line between the faces, where the distance turns and the normal can be any between the two faces' (formulation.md Section 3).
"""

from __future__ import annotations

import numpy as np

from isomortar._bindings import Projections
from isomortar.geometry.patch import Direction, FloatArray, IntArray


class Feet:
    """Starts of one contact pair's projections during a load increment.

    The kernel keeps a foot on a C0 line only where it starts exactly on it and the distance turns across it.
    """

    def __init__(self, directions: tuple[Direction, Direction] | None) -> None:
        """`directions` of the master's face; None for a rigid plane."""
        self._directions = directions if directions and any(d.kinks.size for d in directions) else None
        self.begin_increment()

    def begin_increment(self) -> None:
        """Forget what the feet did in the last one."""
        self._visited: list[IntArray] = []
        self._lines: FloatArray | None = None

    def starts(self, converged: FloatArray) -> FloatArray:
        """Starts from the last converged feet, shape (points, 2)."""
        return converged if self._lines is None else np.where(np.isnan(self._lines), converged, self._lines)

    def follow(self, projections: Projections) -> int:
        """Note where the feet of an iterate are, and put those on a line that are back in an element that they had left; how many."""
        if self._directions is None:
            return 0
        now, put = projections.element, 0
        for a, direction in enumerate(self._directions):
            if not self._visited:
                break
            last = self._visited[-1][:, a]
            back = (now[:, a] != last) & np.any([before[:, a] == now[:, a] for before in self._visited], axis=0)
            line = direction.boundaries[np.maximum(now[:, a], last)]
            back &= (np.abs(now[:, a] - last) == 1) & np.isin(line, direction.kinks) & (projections.found > 0)
            if self._lines is None:
                self._lines = np.full((len(now), 2), np.nan)
            put += int(np.count_nonzero(back & np.isnan(self._lines[:, a])))
            self._lines[back, a] = line[back]
        self._visited.append(now)
        return put
