"""Bodies that begin without contact: what loads or others press closes first, what they rest on, and what does not draw them."""

from __future__ import annotations

import functools

import numpy as np
from loads.falling import computed
from loads.light import CUTS

from isomortar.errors import ConvergenceError
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case

#: A roller on a floor, which it touches as well as the plate on it, and a block in a gap, between what is pressed together.
_ROLLER = """
format = 1
bodies.loose = { geometry = { kind = "ring", inner = 0.2, outer = 0.5, width = 0.6, centre = [0, 0, 0.5] }, mesh.elements = [32, 1, 1] }
bodies.plate = { geometry = { kind = "box", lower = [-0.5, -0.4, 1], upper = [0.5, 0.4, 1.3] }, mesh.elements = [6, 2, 1] }
contacts.floor = { slave = "loose.v1", plane = {}, friction = 0.4 }
contacts.top = { slave = "loose.v1", master = "plate.w0", friction = 0.4 }
supports = { top.face = "plate.w1", side = { face = "loose.w0", components = ["y"] } }
stages = [{ name = "press", steps = 3, motions.top.translate = [0, 0, -0.03] }]
"""
_IN_A_GAP = """
format = 1
bodies.loose = { geometry = { kind = "box", lower = [0, 0, 0.003], upper = [1, 1, 0.998] }, mesh.elements = [2, 2, 2] }
bodies.plate = { geometry = { kind = "box", lower = [-0.2, -0.2, 1], upper = [1.2, 1.2, 1.3] }, mesh.elements = [3, 2, 1] }
contacts.floor = { slave = "loose.w0", plane = {}, friction = 0.4 }
contacts.top = { slave = "loose.w1", master = "plate.w0", friction = 0.4 }
supports.top.face = "plate.w1"
stages = [{ name = "press", steps = 3, motions.top.translate = [0, 0, -0.03] }]
"""
#: A bowl on a floor, where of three or five elements along it one control point is the lowest: weights straight down, and to all sides.
_BOWL = """
format = 1
bodies.bowl.geometry = { kind = "bowl", half_width = 0.5, bottom = 0, rise = 0.1, top = 0.4 }
contacts.floor = { slave = "bowl.w0", plane = {}, friction = 0.5 }
stages = [{ name = "lay", steps = 1 }]
"""
_ASIDE = ([0, 0], [0.1, 0], [-0.1, 0], [0, 0.2], [0, -0.2], [0.13, 0.13], [-0.13, -0.13])
#: A block on a rough floor, or above it, that a plate presses which does not keep it from going along.
_PRESSED = """
format = 1
bodies.block.geometry = {{ kind = "box", lower = [0, 0, {lower}], upper = [1, 1, {upper}] }}
bodies.block.mesh.elements = 2
contacts.floor = {{ slave = "block.w0", plane = {{}}, friction = 0.4 }}
supports.top = {{ face = "block.w1", components = {components} }}
loads.side = {{ face = "block.u1", traction = [{push}, 0, 0] }}
stages = [{{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.05] }}]
"""
#: A ring on a floor, of which one row of control points is the lowest.
_RING = """
format = 1
bodies.ring.geometry = { kind = "ring", inner = 0.5, outer = 1.0, width = 0.5, centre = [0, 0, 1] }
contacts.floor = { slave = "ring.v1", plane = {}, friction = 0.5 }
loads.own = { body = "ring", weight = [0, 0, -0.02] }
stages = [{ name = "lay", steps = 1 }]
"""
_BETWEEN = {"roller": _ROLLER, "in a gap": _IN_A_GAP}
#: Two bodies, and a roller between them, which touches both.
_PLATES = """
format = 1
bodies.plate = { geometry = { kind = "box", lower = [-2, 0, 1], upper = [2, 0.3, 1.4] }, mesh.elements = [16, 1, 2] }
bodies.floor = { geometry = { kind = "box", lower = [-2, 0, -0.4], upper = [2, 0.3, 0] }, mesh.elements = [16, 1, 2] }
supports = { top.face = "plate.w1", base.face = "floor.w0" }
stages = [{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.025] }]
"""
_BETWEEN_PLATES = """
bodies.NAME = { geometry = { kind = "ring", inner = 0.2, outer = 0.5, width = 0.3, centre = [AT, 0, 0.5] }, mesh.elements = [16, 2, 1] }
contacts.floor-NAME = { slave = "NAME.v1", master = "floor.w1", friction = 0.3 }
contacts.top-NAME = { slave = "NAME.v1", master = "plate.w0", friction = 0.3 }
"""
_PLACES = {1: (0.0,), 2: (-1.2, 1.2), 3: (-1.2, 0.0, 1.2)}


