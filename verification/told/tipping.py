"""What is said of bodies that loads tip over an edge of what bears them, or lift: no increment converges, and no friction would help."""

from __future__ import annotations

import re
from itertools import product

import numpy as np
from told.too_steep import said

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.told.after.overcome import overcome
from isomortar.told.after.tipping import giving_way
from isomortar.told.after.tipping import tipping as tipping_over

#: A block twice as high as wide: it stands while the middle of its loads is over its base, here as far as its control points carry.
SCENE = """
format = 1
materials.soft.young = YOUNG
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 2] }, mesh.elements = [4, 2, 2] }
GROUND
LOADS
solver = { method = "METHOD", max_cuts = 1, max_iterations = 15 }
stages = [{ name = "stand", steps = 1 }]
"""
TABLE = """
supports.table.face = "table.w0"
bodies.table = { geometry = { kind = "box", lower = [-0.5, -0.5, -0.5], upper = [1.5, 1.5, 0] }, mesh.elements = [8, 4, 1] }
"""
GROUNDS = {
    "plane": 'contacts.floor = { slave = "block.w0", friction = 1, plane = {} }',
    "smooth": 'contacts.floor = { slave = "block.w0", plane = {} }\nsupports.foot = { edge = "block.u1.w0", components = ["x"] }',
    "body": TABLE + 'contacts.floor = { slave = "block.w0", master = "table.w1", friction = 1 }',
    "swapped": TABLE + 'contacts.floor = { slave = "table.w1", master = "block.w0", friction = 1 }',
}
WEIGHT = 'loads.own = { body = "block", weight = [0, 0, -1] }\n'
#: Loads whose middle is LEAN beside that of the base.
LOADS = {
    "weight": 'loads.own = { body = "block", weight = [LEAN, 0, -1] }',
    "pressure": WEIGHT + 'loads.push = { face = "block.u0", pressure = LEAN }',
    "traction": WEIGHT + 'loads.push = { face = "block.w1", traction = [LEAN, 0, 0] }',
    "moment": WEIGHT + 'supports.hand = { face = "block.w1", centre = [0.5, 0.5, 2], axis = [0, 1, 0], FREE, moment = TWICE }',
}
TOLD = re.compile(r"Loads (turn|move) (.*?) (?:about an axis )?along \((.*?)\)(?: through \((.*?)\))? by then, which contact (.*?) could")
FINER = "refine the slave, whose outermost control points bear within its edge"


def of_block(loads: str, ground: str, method: str, lean: float, young: str = "10000") -> str:
    """Why a block does not stand; nothing, if it does."""
    scene = SCENE.replace("LOADS", LOADS[loads]).replace("GROUND", GROUNDS[ground]).replace("METHOD", method)
    return said(
        scene.replace("TWICE", str(2.0 * lean))
        .replace("FREE", "force = { x = 0, y = 0, z = 0 }")
        .replace("LEAN", str(lean))
        .replace("YOUNG", young)
    )


def axis(sentence: str) -> tuple[str, float]:
    """Along what a block is told to turn, and where on its base; nothing, if it is not told."""
    found = TOLD.search(sentence)
    tips = found and found[1] == "turn" and found[2] == "body 'block'" and found[5] == "'floor'"
    return (found[3], float(found[4].split(",")[0])) if found and tips else ("", np.inf)


