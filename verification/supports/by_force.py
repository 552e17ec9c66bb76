"""Supports that exert a prescribed force or moment: what they move or turn by, prescribed in its place, makes that force or moment."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
from small_scenes import TIGHT

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Motion, Problem, Stage, unit
from isomortar.model.supports import factor_at
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: Scenes with one support `top` that a force moves, or a moment turns.
SCENES = {
    # A bar that is bent by a force across its end, which turns meanwhile.
    "bar": """
format = 1
bodies.bar = { geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 1, 1] }, mesh = { order = 2, elements = [3, 2, 2] } }
supports.base.face = "bar.u0"
supports.top = { face = "bar.u1", force = { y = 0.2, z = -0.1 }, centre = [2, 0.5, 0.5], axis = [1, 2, 3] }
stages = [
    { name = "bend", steps = 2, loads.top = 1 },
    { name = "turn", steps = 2, loads.top = -0.5, motions.top = { translate = [0.1, 0, 0], rotate = 10 } },
]
""",
    # A bowl that stands above a plane, is pressed onto it by a weight, and dragged.
    "onto a plane": """
format = 1
bodies.pad = { geometry = { kind = "bowl", half_width = 0.5, bottom = 0.02, rise = 0.1, top = 1 }, mesh = { elements = [4, 4, 2] } }
contacts.floor = { slave = "pad.w0", plane = {}, friction = 0.3 }
supports.top = { face = "pad.w1", force.z = -0.4 }
stages = [
    { name = "press", steps = 2 },
    { name = "drag", steps = 3, motions.top.translate = [0.1, 0, 0] },
    { name = "more", steps = 2, loads.top = 1.5, motions.top.translate = [0, 0.05, 0] },
]
""",
    # The same on a block, without friction, of Lagrange elements, glued on top to a stiffer one that the force acts on.
    "onto a block": """
format = 1
glue = [["pad.w1", "head.w0"]]
materials = { soft = {}, stiff = { young = 100.0 } }
bodies.pad.geometry = { kind = "box", lower = [-0.3, -0.3, 0], upper = [0.3, 0.3, 0.4] }
bodies.pad.mesh = { family = "L", order = 2, elements = [2, 2, 1] }
bodies.pad.material = "soft"
bodies.head.geometry = { kind = "box", lower = [-0.3, -0.3, 0.4], upper = [0.3, 0.3, 0.6] }
bodies.head.mesh = { family = "L", order = 2, elements = [2, 2, 1] }
bodies.head.material = "stiff"
bodies.block.geometry = { kind = "box", lower = [-1, -1, -0.5], upper = [1, 1, 0] }
bodies.block.mesh = { elements = [5, 5, 2] }
bodies.block.material = "soft"
contacts.pair = { slave = "pad.w0", master = "block.w1", friction = 0 }
supports.base.face = "block.w0"
supports.top = { face = "head.w1", force = { x = 0, y = 0, z = -0.3 } }
supports.side = { face = "pad.u0", components = ["x"] }
supports.front = { face = "pad.v0", components = ["y"] }
stages = [{ name = "press", steps = 2, loads.top = 1 }]
""",
    # A bar that a force and a moment bend, its end turning about an axis beside it and askew, and more while it is drawn out.
    "bar, turned": """
format = 1
bodies.bar = { geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 1, 1] }, mesh = { order = 2, elements = [3, 2, 2] } }
supports.base.face = "bar.u0"
supports.top = { face = "bar.u1", force.z = -0.1, moment = 0.3, centre = [2.2, 0.5, 0.3], axis = [1, 2, 3] }
stages = [{ name = "bend", steps = 2 }, { name = "draw", steps = 2, loads.top = 2, motions.top.translate = [0.1, 0, 0] }]
""",
    # A pad that is pressed, dragged and tilted at its top, of which an edge is on a face under pressure as well.
    "onto a plane, tilting": """
format = 1
bodies.pad = { geometry = { kind = "box", lower = [-0.5, -0.5, 0], upper = [0.5, 0.5, 0.4] }, mesh = { order = 2, elements = [3, 3, 1] } }
contacts.floor = { slave = "pad.w0", plane = {}, friction = 0.3 }
supports.top = { face = "pad.w1", force.z = -0.4, moment = 0.01, centre = [0, 0, 0.4], axis = [0, 1, 0] }
loads.wind = { face = "pad.u0", pressure = 0.05 }
stages = [{ name = "press", steps = 2 }, { name = "drag", steps = 2, motions.top.translate = [0.05, 0, 0] }]
""",
    # A rigid box that a force presses onto a block beside its middle: a moment keeps it from tilting, in part.
    "a rigid box": """
