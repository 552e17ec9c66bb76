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
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.system import LinearSystem
from isomortar.solve.timing import Ledger


class Rival:
    """An ordering that takes some operations, and finds a matrix singular or not."""

    statistics = None

    def __init__(self, flops: float, refuses: bool) -> None:
        self.flops, self.refuses = flops, refuses

    def factorise(self, values: FloatArray) -> Rival:
        """Itself, or that the matrix is singular."""
        del values
        if self.refuses:
            raise SingularSystemError(f"by {self.flops:g}")
        return self


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