@case(
    claim="A high block stands while the middle of its loads is over its base, and is told to tip over that edge of it beyond; on all "
    "grounds, whatever pushes, to either side.",
    tier=lambda ground, method: "nightly" if (ground, method) == ("swapped", "uzawa") else "gate",
    grid={"ground": tuple(GROUNDS), "method": ("monolithic", "uzawa")},
    bounds={
        "restless": Bound(0.0, 0.0, "definition: blocks that do not stand though they should"),
        "others": Bound(0.0, 0.0, "definition: blocks of which another axis is told, or none"),
        "off": Bound(at_most=0.125, reason="definition: how far the axis is from the edge; half an element of the slave"),
    },
)
def tips(ground: str, method: str) -> dict[str, float]:
    """How many of two and of four, and how far off at most."""
    rest = [of_block(loads, ground, method, 0.3) for loads in ("weight", "pressure")]
    ways = [*product(LOADS, (0.7,)), *([] if ground == "smooth" else [("weight", -0.7)])]
    found = [(lean, axis(of_block(loads, ground, method, lean))) for loads, lean in ways]
    others = [along != ("0, 1, 0" if lean > 0.0 else "0, -1, 0") for lean, (along, _) in found]
    off = [abs(place - (1.0 if lean > 0.0 else 0.0)) for lean, (_, place) in found]
    return {"restless": float(sum(map(bool, rest))), "others": float(sum(others)), "off": float(np.max(off))}


@case(
    claim="A block that its slave's control points cannot carry though its base could is told so; one of rubber that has sunk in on its "
    "edge is told to tip over before a rigid one would; and a finer slave carries more.",
    tier="gate",
    bounds={
        "finer": Bound(2.0, 2.0, "definition: of a block that a finer slave would bear, and one beyond its edge, those told so"),
        "stands": Bound(1.0, 1.0, "definition: the first, on the same elements where they carry it"),
        "rubber": Bound(2.0, 2.0, "definition: of two methods those by which rubber is told"),
    },
)
def carries() -> dict[str, float]:
    """How many of each."""
    within, beyond = (of_block("weight", "plane", "monolithic", lean) for lean in (0.46, 0.55))
    stands = of_block("weight", "plane", "monolithic", 0.42)
    rubber = [of_block("weight", "plane", method, 0.41, "100") for method in ("monolithic", "uzawa")]
    return {
        "finer": float(sum(axis(s)[0] == "0, 1, 0" and (FINER in s) == finer for s, finer in ((within, True), (beyond, False)))),
        "stands": float(stands == ""),
        "rubber": float(sum(axis(sentence)[0] == "0, 1, 0" for sentence in rubber)),
    }