format = 1
bodies.block.geometry = { kind = "box", lower = [-0.4, -0.3, -0.5], upper = [0.4, 0.3, 0] }
bodies.block.mesh = { order = 2, elements = [4, 2, 2] }
bodies.box.geometry = { kind = "box", lower = [-1, -1, 0], upper = [1, 1, 0.5] }
bodies.box.mesh.order = 1
bodies.box.rigid = true
contacts.pair = { slave = "block.w1", master = "box.w0", friction = 0 }
supports.base.face = "block.w0"
supports.top = { face = "box.w1", force.z = -0.3, moment = -0.02, centre = [0.05, 0, 0.5], axis = [0, 1, 0] }
solver.penalty_growth_max = 10
stages = [{ name = "press", steps = 2 }, { name = "turn", steps = 2, loads.top = 1.2 }]
""",
}


def problem(scene: str, method: str) -> Problem:
    """A scene at tight tolerances."""
    found = Scene.from_toml(SCENES[scene], overrides=[f"solver.method={method}"]).problem()
    return replace(found, settings=replace(found.settings, **TIGHT, augmentation_tolerance=1e-10))  # type: ignore[arg-type]


def by_displacement(given: Problem, results: list[StepResult]) -> Problem:
    """The problem with the motions that its supports were found to make in place of forces, a stage for each load step."""
    supports = []
    for k, support in enumerate(given.supports):
        ways = np.diff([np.zeros(3), *(result.reactions[k].displacement for result in results)], axis=0)
        turns = np.diff([0.0, *(result.reactions[k].rotation for result in results)])
        motions = tuple(Motion((float(x), float(y), float(z)), float(turn)) for (x, y, z), turn in zip(ways, turns, strict=True))
        components = tuple(sorted(support.carried))
        supports.append(replace(support, motions=motions, components=components, force=(None, None, None), factors=(), moment=None))
    steps = range(1, given.total_steps + 1)
    loads = [replace(load, factors=tuple(factor_at(given.stages, load.factors, step) for step in steps)) for load in given.loads]
    stages = tuple(Stage(f"step-{step}", 1) for step in steps)
    return replace(given, supports=tuple(supports), stages=stages, loads=tuple(loads))


@case(
    claim="A support by force or moment goes where the same support by displacement or angle makes that force or moment.",
    tier="gate",
    grid={"scene": tuple(SCENES), "method": ("monolithic", "uzawa")},
    bounds={
        "prescribed": Bound(at_most=1e-10, reason="theory: forces on all control points are in balance to 1e-12 of the internal ones"),
        "force": Bound(at_most=1e-10, reason="theory: the same equations, the unknown exchanged; both to tight tolerances"),
        "moment": Bound(at_most=1e-10, reason="theory: as above"),
        "positions": Bound(at_most=1e-10, reason="theory: as above"),
        "plate": Bound(at_most=1e-14, reason="round-off: the face is in shape"),
    },
)
def exchanged(scene: str, method: str) -> dict[str, float]:
    """Force of the support off the one prescribed, and that by displacement; moments of both over force times size; positions; the shape.

    Moments are those about the axis, off what is prescribed; positions those of one run off the other's, and shape what the face is off.
    """
    given = problem(scene, method)
    simulation = Simulation(given)
    pressed, supports, reference = list(simulation.run()), simulation.equilibrium.supports, simulation.equilibrium.numbering.reference
    moved = list(Simulation(by_displacement(given, pressed)).run())
    top = next(k for k, support in enumerate(given.supports) if support.is_plate)
    support, own = given.supports[top], list(given.supports[top].pressed)
    ends = np.cumsum([0, *(stage.steps for stage in given.stages)])
    factors = np.interp(np.arange(1, given.total_steps + 1), ends, [0.0, *support.factors])
    wanted = factors[:, None] * np.array([support.force[k] for k in own], dtype=np.float64)
    found, again = (np.array([result.reactions[top].force[own] for result in run]) for run in (pressed, moved))
    apart = [np.abs(a.state.positions - b.state.positions).max() for a, b in zip(pressed, moved, strict=True)]
    shapes = []
    for result in pressed:
        off = (result.state.positions - supports.place(result.time, result.state.positions))[supports.points[top]][:, own]
        shapes.append(np.ptp(off, axis=0).max() / np.ptp(reference))
    size, moments = np.abs(wanted).max(), np.zeros((2, 1))
    if support.moment is not None:
        moments = np.array([[result.reactions[top].moment @ unit(support.axis) for result in run] for run in (pressed, moved)])
        moments -= factors * support.moment
    return {
        "prescribed": float(np.abs(found - wanted).max() / size),
        "force": float(np.abs(again - wanted).max() / size),
        "moment": float(np.abs(moments).max() / (size * np.ptp(reference))),
        "positions": float(max(apart)),
        "plate": float(max(shapes)),
    }


#: A bar that is symmetric across y = 0, and bent by a force in that plane.
_BENT = """
format = 1
bodies.bar.geometry = { kind = "box", lower = [0, -1, 0], upper = [2, 1, 0.6] }
bodies.bar.mesh = { family = "L", order = 2, elements = [2, 2, 1] }
supports.wall.face = "bar.u0"
supports.end = { face = "bar.u1", force = { x = 0.1, z = 0.2 } }
stages = [{ name = "bend", steps = 2 }]
"""


@case(
    claim="A force that is prescribed is the whole's, where symmetry halves a scene.",
    tier="gate",
    bounds={
        "force": Bound(at_most=1e-10, reason="theory: Lagrange elements of the halves have the same functions"),
        "way": Bound(at_most=1e-10, reason="theory: as above"),
    },
)
def halved() -> dict[str, float]:
    """Differences between the half and the whole of the force of the support over it, and of how far it goes over that."""
    problems = [Scene.from_toml(_BENT + more).problem() for more in ("", "symmetry = { y = 0.0 }\n")]
    tight = [replace(found, settings=replace(found.settings, **TIGHT)) for found in problems]  # type: ignore[arg-type]
    whole, half = (list(Simulation(found).run())[-1].reactions[1] for found in tight)
    return {
        "force": float(np.linalg.norm(whole.force - half.force) / np.linalg.norm(whole.force)),
        "way": float(np.linalg.norm(whole.displacement - half.displacement) / np.linalg.norm(whole.displacement)),
    }


#: A bar of soft skew elements, all of whose directions pull on each other.
SKEW = """
format = 1
bodies.bar.patch = { order = 1, knots = [[0, 0, 1, 1], [0, 0, 1, 1], [0, 0, 1, 1]], control_points = [
    [0, 0, 0], [2, 0.5, 0.3], [0.2, 1, 0.1], [2.2, 1.4, 0.2], [0, 0.2, 1], [2, 0.6, 1.2], [0.3, 1.1, 1.1], [2.1, 1.6, 1.3]] }
