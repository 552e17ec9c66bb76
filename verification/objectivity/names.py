"""What directions of bodies are called, and which way they run, where they differ: closed ones, raised faces, points along each of them."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
from small_scenes import TIGHT
from transforms import orientations, oriented

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

_BLOCK = '{{ kind = "box", lower = [-0.4, -0.25, {low}], upper = [0.4, 0.3, {high}] }}'
_ENDS = """
stages = [
    {{ name = "press", steps = 2, motions.{moves}.translate = [0.01, 0, {down}] }},
    {{ name = "turn", steps = 2, motions.{moves} = {{ translate = [0.03, 0.01, 0], rotate = {turn} }} }},
]
"""
#: A ring of three orders rolled on a plane; one that a block is pressed onto, by both gap maps; raised faces; a slave of two faces.
SCENES = {
    "ring": """
format = 1
bodies.ring.geometry = { kind = "ring", centre = [0, 0, 0.52], inner = 0.25, outer = 0.5, width = 0.25 }
bodies.ring.mesh = { order = [3, 1, 2], elements = [16, 2, 1], quadrature = [4, 3, 5] }
contacts.road = { slave = "ring.v1", plane = {}, friction = 0.3, quadrature = [6, 4] }
supports.rim = { face = "ring.v0", centre = [0, 0, 0.5], axis = [0, 1, 0] }
"""
    + _ENDS.format(moves="rim", down=-0.06, turn=10),
    **{
        f"on a ring, {projection}": f"""
format = 1
bodies.ring.geometry = {{ kind = "ring", centre = [0, 0, -0.5], inner = 0.25, outer = 0.5, width = 1 }}
bodies.ring.mesh = {{ order = [2, 1, 1], elements = [16, 1, 2] }}
bodies.block.geometry = {_BLOCK.format(low=0.01, high=0.4)}
bodies.block.mesh = {{ order = [1, 2, 3], elements = [3, 2, 1], quadrature = [3, 4, 5] }}
contacts.between = {{ slave = "block.w0", master = "ring.v1", friction = 0.3, quadrature = [4, 7], projection = "{projection}" }}
supports.rim = {{ face = "ring.v0" }}
supports.top = {{ face = "block.w1", centre = [0, 0, 0.4] }}
"""
        + _ENDS.format(moves="top", down=-0.08, turn=5)
        for projection in ("closest", "averaged")
    },
    "raised": """
format = 1
bodies.punch.geometry = { kind = "bowl", half_width = 0.3, bottom = 0.01, rise = 0.1, top = 0.5 }
bodies.punch.mesh = { order = [2, 3, 1], elements = [3, 2, 1], contact_order = 4 }
bodies.base.geometry = { kind = "box", lower = [-0.6, -0.5, -0.5], upper = [0.6, 0.5, 0] }
bodies.base.mesh = { order = [1, 2, 2], elements = [3, 2, 2], contact_order = 3, quadrature = [4, 5, 3] }
contacts.pair = { slave = "punch.w0", master = "base.w1", friction = 0.3, projection = "closest", quadrature = [5, 7] }
supports.top = { face = "punch.w1" }
supports.ground = { face = "base.w0" }
"""
    + _ENDS.format(moves="top", down=-0.06, turn=5),
    "two faces": f"""
format = 1
bodies.one.geometry = {{ kind = "box", lower = [-0.4, -0.25, 0.005], upper = [0, 0.3, 0.4] }}
bodies.one.mesh = {{ order = [2, 1, 1], elements = [2, 3, 1] }}
bodies.other.geometry = {{ kind = "box", lower = [0, -0.25, 0.005], upper = [0.5, 0.3, 0.4] }}
bodies.other.mesh = {{ order = [2, 1, 1], elements = [3, 3, 1] }}
bodies.base.geometry = {_BLOCK.format(low=-0.5, high=0)}
bodies.base.mesh = {{ order = [2, 2, 1], elements = [3, 2, 1] }}
glue = [["one.u1", "other.u0"]]
contacts.between = {{ slave = ["one.w0", "other.w0"], master = "base.w1", friction = 0.3, quadrature = [4, 6] }}
supports.top = {{ face = "one.w1", centre = [0, 0, 0.4] }}
supports.beside = {{ face = "other.w1", centre = [0, 0, 0.4] }}
supports.ground = {{ face = "base.w0" }}
stages = [
    {{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.05], motions.beside.translate = [0, 0, -0.05] }},
    {{ name = "drag", steps = 1, motions.top.translate = [0, 0.03, 0], motions.beside.translate = [0, 0.03, 0] }},
]
""",
}
#: Those of `orientations` that are tried: all orders of names, and each direction reversed.
TRIED = (1, 4, 6, 9, 13, 18, 22)
_REASON = "round-off: forces are in balance to Newton's 1e-12"


def measured(results: list[StepResult]) -> dict[str, FloatArray]:
    """Forces and moments of supports, and what the contact has, sorted, by load step."""
    return {
        "forces": np.array([[reaction.force for reaction in result.reactions] for result in results]),
        "moments": np.array([[reaction.moment for reaction in result.reactions] for result in results]),
        "pressures": np.array([np.sort(result.state.contacts[0].pressure) for result in results]),
        "tractions": np.array([np.sort(result.contacts[0].traction_norm) for result in results]),
        "works": np.array([[result.contacts[0].friction_work, result.contacts[0].spurious_work] for result in results]),
    }


@functools.cache
def as_it_is(scene: str) -> tuple[Problem, dict[str, FloatArray]]:
    """A scene and its results, computed once."""
    found = Scene.from_toml(SCENES[scene]).problem()
    problem = replace(found, settings=replace(found.settings, **TIGHT))  # type: ignore[arg-type]
    return problem, measured(list(Simulation(problem).run()))


@case(
    claim="Names and senses of directions change no result, be they closed, of other orders, raised, or with other numbers of points.",
    tier="gate",
    grid={"scene": list(SCENES)},
    bounds={name: Bound(at_most=1e-11, reason=_REASON) for name in ("forces", "moments", "pressures", "tractions", "works")},
)
def renamed(scene: str) -> dict[str, float]:
    """Largest change of each quantity over its largest value, of each body of the contact in turn, named in several ways."""
    problem, before = as_it_is(scene)
    worst = dict.fromkeys(before, 0.0)
    for number, (order, axes) in enumerate(orientations()):
        if number not in TRIED:
            continue
        body = problem.bodies[number % len(problem.bodies)]
        after = measured(list(Simulation(oriented(problem, body.name, order, axes)).run()))
        for name, value in before.items():
            worst[name] = float(np.fmax(worst[name], np.abs(after[name] - value).max() / np.abs(value).max()))
    return worst
