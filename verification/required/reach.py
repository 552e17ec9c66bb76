"""What a contact costs while it is open, and what it is told to be: with the look at boxes that puts its feet off, and without."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from typing import Any
from unittest.mock import patch

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.solve.apart import Separation
from isomortar.solve.record import StepResult

#: A block held at two sides, which are bent, ten lengths above a contact's other side or ten lengths aside of it.
_BENT = """
format = 1
bodies.slave.geometry = {{ kind = "box", lower = [{x}, -0.5, {z}], upper = [{end}, 0.5, {top}] }}
bodies.slave.mesh = {{ order = [2, 2, 1], elements = [2, 2, 1] }}
supports.left.face = "slave.u0"
supports.right = {{ face = "slave.u1", axis = [1, 0, 0] }}
stages = [{{ name = "bend", steps = 2, motions.right = {{ translate = [0.1, 0, 0.2], rotate = 20 }} }}]
solver.method = "{method}"
"""
_MASTER = """
bodies.master.geometry = { kind = "box", lower = [-1, -1, -1], upper = [1, 1, 0] }
bodies.master.mesh = { order = [2, 2, 1], elements = [3, 3, 1] }
supports.base.face = "master.w0"
"""
_CONTACT = 'contacts.c = { slave = "slave.w0", ONTO, friction = 0.3, quadrature = 3 }\n'
_ONTO = {
    "closest": 'master = "master.w1", projection = "closest"',
    "averaged": 'master = "master.w1", projection = "averaged"',
    "plane": "plane = { point = [0, 0, 0] }",
}
#: A bowl that comes from ten lengths above within three load steps, presses, leaves again, and comes back beside.
_COMES = (
    *("bodies.slave.mesh.elements=[2,2,1]", "bodies.master.mesh.elements=[3,3,1]"),
    *("bodies.slave.geometry.bottom=7.5", "bodies.slave.geometry.top=8.25", "contacts.interface.friction=0.1"),
    'stages=[{name="down",steps=3,motions.top.translate=[0.3,0.2,-7.4]},{name="press",steps=2,motions.top.translate=[0.1,0.05,-0.3]},'
    '{name="up",steps=2,motions.top.translate=[0,0,4]},{name="again",steps=2,motions.top.translate=[-0.2,0.1,-4]}]',
)


def bent(onto: str, place: str, method: str = "monolithic", contact: bool = True) -> Problem:
    """The bent block and its contact, or the same bodies without one."""
    x, z = (-0.5, 10.0) if place == "above" else (9.5, 0.01)
    text = _BENT.format(x=x, end=x + 1.0, z=z, top=z + 0.5, method=method)
    text += "" if onto == "plane" else _MASTER
    return Scene.from_toml(text + (_CONTACT.replace("ONTO", _ONTO[onto]) if contact else "")).problem()


def total(steps: list[StepResult], *names: str) -> int:
    """Sum of counters over load steps."""
    return sum(step.counters.get(name, 0) for step in steps for name in names)


@contextmanager
def always_looked_for() -> Iterator[None]:
    """Feet are looked for wherever the bodies are."""
    with patch.object(Separation, "holds", lambda *_: False):
        yield


def told(steps: list[StepResult]) -> list[Any]:
    """All that is recorded of load steps, but for times and counts."""
    return [{name: value for name, value in asdict(step).items() if name not in ("timings", "counters")} for step in steps]


def unlike(one: Any, other: Any) -> int:
    """How many numbers, words and lengths differ, by a bit or more."""
    if isinstance(one, dict):
        return sum(unlike(one[name], other[name]) for name in one)
    if isinstance(one, list | tuple):
        return abs(len(one) - len(other)) + sum(unlike(a, b) for a, b in zip(one, other, strict=False))
    if isinstance(one, np.ndarray):
        return int(one.shape != other.shape) or int(np.count_nonzero(~((one == other) | ((one != one) & (other != other)))))
    return int(not (one == other or (one != one and other != other)))


_NONE = "definition: what the scene does not require is not computed"
_SAME = "definition: nobody sees the look at boxes, to the last bit"


@case(
    claim="With its master ten lengths away a contact takes a look at its feet once a load increment, for the record, and none in "
    "iterations; linear systems are those of the bodies without it, and every number is the one that looking everywhere gives.",
    tier="gate",
    grid={"onto": ["closest", "averaged"], "place": ["above", "aside"], "method": ["monolithic", "uzawa"]},
    bounds={
        "looks": Bound(at_least=1, at_most=1, reason="definition: feet in each load increment over quadrature points, the start included"),
        "looks everywhere": Bound(at_least=3, reason="definition: an increment has three evaluations or more, so that something is saved"),
        "tangents": Bound(at_most=0, reason=_NONE),
        "solved more": Bound(at_most=0, reason="definition: solves, factors, entries and stresses of the bodies alone"),
        "unlike": Bound(at_most=0, reason=_SAME),
    },
)
def out_of_reach(onto: str, place: str, method: str) -> dict[str, float]:
    """Two load steps of a bent block, each with the same bodies without contact and with feet that are always looked for."""
    steps, alone = (list(Simulation(bent(onto, place, method, contact)).run()) for contact in (True, False))
    with always_looked_for():
        everywhere = list(Simulation(bent(onto, place, method)).run())
    points = len(steps[0].state.contacts[0].projected)
    feet = ("warm projections", "cold projections")
    increments = 1 + sum(step.substeps for step in steps)
    bodies = ("solves", "factorisations", "system non-zeros", "factor non-zeros", "solid points")
    return {
        "looks": total(steps, *feet) / points / increments,
        "looks everywhere": total(everywhere, *feet) / points / increments,
        "tangents": total(steps, "contact tangents"),
        "solved more": sum(abs(total(steps, name) - total(alone, name)) for name in bodies) if method == "monolithic" else 0,
        "unlike": unlike(told(steps), told(everywhere)),
    }


@case(
    claim="A contact with a rigid plane searches nothing and evaluates no master. While it is open it takes two passes over its points in "
    "each load increment, for the record.",
    tier="gate",
    bounds={
        "searched": Bound(at_most=0, reason=_NONE),
        "passes": Bound(at_least=2, at_most=2, reason="definition: foot and gap of each point, once in each load increment"),
        "unlike": Bound(at_most=0, reason=_SAME),
    },
)
def open_plane() -> dict[str, float]:
    """Two load steps of a bent block above a plane."""
    steps = list(Simulation(bent("plane", "above")).run())
    with always_looked_for():
        everywhere = list(Simulation(bent("plane", "above")).run())
    names = [name for name in steps[0].counters if name.startswith(("warm", "cold", "elements", "evaluations"))]
    assert len(names) == 7, "the kernel counts"
    increments = 1 + sum(step.substeps for step in steps)
    return {
        "searched": total(steps, *names),
        "passes": total(steps, "contact points") / len(steps[0].state.contacts[0].projected) / increments,
        "unlike": unlike(told(steps), told(everywhere)),
    }


@case(
    claim="Bodies that come from far away, press, part and come again do as they do when feet are looked for everywhere: slips count "
    "from where points were at the last load increment, though nobody had to look before.",
    tier=lambda projection, method: "nightly" if (projection, method) == ("averaged", "uzawa") else "gate",
    grid={"projection": ["closest", "averaged"], "method": ["monolithic", "uzawa"]},
    bounds={
        "rubbing": Bound(at_least=1, reason="definition: load steps with tractions, so that slips are seen"),
        "saved": Bound(at_least=0.02, at_most=1.0, reason="definition: share of the looks that nobody needed, so that some were put off"),
        "unlike": Bound(at_most=0, reason=_SAME),
    },
)
def come_and_go(projection: str, method: str) -> dict[str, float]:
    """Nine load steps, with feet put off and not."""
    settings = (*_COMES, f"contacts.interface.projection={projection}", f"solver.method={method}")
    steps = list(Simulation(Scene.load("twist", settings).problem()).run())
    with always_looked_for():
        everywhere = list(Simulation(Scene.load("twist", settings).problem()).run())
    feet = ("warm projections", "cold projections")
    return {
        "rubbing": sum(step.contacts[0].traction_norm.max() > 0.0 for step in steps),
        "saved": 1.0 - total(steps, *feet) / total(everywhere, *feet),
        "unlike": unlike(told(steps), told(everywhere)),
    }


@case(
    claim="Without contacts nothing of contact is done or recorded, and solids are solved as ever.",
    tier="gate",
    bounds={
        "of contact": Bound(at_most=0, reason=_NONE),
        "solved": Bound(at_least=1, reason="definition: the bodies are bent"),
        "states": Bound(at_most=0, reason=_NONE),
    },
)
def no_contact() -> dict[str, float]:
    """Two load steps of the bent block alone."""
    steps = list(Simulation(bent("closest", "above", contact=False)).run())
    names = [name for name in steps[0].counters if name.startswith(("warm", "cold", "elements", "evaluations", "contact"))]
    return {
        "of contact": total(steps, *names),
        "solved": total(steps, "solves"),
        "states": sum(step.counters["history bytes"] - step.state.positions.nbytes - 8 for step in steps),
    }
