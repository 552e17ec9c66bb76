"""What is said of a load step that is given up while nothing else is told of it: which other way of contact mostly comes to its end."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
from told.wrong.causes import said, scene
from told.wrong.singular import error

from isomortar.errors import ConvergenceError, SingularSystemError
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.told.after.other_ways import other_ways as other_ways_of

#: A bowl that is pressed into a block, by dual functions of high order, which lose the digits that are asked for.
DUAL = """
format = 1
bodies.up.geometry = { kind = "bowl", half_width = 0.5, bottom = 0, rise = 0.06, top = 0.5 }
bodies.up.mesh = { order = [5, 5, 2], elements = [4, 4, 1] }
bodies.low.geometry = { kind = "box", lower = [-1, -1, -0.5], upper = [1, 1, 0] }
bodies.low.mesh.elements = [4, 4, 1]
contacts.c = { slave = "up.w0", master = "low.w1", enforcement = "dual" }
supports = { base.face = "low.w0", top.face = "up.w1" }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.06] }]
solver.max_cuts = 0
"""
#: A coarse soft tyre that rolls on a road of high friction.
TYRE = """
format = 1
materials = { rubber = { young = 14, poisson = 0.49 }, road = { young = 650, law = "neo-hookean-j" } }
bodies.tyre.geometry = { kind = "ring", outer = 0.594, inner = 0.2375, width = 0.4, centre = [0, 0, 0.594] }
bodies.tyre.mesh = { family = "L", elements = [4, 2, 2] }
bodies.tyre.material = "rubber"
bodies.road.geometry = { kind = "box", lower = [-0.8, -0.5, -0.4], upper = [1, 0.5, 0] }
bodies.road.mesh = { order = [2, 4, 2], elements = [1, 2, 1] }
bodies.road.material = "road"
contacts.c = { slave = "tyre.v1", master = "road.w1", friction = 1 }
supports.bed.face = "road.w0"
supports.rim = { face = "tyre.v0", centre = [0, 0, 0.594], axis = [0, 1, 0] }
[[stages]]
name = "press"
steps = 1
motions.rim.translate = [0, 0, -0.047]
[[stages]]
name = "roll"
steps = 8
motions.rim = { translate = [0.1685, 0, 0], rotate = 32.52 }
[solver]
max_cuts = 1
"""
#: Two beams of Lagrange elements out of one wall, one on the other without friction, pressed down at the end: the upper one is the coarser.
BEAMS = """
format = 1
materials.m = { young = 1000, poisson = 0, law = "linear-elastic" }
bodies.a.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 0.1, 0.05] }
bodies.a.mesh = { family = "L", order = 2, elements = [14, 1, 1] }
bodies.b.geometry = { kind = "box", lower = [0, 0, -0.05], upper = [1, 0.1, 0] }
bodies.b.mesh = { family = "L", order = 2, elements = [20, 1, 1] }
contacts.c = { slave = "a.w0", master = "b.w1", friction = 0 }
supports = { a.face = "a.u0", b.face = "b.u0", tip = { edge = "a.u1.w1", components = ["z"] } }
stages = [{ name = "press", steps = 2, motions.tip.translate = [0, 0, -0.02] }]
solver.max_cuts = 0
"""
SCENES = {"averages": DUAL, "smooth friction": TYRE, "smooth pressures": BEAMS}
TOLD = re.compile(r"take (contacts\.c\.\w+ = \S+?),?( by which|$)")


def pressed(**changes: float) -> Simulation:
    """A scene whose contact bears."""
    simulation = scene(**changes)
    (contact,) = simulation.state.contacts
    simulation.state = replace(simulation.state, contacts=(replace(contact, pressure=np.ones_like(contact.pressure)),))
    return simulation


@case(
    claim="A load step that is given up while nothing else is told of it comes to its end by what is advised: averages in place of other "
    "constraints, else friction or pressures that are smooth.",
    tier="gate",
    grid={"way": tuple(SCENES)},
    bounds={
        "silent": Bound(0.0, 0.0, "definition: whether nothing is advised"),
        "given up": Bound(0.0, 0.0, "definition: whether it is given up as advised, too"),
    },
)
def other_ways(way: str) -> dict[str, float]:
    """By what is said of the scene."""
    found = TOLD.search(error(SCENES[way]))
    change = found[1].replace(" = ", "=") if found else ""
    return {"silent": float(not found), "given up": float(bool(error(SCENES[way], *filter(None, [change]))))}


@case(
    claim="Other ways are advised where iterations end and nothing else is told: not beside what is, nor where a tangent is singular, "
    "something is advised already, or contact is open, or smooth.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: advice that is given, or is not")},
)
def no_other_way() -> dict[str, float]:
    """Of seven."""
    stopped = ConvergenceError("Newton's method stopped at 1")
    others = [
        said(scene(), stopped),
        said(pressed(SLIP=0.1), stopped),
        said(pressed(HARD=1e12), stopped),
        said(pressed(), SingularSystemError("")),
        said(pressed(), ConvergenceError("Newton's method stopped at 1, which is next to round-off: take 2")),
        said(pressed(), ConvergenceError("support 'top' turns by 40 degrees")),
    ]
    wrong = [any("elastic_slip = " in sentence for sentence in sentences) for sentences in others]
    return {"wrong": float(sum(wrong) + (len(said(pressed(), stopped)) != 1))}


@case(
    claim="Other ways are advised for contacts that bear: constraints of one that is open are not what ends a load step.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: advice on the contact that is open, or none on the one that bears")},
)
def of_what_bears() -> dict[str, float]:
    """Of two contacts, the open one by other constraints, and with both of them open."""
    simulation = pressed()
    problem, state = simulation.problem, simulation.state
    (contact,), (bears,) = problem.contacts, state.contacts
    both = replace(problem, contacts=(contact, replace(contact, name="other", enforcement="dual")))
    is_open = replace(bears, pressure=np.zeros_like(bears.pressure))
    one, none = (list(other_ways_of(both, replace(state, contacts=(first, is_open)), ConvergenceError(""))) for first in (bears, is_open))
    wrong = (len(one), len(none)) != (1, 1) or "elastic_slip" not in one[0] or "'other'" not in none[0]
    return {"wrong": float(wrong)}