HEAD = """
format = 1
materials.soft.young = 1e4
solver = { max_cuts = 1, max_iterations = 15 }
stages = [{ name = "stand", steps = 1 }]
"""
LOWER = 'bodies.lower = { geometry = { kind = "box", lower = [0, 0, 0], upper = [3, 1, 1] }, mesh.elements = [6, 2, 1] }\n'
UPPER = 'bodies.upper = { geometry = { kind = "box", lower = [1, 0, 1], upper = [2, 1, 3] }, mesh.elements = [4, 2, 2] }\n'
PILE = LOWER + UPPER + 'contacts.floor = { slave = "lower.w0", friction = 1, plane = {} }\n'
MID = 'contacts.mid = { slave = "upper.w0", master = "lower.w1", friction = 1 }\n'
BOTH = 'loads = { low = { body = "lower", weight = [0, 0, -1] }, high = { body = "upper", weight = [LEAN, 0, -1] } }\n'
LIFTED = """
contacts.floor = { slave = "lower.w0", friction = 1, plane = {} }
loads.low = { body = "lower", weight = [0.3, 0, 1] }
"""
PLANK = """
bodies.plank = { geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 1, 0.3] }, mesh.elements = [8, 2, 1] }
bodies.table = { geometry = { kind = "box", lower = [-1, -0.5, -0.5], upper = [0.8, 1.5, 0] }, mesh.elements = [8, 4, 1] }
supports.table.face = "table.w0"
contacts.edge = { slave = "plank.w0", master = "table.w1", friction = 1 }
loads.own = { body = "plank", weight = [0, 0, -1] }
"""
RING = """
bodies.ring = { geometry = { kind = "ring", inner = 0.6, outer = 1, width = 0.5, centre = [0, 0, 1] } }
contacts.floor = { slave = "ring.v1", friction = 0.3, plane = {} }
loads.own = { body = "ring", weight = [0.5, 0, -1] }
"""
#: A ring under pressure from within between a plane and a plate that presses it flat: no load moves it.
BLOWN = """
format = 1
materials.m = { young = 10, poisson = 0.3 }
bodies.ring = { geometry = { kind = "ring", inner = 0.6, outer = 1, width = 0.5, centre = [0, 0, 1] }, mesh.elements = [16, 2, 1] }
bodies.lid = { rigid = true, geometry = { kind = "box", lower = [-2, -1, 2], upper = [2, 1, 2.5] } }
contacts.floor = { slave = "ring.v1", friction = 0, plane = {} }
contacts.top = { slave = "ring.v1", master = "lid.w0", friction = 0 }
supports.lid.face = "lid.w1"
loads.in = { face = "ring.v0", pressure = 0.05 }
solver = { method = "METHOD", max_cuts = 1 }
stages = [{ name = "press", steps = 2, motions.lid.translate = [0, 0, -1.9] }]
"""
BOX = 'kind = "box", lower = [0, 0, 0], upper = [1, 1.3, 2]'
#: A block between a plane and a plate, under the same pressure from two sides.
SQUEEZED = (
    BLOWN.replace("ring.v1", "ring.w0", 1).replace("ring.v1", "ring.w1").replace("[16, 2, 1]", "[3, 3, 2]")
    .replace('"ring.v0"', '"ring.u0"').replace('kind = "ring", inner = 0.6, outer = 1, width = 0.5, centre = [0, 0, 1]', BOX)
    .replace("stages =", 'loads.out = { face = "ring.u1", pressure = 0.05 }\nstages =').replace("-1.9", "-2.3")
)  # fmt: skip
#: A block of no even numbers on a plane without friction: round-off changes its gaps as it slides, and nothing slips in lengths.
SMOOTH = """
bodies.block.geometry = { kind = "box", lower = [-0.53756, -0.53756, 0], upper = [0.53756, 0.43652, 0.43188] }
bodies.block.mesh = { order = [3, 2, 2], elements = [3, 2, 1] }
contacts.floor = { slave = "block.w0", friction = 0, plane = {} }
supports.top = { face = "block.w1", force = { x = -0.00148, z = -0.00625 } }
"""
WALL = 'contacts.wall = { slave = "block.u1", friction = 0.1, plane = { point = [1, 0, 0], normal = [-1, 0, 0] } }\n'
#: Scenes, and what is to be told: bodies, how, and along what; nothing: they stand, or do something else.
SCENES: dict[str, tuple[str, tuple[str, str, str] | None]] = {
    "upper one": (PILE + MID + BOTH.replace("LEAN", "0.8"), ("turn", "body 'upper'", "0, 1, 0")),
    "stays up": (PILE + MID + BOTH.replace("LEAN", "0.3"), None),
    "glued": (
        PILE.replace("upper = [3, 1, 1]", "upper = [2, 1, 1]").replace("lower = [0, 0, 0]", "lower = [1, 0, 0]")
        .replace("[6, 2, 1]", "[4, 2, 1]") + 'glue = [["lower.w1", "upper.w0"]]\n' + BOTH.replace("LEAN", "0.8"),
        ("turn", "body 'lower' (glued to 'upper')", "0, 1, 0"),
    ),
    "over an edge": (PLANK, ("turn", "body 'plank'", "0, 1, 0")),
    "a half": (
        SCENE.replace("lower = [0, 0, 0]", "lower = [0, -1, 0]").replace("GROUND", GROUNDS["plane"]).replace("LOADS", LOADS["weight"])
        .replace("LEAN", "0.7") + "symmetry = { y = 0 }\n", ("turn", "body 'block'", "0, 1, 0"),
    ),
    "against a wall": (
        SCENE.replace("GROUND", GROUNDS["plane"] + "\n" + WALL).replace("LOADS", LOADS["weight"]).replace("LEAN", "0.7"), None,
    ),
    "lifted": (LOWER + LIFTED, ("move", "body 'lower'", "0, 0, 1")),
    "slides": (
        SCENE.replace("GROUND", GROUNDS["plane"].replace("= 1,", "= 0.1,")).replace("LOADS", LOADS["weight"]).replace("LEAN", "0.2"), None,
    ),
    "slides without friction": (SMOOTH, None),
    "rolls": (RING, None),
    "in balance": (BLOWN, None),
    "squeezed": (SQUEEZED, None),
    "upper one on a heavy one": (
        PILE + MID + BOTH.replace("LEAN", "0.8").replace("[0, 0, -1]", "[0, 0, -100]"), ("turn", "body 'upper'", "0, 1, 0"),
    ),
}  # fmt: skip


