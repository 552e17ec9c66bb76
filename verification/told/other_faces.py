"""What is said of bodies in contact that come into each other by faces which have no contact there."""

from __future__ import annotations

import re

from told.runs import Heard

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A wedge whose edge is pressed into a block, or drawn off it, by flanks that are in contact.
WEDGE = """
format = 1
bodies.wedge.geometry = { kind = "wedge", bottom = [0, 0], top = [-0.5, 0.5], y = [0, 1], z = [0, 0.5] }
bodies.wedge.mesh = { order = [2, 1, 2], elements = [4, 1, 4] }
bodies.block.geometry = { kind = "box", lower = [-1, -0.25, -1], upper = [1, 1.25, 0] }
bodies.block.mesh = { order = [2, 1, 2], elements = [8, 1, 4] }
contacts.sides = { slave = SLAVE, master = "block.w1" }
supports = { base.face = "block.w0", top.face = "wedge.w1" }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.1] }]
"""
#: A block that goes into a rigid wall.
WALL = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = 1, elements = [2, 2, 4] } }
bodies.wall = { geometry = { kind = "box", lower = [1.1, -0.5, -0.5], upper = [1.5, 1.5, 1.5] }, rigid = true }
contacts.far = { slave = "block.FACE", master = "wall.u0", friction = 0 }
supports.top.face = "block.w1"
stages = [{ name = "press", steps = 1, motions.top.translate = [WAY, 0, 0] }, { name = "rest", steps = 1 }]
"""
#: A block near the edge of a large plate, whose elements are longer than that is away, both turned.
BESIDE_AN_EDGE = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0.09, 9.5, 0.999], upper = [1.09, 10.5, 1.999] }, mesh = { order = 1, elements = 3 } }
bodies.plate = { rigid = true, geometry = { kind = "box", lower = [0, 0, 0], upper = [20, 20, 1] }, mesh = { elements = [8, 8, 1] } }
contacts.below = { slave = "block.w0", master = "plate.w1", friction = 0 }
supports.base = { face = "plate.w0", axis = [0, 1, 0], centre = [0, 0, 0] }
supports.top = { face = "block.w1", axis = [0, 1, 0], centre = [0, 0, 0] }
stages = [{ name = "turn", steps = 2, motions.top.rotate = -8, motions.base.rotate = -8 }]
"""
TOLD = re.compile(
    r"body '(\w+)' is in body '(\w+)' at the end of stage '(\w+)', by (\S+), and nothing keeps its face (\S+) from it: their contact"
)
FLANK, BOTH = '"wedge.u1"', '["wedge.u0", "wedge.u1"]'
INTO_A_WALL = WALL.replace("FACE", "v0").replace("WAY", "0.2")
#: Scenes, and which body, stage and face are to be told of.
SCENES = {
    "one flank": (WEDGE.replace("SLAVE", FLANK), [("wedge", "block", "press", "wedge.u0")]),
    "both flanks": (WEDGE.replace("SLAVE", BOTH), []),
    "one flank, hardly pressed": (WEDGE.replace("SLAVE", FLANK).replace("-0.1]", "-0.001]"), []),
    "a side that goes into a wall": (INTO_A_WALL, [("block", "wall", "press", "block.u1")]),
    "a side that touches it": (WALL.replace("FACE", "u1").replace("WAY", "0.2"), []),
    "a side that does not reach it": (WALL.replace("FACE", "v0").replace("WAY", "0.05"), []),
    "beside an edge": (BESIDE_AN_EDGE, []),
}


@case(
    claim="Bodies in contact that come into each other by a face without a contact between them are told of at the end of the stage, once, "
    "with that face; others are not, though edges of what is in contact come in by as much as elements do not see.",
    tier="gate",
    bounds={"others": Bound(0.0, 0.0, "definition: scenes of which something else is said")},
)
def other_faces() -> dict[str, float]:
    """How many of seven."""
    wrong = 0
    for text, expected in SCENES.values():
        heard = Heard()
        list(Simulation(Scene.from_toml(text).problem(), heard).run())
        told = [found.groups() for said in heard.said if (found := TOLD.search(said))]
        wrong += [(one, other, stage, face) for one, other, stage, _, face in told] != expected
    return {"others": float(wrong)}
