"""What is said of masters, and of slaves, whose elements are too long for what is pressed in, against forces of finer ones."""

from __future__ import annotations

import re

from told.runs import Heard

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A cap that is pressed into a block by a twentieth of its radius.
CAP = """
format = 1
materials = { soft = { young = 10, poisson = 0.3 }, other = { young = YOUNG, poisson = 0.3 } }
bodies.cap.material = "other"
bodies.cap.mesh = { order = 2, elements = [8, 8, 2] }
bodies.cap.geometry = { kind = "cap", radius = 1, half_width = 0.4, bottom = 1, top = 1.6 }
bodies.block.material = "soft"
bodies.block.geometry = { kind = "box", lower = [-1, -1, 0], upper = [1, 1, 1] }
bodies.block.mesh = { order = ORDER, elements = [MANY, MANY, 4] }
contacts.c = { slave = "cap.w0", master = "block.w1", friction = 0, projection = "closest" }
supports = { foot.face = "block.w0", hand.face = "cap.w1" }
stages = [{ name = "press", steps = 1, motions.hand.translate = [0, 0, -0.05] }]
"""
#: A part of a cylinder, and a strip of a block.
CYLINDER = """
format = 1
materials = { soft = { young = 10, poisson = 0.3 }, other = { young = YOUNG, poisson = 0.3 } }
bodies.cap.material = "other"
bodies.cap.mesh = { order = 2, elements = [8, 2, 1] }
bodies.cap.geometry = { kind = "ring", inner = 0.4, outer = 1, width = 0.4, centre = [0, 0.2, 2], angles = [150, 210] }
bodies.block.material = "soft"
bodies.block.geometry = { kind = "box", lower = [-1, 0, 0], upper = [1, 0.4, 1] }
bodies.block.mesh = { order = ORDER, elements = [MANY, 2, 4] }
contacts.c = { slave = "cap.v1", master = "block.w1", friction = 0, projection = "closest" }
supports.foot.face = "block.w0"
supports.hand.face = "cap.v0"
supports.front = { face = "cap.w0", components = ["y"] }
supports.back = { face = "cap.w1", components = ["y"] }
supports.left = { face = "block.v0", components = ["y"] }
supports.right = { face = "block.v1", components = ["y"] }
stages = [{ name = "press", steps = 1, motions.hand.translate = [0, 0, -0.05] }]
"""
SCENES = {"cap": (CAP, "u and v"), "cylinder": (CYLINDER, "u")}
TOLD = re.compile(
    r"contact 'c', load step 1, the last of stage 'press': elements of its (master block.w1|slave cap.w0) are too long for it, and too "
    r"stiff: .* by about (\d+) %, or by little, as knots lie there, and pressures by more. Take twice as many elements or more along "
    r"(u and v|[uvw]) \(bodies.(block|cap)"
)


def pressed(text: str, order: int, many: int, young: int) -> tuple[list[re.Match[str]], float]:
    """What is said of a master of so many elements, under a slave of some modulus, and the force."""
    heard, scene = Heard(), text.replace("ORDER", str(order)).replace("MANY", str(many)).replace("YOUNG", str(young))
    *_, last = Simulation(Scene.from_toml(scene).problem(), heard).run()
    return [found for said in heard.said if (found := TOLD.search(said))], float(last.contacts[0].force_slave[2])


@case(
    claim="A master whose elements are too long for what a finer slave presses in, be that as soft or ten times stiffer, is told, once, "
    "along the directions that are too coarse, and by about as much as the force is too large; of one that is fine nothing is said.",
    tier="gate",
    grid={"scene": tuple(SCENES), "order": (2, 3), "young": (10, 100)},
    bounds={
        "said": Bound(1.0, 1.0, "definition: sentences of three elements"),
        "off": Bound(at_least=0.1, reason="definition: share by which the force of these is too large, or there is nothing to tell of"),
        "told over off": Bound(at_most=2.5, at_least=0.4, reason="definition: an estimate, of which the order of magnitude counts"),
        "fine": Bound(0.0, 0.0, "definition: sentences of twelve elements"),
    },
)
def long_masters(scene: str, order: int, young: int) -> dict[str, float]:
    """What is said of a coarse master and of a fine one."""
    text, along = SCENES[scene]
    said, force = pressed(text, order, 3, young)
    fine, true = pressed(text, order, 12, young)
    off = force / true - 1.0
    return {
        "said": float([found.group(1, 3) for found in said] == [("master block.w1", along)]),
        "off": off,
        "told over off": 0.01 * float(said[0][2]) / off if said else 0.0,
        "fine": float(len(fine)),
    }


