"""What supports have moved by a load time, and which tractions they take: told by where they put control points."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.model.held import held_by
from isomortar.model.numbering import Numbering
from isomortar.model.pairs import Pair
from isomortar.model.supports import Supports
from isomortar.scene import Scene

#: Supports that turn and go in one of three stages each, about axes along the coordinates and askew, or in none.
WAYS = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = 1, elements = [1, 1, 1] } }
supports.a = { corner = "block.u0.v0.w0", axis = [0, 0, 1], centre = [3, 2, 1] }
supports.b = { corner = "block.u1.v0.w0", axis = [1, 0, 0], centre = [3, 2, 1] }
supports.c = { corner = "block.u0.v1.w0", axis = [1, 1, 0], centre = [3, 2, 1] }
supports.d = { corner = "block.u1.v1.w0" }
supports.e = { corner = "block.u0.v0.w1", components = ["x", "z"] }
supports.f = { corner = "block.u1.v1.w1" }
stages = [
    { name = "one", steps = 2, motions = { a.rotate = 10, d.translate = [0, 0.1, 0], e.translate = [0.1, 0, 0] } },
    { name = "two", steps = 1, motions = { b.rotate = -20, d.translate = [0.1, 0, 0] } },
    { name = "three", steps = 2, motions = { c.rotate = 5, e.translate = [0, 0, 0.1] } },
]
"""
#: Load times within stages and at their ends.
TIMES = (0.5, 1.0, 2.0, 2.5, 3.0, 3.5, 5.0)


@case(
    claim="What supports have moved by a load time are the components in which they have put control points elsewhere by then.",
    tier="gate",
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: components that have been elsewhere, and are not said to have moved, or the other way round"),
        "moved": Bound(at_least=10.0, reason="definition: components that have, at the end"),
    },
)
def has_moved() -> dict[str, float]:
    """Components that differ, at all times; how many have moved."""
    problem = Scene.from_toml(WAYS).problem()
    numbering = Numbering(problem)
    supports = Supports(problem, numbering)
    elsewhere, wrong, before = np.zeros_like(supports.held), 0, 0.0
    for time in TIMES:
        for moment in np.linspace(before, time, 5):
            elsewhere |= np.abs(supports.place(float(moment)) - numbering.reference) > 1e-9
        wrong, before = wrong + int(np.count_nonzero(supports.moved(time) != elsewhere)), time
    return {"wrong": float(wrong), "moved": float(np.count_nonzero(elsewhere))}


#: A slave on a master, both held across y at v0; the slave's other side is held too, the master's is not, but for one corner.
SIDES = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0.2, 0, 0], upper = [0.8, 0.7, 0.5] }, mesh = { order = ORDER, elements = 2 } }
bodies.base = { geometry = { kind = "box", lower = [0, 0, -0.5], upper = [1, 1, 0] }, mesh = { order = ORDER, elements = 3 } }
contacts.c = { slave = "block.w0", master = "base.w1", projection = "PROJECTION", friction = 0.3 }
supports.top = { face = "block.w1" }
supports.front = { face = "block.v0", components = ["y"] }
supports.back = { face = "block.v1", components = ["y"] }
supports.below = { face = "base.w0" }
supports.plane = { face = "base.v0", components = ["y"] }
supports.corner = { corner = "base.u1.v1.w1", components = ["y"] }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.03] }]
"""


@case(
    claim="Supports take the traction across a plane where they hold both sides in it, and none where the slave alone is held.",
    tier="gate",
    grid={"projection": ("closest", "averaged"), "order": (1, 2)},
    bounds={
        "in the plane": Bound(at_most=0.0, reason="definition: all along it, nothing across"),
        "elsewhere": Bound(at_most=0.0, reason="definition: all of it"),
        "counts": Bound(0.0, 0.0, "definition: constraints that are not whole: those of the slave's edge in the plane"),
    },
)
def held_in_a_plane(projection: str, order: int) -> dict[str, float]:
    """Largest differences from what is free of tractions in the plane and elsewhere; constraints that are in it and should not be."""
    problem = Scene.from_toml(SIDES.replace("PROJECTION", projection).replace("ORDER", str(order))).problem()
    numbering = Numbering(problem)
    pair = Pair(problem.contacts[0], problem, numbering)
    free = held_by(Supports(problem, numbering), pair, numbering.reference, 1.0).free
    edge = pair.at_tests(numbering.reference)[:, 1] < 1e-9
    across = int(np.argmin(np.abs(free[edge][0].diagonal())))
    wanted = np.diag([1.0 - (across == 0), 1.0 - (across == 1)])
    limited = np.any(free != np.eye(2), axis=(1, 2))
    return {
        "in the plane": float(np.abs(free[edge] - wanted).max()),
        "elsewhere": float(np.abs(free[~edge] - np.eye(2)).max()),
        "counts": float(np.count_nonzero(limited != edge)),
    }
