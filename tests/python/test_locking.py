"""Bodies that bend are computed by a higher order where they are not too large for it."""

from __future__ import annotations

import pytest

from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger
from isomortar.told.during import locking

BEAM = """
format = 1
materials.m = { young = 1, poisson = 0 }
bodies.b.geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 0.1, 0.05] }
bodies.b.mesh = { order = [2, 1, 2], elements = [4, 1, 1] }
supports.wall.face = "b.u0"
stages = [{ name = "bend", steps = 1 }]
"""


def solves(monkeypatch: pytest.MonkeyPatch) -> int:
    """How often it is solved for how far forces move a beam that is drawn out."""
    equilibrium, solved = Equilibrium(Scene.from_toml(BEAM).problem(), Ledger()), list[Equilibrium]()

    def went(of: Equilibrium, *_: object) -> float:
        solved.append(of)
        return float(len(solved))

    monkeypatch.setattr(locking, "_went", went)
    positions = equilibrium.numbering.reference.copy()
    positions[:, 0] *= 1.0001
    found = locking.locking(equilibrium, positions, equilibrium.problem.bodies[0], 0)
    assert (found is None) == (not solved)
    return len(solved)


def test_large_bodies_are_not_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    """By a higher order they are larger: four elements of order 5 that are smooth once have 18 functions, and 2 x 3 are across."""
    monkeypatch.setattr(locking, "MOST", 6 * 18)
    assert solves(monkeypatch) == 2
    monkeypatch.setattr(locking, "MOST", 6 * 18 - 1)
    assert solves(monkeypatch) == 0