#: A bowl on a block whose elements are about as long, by their numbers: knots of four lie under the middle of it, of five they do not.
BOWL = """
format = 1
materials.soft = { young = 10, poisson = 0.3 }
bodies.cap.geometry = { kind = "bowl", centre = [0.05, 0.02], half_width = 0.375, bottom = 0, rise = 0.12, top = 0.5 }
bodies.cap.mesh = { order = [2, 2, 1], elements = [10, 10, 3] }
bodies.block.geometry = { kind = "box", lower = [-0.6, -0.6, -0.5], upper = [0.7, 0.65, 0] }
bodies.block.mesh = { order = ORDER, elements = [MANY, MANY, 2] }
contacts.c = { slave = "cap.w0", master = "block.w1", friction = 0, projection = "closest" }
supports = { foot.face = "block.w0", hand.face = "cap.w1" }
stages = [{ name = "press", steps = 1, motions.hand.translate = [0, 0, -0.04] }]
"""


@case(
    claim="A master whose knots lie so that its elements keep back far more than their lengths tell is told; of one with more elements, "
    "that lie well, nothing is said.",
    tier="gate",
    bounds={
        "said": Bound(1.0, 1.0, "definition: sentences of four elements"),
        "off": Bound(at_least=0.1, reason="definition: share by which the force of these is too large, or there is nothing to tell of"),
        "well": Bound(0.0, 0.0, "definition: sentences of nine elements"),
    },
)
def by_knots() -> dict[str, float]:
    """What is said of both."""
    said, force = pressed(BOWL, 2, 4, 10)
    well, true = pressed(BOWL, 2, 9, 10)
    return {"said": float(len(said)), "off": force / true - 1.0, "well": float(len(well))}


@case(
    claim="A slave that bears contact by two rows of its points alike, between which that lies, on a softer block is told, along both "
    "directions, and by about as much as the force is too large; of a finer one nothing is said.",
    tier="gate",
    grid={"order": (2, 3)},
    bounds={
        "said": Bound(1.0, 1.0, "definition: sentences of six elements of order 2, or seven of order 3"),
        "off": Bound(at_least=0.1, reason="definition: share by which the force of these is too large, or there is nothing to tell of"),
        "told over off": Bound(at_most=2.0, at_least=0.5, reason="definition: an estimate, of which the order of magnitude counts"),
        "fine": Bound(0.0, 0.0, "definition: sentences of twelve elements"),
    },
)
def between_rows(order: int) -> dict[str, float]:
    """What is said of a slave that has rows on both sides of contact, on a block of as many elements, and of a fine one."""
    scene = BOWL.replace("-0.04", "-0.05").replace("rise = 0.12", "rise = 0.2").replace("[2, 2, 1]", f"[{order}, {order}, 2]")
    softer = 'materials.softer = { young = 3, poisson = 0.3 }\nbodies.block.material = "softer"\nbodies.cap.material = "soft"\n'
    scene = scene.replace("bodies.cap.geometry", f"{softer}bodies.cap.geometry")
    many = 4 + order
    said, force = pressed(scene.replace("10, 10", f"{many}, {many}"), 2, many, 10)
    fine, true = pressed(scene.replace("10, 10", "12, 12"), 2, 12, 10)
    off = force / true - 1.0
    return {
        "said": float([found.group(1, 3) for found in said] == [("slave cap.w0", "u and v")]),
        "off": off,
        "told over off": 0.01 * float(said[0][2]) / off if said else 0.0,
        "fine": float(len(fine)),
    }