@case(
    claim="A block that a support presses on a rough floor, and leaves free along that, is held by friction from the first increment on, "
    "whether it touches the floor before or comes down to it, and whether a load pushes it along.",
    tier="gate",
    grid={"gap": (0.0, 0.01), "free": ("x", "xy"), "push": (0.0, 0.01), "method": ("monolithic", "uzawa")},
    bounds={"balance": Bound(at_most=1e-7, reason="definition: friction bears the load, to the tolerance of balance")} | CUTS,
)
def pressed(gap: float, free: str, push: float, method: str) -> dict[str, float]:
    """Largest difference of friction and load over the pressing force, of both load steps; cuts of load increments."""
    held = [component for component in "xyz" if component not in free]
    text = _PRESSED.format(lower=gap, upper=1.0 + gap, components=held, push=push)
    steps = computed(text, method)
    off = [(step.contacts[0].force_slave + step.loads[0].force)[:2] / step.contacts[0].force_slave[2] for step in steps]
    return {"balance": float(np.abs(off).max()), "cuts": float(sum(step.cuts for step in steps))}


@case(
    claim="A bowl that its weight lays on a floor rests there, straight or to a side, whether one control point is the lowest or several.",
    tier="gate",
    grid={"elements": (3, 4, 5), "method": ("monolithic", "uzawa")},
    bounds={"balance": Bound(at_most=1e-8, reason="definition: contact bears the weight, to the tolerance of balance")},
)
def bowl(elements: int, method: str) -> dict[str, float]:
    """Largest difference of contact and weight over the weight, of weights to all sides."""
    off = list[np.ndarray]()
    for aside in _ASIDE:
        weight = 0.03 * np.array([*aside, -1.0])
        load = f'loads.own = {{ body = "bowl", weight = {weight.tolist()} }}\nbodies.bowl.mesh.elements = [{elements}, {elements}, 2]\n'
        (step,) = computed(_BOWL + load, method)
        off.append(np.abs(step.contacts[0].force_slave + step.loads[0].force) / np.abs(step.loads[0].force[2]))
    return {"balance": float(np.max(off))}


@case(
    claim="A ring that its weight lays on a floor rests there on how few elements there may be.",
    tier="gate",
    grid={"elements": (4, 8)},
    bounds={"balance": Bound(at_most=1e-8, reason="definition: contact bears the weight, to the tolerance of balance")},
)
def ring(elements: int) -> dict[str, float]:
    """Relative difference of contact and weight."""
    (step,) = computed(_RING + f"bodies.ring.mesh.elements = [{elements}, 1, 1]\n", "monolithic")
    return {"balance": float(abs(step.contacts[0].force_slave[2] / step.loads[0].force[2] + 1.0))}


@case(
    claim="A body that nothing holds but what presses it together needs no load for that: it bears what it does with a weight of next to "
    "nothing.",
    tier="gate",
    grid={"body": tuple(_BETWEEN), "method": ("monolithic", "uzawa")},
    bounds={"forces": Bound(at_most=1e-6, reason="theory: in proportion to the weight, 1e-8 of them")} | CUTS,
)
def without_load(body: str, method: str) -> dict[str, float]:
    """Largest difference of the forces of contacts over the largest of them; cuts of load increments."""
    text = _BETWEEN[body]
    alone, laid = computed(text, method), computed(f'{text}loads.own = {{ body = "loose", weight = [0, 0, -1e-9] }}\n', method)
    one, other = (np.array([[contact.force_slave[2] for contact in step.contacts] for step in steps]) for steps in (alone, laid))
    return {"forces": float(np.abs(one - other).max() / np.abs(other).max()), "cuts": float(sum(step.cuts for step in alone))}


@functools.cache
def between_plates(rollers: int, method: str) -> tuple[FloatArray, float]:
    """Forces at the end below and above each of some rollers, shape (rollers, 2), and cuts of load increments."""
    text = "".join(_BETWEEN_PLATES.replace("NAME", f"r{k}").replace("AT", str(x)) for k, x in enumerate(_PLACES[rollers]))
    steps = computed(_PLATES + text, method)
    forces = np.array([contact.force_slave[2] for contact in steps[-1].contacts]).reshape(-1, 2)
    return forces, float(sum(step.cuts for step in steps))


