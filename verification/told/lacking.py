"""What is said of supports that push a slave behind a plane, or bring bodies together with no contact, and of slaves of several bodies."""

from __future__ import annotations

from isomortar.errors import ConvergenceError
from isomortar.harness import Bound, case
from isomortar.march.outlook import outlook
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A block above a plane, of which supports move the slave face along x.
PUSHED = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh.elements = [2, 2, 2] }
contacts.floor = { slave = "block.w0", plane = { normal = [SLANT, 0, 1] } }
supports.top = { face = "block.w1", components = ["x", "y"], force.z = -0.01 }
supports.sole = { face = "block.w0", components = [HELD] }
stages = [{ name = "go", steps = 4, motions.sole.translate = [ALONG, 0, 0] }]
"""
BEHIND = "of its slave control points behind the plane, by"
#: Slant of the plane, components that are held, their way, and whether that leads behind the plane without a way out.
SUPPORTS = (
    ("0", '"x"', "0.1", False),
    ("1", '"x"', "-0.1", False),
    ("1", '"x", "y"', "-0.1", False),
    ("1", '"x", "y", "z"', "-0.1", True),
    ("1", '"x", "z"', "-0.1", True),
    ("1", '"x", "y", "z"', "0.1", False),
    ("0", '"x", "y", "z"', "-0.1", False),
)
#: A block that is brought to another one by one of its supports, and kept by the other, which stays: which of both is first is no matter.
MEETING = """
format = 1
bodies.low = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh.elements = [1, 1, 1] }
bodies.high = { geometry = { kind = "box", lower = [0, 0, 1.1], upper = [1, 1, 2] }, mesh.elements = [1, 1, 1] }
supports.base.face = "low.w0"
FIRST
SECOND
stages = [{ name = "go", steps = 4, motions.mover.translate = [0, 0, -WAY] }]
"""
MOVER, GUIDE = 'supports.mover.face = "high.w1"', 'supports.guide = { face = "high.u0", components = ["x"] }'
MEET = "bodies 'low' and 'high' meet, and no contact is between them"
#: Two blocks that are glued, one soft and one stiff, on a finer one that is between them in stiffness.
ON_A_FINER_ONE = """
format = 1
materials = { soft = { young = 1 }, firm = { young = 10 }, stiff = { young = STIFF } }
bodies.a = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = 1 }, material = "soft" }
bodies.b = { geometry = { kind = "box", lower = [1, 0, 0], upper = [2, 1, 1] }, mesh = { order = 1 }, material = "stiff" }
bodies.base.geometry = { kind = "box", lower = [-0.5, -0.5, -1], upper = [2.5, 2.5, 0] }
bodies.base.mesh = { order = 1, elements = [24, 24, 1] }
bodies.base.material = "firm"
glue = [["a.u1", "b.u0"]]
contacts.c = { slave = ["a.w0", "b.w0"], master = "base.w1", quadrature = [4, 2], projection = "closest" }
supports = { base.face = "base.w0", top.face = "b.w1" }
stages = [{ name = "press", steps = 4, motions.top.translate = [0, 0, -0.01] }]
"""
#: Elements of the base are 1/8 long, points of the slave 1 / sqrt(8) apart: twice as many as that takes are to be given.
POINTS = "quadrature points of the slave are 2.83 elements of its softer or equal master apart"
CURE = "contacts.c.quadrature = [23, 12]"

#: A slave of two elements, a short one of a tenth next to the pole of a dome and a long one, both a fifth wide, so far from the pole.
BESIDE_A_POLE = """
format = 1
bodies.a.geometry = { kind = "box", lower = [FROM, -0.1, 0], upper = [TO, 0.1, 0.5] }
bodies.a.mesh = { family = "L", order = 1, elements = [2, 1, 1], grading = [9, 1, 1] }
bodies.dome.geometry = { kind = "sphere", centre = [0, 0, -1], inner = 0.5, outer = 1, latitudes = [0, 90] }
bodies.dome.mesh = { order = 2, elements = [8, 1, 4] }
contacts.c = { slave = "a.w0", master = "dome.v1", friction = 0.3, projection = "closest" }
supports = { base.face = "dome.w1", top.face = "a.w1" }
stages = [{ name = "press", steps = 4, motions.top.translate = [0, 0, -0.001] }]
"""
#: The middle of a cell, of 24 that the short element has, may be as far from elements that end at the pole, below it, as one of the long
#: element is large, 0.0125, and no farther: they fall away by half the square of this.
FAR = {0.05: True, 0.1: True, 0.2: False, 0.39: False, 0.9: False}
#: A block on a rigid ball, the poles of which are 0.3 beside it; of two elements from one to the other both end at a pole.
ON_A_BALL = """
format = 1
bodies.a.geometry = { kind = "box", lower = [-0.4, -0.3, 0.6], upper = [0.4, 0.3, 1] }
bodies.a.mesh.elements = [6, 4, 2]
bodies.ball = { geometry = { kind = "sphere", outer = 0.6, axis = "y" }, mesh.elements = [4, 1, ELEMENTS], rigid = true }
contacts.c = { slave = "a.w0", master = "ball.v1", friction = 0.3 }
supports.top.face = "a.w1"
stages = [{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.06] }]
"""


def warnings(text: str, **values: str) -> list[str]:
    """What is said of a scene with some words replaced."""
    for word, value in values.items():
        text = text.replace(word, value)
    return list(outlook(Scene.from_toml(text).problem()).warnings)


@case(
    claim="Of supports it is said what they push behind a plane, and of nothing that can give way; of bodies that one of several supports "
    "brings together that they have no contact; of slaves of several bodies that their points are few for the stiffest of these; and of "
    "friction that it may come to a pole, by the largest of the slave's cells.",
    tier="gate",
    bounds={
        "supports": Bound(0.0, 0.0, "definition: scenes of which something else is said of supports"),
        "meeting": Bound(0.0, 0.0, "definition: scenes of bodies that meet and are not told, or do not"),
        "points": Bound(0.0, 0.0, "definition: slaves of which something else is said of points"),
        "poles": Bound(0.0, 0.0, "definition: slaves beside a pole that are not told, or that are and are not"),
    },
)
def lacking() -> dict[str, float]:
    """How many of seven, four, four, and five."""
    supports = 0
    for slant, held, along, behind in SUPPORTS:
        said = warnings(PUSHED, SLANT=slant, HELD=held, ALONG=along)
        supports += any(BEHIND in warning for warning in said) != behind
    meeting = 0
    for first, second in ((MOVER, GUIDE), (GUIDE, MOVER)):
        for way, meets in (("0.1", True), ("0.05", False)):
            said = warnings(MEETING, FIRST=first, SECOND=second, WAY=way)
            meeting += any(MEET in warning for warning in said) != meets
    points = 0
    for stiff, few in (("10", True), ("100", True), ("5", False)):
        said = [warning for warning in warnings(ON_A_FINER_ONE, STIFF=stiff) if "quadrature points of the slave" in warning]
        points += [POINTS in warning and CURE in warning for warning in said] != [True] * few
    halved = warnings(ON_A_FINER_ONE.replace("quadrature = [4, 2]", "subcells = 1, quadrature = [2, 1]"), STIFF="10")  # as many points
    points += sum(POINTS in warning and "contacts.c.quadrature = [12, 6]" in warning for warning in halved) != 1
    poles = 0
    for far, told in FAR.items():
        said = warnings(BESIDE_A_POLE, FROM=str(far), TO=str(far + 1.0))
        poles += any("has a pole, an edge that is one point" in warning for warning in said) != told
    return {"supports": float(supports), "meeting": float(meeting), "points": float(points), "poles": float(poles)}


@case(
    claim="A slave that comes to elements which end at a pole of its master, with friction, is told of that before its run, which ends "
    "there; with more elements, as it is told to take, nothing is said, and the run comes to its end.",
    tier="gate",
    grid={"elements": (2, 4)},
    bounds=lambda elements: {
        "told": Bound(1.0, 1.0, "definition: whether") if elements == 2 else Bound(0.0, 0.0, "definition: whether"),
        "ended": Bound(1.0, 1.0, "definition: whether") if elements == 2 else Bound(0.0, 0.0, "definition: whether"),
    },
)
def poles_of_a_ball(elements: int) -> dict[str, float]:
    """Whether it is told, and whether its run is given up for that."""
    text, ended = ON_A_BALL.replace("ELEMENTS", str(elements)), False
    told = [warning for warning in warnings(text) if "Take more elements there along w (bodies.ball.mesh.elements)" in warning]
    try:
        list(Simulation(Scene.from_toml(text).problem()).run())
    except ConvergenceError as error:
        ended = "in an element of the master that ends at a pole" in str(error)
    return {"told": float(len(told)), "ended": float(ended)}


#: A punch that goes past the pad between it and a base; two blocks on a floor, of which one is pushed into the other.
_PAST = """
format = 1
bodies.punch = { geometry = { kind = "box", lower = [-2, -2, 0.2], upper = [2, 2, 1] }, mesh = { order = 2, elements = [4, 4, 1] } }
bodies.pad = { geometry = { kind = "box", lower = [-0.5, -0.5, 0], upper = [0.5, 0.5, 0.2] }, mesh = { order = 2, elements = [4, 4, 2] } }
bodies.base = { geometry = { kind = "box", lower = [-3, -3, -1], upper = [3, 3, 0] }, mesh = { order = 2, elements = [4, 4, 1] } }
contacts.upper = { slave = "pad.w1", master = "punch.w0" }
contacts.lower = { slave = "pad.w0", master = "base.w1" }
supports = { top.face = "punch.w1", ground.face = "base.w0" }
stages = [{ name = "press", steps = 5, motions.top.translate = [0, 0, -0.25] }]
"""
_ALONG = """
format = 1
bodies.left = { geometry = { kind = "box", lower = [-1, 0, 0], upper = [0, 1, 1] }, mesh = { order = 2, elements = 2 } }
bodies.right = { geometry = { kind = "box", lower = [0.01, 0, 0], upper = [1.01, 1, 1] }, mesh = { order = 2, elements = 2 } }
bodies.floor = { geometry = { kind = "box", lower = [-3, -3, -1], upper = [3, 3, 0] }, mesh = { order = 2, elements = [4, 4, 1] } }
contacts.one = { slave = "left.w0", master = "floor.w1" }
contacts.other = { slave = "right.w0", master = "floor.w1" }
supports = { left.face = "left.w1", right.face = "right.w1", ground.face = "floor.w0" }
[[stages]]
name = "press"
steps = 5
motions = { left.translate = [0, 0, -0.05], right.translate = [0, 0, -0.05] }
[[stages]]
name = "push"
steps = 2
motions.left.translate = [0.04, 0, 0]
"""


#: A sheet between two others, of which one is pressed by as much as it is thick, or the sheet is narrow and the others meet beside it, or
#: it is pushed into the lower one, which it is in no contact with.
_SHEETS = """
format = 1
bodies.low = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.2] }, mesh.elements = [2, 2, 1] }
bodies.sheet = { geometry = { kind = "box", lower = [0, 0, 0.2], upper = [WIDE, 1, 0.3] }, mesh.elements = [3, 3, 1] }
bodies.high = { geometry = { kind = "box", lower = [0, 0, 0.3], upper = [1, 1, 0.5] }, mesh.elements = [2, 2, 1] }
contacts.below = { slave = "sheet.w0", master = "low.w1", friction = 0 }
contacts.above = { slave = "sheet.w1", master = "high.w0", friction = 0 }
supports.base.face = "low.w0"
supports.top.face = "high.w1"
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -WAY] }]
"""
_BELOW = 'contacts.below = { slave = "sheet.w0", master = "low.w1", friction = 0 }\n'


@case(
    claim="A body that two others touch keeps these apart neither beside it nor along it: it is said that they meet; and not of what would "
    "have to go through it.",
    tier="gate",
    bounds={
        "silent": Bound(0.0, 0.0, "definition: scenes of which it is not"),
        "doubted": Bound(0.0, 0.0, "definition: sheets that are pressed by up to twice their thickness of which it is"),
    },
)
def past_what_both_touch() -> dict[str, float]:
    """How many of four, and of three."""
    beside = _SHEETS.replace("WIDE", "0.4").replace("WAY", "0.1")
    within = [_SHEETS.replace("WIDE", "1").replace("WAY", way) for way in ("0.05", "0.1", "0.2")]
    pushed = within[2].replace("[1, 1, 0.2]", "[1, 1, 0.19]").replace(_BELOW, 'supports.side.face = "sheet.u0"\n')
    pairs = {_PAST: "bodies 'punch' and 'base' meet", _ALONG: "bodies 'left' and 'right' meet", beside: MEET, pushed: MEET}
    return {
        "silent": float(sum(not any(words in warning for warning in warnings(text)) for text, words in pairs.items())),
        "doubted": float(sum(any(MEET in warning for warning in warnings(text)) for text in within)),
    }