@case(
    claim="A soft slave of a single element of order 1 across, which is higher than contact is wide, is told, along that; of one of order "
    "2 and two elements nothing is said.",
    tier="gate",
    grid={"many": (4, 8)},
    bounds={
        "said": Bound(1.0, 1.0, "definition: sentences of one element"),
        "off": Bound(at_least=0.1, reason="definition: share by which the force of this is too large, or there is nothing to tell of"),
        "told over off": Bound(at_most=2.5, at_least=0.4, reason="definition: an estimate, of which the order of magnitude counts"),
        "fine": Bound(0.0, 0.0, "definition: sentences of two elements of order 2"),
    },
)
def tall_slaves(many: int) -> dict[str, float]:
    """What is said of a slave of one element across and of a better one."""
    soft = CAP.replace("YOUNG", "0.1").replace("order = ORDER", "order = 2").replace("MANY, MANY", "8, 8")
    said, force = pressed(soft.replace("order = 2, elements = [8, 8, 2]", f"order = [2, 2, 1], elements = [{many}, {many}, 1]"), 2, 8, 10)
    fine, true = pressed(soft, 2, 8, 10)
    off = force / true - 1.0
    return {
        "said": float([found.group(1, 3) for found in said] == [("slave cap.w0", "w")]),
        "off": off,
        "told over off": 0.01 * float(said[0][2]) / off if said else 0.0,
        "fine": float(len(fine)),
    }


@case(
    claim="Of a block on another one that is as wide, and a single element, nothing is said, however soft that is; nor is of a cap whose "
    "own elements are as long.",
    tier="gate",
    grid={"young": (10, 100, 1000)},
    bounds={"said": Bound(0.0, 0.0, "definition: sentences of both")},
)
def as_wide(young: int) -> dict[str, float]:
    """What is said."""
    text = CAP.replace(
        'kind = "cap", radius = 1, half_width = 0.4, bottom = 1, top = 1.6', 'kind = "box", lower = [-1, -1, 1], upper = [1, 1, 2]'
    )
    as_long = CAP.replace("[8, 8, 2]", "[2, 2, 2]")
    return {"said": float(len(pressed(text, 2, 1, young)[0]) + len(pressed(as_long, 2, 6, young)[0]))}


#: A ball that bends a beam; and one on a tube that begins somewhere.
_BEAM = """
format = 1
materials = { soft = { young = 10 }, hard = { young = 100 } }
bodies.ball.material = "hard"
bodies.ball.geometry = { kind = "cap", radius = 2, half_width = 0.08, bottom = 0.2, top = 0.4 }
bodies.ball.mesh = { order = 2, elements = [12, 12, 1] }
bodies.beam.material = "soft"
bodies.beam.geometry = { kind = "box", lower = [-2, -0.3, 0], upper = [2, 0.3, 0.2] }
bodies.beam.mesh = { order = 3, elements = [8, 2, 1] }
contacts.c = { slave = "ball.w0", master = "beam.w1", friction = 0, projection = "closest" }
supports = { hand.face = "ball.w1", left.face = "beam.u0", right.face = "beam.u1" }
stages = [{ name = "press", steps = 2, motions.hand.translate = [0, 0, -0.1] }]
"""
_TUBE = """
format = 1
bodies.ball.geometry = { kind = "cap", radius = 0.6, half_width = 0.3, bottom = 1, top = 1.4 }
bodies.ball.mesh = { order = 2, elements = [8, 8, 2] }
bodies.tube.geometry = { kind = "ring", inner = 0.4, outer = 1, width = 2, axis = "y", angles = [BEGIN, END] }
bodies.tube.mesh = { order = 2, elements = [8, 2, 4] }
contacts.c = { slave = "ball.w0", master = "tube.v1", friction = 0, projection = "closest" }
supports = { hand.face = "ball.w1", hole.face = "tube.v0" }
stages = [{ name = "press", steps = 2, motions.hand.translate = [0, 0, -0.06] }]
"""


def said_of(text: str) -> list[str]:
    """What is said of long elements in a run."""
    heard = Heard()
    list(Simulation(Scene.from_toml(text).problem(), heard).run())
    return [said for said in heard.said if "too long for it" in said]


@case(
    claim="Of a beam that bends nothing is said; of a tube the same, wherever it begins.",
    tier="gate",
    bounds={
        "beam": Bound(0.0, 0.0, "definition: sentences"),
        "tubes": Bound(0.0, 0.0, "definition: tubes of which another sentence is said, or of another direction"),
    },
)
def bent_and_round() -> dict[str, float]:
    """What is said."""
    beginnings = ((-180, 180), (0, 360), (90, 450))
    said = [said_of(_TUBE.replace("BEGIN", str(begin)).replace("END", str(end))) for begin, end in beginnings]
    other = sum(len(words) != 1 or words != said[1] or "more along u (bodies.tube" not in words[0] for words in said)
    return {"beam": float(len(said_of(_BEAM))), "tubes": float(other)}