def whole(scene: str) -> str:
    """All of one of them."""
    text, _ = SCENES[scene]
    return text.replace("METHOD", "monolithic").replace("YOUNG", "10000") if "METHOD" in text else HEAD + text


@case(
    claim="Of several bodies, glued or on each other or over their table's edge, the one is told of that tips; of bodies that slide or "
    "roll, or that something else holds, it is not said, and of one that is lifted that it lifts off.",
    tier="gate",
    grid={"scene": tuple(SCENES)},
    bounds={"others": Bound(0.0, 0.0, "definition: bodies and ways that are told and are others")},
)
def tipping(scene: str) -> dict[str, float]:
    """Whether something else is told."""
    _, expected = SCENES[scene]
    found = TOLD.search(said(whole(scene)))
    return {"others": float((found and (found[1], found[2], found[3])) != expected)}


#: A wall before the block or behind it, and one above what lifts off.
APART = 'contacts.wall = { slave = "block.FACE", friction = 0.1, plane = { point = [PLACE, 0, 0], normal = [NORMAL, 0, 0] } }\n'
ABOVE = 'contacts.wall = { slave = "lower.w1", plane = { point = [0, 0, PLACE], normal = [0, 0, -1] } }\n'
UNTIL = "until contact 'wall' closes, where it may rest"


def before(place: float, face: str = "u1", lean: float = 0.7) -> str:
    """What is said of a block that tips, with a wall somewhere."""
    wall = APART.replace("FACE", face).replace("PLACE", str(place)).replace("NORMAL", "-1" if face == "u1" else "1")
    scene = SCENE.replace("GROUND", GROUNDS["plane"] + "\n" + wall).replace("LOADS", LOADS["weight"]).replace("LEAN", str(lean))
    return said(scene.replace("METHOD", "monolithic").replace("YOUNG", "10000"))


@case(
    claim="A body that tips or lifts off onto a contact that is open, and no farther than its own size, is told where it may rest; one "
    "that goes the other way, or far, is told that it tips over.",
    tier="gate",
    bounds={
        "onto": Bound(5.0, 5.0, "definition: of four gaps before a block, and one above, those that are told to close"),
        "over": Bound(3.0, 3.0, "definition: of one that is far, one behind and one far above, those of which only the motion is told"),
    },
)
def onto() -> dict[str, float]:
    """How many."""
    onto = [before(place) for place in (1.01, 1.2, 1.9)] + [before(-0.2, "u0", -0.7)]
    over = [before(3.2), before(-0.2, "u0")]
    lifted = {place: said(HEAD + LOWER + LIFTED + ABOVE.replace("PLACE", place)) for place in ("1.5", "9")}
    return {
        "onto": float(sum(TOLD.search(sentence) is not None and UNTIL in sentence for sentence in (*onto, lifted["1.5"]))),
        "over": float(sum(TOLD.search(sentence) is not None and "until" not in sentence for sentence in (*over, lifted["9"]))),
    }


