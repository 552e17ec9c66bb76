"""Bodies that bend are computed by a higher order where they are not too large for it."""

from __future__ import annotations

import re

import pytest
from told.runs import Heard

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


#: A column between a plane and a support that presses it: all is homogeneous, whatever its order.
COLUMN = """
format = 1
bodies.b.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
bodies.b.mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
contacts.floor = { slave = "b.w0", plane = { point = [0, 0, 0] }, friction = 0 }
supports.top = { face = "b.w1", components = ["z"] }
supports.x = { face = "b.u0", components = ["x"] }
supports.y = { face = "b.v0", components = ["y"] }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.1] }]
"""


def test_contact_at_an_end_acts_at_that_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """A column is no stiffer than one of a higher order: what presses on its end, and is not spread along it, squeezes both as much."""
    simulation, kept = Simulation(Scene.from_toml(COLUMN).problem()), list[Balance]()
    after_step = simulation._watches.after_step
    monkeypatch.setattr(simulation._watches, "after_step", lambda balance, *other: kept.append(balance) or after_step(balance, *other))
    list(simulation.run())
    share = locking.locking(simulation.equilibrium, kept[-1], simulation.problem.bodies[0], [2])
    assert share == pytest.approx(0.0, abs=1e-9)


#: Two beams that go on in one, or as much of one that JOINT lacks, with what acts on them.
IN_LINE = """
format = 1
materials.m = { young = 1, poisson = 0.3 }
bodies.b = { material = "m", geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 0.1, 0.02] }, mesh = MESH }
bodies.c = { material = "m", geometry = { kind = "box", lower = [2, 0, 0], upper = [4, 0.1, 0.02] }, mesh = MESH }
glue = [JOINT]
supports = { wall.face = "b.u0", other.face = "c.u1", hand.face = "roll.v0" }
bodies.roll = { rigid = true, geometry = ROLL, mesh = { order = 2, elements = [4, 1, 1] } }
contacts.c = { slave = SIDE, master = "roll.v1", enforcement = "dual" }
stages = [{ name = "bend", steps = 1, motions.hand.translate = [0, 0, -0.3] }]
"""
ROLL = '{ kind = "ring", inner = 0.05, outer = 1, width = 0.3, axis = "y", centre = [3, 0.05, 1.02], angles = [90, 270] }'
MESH = "{ order = [2, 1, 2], elements = [3, 1, 1] }"


def told(text: str) -> dict[str, float]:
    """By how much bodies are said to be too stiff, by name."""
    heard = Heard()
    list(Simulation(Scene.from_toml(text).problem(), heard).run())
    found = (re.search(r"body '(\w+)'.*up to about ([0-9. ]+)( times| %) too stiff", said) for said in heard.said)
    return {one[1]: float(one[2].replace(" ", "")) * (1.0 if "times" in one[3] else 0.01) for one in found if one}


@pytest.mark.parametrize("joint", ['["b.u1", "c.u0"]', '["c.u0", "b.u1"]'])
@pytest.mark.parametrize("side", ['["b.w1", "c.w1"]', '["c.w1", "b.w1"]'])
def test_what_goes_on_in_another_body_is_told_whichever_is_first(joint: str, side: str) -> None:
    """One beam as a single body was 130 times too stiff; the other half of it hardly bends."""
    text = IN_LINE.replace("JOINT", joint).replace("SIDE", side).replace("ROLL", ROLL).replace("MESH", MESH)
    found = told(text)
    assert found.keys() == {"c"}
    assert 100.0 < found["c"] < 170.0


RING = """
format = 1
materials.m = { young = 1, poisson = 0.3 }
bodies.b.geometry = { kind = "ring", inner = 0.98, outer = 1, width = 0.1, axis = "y", angles = [0, 90] }
bodies.b.mesh = { order = [2, 2, 1], elements = [4, 1, 1]HIGHER }
supports.wall.face = "b.u0"
contacts.c = { slave = "b.v1", plane = { point = [0, 0, -100], normal = [0, 0, 1] } }
loads.p = { body = "b", weight = [0, 0, -1e-8] }
stages = [{ name = "bend", steps = 1 }]
"""


def test_a_higher_order_at_a_face_changes_little_of_what_is_told() -> None:
    one, two = (told(RING.replace("HIGHER", higher))["b"] for higher in ("", ", contact_order = 3"))
    assert 0.5 < one / two < 2.0


PLATE = """
format = 1
materials.m = { young = 1, poisson = 0.3 }
bodies.b.geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 2, 0.001] }
bodies.b.mesh = { order = [2, 3, 2], elements = [COUNT, 1, 1] }
supports = { wall.face = "b.v0", other.face = "b.v1" }
loads.p = { face = "b.w1", pressure = 1e-10 }
stages = [{ name = "bend", steps = 1 }]
"""


def test_what_is_known_of_one_direction_is_told_where_the_other_one_has_too_many_elements() -> None:
    few, many = (told(PLATE.replace("COUNT", count))["b"] for count in ("4", "50"))
    assert few == pytest.approx(many, rel=0.05)
    assert many > 1e4