@case(
    claim="Rollers side by side between two bodies, which they touch and which alone hold them, begin in contact and stay between.",
    tier=lambda rollers, method: "nightly" if (rollers, method) == (3, "uzawa") else "gate",
    grid={"rollers": tuple(_PLACES), "method": ("monolithic", "uzawa")},
    bounds={
        "between": Bound(at_most=1e-6, reason="definition: each bears below what it bears above, to the tolerance of balance"),
        "sides": Bound(at_most=1e-6, reason="definition: the scene is its own mirror image, to the tolerance of balance"),
        "neighbours": Bound(at_most=0.05, reason="discretisation: thick plates carry little of what one roller does to the others"),
    }
    | CUTS,
)
def side_by_side(rollers: int, method: str) -> dict[str, float]:
    """Differences of forces above and below, of both sides, and to a single roller, over the mean; cuts of load increments."""
    (forces, cuts), (alone, _) = between_plates(rollers, method), between_plates(1, method)
    left = {
        "between": forces.sum(axis=1),
        "sides": forces - forces[::-1],
        "neighbours": forces - alone,
    }
    mean = float(np.abs(forces).mean())
    return {name: float(np.abs(values).max() / mean) for name, values in left.items()} | {"cuts": cuts}


@case(
    claim="Rollers that supports hold first, and let go, begin between two bodies in the stage in which these alone hold them.",
    tier="gate",
    bounds={"between": Bound(at_most=1e-6, reason="definition: each bears below what it bears above, to the tolerance of balance")} | CUTS,
)
def let_go() -> dict[str, float]:
    """Differences of forces above and below, over the mean; cuts of load increments."""
    held = 'supports.NAME = { face = "NAME.w0", stages = ["hold"] }\n'
    rollers = ((_BETWEEN_PLATES + held).replace("NAME", f"r{k}").replace("AT", str(x)) for k, x in enumerate(_PLACES[2]))
    plates = _PLATES.replace("stages = [", 'stages = [{ name = "hold", steps = 1 }, ')
    plates = plates.replace("supports = { top.face", "supports.top.face").replace(
        ', base.face = "floor.w0" }', '\nsupports.base.face = "floor.w0"'
    )
    steps = computed(plates + "".join(rollers), "monolithic")
    forces = np.array([contact.force_slave[2] for contact in steps[-1].contacts]).reshape(-1, 2)
    return {"between": float(np.abs(forces.sum(axis=1)).max() / np.abs(forces).mean()), "cuts": float(sum(step.cuts for step in steps))}


#: A block that its base leaves free along x, and a wall beside it; a tool may hold it by friction.
_BESIDE = """
format = 1
bodies.loose = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh.elements = 2 }
bodies.wall = { geometry = { kind = "box", lower = [FAR, -0.2, -0.2], upper = [9, 1.2, 1.2] }, mesh.elements = [1, 2, 2] }
contacts.side = { slave = "loose.u1", master = "wall.u0" }
supports.floor = { face = "loose.w0", components = ["y", "z"] }
supports.wall = { face = "wall.u1" }
"""
_TOOL = """
bodies.tool = { geometry = { kind = "box", lower = [-0.2, -0.2, 0.995], upper = [1.4, 1.2, 1.3] }, mesh.elements = [2, 2, 1] }
contacts.top = { slave = "loose.w1", master = "tool.w0", friction = 0.3 }
supports.tool = { face = "tool.w1" }
stages = [{ name = "press", steps = 2, motions.tool.translate = [0, 0, -0.05] }]
"""
_AWAY = "stages = [{ name = 'away', steps = 1, motions.wall.translate = [0.05, 0, 0] }]"


@case(
    claim="Without loads nothing draws a body to what it may go away from: a wall that is never reached changes no iteration, and a body "
    "that could go from it is told to be free.",
    tier="gate",
    grid={"method": ("monolithic", "uzawa")},
    bounds={
        "solves": Bound(0.0, 0.0, "definition: solves more or less than with the wall far away"),
        "silent": Bound(0.0, 0.0, "definition: walls beside which a body that is free runs to its end"),
    },
)
def nothing_draws(method: str) -> dict[str, float]:
    """Of walls at two distances each."""
    solves = [sum(step.counters["solves"] for step in computed(_BESIDE.replace("FAR", far) + _TOOL, method)) for far in ("1.1", "1.5", "6")]
    silent = 0
    for far in ("1.05", "1.5"):
        try:
            computed(_BESIDE.replace("FAR", far) + _AWAY, method)
        except ConvergenceError as error:
            silent += "can move along (1, 0, 0) freely" not in str(error)
        else:
            silent += 1
    return {"solves": float(np.ptp(solves)), "silent": float(silent)}
