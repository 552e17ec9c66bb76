"""Contact fields of a run at the points of one grid over the slave face's exact geometry, the same for all runs of a section."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from paper.figures.flat import CONTACT_ZONE
from paper.outcome import Outcome

from isomortar.accuracy.sampling import Grid, slave_grid, values_at
from isomortar.geometry.patch import FloatArray
from isomortar.results.fields import contact_surfaces
from isomortar.scene.scene import Scene


@dataclass(frozen=True)
class Fields:
    """Contact fields at the cell centres of a grid.

    `pressure`, `traction` (first covariant component), `height` (z of the surface): shape (n_j, n_i). `areas`: of the cells,
    shape (n_j * n_i,). The contact zone is where the pressure is above `CONTACT_ZONE` of its peak, as in the figure of the gap.
    """

    pressure: FloatArray
    traction: FloatArray
    height: FloatArray
    areas: FloatArray

    @property
    def zone_height(self) -> float:
        """Largest distance of the surface from the plane z = 0 within the contact zone."""
        return float(np.abs(self._within).max())

    @property
    def zone_roughness(self) -> float:
        """Root mean square distance of the surface from the plane z = 0 within the contact zone."""
        return float(np.sqrt((self._within**2).mean()))

    @property
    def _within(self) -> FloatArray:
        return self.height[self.pressure > CONTACT_ZONE * self.pressure.max()]

    @property
    def peak(self) -> tuple[float, float]:
        """Where the pressure is largest, as shares of both surface directions."""
        j, i = np.unravel_index(np.argmax(self.pressure), self.pressure.shape)
        return (i + 0.5) / self.pressure.shape[1], (j + 0.5) / self.pressure.shape[0]


def fields(outcome: Outcome, step: int) -> Fields:
    """The fields of a run at the end of a load step."""
    grid = _grid(outcome.section.scene)
    with outcome.results() as results:
        surface = contact_surfaces(results.problem, results.step(step))[0]
    coefficients = np.column_stack([surface.pressure, surface.covariant[:, 0], surface.points[:, 2]])
    pressure, traction, height = values_at(surface.directions, surface.weights, coefficients, grid).T.reshape(3, *grid.shape[::-1])
    return Fields(pressure, traction, height, grid.weights)


@cache
def _grid(scene: str) -> Grid:
    loaded = Scene.load(scene)
    return slave_grid(loaded, loaded.problem(), 0)
