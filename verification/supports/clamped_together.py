"""Control points that supports hold at edges that they hold, too: two beams out of one wall, and what is near to that and is not."""

from __future__ import annotations

from functools import cache

import numpy as np
from transforms import turned

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: The upper one is loaded; orders, and elements along them, are filled in.
SCENE = """
format = 1
bodies.upper.geometry = { kind = "box", lower = [0, -0.2, 0], upper = [1, 0.2, 0.2] }
bodies.upper.mesh = { order = [ORDER, 2, 2], elements = [UPPER, 1, 1] }
bodies.lower.geometry = { kind = "box", lower = [0, -0.2, -0.2], upper = [1, 0.2, 0] }
bodies.lower.mesh = { order = [ORDER, 2, 2], elements = [LOWER, 1, 1] }
contacts.c = { slave = "lower.w1", master = "upper.w0", enforcement = "KIND", friction = 0 }
supports = { above.face = "upper.u0", below.face = "lower.u0" }
loads.top = { face = "upper.w1", pressure = 0.01 }
stages = [{ name = "load", steps = 1 }]
"""
LOAD = 0.004
#: Orders, and elements of the upper and the lower one.
MESHES = {"order 2": (2, 4, 4), "order 2, finer below": (2, 3, 6), "order 3": (3, 4, 4), "order 3, finer above": (3, 6, 4)}
#: What the scene is turned by: nothing is along an axis then.
TURN = np.array([[2.0, -2.0, 1.0], [1.0, 2.0, 2.0], [-2.0, -1.0, 2.0]]) / 3.0


KINDS = ("mortar", "dual", "knots", "greville")


def borne(kind: str, mesh: tuple[int, int, int], is_turned: bool) -> float:
    """What share of the load the lower beam's support bears."""
    text = SCENE
    for word, value in zip(("KIND", "ORDER", "UPPER", "LOWER"), (kind, *mesh), strict=True):
        text = text.replace(word, str(value))
    problem = Scene.from_toml(text).problem()
    *_, last = Simulation(turned(problem, TURN) if is_turned else problem).run()
    up = TURN[:, 2] if is_turned else np.array([0.0, 0.0, 1.0])
    return float(last.reactions[1].force @ up) / LOAD


@cache
def true() -> float:
    """The same of fine meshes."""
    return borne("mortar", (3, 14, 11), False)


@case(
    claim="Beams that one wall holds, one on the other, share a load as fine ones do, by every kind of constraint, wherever they point: "
    "constraints of control points that supports hold beside what they hold of the master bear nothing.",
    tier="gate",
    grid={"kind": KINDS, "mesh": tuple(MESHES)},
    bounds={
        "off": Bound(at_most=0.1, reason="discretisation: of coarse beams, as a share of the load; by dual functions it was 0.6 to 14"),
        "turned": Bound(at_most=1e-4, reason="round-off: of the same scene elsewhere; averages and dual functions had no tangent there"),
    },
)
def clamped_together(kind: str, mesh: str) -> dict[str, float]:
    """What the lower one bears, apart from that, and from what it bears turned."""
    share, elsewhere = (borne(kind, MESHES[mesh], is_turned) for is_turned in (False, True))
    return {"off": abs(share - true()), "turned": abs(elsewhere - share)}


#: A block that its end face drags off the clamped end of what it lies on, or that stands there from the start, and is pressed.
DRAGGED = """
format = 1
bodies.block.geometry = { kind = "box", lower = [AT, -0.2, 0], upper = [ATEND, 0.2, 0.2] }
bodies.block.mesh.elements = [4, 2, 1]
bodies.base.geometry = { kind = "box", lower = [0, -0.2, -0.3], upper = [1, 0.2, 0] }
bodies.base.mesh.elements = [6, 2, 2]
contacts.c = { slave = "block.w0", master = "base.w1", enforcement = "KIND", subcells = 0 } # these are cut where it stands
supports = { drag.face = "block.u0", clamp.face = "base.u0", bed.face = "base.w0" }
stages = [
    { name = "slide", steps = 1, motions.drag.translate = [WAY, 0, 0] }, # it touches without a force: in shorter ones round-off decides
    { name = "press", steps = 2, motions.drag.translate = [0, 0, -0.01] },
]
"""
#: A plate clamped at its rim, and a flange within that circle whose own face presses it.
FLANGE = """
format = 1
bodies.plate.geometry = { kind = "ring", inner = 0.1, outer = 1.0, width = 0.2, axis = "z", centre = [0, 0, -0.1] }
bodies.plate.mesh.elements = [8, 8, 1]
bodies.flange.geometry = { kind = "ring", inner = 0.2, outer = 0.6, width = 0.2, axis = "z", centre = [0, 0, 0.1] }
bodies.flange.mesh.elements = [8, 5, 1]
contacts.c = { slave = "SLAVE", master = "MASTER" }
supports = { rim.face = "plate.v1", shaft.face = "flange.w1" }
stages = [{ name = "press", steps = 2, motions.shaft.translate = [0, 0, -0.02] }]
"""


def force(text: str, **words: str) -> float:
    """What a contact bears along z in the end."""
    for word, value in words.items():
        text = text.replace(word, value)
    *_, last = Simulation(Scene.from_toml(text).problem()).run()
    return float(last.contacts[0].force_slave[2])


@case(
    claim="A row that supports move off a held edge bears as if it had never been there.",
    tier="gate",
    grid={"kind": KINDS},
    bounds={"off": Bound(at_most=1e-6, reason="theory: without friction the way there has no part; to the tolerance of balance")},
)
def off_the_edge(kind: str) -> dict[str, float]:
    """Relative difference of the forces."""
    dragged = force(DRAGGED, KIND=kind, ATEND="0.5", AT="0", WAY="0.3")
    return {"off": abs(dragged / force(DRAGGED, KIND=kind, ATEND="0.8", AT="0.3", WAY="0") - 1.0)}


@case(
    claim="A face that a support holds presses what is clamped round it, in that edge's plane: the force is that of the exchanged pair.",
    tier="gate",
    bounds={"off": Bound(at_most=0.1, reason="discretisation: of coarse faces, of which one or the other is the slave")},
)
def within_an_edge() -> dict[str, float]:
    """Relative difference of the forces."""
    one, other = force(FLANGE, SLAVE="flange.w1", MASTER="plate.w0"), force(FLANGE, SLAVE="plate.w0", MASTER="flange.w1")
    return {"off": abs(one / -other - 1.0)}
