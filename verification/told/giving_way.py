"""What is said of narrow contact with bodies that bend: theirs is most of what gives way, and forces are as beams and rings have them."""

from __future__ import annotations

import re

import numpy as np
from told.long_masters import CYLINDER
from told.narrow import STRIP
from told.runs import Heard

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: What all beams and rings are of: of no Poisson's ratio, so that they are slices of plates.
SCENE = """
format = 1
materials.m = { young = 1000, poisson = 0, law = "linear-elastic" }
"""
#: Half of a thin ring between a floor and a rigid plate.
RING = """
bodies.ring.geometry = { kind = "ring", inner = 0.98, outer = 1.02, width = 0.1, centre = [0, 0, 1.02], angles = [0, 180] }
bodies.ring.mesh = { order = [3, 2, 2], elements = [32, 1, 1] }
bodies.plate = { rigid = true, geometry = { kind = "box", lower = [-0.5, -0.2, 2.04], upper = [0.5, 0.2, 2.24] } }
contacts.floor = { slave = "ring.v1", plane = {}, friction = 0 }
contacts.top = { slave = "ring.v1", master = "plate.w0", friction = 0 }
supports.low = { face = "ring.u0", components = ["x"] }
supports.high = { face = "ring.u1", components = ["x"] }
supports.side = { face = "ring.w0", components = ["y"] }
supports.plate.face = "plate.w1"
stages = [{ name = "press", steps = 2, motions.plate.translate = [0, 0, -0.02] }]
"""
#: Two beams out of one wall, one on the other without friction, pressed down at the end.
STACK = """
bodies.a = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 0.1, 0.05] }, mesh = { order = [3, 2, 2], elements = [10, 1, 1] } }
bodies.b = { geometry = { kind = "box", lower = [0, 0, -0.05], upper = [1, 0.1, 0] }, mesh = { order = [3, 2, 2], elements = [7, 1, 1] } }
contacts.c = { slave = "a.w0", master = "b.w1", friction = 0 }
supports.a.face = "a.u0"
supports.b.face = "b.u0"
supports.tip = { edge = "a.u1.w1", components = ["z"] }
stages = [{ name = "press", steps = 2, motions.tip.translate = [0, 0, -0.02] }]
"""
#: A beam out of a wall under a load, whose end comes down on a narrow block.
STOP = """
bodies.a = { geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 0.1, 0.1] }, mesh = { order = [3, 2, 2], elements = [12, 1, 1] } }
bodies.b = { rigid = true, geometry = { kind = "box", lower = [1.98, -0.1, -0.2], upper = [2.02, 0.2, -0.02] } }
contacts.c = { slave = "a.w0", master = "b.w1", friction = 0 }
supports.b.face = "b.w0"
supports.a.face = "a.u0"
loads.down = { face = "a.w1", traction = [0, 0, -0.02] }
stages = [{ name = "load", steps = 3 }]
"""
#: Width of all of them, and the bending stiffness of a slice over the cube of its thickness.
WIDTH, STIFFNESS = 0.1, 1000.0 / 12.0
ON_STOP = 3.0 * 0.02 * 2.0 / 8.0 - 3.0 * STIFFNESS * 0.1**3 * 0.02 / 2.0**3
#: What bends: scene, and the force of its last contact over the width by the theory of beams.
BENDING = {
    "ring between plates": (RING, 0.5 * 0.02 * STIFFNESS * 0.04**3 * 4.0 * np.pi / (np.pi**2 - 8.0)),
    "beam on a stop": (STOP, ON_STOP),
    "beam on a beam": (STACK, 0.02 * 3.0 * STIFFNESS * 0.05**3),
}
NARROW = re.compile("it is too narrow for its slave|elements of its slave .* are too long for its master")
#: A part of a cylinder on a block, which turn together before it is pressed in.
TURNED = CYLINDER.replace("stages = [{", "stages = [TURN{").replace("[0, 0, -0.05]", "WAY")
TURNED += "supports.foot.axis = [0, 1, 0]\nsupports.hand.axis = [0, 1, 0]\n"
TURN = '{ name = "turn", steps = 3, motions = { foot.rotate = 90, hand.rotate = 90 } }, '
#: A cylinder on a strip of no Poisson's ratio, whose sides are moved in before it is pressed in.
SQUEEZED = STRIP.replace("AT", "0").replace("poisson = 0.3", "poisson = 0").replace("elements = 8 }", "elements = [8, 1, 8] }")
SQUEEZED = SQUEEZED.replace("stages = [", "stages = [SQUEEZE")
SQUEEZED += """
supports.base.components = ["z"]
supports.left = { face = "a.u0", components = ["x"] }
supports.right = { face = "a.u1", components = ["x"] }
"""
SQUEEZE = '{ name = "squeeze", steps = 2, motions = { left.translate = [WAY, 0, 0], right.translate = [-WAY, 0, 0] } }, '
LONG = re.compile(r"elements of its master block.w1 are too long for it, .* too large by about (\d+) %")


def run(text: str) -> tuple[list[str], float]:
    """What is said in a run, and the force of its last contact at the end."""
    heard = Heard()
    *_, last = Simulation(Scene.from_toml(text).problem(), heard).run()
    return heard.said, float(np.linalg.norm(last.contacts[-1].force_slave))


@case(
    claim="Of narrow contact with beams and rings that bend nothing is said where forces are as the theory of beams has them.",
    tier="gate",
    grid={"scene": tuple(BENDING)},
    bounds={
        "off": Bound(at_most=0.04, reason="theory: of beams, without shear; what bears at an end does so within it, by part of an element"),
        "said": Bound(0.0, 0.0, "definition: sentences of contact that is too narrow, or beyond edges"),
    },
)
def bodies_that_bend(scene: str) -> dict[str, float]:
    """By what share the force is off, and how many sentences there are."""
    text, true = BENDING[scene]
    said, force = run(SCENE + text)
    return {"off": abs(force / (WIDTH * true) - 1.0), "said": float(sum(NARROW.search(words) is not None for words in said))}


@case(
    claim="Elements of a master that are too long are told as well where bodies have turned far before: a turn is nothing that gives way.",
    tier="gate",
    bounds={
        "turned": Bound(at_most=0.11, reason="definition: what is told beside what is told without a turn, one digit of two; 1 is nothing"),
    },
)
def after_a_turn() -> dict[str, float]:
    """How far what is told is off."""
    text = TURNED.replace("ORDER", "2").replace("MANY", "3").replace("YOUNG", "100")
    still, turned = (
        [float(found[1]) for words in run(text.replace("TURN", turn).replace("WAY", way))[0] if (found := LONG.search(words))]
        for turn, way in (("", "[0, 0, -0.05]"), (TURN, "[-0.05, 0, 0]"))
    )
    return {"turned": abs(turned[0] / still[0] - 1.0) if turned and still else 1.0}


@case(
    claim="Narrow contact is told as well on a block that was squeezed along its face before: that is no bending.",
    tier="gate",
    grid={"way": (0.0, 0.2)},
    bounds={"said": Bound(1.0, 1.0, "definition: sentences of a contact that is too narrow")},
)
def squeezed_before(way: float) -> dict[str, float]:
    """How many."""
    said, _ = run(SQUEEZED.replace("SQUEEZE", SQUEEZE if way else "").replace("WAY", str(way)))
    return {"said": float(sum(NARROW.search(words) is not None for words in said))}
