"""Supports that are released, or added, from one stage to the next."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from small_scenes import TIGHT

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

_TIGHT = "theory: forces on all control points are in balance to 1e-12 of the internal ones"
_METHODS = ("monolithic", "uzawa")


def problem(text: str, method: str) -> Problem:
    """A scene at tight tolerances."""
    found = Scene.from_toml(text, overrides=[f"solver.method={method}"]).problem()
    return replace(found, settings=replace(found.settings, **TIGHT, augmentation_tolerance=1e-10))  # type: ignore[arg-type]


def computed(text: str, method: str) -> list[StepResult]:
    """All of its load steps."""
    return list(Simulation(problem(text, method)).run())


#: A bar that is bent and twisted by its end, let go, and bent again from where it then is.
_SPRING = """
format = 1
bodies.bar = { geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 1, 1] }, mesh = { order = 2, elements = [3, 2, 2] } }
supports.base.face = "bar.u0"
supports.end = { face = "bar.u1", axis = [1, 0, 0], centre = [2, 0.5, 0.5], stages = ["bend", "again"] }
stages = [
    { name = "bend", steps = 2, motions.end = { translate = [0.1, 0, 0.3], rotate = 20 } },
    { name = "let-go", steps = 4 },
    { name = "again", steps = 1, motions.end = { translate = [0.1, 0, 0] } },
]
"""


@case(
    claim="A body that is let go springs back; what held it fades linearly within the stage, and holds it anew where it then is.",
    tier="gate",
    bounds={
        "fades": Bound(at_most=1e-9, reason=_TIGHT),
        "back": Bound(at_most=1e-9, reason="theory: an elastic body without forces is at rest as it was; " + _TIGHT),
        "force": Bound(at_most=1e-9, reason=_TIGHT),
        "again": Bound(at_most=1e-9, reason="theory: drawn by the same from rest, it bears what it bears on a first way; " + _TIGHT),
    },
)
def let_go() -> dict[str, float]:
    """Force of the support off what is left of it; positions at rest off the first ones; all forces; the second way off a first one."""
    results = computed(_SPRING, "monolithic")
    simulation = Simulation(problem(_SPRING, "monolithic"))
    whole = results[1].reactions[1].force
    left = [result.reactions[1].force - share * whole for result, share in zip(results[2:6], (0.75, 0.5, 0.25, 0.0), strict=True)]
    first = _SPRING.replace("[0.1, 0, 0.3], rotate = 20", "[0.1, 0, 0]").replace("steps = 2", "steps = 1")
    drawn = computed(first.replace(', stages = ["bend", "again"]', ""), "monolithic")[0]
    return {
        "fades": float(np.linalg.norm(left, axis=1).max() / np.linalg.norm(whole)),
        "back": float(np.abs(results[5].state.positions - simulation.state.positions).max()),
        "force": float(np.max([np.linalg.norm(np.sum([r.force for r in result.reactions], axis=0)) for result in results])),
        "again": float(np.abs(results[6].state.positions - drawn.state.positions).max()),
    }


#: A pad that is pushed onto a plane and aside.
_PAD = """
format = 1
bodies.pad = { geometry = { kind = "box", lower = [-0.5, -0.5, 0], upper = [0.5, 0.5, 0.4] }, mesh = { order = 2, elements = [3, 3, 1] } }
contacts.floor = { slave = "pad.w0", plane = {}, friction = 0.3 }
supports.push = { face = "pad.w1", centre = [0, 0, 0.4], stages = ["push"] }
stages = [{ name = "push", steps = 2, motions.push.translate = [0.02, 0, -0.02] }, { name = "rest", steps = 3 }]
"""
#: What holds it then, with the force and moment that it bears.
_RESTS = {
    "moved": "",
    "plate": "force = {{ x = {0!r}, z = {2!r} }},",
    "turning": "force = {{ x = {0!r}, y = 0, z = {2!r} }}, moment = {3!r}, axis = [0, 1, 0],",
}


@case(
    claim="A support takes over from another one without a change: by standing still, by its force, or by its force and moment.",
    tier="gate",
    grid={"rest": tuple(_RESTS), "method": _METHODS},
    bounds={
        "still": Bound(at_most=1e-9, reason="theory: what fades and what grows are the same; " + _TIGHT),
        "force": Bound(at_most=1e-9, reason=_TIGHT),
        "moment": Bound(at_most=1e-9, reason=_TIGHT),
    },
)
def handed_over(rest: str, method: str) -> dict[str, float]:
    """Positions in the second stage off those before; force and moment of the support at the end off those of the first, over the force."""
    pushed = computed(_PAD, method)[1].reactions[0]
    given = _RESTS[rest].format(*map(float, (*pushed.force, pushed.moment[1])))
    support = f'supports.rest = {{ face = "pad.w1", centre = [0, 0, 0.4], {given} stages = ["rest"] }}'
    text = _PAD.replace("\nstages = [", f"\n{support}\nstages = [")
    results = computed(text, method)
    last, size = results[-1].reactions[1], np.linalg.norm(pushed.force)
    moment = last.moment + np.cross(last.centre - pushed.centre, last.force)
    return {
        "still": float(np.max([np.abs(result.state.positions - results[1].state.positions).max() for result in results[2:]])),
        "force": float(np.linalg.norm(last.force - pushed.force) / size),
        "moment": float(np.linalg.norm(moment - pushed.moment) / size),
    }


#: A heavy bar of which a face and its edges are held, released one after the other; then a force and a moment take the face as it is.
_SHARED = """
format = 1
bodies.bar = { geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 1, 1] }, mesh = { order = 2, elements = [3, 2, 2] } }
loads.own = { body = "bar", weight = [0.05, 0.1, -0.2] }
supports.base.face = "bar.u0"
supports.end = { face = "bar.u1", stages = ["held"] }
supports.lower = { edge = "bar.u1.w0", stages = ["held"] }
supports.upper = { edge = "bar.u1.w1", stages = ["held", "by-the-edge"] }
supports.plate = { face = "bar.u1", force.z = 0.1, moment = 0.1, axis = [0, 1, 0], centre = [2, 0, 0.5], stages = ["plate"] }
stages = [
    { name = "held", steps = 1 },
    { name = "by-the-edge", steps = 2 },
    { name = "free", steps = 2 },
    { name = "plate", steps = 2, loads.own = 0.5 },
]
"""


@case(
    claim="Supports that share control points, held or released, bear each force once; one that takes over has the shape that is there.",
    tier="gate",
    grid={"method": _METHODS},
    bounds={
        "force": Bound(at_most=1e-9, reason=_TIGHT),
        "moment": Bound(at_most=1e-9, reason=_TIGHT),
        "gone": Bound(at_most=0.0, reason="definition: what was released a stage ago bears nothing"),
        "prescribed": Bound(at_most=1e-9, reason=_TIGHT),
        "shape": Bound(at_most=1e-12, reason="round-off: all control points of the face turn as one"),
        "bent": Bound(at_least=1e-3, reason="definition: the face that is taken is not as it was at first"),
    },
)
def shared(method: str) -> dict[str, float]:
    """Sums of forces, and of moments about the origin, of supports and the weight, over the largest force of one; forces of what is gone.

    What the plate exerts off what it is to; distances between its control points off those when it took them, and these off the first ones.
    """
    simulation = Simulation(problem(_SHARED, method))
    first = simulation.state.positions
    results = list(simulation.run())
    forces, moments = [], []
    for result in results:
        acting = [(r.force, r.moment + np.cross(r.centre, r.force)) for r in result.reactions]
        acting += [(load.force, load.moment) for load in result.loads]
        size = np.abs([force for force, _ in acting]).max()
        force, moment = np.sum(acting, axis=0)
        forces.append(np.linalg.norm(force) / size)
        moments.append(np.linalg.norm(moment) / size)
    plate, face = results[-1].reactions[4], simulation.equilibrium.supports.points[1]
    rest, taken, end = (positions[face] for positions in (first, results[4].state.positions, results[-1].state.positions))
    apart = [np.linalg.norm(points[:, None] - points, axis=2) for points in (rest, taken, end)]
    return {
        "force": float(np.max(forces)),
        "moment": float(np.max(moments)),
        "gone": float(np.abs([result.reactions[1].force for result in results[3:]]).max()),
        "prescribed": float(np.abs([plate.force[2] - 0.1, plate.moment[1] - 0.1]).max()),
        "shape": float(np.abs(apart[2] - apart[1]).max()),
        "bent": float(np.abs(apart[1] - apart[0]).max()),
    }


#: A pad that a force and a moment press and turn on a plane, then its own weight alone.
_PLATE = """
format = 1
bodies.pad = { geometry = { kind = "box", lower = [-0.5, -0.5, 0], upper = [0.5, 0.5, 0.4] }, mesh = { elements = [2, 2, 1] } }
contacts.floor = { slave = "pad.w0", plane = {}, friction = 0.3 }
loads.own = { body = "pad", weight = [0, 0, -0.5] }

