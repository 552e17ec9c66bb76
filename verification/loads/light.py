"""Light forces: what just touches a curved face, or comes back to bearing nothing, is computed as what is pressed hard."""

from __future__ import annotations

import numpy as np
from loads.falling import computed

from isomortar.harness import Bound, case

#: A spherical punch of steel, in mm and N, that a force lays on a block; the finer block is the slave.
_PUNCH = """
format = 1
materials.steel = {{ young = 210000.0, poisson = 0.3 }}
[bodies.block]
geometry = {{ kind = "box", lower = [-5, -5, -5], upper = [5, 5, 0] }}
mesh = {{ order = 2, elements = [8, 8, 1] }}
[bodies.punch]
geometry = {{ kind = "cap", radius = 20.0, half_width = 7.0, bottom = {gap}, top = {top} }}
mesh = {{ order = 2, elements = [4, 4, 1] }}
[contacts.c]
slave = "block.w1"
master = "punch.w0"
friction = {friction}
[supports]
bottom.face = "block.w0"
top = {{ face = "punch.w1", components = ["x", "y"], force.z = {force} }}
[[stages]]
name = "press"
steps = 1
"""
#: A ring in a groove of two planes, at right angles and touched by both, which its weight presses into it.
_GROOVE = """
format = 1
bodies.ring.geometry = { kind = "ring", inner = 0.5, outer = 1.0, width = 0.5, centre = [0, 0, 1.414213562373095] }
bodies.ring.mesh = { order = [2, 2, 1], elements = [16, 1, 1] }
contacts.left = { slave = "ring.v1", friction = 0.1, plane = { point = [0, 0, 0], normal = [1, 0, 1] } }
contacts.right = { slave = "ring.v1", friction = 0.1, plane = { point = [0, 0, 0], normal = [-1, 0, 1] } }
supports.front = { face = "ring.w0", components = ["y"] }
supports.back = { face = "ring.w1", components = ["y"] }
loads.own = { body = "ring", weight = [0, 0, -0.05] }
stages = [{ name = "lay", steps = 1 }]
"""
#: A block on an incline, which has nothing but friction to hold it: weight that pushes it along by 0.36 of what it presses with.
WEIGHT = np.array([0.108, 0.0, -0.3])
_INCLINE = """
format = 1
bodies.block.geometry = {{ kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }}
bodies.block.mesh = {{ order = 2, elements = [2, 2, 2] }}
contacts.c = {{ slave = "block.w0", friction = 0.4, plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }} }}
loads.own = {{ body = "block", weight = {} }}
stages = [{{ name = "lay", steps = 1 }}]
"""
#: A block on a plane that is pressed and comes back to where it began, or is slid without a load; increments are solved in halves, too.
_BACK = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
bodies.block.mesh = { order = 2, elements = [2, 2, 2] }
contacts.c = { slave = "block.w0", friction = 0.3, plane = { point = [0, 0, 0], normal = [0, 0, 1] } }
supports.top.face = "block.w1"
solver.path_tolerance = 0.1
"""
_MOTIONS = {"press and back": ([0, 0, -0.1], [0, 0, 0.1]), "slide": ([0.05, 0, 0], [0.05, 0, 0])}


#: Of cases in which no load increment is cut.
CUTS = {"cuts": Bound(at_most=0.0, reason="definition: what is light is no harder than what is heavy")}


@case(
    claim="A force lays a curved body on its slave in one increment, however light it is, across a gap too, with friction and without.",
    tier="gate",
    grid={"force": (1e3, 1e-2), "gap": (0.0, 0.1), "friction": (0.0, 0.3), "method": ("monolithic", "uzawa")},
    bounds=lambda force, **_: (
        {
            "balance": Bound(
                at_most=1e-8 + 4e-9 / force,
                reason="definition: contact bears the force, to the tolerance of balance; round-off: last bits of 8 mm times 2e6 N/mm",
            )
        }
        | CUTS
    ),
)
def punch(force: float, gap: float, friction: float, method: str) -> dict[str, float]:
    """Relative difference of contact and force, and cuts of the load increment."""
    (step,) = computed(_PUNCH.format(force=-force, gap=gap, top=gap + 8.0, friction=friction), method)
    return {"balance": float(abs(step.contacts[0].force_slave[2] / force + 1.0)), "cuts": float(step.cuts)}


@case(
    claim="A ring that its weight lays into a groove with friction, which it touches on both sides, rests on both.",
    tier="gate",
    grid={"method": ("monolithic", "uzawa")},
    bounds={
        "balance": Bound(at_most=1e-8, reason="definition: the sides bear the weight, to the tolerance of balance"),
        "sides": Bound(at_most=1e-7, reason="definition: the groove is its own mirror image, to the tolerance of balance"),
    }
    | CUTS,
)
def groove(method: str) -> dict[str, float]:
    """Relative differences of what bears and weighs, and of both sides; cuts of the load increment."""
    (step,) = computed(_GROOVE, method)
    left, right = (contact.force_slave for contact in step.contacts)
    weight = float(left[2] + right[2])
    exact = 0.05 * np.pi * (1.0 - 0.25) * 0.5
    return {
        "balance": float(abs(weight / exact - 1.0)),
        "sides": float(max(abs(left[2] - right[2]), abs(left[0] + right[0])) / weight),
        "cuts": float(step.cuts),
    }


@case(
    claim="A block that its weight lays on an incline, and nothing but friction holds, rests there.",
    tier="gate",
    grid={"method": ("monolithic", "uzawa")},
    bounds={"balance": Bound(at_most=1e-8, reason="definition: contact bears the weight, to the tolerance of balance")} | CUTS,
)
def incline(method: str) -> dict[str, float]:
    """Relative difference of contact and weight; cuts of the load increment."""
    (step,) = computed(_INCLINE.format(WEIGHT.tolist()), method)
    return {"balance": float(np.abs(step.contacts[0].force_slave + WEIGHT).max() / 0.3), "cuts": float(step.cuts)}


@case(
    claim="Pressures of round-off have no path error: a block comes back to bearing nothing, or slides without a load, without a cut.",
    tier="gate",
    grid={"motion": tuple(_MOTIONS), "method": ("monolithic", "uzawa")},
    bounds={
        "cuts": Bound(at_most=0.0, reason="definition: nothing is bent but round-off"),
        "left": Bound(at_most=1e-9, reason="round-off: of a force of one at most, at the end"),
    },
)
def nothing_in_halves(motion: str, method: str) -> dict[str, float]:
    """Cuts of load increments, and the force that is left at the end."""
    first, second = (f"motions.top.translate = {way}" for way in _MOTIONS[motion])
    stages = f'stages = [{{ name = "there", steps = 1, {first} }}, {{ name = "back", steps = 1, {second} }}]\n'
    steps = computed(_BACK + stages, method)
    return {"cuts": float(sum(step.cuts for step in steps)), "left": float(np.abs(steps[-1].contacts[0].force_slave).max())}
