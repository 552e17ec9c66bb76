"""What is said of supports that hold a body where something rigid comes to be: it cannot give way there."""

from __future__ import annotations

import re

from told.runs import Heard

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A rigid drum that is pressed on a strip, of which an end is held, beside that end or on its edge.
DRUM = """
format = 1
materials.m = { young = 10, poisson = 0.3 }
bodies.a = { geometry = { kind = "box", lower = [-1, 0, -1], upper = [1, 0.3, 0] }, mesh = { order = 2, elements = [16, 1, 4] } }
bodies.b.geometry = { kind = "ring", inner = 0.2, outer = 0.6, width = 0.5, centre = [AT, 0.15, 0.6], axis = "y" }
bodies.b.mesh = { order = 2, elements = [16, 1, 1] }
bodies.b.rigid = true
contacts.c = { slave = "a.w1", master = "b.v1", friction = 0, projection = "closest" }
supports.base.face = "a.w0"
supports.side.face = "a.u0"
supports.back = { face = "a.v0", components = ["y"] }
supports.front = { face = "a.v1", components = ["y"] }
supports.top.face = "b.v0"
stages = [{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.03] }, { name = "hold", steps = 1 }]
"""
#: On the edge, and beside it: the drum reaches 0.19 beside its middle at this depth.
ON_EDGE, BESIDE = DRUM.replace("AT", "-0.95"), DRUM.replace("AT", "-0.7")
HELD = re.compile(
    r"contact 'c': supports hold (\d+) places of a\.w1 inside the rigid b\.\w\d, by (\S+) at the end of stage '\w+', and those cannot "
    r"give way"
)
Changes = tuple[str, ...]
#: The rigid body as the slave, of which a flat one comes down all over the strip.
FLAT: Changes = (
    'bodies.b.geometry={ kind = "box", lower = [-2, -1, 0], upper = [2, 1, 1] }',
    'contacts.c.slave="b.w0"',
    'contacts.c.master="a.w1"',
    'supports.top.face="b.w1"',
)
#: A third of the way.
LESS = "stages.press.motions.top.translate=[0, 0, -0.01]"
#: Scenes in which an edge that is held, or held across what is rigid alone, is inside that, how many places that are ends and middles of
#: elements, and how deep they are.
INSIDE: dict[str, tuple[str, Changes, int, float]] = {
    "drum": (ON_EDGE, (), 3, 0.6 - (0.05**2 + 0.57**2) ** 0.5),
    "averaged": (ON_EDGE, ('contacts.c.projection="averaged"',), 3, 0.6 - (0.05**2 + 0.57**2) ** 0.5),
    "dual": (ON_EDGE, ('contacts.c.enforcement="dual"', LESS), 3, 0.6 - (0.05**2 + 0.59**2) ** 0.5),
    "rigid slave": (ON_EDGE, (*FLAT, LESS), 3, 0.01),
    "across alone": (ON_EDGE, (*FLAT, LESS, 'supports.side.components=["z"]'), 3, 0.01),
}
#: Scenes in which none is: the drum is beside it, or what is held is along its face, or is one of two components across it, or the drum
#: goes up with what is held.
OUTSIDE: dict[str, tuple[str, Changes]] = {
    "beside": (BESIDE, ()),
    "along": (ON_EDGE, ('supports.side.components=["x", "y"]',)),
    "one of two": (ON_EDGE, ('supports.side.components=["z"]',)),
    "open": (ON_EDGE, ("stages.press.motions.top.translate=[0, 0, 0.03]",)),
    "soft": (BESIDE, ("bodies.b.rigid=false",)),
}


def said(text: str, changes: Changes) -> list[re.Match[str]]:
    """What is said of what is held inside."""
    heard = Heard()
    list(Simulation(Scene.from_toml(text, overrides=changes).problem(), heard).run())
    return [found for words in heard.said if (found := HELD.search(words))]


@case(
    claim="A held edge that something rigid comes down on is told, once, with how deep it is inside; of one that it does not meet, or "
    "that gives way, nothing is.",
    tier="gate",
    grid={"scene": (*INSIDE, *OUTSIDE)},
    bounds={
        "said": Bound(0.0, 0.0, "definition: sentences more or less than one of a held edge inside, none of others"),
        "places": Bound(0.0, 0.0, "definition: places more or less than are held"),
        "depth": Bound(at_most=0.01, reason="definition: of the depth by the places of drum and edge, to three digits"),
    },
)
def held_inside(scene: str) -> dict[str, float]:
    """How far what is said is off."""
    if scene in OUTSIDE:
        return {"said": float(len(said(*OUTSIDE[scene]))), "places": 0.0, "depth": 0.0}
    text, changes, places, depth = INSIDE[scene]
    found = said(text, changes)
    count, told = (int(found[0][1]), float(found[0][2])) if found else (0, 0.0)
    return {"said": abs(len(found) - 1.0), "places": float(abs(count - places)), "depth": abs(told / depth - 1.0)}
