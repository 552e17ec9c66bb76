"""What is run of a scene: kinds on meshes, and a reference with the two coarser meshes that tell its own error."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import count

from orders import run

from isomortar.accuracy.discretisations import Discretisation, Sweep, discretisation, lowest_order, overrides, parse_kind, refined, sweep_of
from isomortar.accuracy.sampling import Grid, slave_grid
from isomortar.errors import InputError
from isomortar.harness.cases import LAGRANGE, NURBS
from isomortar.harness.orders import SMALLEST_RATIO, WINDOW
from isomortar.model.entities import Problem
from isomortar.scene.scene import Scene

#: Elements of the meshes of a kind coarser than the scene's own, as shares of its.
FACTORS = (2 / 3, 1 / 2, 1 / 3)
#: Least ratio of a finer mesh that is added where these are too near to each other.
NEXT = 4 / 3
#: Kinds of a plan, and of a quick one on half the elements.
ALL, QUICK = (*NURBS, *LAGRANGE), ("N1", "N2", "N3", "L1", "L2")


@dataclass(frozen=True)
class Plan:
    """Kinds of discretisation of a scene over meshes.

    Parameters
    ----------
    scene : Scene
    sweep : Sweep
    kinds : tuple of str
    share : float
        Elements of the finest mesh over the scene's own.
    """

    scene: Scene
    sweep: Sweep
    kinds: tuple[str, ...]
    share: float

    @classmethod
    def of(cls, scene: Scene, kinds: Sequence[str] = (), body: str | None = None, quick: bool = False) -> Plan:
        """The plan of a scene; all is checked before anything runs.

        Raises
        ------
        InputError
            Unknown kinds, a body without contact, no support that moves, or a discretisation that the scene cannot have.
        """
        for kind in kinds:
            parse_kind(kind)
        sweep = sweep_of(scene, body)
        lowest = lowest_order(scene, sweep.body, sweep.directions)
        default = (kind for kind in (QUICK if quick else ALL) if kind in ("N1", *LAGRANGE) or parse_kind(kind)[1] >= lowest)
        plan = cls(scene, sweep, tuple(dict.fromkeys(kinds or default)), 0.5 if quick else 1.0)
        if not any(support.moves for support in scene.problem().supports):
            raise InputError("no support of the scene moves: there are no curves to compare", "supports")
        for each in plan.runs:
            plan.problem(each)
        return plan

    def meshes(self, kind: str) -> tuple[Discretisation, ...]:
        """Discretisations of a kind, coarsest first: as many as an order needs, and as far apart."""
        found = [self.own_mesh(kind)]
        for factor in FACTORS:
            coarser = discretisation(self.scene, self.sweep, kind, self.share * factor)
            if self._apart(coarser, found[0]):
                found.insert(0, coarser)
        while len(found) < WINDOW:
            growing = (refined(self.scene, self.sweep, found[-1], factor) for factor in count(NEXT, 1 / 3))
            found.append(next(mesh for mesh in growing if self._apart(found[-1], mesh)))
        return tuple(found)

    def _apart(self, coarse: Discretisation, fine: Discretisation) -> bool:
        """Whether the sizes of two meshes differ by more than an order estimate asks for."""
        return self.size(coarse) > SMALLEST_RATIO * self.size(fine) * (1 + 1e-9)

    def own_mesh(self, kind: str) -> Discretisation:
        """The scene's own mesh, in a quick plan with half of its elements."""
        return discretisation(self.scene, self.sweep, kind, self.share)

    @cached_property
    def reference(self) -> tuple[Discretisation, Discretisation, Discretisation]:
        """The reference's kind on half the elements of its finest mesh, on as many, and on twice as many: the last is the reference."""
        coarse = refined(self.scene, self.sweep, self.meshes(self.sweep.reference)[-1], 0.5)
        medium = refined(self.scene, self.sweep, coarse, 2.0)
        return coarse, medium, refined(self.scene, self.sweep, medium, 2.0)

    @cached_property
    def runs(self) -> tuple[Discretisation, ...]:
        """All that is run, each once, the reference last."""
        return tuple(dict.fromkeys([*(mesh for kind in self.kinds for mesh in self.meshes(kind)), *self.reference]))

    @property
    def slave_refined(self) -> bool:
        """Whether the swept body is the slave of the contact pair."""
        contact = next(c for c in self.scene.problem().contacts if c.name == self.sweep.contact)
        return contact.slave.body == self.sweep.body

    def size(self, chosen: Discretisation) -> float:
        """Element size: mean over the swept directions, as a share of the body's length."""
        counts = [n for axis, n in zip("uvw", chosen.elements, strict=True) if axis in self.sweep.directions]
        return float(math.prod(counts) ** (-1 / len(counts)))

    def problem(self, chosen: Discretisation) -> Problem:
        """The problem of a discretisation."""
        return self.discretised(chosen).problem()

    def discretised(self, chosen: Discretisation) -> Scene:
        """The scene in a discretisation."""
        return Scene.from_toml(self.scene.to_toml(), overrides=overrides(self.scene, self.sweep, chosen))

    def grids(self) -> tuple[Grid, Grid]:
        """Where pressure and displacement of all runs are sampled."""
        problem = self.scene.problem()
        number = [c.name for c in problem.contacts].index(self.sweep.contact)
        return slave_grid(self.scene, problem, number), run.swept_grid(self.scene, self.sweep.body)