[supports.plate]
face = "pad.w1"
components = ["x"]
force = { y = 0.02, z = -0.3 }
moment = 0.02
axis = [0, 1, 0]
centre = [0, 0, 0.4]
stages = ["pressed"]

[[stages]]
name = "pressed"
steps = 2
motions.plate.translate = [0.02, 0, 0]

[[stages]]
name = "let-go"
steps = 2

[[stages]]
name = "free"
steps = 1
"""


@case(
    claim="A support by force and moment that is released is recorded as staying where it was, wherever the origin is, in a run that goes "
    "on from any step too.",
    tier="gate",
    grid={"away": (0, 128)},
    bounds={
        "way": Bound(0.0, 0.0, "definition: displacement and centre of what does not hold any more do not change"),
        "angle": Bound(0.0, 0.0, "definition: nor does its rotation"),
        "gone": Bound(at_least=1e-3, reason="definition: or it has not gone anywhere by its force"),
        "turned": Bound(at_least=0.1, reason="definition: nor turned by its moment, in degrees"),
        "resumed": Bound(0.0, 0.0, "definition: the bits of the whole run"),
    },
)
def stays(away: int) -> dict[str, float]:
    """Displacement, centre and rotation after the release off those before; how far and by how much it went; the same of resumed runs."""
    text = _PLATE.replace("[-0.5, -0.5, 0], upper = [0.5,", f"[{away - 0.5}, -0.5, 0], upper = [{away + 0.5},")
    found = problem(text.replace("centre = [0,", f"centre = [{away},"), "monolithic")
    results = list(Simulation(found).run())
    (held, *left) = (result.reactions[0] for result in results[1:])
    resumed = [
        (one, other) for k, start in enumerate(results[:-1]) for one, other in zip(results[k + 1 :], _resumed(found, start), strict=True)
    ]
    off = [np.abs(_place(one) - _place(other)).max() for one, other in resumed]
    ways = [np.abs(np.subtract([r.displacement, r.centre], [held.displacement, held.centre])).max() for r in left]
    return {
        "way": float(np.max(ways)),
        "angle": float(np.max([abs(r.rotation - held.rotation) for r in left])),
        "gone": float(abs(held.displacement[2])),
        "turned": float(abs(held.rotation)),
        "resumed": float(np.max(off)),
    }


def _resumed(found: Problem, start: StepResult) -> list[StepResult]:
    """The load steps after one, by a simulation that begins there."""
    return list(Simulation(found, resume_from=start).run())


def _place(result: StepResult) -> np.ndarray:
    """All that is recorded of the first support, in one array."""
    reaction = result.reactions[0]
    return np.concatenate([reaction.force, reaction.moment, reaction.centre, reaction.displacement, [reaction.rotation]])
