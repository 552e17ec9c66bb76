"""Orderings that are tried at the first factors of a system: the cheapest of those that find it regular is kept, and the others go."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import permutations, product

import numpy as np
from told.either_way import SCENE

from isomortar.errors import SingularSystemError
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.solve.condensed import Bodies, CondensedSystem
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.system import LinearSystem, entries
from isomortar.solve.timing import Ledger


class Rival:
    """An ordering that takes some operations, and finds a matrix singular or not."""

    statistics, ordering, rcond = None, "amd", 0.25

    def __init__(self, flops: float, refuses: bool, off: tuple[float, float] = (0.0, 0.0)) -> None:
        self.flops, self.refuses, self.off = flops, refuses, off

    def factorise(self, values: FloatArray) -> Rival:
        """Itself, or that the matrix is singular."""
        del values
        if self.refuses:
            raise SingularSystemError(f"by {self.flops:g}")
        return self

    def solve(self, right: FloatArray, refine: int = 2) -> FloatArray:
        """Of a matrix of ones on its diagonal, and off by a share, by another one where it is refined."""
        return right * (1.0 + self.off[refine > 0])


def tried() -> Iterator[tuple[list[Rival], Rival | None]]:
    """Three in any order, some of which refuse, and the one that is to be kept."""
    for flops, refuses in product(permutations((1.0, 2.0, 3.0)), product((False, True), repeat=3)):
        rivals = [Rival(*of) for of in zip(flops, refuses, strict=True)]
        yield rivals, min((rival for rival in rivals if not rival.refuses), key=lambda rival: rival.flops, default=None)


@case(
    claim="Of the orderings that are tried the cheapest that does not find the matrix singular is kept, and where all do that is said.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: of 48 threes of orderings those of which another one is kept, or none, or one too many")},
)
def rivals() -> dict[str, float]:
    """How many."""
    equilibrium = Equilibrium(Scene.from_toml(SCENE).problem(), Ledger())
    source, wrong = equilibrium.solid_source, 0
    system = LinearSystem(len(equilibrium.supports.free), [source], equilibrium.ledger, ordering="amd")
    values = np.zeros((len(source.pattern.column), 3, 3))
    for given, best in tried():
        system._rivals = list(given)  # type: ignore[arg-type]
        try:
            system.factorise([values])
            wrong += best is None or [id(rival) for rival in system._rivals] != [id(best)]
        except SingularSystemError:
            wrong += best is not None
    return {"wrong": float(wrong)}


#: Shares that a solution is off by before it is refined and then, and by how much the one that is given is; none: it is refused.
OFF = (
    (5e-7, 0.5, 5e-7),
    (2e-6, 0.0, 0.0),
    (2e-6, 0.09, 0.09),
    (2e-6, 0.11, None),
    (float("nan"), 1e-9, 1e-9),
    (float("nan"), float("nan"), None),
)


@case(
    claim="Solutions by general factors, which took the place of bodies' or not, are looked at, and refined or refused by what they leave.",
    tier="gate",
    grid={"by": ("general factors", "general ones in the place of bodies'")},
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: solutions on either side of a millionth and, where they are refined, of a tenth"),
        "told": Bound(0.0, 0.0, "definition: nearness to a singular system, and the ordering, that are not those of the factors in use"),
    },
)
def looked_at(by: str) -> dict[str, float]:
    """How many solutions are others, or are taken or refused where they are not to be; what else is told of the factors."""
    equilibrium = Equilibrium(Scene.from_toml(SCENE).problem(), Ledger())
    source, size, ledger = equilibrium.solid_source, len(equilibrium.supports.free), equilibrium.ledger
    rows = np.repeat(np.arange(len(source.pattern.start) - 1), np.diff(source.pattern.start))
    ones = (source.pattern.column == rows)[:, None, None] * np.eye(3)
    general = LinearSystem(size, [source], ledger, ordering="amd")
    system: LinearSystem | CondensedSystem = general
    if by != "general factors":
        system = CondensedSystem(Bodies(source, entries([source], size), ledger), size, [source], lambda: general, ledger)
        system._general = general
    wrong, right = 0, np.random.default_rng(1).standard_normal(size)
    for before, after, left in OFF:
        general._rivals = [Rival(1.0, False, (before, after))]  # type: ignore[list-item]
        system.factorise([ones])
        try:
            found = system.solve(right) / right - 1.0
            wrong += left is None or bool(np.abs(found - left).max() > 1e-12)
        except SingularSystemError:
            wrong += left is not None
    return {"wrong": float(wrong), "told": float((system.rcond != Rival.rcond) + (system.ordering != Rival.ordering))}
