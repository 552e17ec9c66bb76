"""What is said of contact that is narrower than its slave can carry."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Balance
from isomortar.told.during.coarse import Coarse
from isomortar.told.during.narrow import _between

SCENE = """
format = 1
materials.m = { young = 10, poisson = 0.3 }
bodies.a = { geometry = { kind = "box", lower = [-1, 0, -1], upper = [1, 0.2, 0] }, mesh = { order = 1, elements = [8, 1, 4] } }
bodies.b = { rigid = true, geometry = { kind = "ring", inner = 0.2, outer = 1, width = 0.4, centre = [0, 0.1, 1], axis = "y" } }
contacts.c = { slave = "a.w1", master = "b.v1", friction = 0, projection = "closest" }
supports.base.face = "a.w0"
supports.top.face = "b.v0"
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.03] }]
"""


@pytest.mark.parametrize(("share", "said"), [(1.0, 1), (1e-12, 0)])
def test_round_off_is_not_narrow(share: float, said: int) -> None:
    simulation = Simulation(Scene.from_toml(SCENE).problem())
    kept: list[Balance] = []
    after_step = simulation._watches._coarse.after_step
    simulation._watches._coarse.after_step = lambda balance, *other: kept.append(balance) or after_step(balance, *other)  # type: ignore[method-assign]
    list(simulation.run())
    (balance,) = kept
    responses = [replace(response, pressure=share * response.pressure) for response in balance.responses]
    coarse = Coarse(simulation.equilibrium, simulation.equilibrium.initial_state().contacts)
    assert len(list(coarse.after_step(replace(balance, responses=responses), 1, True))) == said


@pytest.mark.parametrize(
    ("sums", "lies"),
    [
        ((0, 1, 1, 0, 0), True),
        ((0, 0, 0.42, 0.58), True),
        ((0, 0, 0.38, 0.62), False),
        ((1, 0, 1), False),  # a beam that lies on its ends
        ((0, 2, 0, 0), False),
        ((1,), False),
    ],
)
def test_contact_lies_between_two_rows(sums: tuple[float, ...], lies: bool) -> None:
    assert _between(np.array(sums, dtype=float)) == lies
