"""What the benchmarks run: scenes in other discretisations, their systems of equations, and their times in CPU seconds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import islice
from typing import Any
from unittest.mock import patch

import numpy as np
from scipy import sparse

from isomortar.accuracy.discretisations import Discretisation, overrides, sweep_of
from isomortar.geometry.patch import FloatArray
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.system import CheckedSystem, LinearSystem, Source
from isomortar.solve.timing import Ledger

#: Size of the deformation of a body whose tangent is wanted, relative to its coordinates.
STRAIN = 0.02


@dataclass(frozen=True)
class System:
    """A linear system as Newton's method solves it: of which bodies and contacts it is made, and its right-hand side."""

    equilibrium: Equilibrium
    sources: list[Source]
    values: list[FloatArray]
    right: FloatArray

    def analysed(self) -> CheckedSystem:
        """A system to factorise it by, as a run makes one: by parts where these take fewer operations. All is analysed anew."""
        systems = self.equilibrium.systems
        systems.bodies = None
        return systems.new(self.sources, len(self.right))

    @cached_property
    def matrix(self) -> sparse.csr_array:
        """The same as a whole."""
        general = LinearSystem(len(self.right), self.sources, Ledger())
        general.factorise(self.values)
        return general.matrix()

    def factorise(self, factors: CheckedSystem) -> None:
        """Gather and factorise anew: with one of two copies after the other, as bodies keep their factors of the very same array."""
        self._copies.reverse()
        factors.factorise(self._copies[0])

    @cached_property
    def _copies(self) -> list[list[FloatArray]]:
        return [self.values, [value.copy() for value in self.values]]

    @property
    def definite(self) -> bool:
        """Whether it is a solid's alone: symmetric and positive definite."""
        return len(self.sources) == 1


@dataclass(frozen=True)
class Phases:
    """CPU seconds by phase and in total, tangents, and free unknowns of some load steps."""

    seconds: dict[str, float]
    tangents: int
    unknowns: int


def problem(scene: str, kind: str, elements: tuple[int, int, int] | None = None, settings: Sequence[str] = ()) -> Problem:
    """A bundled scene with its swept body in the discretisation of a kind, on the body's own elements or others."""
    loaded = Scene.load(scene)
    sweep = sweep_of(loaded)
    u, v, w = elements or [d.elements for d in loaded.problem().body(sweep.body).patch.directions]
    return Scene.load(scene, [*overrides(loaded, sweep, Discretisation(kind, (u, v, w))), *settings]).problem()


def solid_block(order: int, elements: tuple[int, int, int]) -> Equilibrium:
    """The block of the press alone, of one order in all directions, held at its top."""
    mesh = "bodies.block.mesh"
    settings = [f"{mesh}.order={[order] * 3}", f"{mesh}.elements={list(elements)}"]
    return Equilibrium(Scene.load("press", settings).problem(), Ledger())


def deformed(equilibrium: Equilibrium) -> FloatArray:
    """Positions of control points with a smooth deformation, shape (control points, 3)."""
    x = equilibrium.numbering.reference
    return np.add(x, STRAIN * np.sin(3.0 * x[:, [1, 2, 0]]), order="C")  # NumPy would reuse what is in another order


def solid_system(order: int, elements: tuple[int, int, int]) -> System:
    """The tangent of a deformed block alone, with a right-hand side of all frequencies."""
    equilibrium = solid_block(order, elements)
    _, tangent = equilibrium.solid.forces_and_tangent(deformed(equilibrium))
    right = np.random.default_rng(2).standard_normal(len(equilibrium.supports.free))
    return System(equilibrium, [equilibrium.solid_source], [tangent], right)


def last_system(problem: Problem, steps: int) -> System:
    """The last linear system that is factorised in some load steps, multipliers included."""
    solved: list[System] = []
    solve = Equilibrium.solve

    def note(equilibrium: Equilibrium, sources: list[Source], values: list[FloatArray], right: FloatArray, *where: Any) -> FloatArray:
        solved[:] = [System(equilibrium, sources, [value.copy() for value in values], right.copy())]
        return solve(equilibrium, sources, values, right, *where)

    with patch.object(Equilibrium, "solve", note):
        for _ in islice(Simulation(problem).run(), steps):
            pass
    return solved[0]


def phases(problem: Problem, steps: int) -> Phases:
    """Run some load steps and add up what they took."""
    seconds: Counter[str] = Counter()
    tangents = 0
    simulation = Simulation(problem)
    for result in islice(simulation.run(), steps):
        seconds.update(result.timings)
        tangents += result.counters["factorisations"]
    return Phases(dict(seconds), tangents, len(simulation.equilibrium.supports.free))
