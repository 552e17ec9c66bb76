"""The same scene told otherwise: lists in another order, stages in parts, numbers by overrides, a copy of it far away in the same file."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

import numpy as np
from small_scenes import TIGHT
from transforms import moved

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Edge, Face, Motion, Problem, RigidPlane, Stage, Support
from isomortar.scene import Scene

#: Three blocks on each other, of which the upper is pressed and dragged: the one between is slave and master, and both contacts slip.
ROW = """
format = 1
bodies.low = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1.2, 1.1, 0.6] }, mesh.elements = [3, 2, 1] }
bodies.mid = { geometry = { kind = "box", lower = [0.1, 0.05, 0.6], upper = [0.9, 0.95, 1] }, mesh.elements = [3, 3, 1] }
bodies.top = { geometry = { kind = "box", lower = [0.25, 0.2, 1], upper = [0.7, 0.8, 1.4] }, mesh.elements = [2, 2, 1] }
contacts.one = { slave = "mid.w0", master = "low.w1", friction = 0.1 }
contacts.two = { slave = "top.w0", master = "mid.w1", friction = 0.3 }
supports = { base.face = "low.w0", hand.face = "top.w1" }
loads = { weight = { body = "mid", weight = [0, 0.02, -0.1] }, wind = { face = "top.u0", pressure = 0.02 } }
[[stages]]
name = "press"
steps = 2
motions.hand.translate = [0, 0, -0.04]
[[stages]]
name = "drag"
steps = 2
motions.hand = { translate = [0.06, 0.04, 0], rotate = 4 }
"""
Place = TypeVar("Place", Face, Edge, Face | RigidPlane, Edge | Face)
#: Numbers that are others in the file, and set from outside.
SET = {
    "contacts.one.friction": "0.1",
    "stages.drag.steps": "2",
    "stages.drag.motions.hand.rotate": "4",
    "bodies.mid.mesh.elements": "[3, 3, 1]",
}


def problem_of(scene: Scene) -> Problem:
    """At tight tolerances."""
    found = scene.problem()
    return replace(found, settings=replace(found.settings, **TIGHT))  # type: ignore[arg-type]


def _by_overrides() -> Problem:
    other = ROW.replace("friction = 0.1", "friction = 0.7").replace("rotate = 4", "rotate = 9").replace("[3, 3, 1]", "[2, 2, 1]")
    assert other != ROW
    return problem_of(Scene.from_toml(other, overrides=[f"{path}={value}" for path, value in SET.items()]))


def _in_other_order(problem: Problem) -> Problem:
    return replace(problem, contacts=problem.contacts[::-1], supports=problem.supports[::-1], loads=problem.loads[::-1])


def _in_parts(problem: Problem) -> Problem:
    """The last stage as two of half its motions and load steps."""
    *before, last = problem.stages

    def of(support: Support) -> Support:
        *earlier, motion = support.motions
        x, y, z = (0.5 * part for part in motion.translate)
        return replace(support, motions=(*earlier, *2 * (Motion((x, y, z), 0.5 * motion.rotate),)))

    parts = (Stage(last.name, last.steps // 2), Stage("rest", last.steps - last.steps // 2))
    loads = tuple(replace(load, factors=(*load.factors, load.factors[-1]) if load.factors else ()) for load in problem.loads)
    return replace(problem, stages=(*before, *parts), supports=tuple(map(of, problem.supports)), loads=loads)


def _beside_its_copy(problem: Problem) -> Problem:
    """With all of it once more, a thousand lengths away, first in every list."""
    far = moved(problem, np.array([1000.0, -300.0, 0.0]))
    contacts = tuple(replace(c, name=f"far-{c.name}", slave=_far(c.slave), master=_far(c.master)) for c in far.contacts)
    supports = tuple(replace(support, name=f"far-{support.name}", place=_far(support.place)) for support in far.supports)
    return replace(
        problem,
        bodies=(*(replace(body, name=f"far-{body.name}") for body in far.bodies), *problem.bodies),
        contacts=contacts + problem.contacts,
        supports=supports + problem.supports,
        loads=(*(replace(load, name=f"far-{load.name}", body=f"far-{load.body}") for load in far.loads), *problem.loads),
    )


def _far(place: Place) -> Place:
    """The place on the copy."""
    assert not isinstance(place, RigidPlane)
    return replace(place, body=f"far-{place.body}")


@functools.cache
def as_it_is() -> Problem:
    """The scene."""
    return problem_of(Scene.from_toml(ROW))


WAYS: dict[str, Callable[[], Problem]] = {
    "in other order": lambda: _in_other_order(as_it_is()),
    "bodies in other order": lambda: replace(as_it_is(), bodies=as_it_is().bodies[::-1]),
    "in parts": lambda: _in_parts(as_it_is()),
    "by overrides": _by_overrides,
    "beside its copy": lambda: _beside_its_copy(as_it_is()),
}


def found(problem: Problem) -> dict[str, FloatArray]:
    """Forces and moments of supports by load step, those of contacts with what they take up, and pressures; of the scene's own names."""
    results, own = list(Simulation(problem).run()), as_it_is()
    supports = [[support.name for support in problem.supports].index(support.name) for support in own.supports]
    contacts = [[contact.name for contact in problem.contacts].index(contact.name) for contact in own.contacts]
    return {
        "forces": np.array([[r.reactions[k].force for k in supports] + [r.contacts[k].force_slave for k in contacts] for r in results]),
        "moments": np.array([[r.reactions[k].moment for k in supports] for r in results]),
        "works": np.array([[(r.contacts[k].friction_work, r.contacts[k].spurious_work) for k in contacts] for r in results]),
        "pressures": np.array([np.concatenate([r.state.contacts[k].pressure for k in contacts]) for r in results]),
    }


@functools.cache
def found_as_it_is() -> dict[str, FloatArray]:
    """The same of the scene as it is."""
    return found(as_it_is())


@case(
    claim="A scene of two contacts that slip, of which a body is slave and master, has the same results with its lists in another order, "
    "a stage in two, numbers set from outside, and a copy of it far away in the same file.",
    tier="gate",
    grid={"way": tuple(WAYS)},
    bounds={
        name: Bound(at_most=1e-10, reason="round-off: forces are in balance to Newton's 1e-12")
        for name in ("forces", "moments", "works", "pressures")
    },
)
def retold(way: str) -> dict[str, float]:
    """Largest change of each quantity over its largest value."""
    before, after = found_as_it_is(), found(WAYS[way]())
    return {name: float(np.abs(after[name] - value).max() / np.abs(value).max()) for name, value in before.items()}