supports.base.face = "bar.u0"
supports.top = { face = "bar.u1", force = { GIVEN } }
stages = [{ name = "pull", steps = 1, motions.top.translate = [MOTION] }]
"""


@case(
    claim="A support exerts the force that is given along an axis, of no size as well, and moves there; it is held where none is given.",
    tier="gate",
    bounds={
        "force": Bound(at_most=1e-9, reason="round-off: forces are in balance to Newton's 1e-10"),
        "way": Bound(at_most=0.0, reason="definition: an axis without a force is held where its motion is"),
        "held": Bound(0.0, 0.0, "definition: axes with a force along which nothing has moved, as the bar is pulled some way"),
        "said": Bound(0.0, 0.0, "definition: supports that are said to prescribe the motion along other axes"),
    },
)
def along_each_axis() -> dict[str, float]:
    """Over all choices of no force, one of no size and one of some size along the axes."""
    force = way = held = said = 0.0
    for sizes in product((None, 0.0, 0.05), repeat=3):
        if len(set(sizes)) == 1 and not any(sizes):
            continue
        given = ", ".join(f"{axis} = {size}" for axis, size in zip("xyz", sizes, strict=True) if size is not None)
        motion = [0.01 if size is None else 0.0 for size in sizes]
        text = SKEW.replace("GIVEN", given).replace("MOTION", ", ".join(map(str, motion)))
        problem = Scene.from_toml(text, overrides=["solver.newton_tolerance=1e-10"]).problem()
        said += problem.supports[1].components != tuple(axis for axis, size in enumerate(sizes) if size is None)
        last = list(Simulation(problem).run())[-1]
        top = last.reactions[1]
        largest = float(np.abs(top.force).max()) or 1.0
        for axis, size in enumerate(sizes):
            if size is None:
                way = float(np.maximum(way, abs(top.displacement[axis] - motion[axis])))
            else:
                force = float(np.maximum(force, abs(top.force[axis] - size) / largest))
                held += float(top.displacement[axis] == 0.0)
    return {"force": force, "way": way, "held": held, "said": said}
