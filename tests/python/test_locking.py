"""Bodies that bend are computed by a higher order only where that tells something, and where they are not too large for it."""

from __future__ import annotations

import pytest

from isomortar.geometry.patch import FloatArray
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger
from isomortar.told.during import locking

BEAM = """
format = 1
materials.m = { young = 1, poisson = 0 }
bodies.b.geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 0.1, 0.05] }
bodies.b.mesh = { order = [ORDER, 1, 2], elements = [4, 1, 1] }
supports.wall.face = "b.u0"
stages = [{ name = "bend", steps = 1 }]
"""


def solves(monkeypatch: pytest.MonkeyPatch, order: int, power: int) -> int:
    """How often it is solved for how far forces move a beam whose points go across by a power of their place, or along for none."""
    equilibrium, solved = Equilibrium(Scene.from_toml(BEAM.replace("ORDER", str(order))).problem(), Ledger()), list[Equilibrium]()

    def went(of: Equilibrium, *_: object) -> float:
        solved.append(of)
        return float(len(solved))

    monkeypatch.setattr(locking, "_went", went)
    positions = equilibrium.numbering.reference.copy()
    positions[:, 2 if power else 0] += 1e-4 * positions[:, 0] ** (power or 1)
    found = locking.locking(equilibrium, positions, equilibrium.problem.bodies[0], 0)
    assert (found == locking.UNKNOWN) == (not solved)
    return len(solved)


@pytest.mark.parametrize(("order", "power", "times"), [(1, 4, 0), (2, 4, 0), (3, 4, 2), (2, 0, 2)])
def test_what_is_estimated_is_not_computed(monkeypatch: pytest.MonkeyPatch, order: int, power: int, times: int) -> None:
    """Strains that grow along a beam are those of forces between its ends, even ones those of forces at them."""
    assert solves(monkeypatch, order, power) == times


def test_large_bodies_are_not_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    """By a higher order they are larger: four elements of order 5 that are smooth once have 18 functions, and 2 x 3 are across."""
    monkeypatch.setattr(locking, "MOST", 6 * 18)
    assert solves(monkeypatch, 2, 0) == 2
    monkeypatch.setattr(locking, "MOST", 6 * 18 - 1)
    assert solves(monkeypatch, 2, 0) == 0