#: A block that a load presses onto another one and then lifts; friction has borne next to nothing by then, and all of what it can.
REVERSED = """
format = 1
bodies.low = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh.elements = 2 }
bodies.block = { geometry = { kind = "box", lower = [0.2, 0.2, 1], upper = [0.8, 0.8, 1.6] }, mesh.elements = 2 }
contacts.floor = { slave = "block.w0", master = "low.w1", friction = FRICTION }
supports.table.face = "low.w0"
loads.push = { face = "block.w1", traction = [0, 0, -1] }
solver = { max_cuts = 2, max_iterations = 15, method = "METHOD" }
stages = [{ name = "press", steps = 2 }, { name = "lift", steps = 2, loads.push = -1 }]
"""


@case(
    claim="A block that its load lifts after it has pressed it is told to lift off, and not to slide for want of friction.",
    tier="gate",
    grid={"method": ("monolithic", "uzawa"), "friction": (0.1, 0.3)},
    bounds={
        "lifts": Bound(1.0, 1.0, "definition: that it moves up and lifts off"),
        "slides": Bound(0.0, 0.0, "definition: that friction bears so much of what it can"),
    },
)
def lifted(method: str, friction: float) -> dict[str, float]:
    """What is said."""
    sentence = said(REVERSED.replace("METHOD", method).replace("FRICTION", str(friction)))
    found = TOLD.search(sentence)
    lifts = found is not None and found[1] == "move" and found[3] == "0, 0, 1" and "lifts off" in sentence
    return {"lifts": float(lifts), "slides": float("of what it can" in sentence)}


#: A block that leans, and beside it one that a plate presses, one that falls and touches nothing, and one without a load.
AMONG = (
    HEAD
    + """
bodies.one = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 2] }, mesh.elements = [4, 2, 2] }
bodies.pressed = { geometry = { kind = "box", lower = [4, 0, 0], upper = [5, 1, 1] }, mesh.elements = [2, 2, 1] }
bodies.falling = { geometry = { kind = "box", lower = [8, 0, 1], upper = [9, 1, 2] }, mesh.elements = [2, 2, 1] }
bodies.still = { geometry = { kind = "box", lower = [12, 0, 0], upper = [13, 1, 1] }, mesh.elements = [2, 2, 1] }
contacts.one = { slave = "one.w0", friction = FRICTION, plane = {} }
contacts.pressed = { slave = "pressed.w0", friction = 1, plane = {} }
contacts.falling = { slave = "falling.w0", friction = 1, plane = {} }
contacts.still = { slave = "still.w0", friction = 1, plane = {} }
supports.pressed = { face = "pressed.w1", components = ["x", "y"], force.z = -50 }
supports.falling = { face = "falling.v0", components = ["y"] }
supports.still = { face = "still.v0", components = ["y"] }
loads.one = { body = "one", weight = [LEAN, 0, -1] }
loads.falling = { body = "falling", weight = [0.5, 0, -1] }
"""
)
#: By friction and lean of the first one, of what of it is told: that it tips, that nothing balances its loads, that it slides.
OF_ONE = {("1", "0.8"): (True, True, False), ("0.3", "0.4"): (True, True, True), ("0.3", "0.1"): (False, False, False)}


@case(
    claim="What is told of bodies that tip or slide is told of these by their own loads, whatever is beside them: bodies that plates "
    "press, that touch nothing, or that nothing moves.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: sentences on other bodies, or that are missing, or too many")},
)
def among_others() -> dict[str, float]:
    """Of nine that may be said."""
    wrong = 0
    for (friction, lean), expected in OF_ONE.items():
        simulation = Simulation(Scene.from_toml(AMONG.replace("FRICTION", friction).replace("LEAN", lean)).problem())
        simulation.equilibrium.time = 1.0
        for sentences, is_told in zip((tipping_over, giving_way, overcome), expected, strict=True):
            told = [sentence for _, sentence in sentences(simulation.equilibrium, simulation.state)]
            wrong += len(told) != is_told or any("body 'one'" not in sentence for sentence in told)
    return {"wrong": float(wrong)}
