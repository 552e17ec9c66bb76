"""Bodies that bend are computed by a higher order where they are not too large for it."""

from __future__ import annotations

import pytest

from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.told.during import locking

BEAM = """
format = 1
materials.m = { young = 1, poisson = 0 }
bodies.b.geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 0.1, 0.05] }
bodies.b.mesh = { order = [2, 1, 2], elements = [4, 1, 1] }
supports.wall.face = "b.u0"
loads.p = { face = "b.w1", pressure = 1e-9 }
stages = [{ name = "bend", steps = 1 }]
"""


def solves(monkeypatch: pytest.MonkeyPatch) -> int:
    """Of how many control points the beam is for which it is solved by a higher order; zero: for none."""
    simulation, solved = Simulation(Scene.from_toml(BEAM).problem()), list[Equilibrium]()

    def went(of: Equilibrium, *_: object) -> float:
        solved.append(of)
        return float(len(solved))

    monkeypatch.setattr(locking, "_went", went)
    kept, after_step = list[Balance](), simulation._watches.after_step
    simulation._watches.after_step = lambda balance, *other: kept.append(balance) or after_step(balance, *other)  # type: ignore[method-assign, func-returns-value]
    list(simulation.run())
    solved.clear()
    found = locking.locking(simulation.equilibrium, kept[-1], simulation.problem.bodies[0], [0])
    assert (found is None) == (not solved)
    return solved[-1].numbering.count if solved else 0


def test_large_bodies_are_not_computed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Four elements of order 5 that are smooth once have 18 functions, 22 if they are halved, and 14 of order 4; 2 x 3 are across.

    Each of them meets 11, or 9, along and 3 x 5 across at the most.
    """
    for functions, couplings, finer in ((22, 11, 22), (18, 11, 18), (14, 9, 14)):
        monkeypatch.setattr(locking, "MOST", 6 * functions * couplings * 15)
        assert solves(monkeypatch) == 6 * finer
        monkeypatch.setattr(locking, "MOST", 6 * functions * couplings * 15 - 1)
        assert solves(monkeypatch) < 6 * finer
