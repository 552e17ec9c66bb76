"""Scenes that run, but in which most likely something else was meant."""

from __future__ import annotations

from told.bending import LOAD, scene
from told.exchanged import GLUE, HALVES
from told.wrong.contacts import PAIR, PRESS, TYRE, UNUSUAL

from isomortar.scene import Scene

SLIT = """
format = 1
[bodies.ring.patch]
order = [2, 1, 1]
knots = [[0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4], [0, 0, 1, 1], [0, 0, 1, 1]]
control_points = [
  POINTS
]
weights = [WEIGHTS]
[supports.hub]
face = "ring.v0"
[[stages]]
name = "turn"
steps = 1
motions.hub.rotate = 10
"""
_RING = Scene.from_toml(TYRE.replace("mesh = { elements = [16, 1, 1] }", "mesh.order = [2, 1, 1]")).problem().bodies[0].patch
SLIT = SLIT.replace("POINTS", ", ".join(str(point.tolist()) for point in _RING.control_points))
SLIT = SLIT.replace("WEIGHTS", ", ".join(map(str, _RING.weights.tolist())))

AVERAGED = PAIR.replace('master = "lower.w1"', 'master = "lower.w1"\nprojection = "averaged"')

_TALL = PRESS.replace('"bowl", half_width = 0.5, bottom = 0.0, rise = 0.2, top = 0.8', '"box", lower = [0, 0, 0], upper = [1, 1, 1e6]')

_FLOOR = PRESS[PRESS.index("[contacts.floor]") : PRESS.index("[supports.top]")]

#: A block on a dome, whose pole is where it touches, and a bowl with its pole there, of quadratic Lagrange elements.
DOME = PAIR.replace(
    'geometry = { kind = "box", lower = [-1, -1, -1], upper = [1, 1, 0] }\nmesh = { elements = [2, 2, 1] }',
    'geometry = { kind = "sphere", centre = [0, 0, -1], inner = 0.5, outer = 1, latitudes = [0, 90] }\nmesh = { elements = [8, 1, 4] }',
)
DOME = DOME.replace("lower.w1", "lower.v1").replace("lower.w0", "lower.w1")
HOLLOW = PAIR.replace(
    'kind = "box", lower = [-0.4, -0.4, 0.0], upper = [0.4, 0.4, 0.6]',
    'kind = "sphere", centre = [0, 0, 0.4], inner = 0.2, outer = 0.4, latitudes = [-90, 0]',
)
HOLLOW = HOLLOW.replace("upper.w0", "upper.v1").replace("upper.w1", "upper.w0")
_INTERFACE = PAIR[PAIR.index("[contacts.pair]") : PAIR.index("[supports.top]")]
_ASIDE = """
[bodies.aside]
geometry = { kind = "box", lower = [3, 3, 0], upper = [4, 4, 1] }
[supports.aside]
face = "aside.w0"
"""
_STEEL = """
[materials]
soft = { young = 1 }
steel = { young = 2e6 }
"""
#: A body with one knot span far shorter than the other.
_GRADED = """
format = 1
bodies.a.patch.order = [1, 1, 1]
bodies.a.patch.knots = [[0, 0, 1e-9, 1, 1], [0, 0, 1, 1], [0, 0, 1, 1]]
bodies.a.patch.control_points = [[0, 0, 0], [1e-9, 0, 0], [1, 0, 0], [0, 1, 0], [1e-9, 1, 0], [1, 1, 0],
                                 [0, 0, 1], [1e-9, 0, 1], [1, 0, 1], [0, 1, 1], [1e-9, 1, 1], [1, 1, 1]]
supports = { top.face = "a.w1", base.face = "a.w0" }
stages = [{ name = "pull", steps = 1, motions.top.translate = [0, 0, 0.1] }]
"""
#: A thin sheet of order 1.
SHEET = scene(0.3, 0.3, 1) + LOAD
#: Nearly incompressible.
_RUBBER = PRESS.replace("[bodies.block]", "[materials.rubber]\npoisson = POISSON\n[bodies.block]")
_RUBBER = _RUBBER.replace("elements = [2, 2, 1]", "order = 3, elements = [2, 2, 1]")
#: A ring of which the half above a plane is given.
_HALF = """
format = 1
[bodies.arch.patch]
order = [2, 1, 1]
knots = [[0, 0, 0, 1, 1, 2, 2, 2], [0, 0, 1, 1], [0, 0, 1, 1]]
control_points = [
  POINTS
]
weights = [WEIGHTS]
[bodies.arch.mesh]
elements = [8, 1, 1]
[contacts.road]
slave = "arch.v1"
plane = { point = [0, 0, -1], normal = [0, 0, 1] }
[supports.rim]
face = "arch.v0"
[[stages]]
name = "press"
steps = 1
motions.rim.translate = [0, 0, -0.05]
"""

_ROUND = ((0, -1, 1.0), (1, -1, 0.5**0.5), (1, 0, 1.0), (1, 1, 0.5**0.5), (0, 1, 1.0))
_POINTS = [[r * x, y, r * z] for y in (0.0, 0.5) for r in (0.5, 1.0) for x, z, _ in _ROUND]
_HALF = _HALF.replace("POINTS", str(_POINTS)[1:-1]).replace("WEIGHTS", ", ".join(str(w) for _ in range(4) for *_, w in _ROUND))

# Scene, what is replaced, by what, and words of the one warning.
DOUBTFUL = {
    "overlap": (PRESS, "point = [0, 0, 0]", "point = [0, 0, 0.3]", "overlap by 0.3 at the start"),
    "overlap of bodies": (PAIR, "-0.4, 0.0]", "-0.4, -0.2]", "overlap by 0.2 at the start"),
    "overlap too deep": (AVERAGED, "-0.4, 0.0]", "-0.4, -0.4]", "144 of its slave quadrature points are inside their master"),
    "overlap too deep in part": (
        AVERAGED,
        'kind = "box", lower = [-0.4, -0.4, 0.0], upper = [0.4, 0.4, 0.6]',
        'kind = "bowl", half_width = 0.4, bottom = -0.4, rise = 0.2, top = 0.6',
        "inside their master",
    ),
    "overlap too deep of thick bodies": (
        AVERAGED.replace("-1, -1, -1]", "-1, -1, -30]").replace("[2, 2, 1]", "[2, 2, 8]"),
        "0.0], upper = [0.4, 0.4, 0.6]",
        "-0.35], upper = [0.4, 0.4, 30]",
        "inside their master",
    ),
    "slave around its master": (
        PAIR,
        'slave = "upper.w0"\nmaster = "lower.w1"',
        'slave = "lower.w1"\nmaster = "upper.w0"',
        "Exchange the two: upper.w0 ends within lower.w1",
    ),
    "masters that go on": (
        HALVES.replace(GLUE, ""),
        "format = 1\n",
        "format = 1\n" + GLUE,
        'both masters, which are joined, and remove contact \'other\': contacts.one.master = ["one.w0", "other.w0"]',
    ),
    "wholly beside": (*UNUSUAL["slave beside its master"], "upper.w0 is wholly beside its master"),
    "between the points": (
        PAIR.replace('slave = "upper.w0"\nmaster = "lower.w1"', 'slave = "lower.w1"\nmaster = "upper.w0"'),
        "lower = [-0.4, -0.4, 0.0], upper = [0.4, 0.4, 0.6]",
        "lower = [-0.03, -0.03, 0.0], upper = [0.03, 0.03, 0.6]",
        "are beside its master, which is between them",
    ),
    "cannot close": (PRESS, "point = [0, 0, 0]", "point = [0, 0, -0.5]", "0.5 apart at the start, and all supports together travel 0.1"),
    "bodies cannot close": (PAIR, "-0.4, 0.0], upper = [0.4, 0.4, 0.6]", "-0.4, 0.9], upper = [0.4, 0.4, 1.6]", "it cannot close"),
    "other unit of length": (
        PAIR,
        "[-1, -1, -1], upper = [1, 1, 0]",
        "[-1000, -1000, -1000], upper = [1000, 1000, 0]",
        "same unit of length",
    ),
    "other unit of motions": (PRESS, "[0, 0, -0.1]", "[0, 0, -100]", "moves by 100 in each load step"),
    "motions of round-off": (PAIR, "[0, 0, -0.1]", "[0, 0, -1e-13]", "takes the digits of forces"),
    "held on both sides": (*UNUSUAL["support on the contact face"], "can move nothing: its slave face is held by support 'bottom'"),
    "friction in per cent": (PRESS, "[supports.top]", "friction = 30\n[supports.top]", "Was it meant in per cent, 0.3?"),
    "friction of no material": (PRESS, "[supports.top]", "friction = 3\n[supports.top]", "is above what materials have"),
    "motion of what is not held": (
        PRESS,
        'face = "block.w1"',
        'face = "block.w1"\ncomponents = ["x", "y"]',
        "is to move along z in stage 'press', but prescribes only x, y",
    ),
    "nothing moves": (PRESS, "[0, 0, -0.1]", "[0, 0, 0]", "no support moves in any stage"),
    "all rigid": (PRESS.replace(_FLOOR, ""), "[bodies.block]", "[bodies.block]\nrigid = true", "all bodies are rigid"),
    "ring that is not closed": (SLIT, "", "", "faces u0 and u1 lie on each other, but are not joined"),
    "both ways": (*UNUSUAL["both ways"], "are the same one, both ways"),
    "pole under friction": (DOME, "", "", "the master lower.v1 has a pole, an edge that is one point, at (0, 0, 0)"),
    "pole beside friction": (DOME, "lower = [-0.4,", "lower = [0.2,", "Take more elements there along w"),
    "pole without area": (
        HOLLOW,
        "[2, 2, 1] }\n\n[bodies.lower]",
        '[4, 1, 2], family = "L" }\n[bodies.lower]',
        "the slave upper.v1 has a pole",
    ),
    "across": (PAIR, 'slave = "upper.w0"', 'slave = "upper.u0"', "no part of upper.u0 looks at its master"),
    "away, turning about the way": (
        PRESS,
        "[0, 0, -0.1], rotate = 0",
        "[0, 0, 0.1], rotate = 20",
        "motions take its sides away from each other",
    ),
    "away": (PRESS, "[0, 0, -0.1]", "[0, 0, 0.1]", "motions take its sides away from each other"),
    "not near enough": (
        PRESS.replace("point = [0, 0, 0]", "point = [0, 0, -0.15]"),
        "[0, 0, -0.1]",
        "[0.1, 0, -0.01]",
        "motions bring its sides nearer by 0.01: it cannot close",
    ),
    "pressed flat": (
        PAIR,
        "steps = 1\nmotions.top.translate = [0, 0, -0.1]",
        "steps = 4\nmotions.top.translate = [0, 0, -1.5]",
        "they would be pressed flat",
    ),
    "radians": (TYRE, "rotate = 30", "rotate = 3.1416", "If radians were meant, give 180"),
    "axis beside": (
        PRESS.replace("rotate = 0", "rotate = 5"),
        'face = "block.w1"',
        'face = "block.w1"\ncentre = [5, 0, 0]',
        "it goes round on a large circle",
    ),
    "as absolute": (
        PRESS,
        "translate = [0, 0, -0.1], rotate = 0 }",
        'translate = [0, 0, -0.1] }\n[[stages]]\nname = "drag"\nsteps = 1\nmotions.top.translate = [0.1, 0, -0.1]',
        "If it is to stay there along z, give 0",
    ),
    "no contact": (PAIR, _INTERFACE, "", "nothing keeps them apart"),
    "no contact on the way": (PAIR.replace("-0.4, 0.0]", "-0.4, 0.05]"), _INTERFACE, "", "nothing keeps them apart"),
    "idle body": (PAIR, "[contacts.pair]", _ASIDE + "[contacts.pair]", "body 'aside' is in no contact, and nothing moves or loads it"),
    "not held against": (PAIR, '[supports.base]\nface = "lower.w0"', "", "body 'lower': what it touches ('pair') pushes it one way"),
    "half a model": (PAIR.replace("-0.4, -0.4, 0.0]", "0, -0.4, 0]"), "[-1, -1, -1]", "[0, -1, -1]", "as halves of a whole do"),
    "half a ring": (_HALF, "", "", 'supports with components = ["x"] to arch.u0, arch.u1'),
    "slender elements": (PRESS, "elements = [2, 2, 1]", "elements = [2, 2, 40]", "take fewer along w, or more along u"),
    "tall": (_TALL, "elements = [2, 2, 1]", "order = 7, elements = [1, 1, 1]", "round-off of its positions"),
    "one element": (PRESS, "elements = [2, 2, 1]", "elements = [1, 1, 1]", "the slave face block.w0 is a single element"),
    "graded away": (PRESS, "elements = [2, 2, 1]", "elements = [2, 2, 3], grading = [1, 1, 0.2]", "mesh.grading along w above 1"),
    "graded away from a last face": (
        PAIR,
        "[2, 2, 1] }\n[contacts.pair]",
        "[2, 2, 3], grading = [1, 1, 5] }\n[contacts.pair]",
        "Take bodies.lower.mesh.grading along w below 1",
    ),
    "few Gauss points": (PRESS, "elements = [2, 2, 1]", "elements = [2, 2, 1], quadrature = 1", "mesh.quadrature = [2, 2, 2] or more"),
    "few contact points": (PRESS, "[supports.top]", "quadrature = 2\n[supports.top]", "contacts.floor.quadrature = [3, 3] or more"),
    "loose": (PRESS, "[supports.top]", "[solver]\nnewton_tolerance = 1e-3\n[supports.top]", "Take 0.0001 or less"),
    "other unit of moduli": (
        PAIR.replace("[bodies.upper]", '[bodies.upper]\nmaterial = "soft"').replace("[bodies.lower]", '[bodies.lower]\nmaterial = "steel"'),
        "[contacts.pair]",
        _STEEL + "[contacts.pair]",
        "Are their Young's moduli given in the same unit?",
    ),
    "cohesion": (PRESS, "[supports.top]", "cohesion = 20\n[supports.top]", "a cohesion of 20 makes all stick"),
    "elastic slip": (PRESS, "[supports.top]", "elastic_slip = 0.5\n[supports.top]", "nothing slides before it has gone that far"),
    "no load": (PRESS, "[supports.top]", '[loads.wind]\nface = "block.u0"\npressure = 0\n[supports.top]', "is zero in all stages"),
    "load in another unit": (
        PRESS,
        "[supports.top]",
        '[loads.wind]\nface = "block.u0"\npressure = 1e3\n[supports.top]',
        "hardly anything bears that",
    ),
    "load as large as the modulus": (
        PRESS,
        "[supports.top]",
        '[loads.wind]\nface = "block.u0"\ntraction = [8, 0, 0]\n[supports.top]',
        "hardly anything bears that",
    ),
    "weight in another unit": (
        PRESS,
        "[supports.top]",
        '[loads.own]\nbody = "block"\nweight = [0, 0, -1e3]\n[supports.top]',
        "times the size",
    ),
    "force in another unit": (
        PRESS.replace("[0, 0, -0.1]", "[0, 0, 0]"),
        'face = "block.w1"',
        'face = "block.w1"\nforce.z = -1e4',
        "presses by 1e+04 force per area",
    ),
    "acceleration": (PRESS, "[supports.top]", '[loads.own]\nbody = "block"\nweight = [0, 0, -9.8]\n[supports.top]', "give density times"),
    "faint cohesion": (PRESS, "[supports.top]", "cohesion = 1e-9\n[supports.top]", "cohesion = 1e-09 is as good as no traction"),
    "faint friction": (
        PRESS,
        "[supports.top]",
        "friction = 0.3\ntraction_max = 1e-9\n[supports.top]",
        "traction_max = 1e-09 is as good as no traction",
    ),
    "auxetic": (PRESS, "[bodies.block]", "[materials.rubber]\npoisson = -0.3\n[bodies.block]", "Is the sign meant?"),
    "turn of what is not held": (
        PRESS.replace("rotate = 0", "rotate = 20"),
        'face = "block.w1"',
        'face = "block.w1"\naxis = [0, 0, 2]\ncomponents = ["x", "z"]',
        "but leaves y free, across its axis",
    ),
    "spins": (TYRE, "axis = [0, 1, 0]", "axis = [0, 0, 1]", "If it is to roll, give supports.rim.axis another direction"),
    "rolls the other way": (TYRE, "rotate = 30", "rotate = -30", "it slides by 1.02. If it is to roll, turn it by 28.8 degrees"),
    "turned by a tenth": (TYRE, "rotate = 30", "rotate = 3", "turn it by 28.8 degrees"),
    "turns off its centre": (TYRE, "centre = [0, 0, 1]\naxis", "centre = [0, 0, 0]\naxis", "give that as supports.rim.centre"),
    "setting of the other method": (PRESS, "[supports.top]", "[solver]\npenalty_growth = 3\n[supports.top]", "Take it out, or take that"),
    "setting of the first method": (
        PRESS,
        "[supports.top]",
        '[solver]\nmethod = "uzawa"\ncomplementarity_tolerance = 1e-9\n[supports.top]',
        "does nothing",
    ),
    "idle stage": (PRESS, "rotate = 0 }", 'rotate = 0 }\n[[stages]]\nname = "hold"\nsteps = 20', "compute the same state again"),
    "held on one side": (PAIR, 'face = "lower.w0"', 'face = "lower.w1"', "its face lower.w1 is held by support 'base'"),
    "load on contact": (
        PRESS,
        "[supports.top]",
        '[loads.wind]\nface = "block.w0"\npressure = 0.1\n[supports.top]',
        "a face of contact 'floor', and acts where that is closed as well",
    ),
    "two planes": (
        PRESS,
        "[supports.top]",
        '[contacts.below]\nslave = "block.w0"\nplane.point = [0, 0, -0.01]\n[supports.top]',
        "the plane of 'below' is at or behind the plane of 'floor'",
    ),
    "plane and body": (
        PAIR,
        "[contacts.pair]",
        '[contacts.floor]\nslave = "upper.w0"\nplane = {}\n[contacts.pair]',
        "lower.w1, the master of 'pair', is at or behind the plane of 'floor'",
    ),
    "held twice": (PAIR, "[supports.base]", '[supports.bottom]\nface = "lower.w0"\n[supports.base]', "told half of the force there"),
    "held twice in part": (
        PAIR,
        "[supports.base]",
        '[supports.bottom]\nface = "lower.w0"\ncomponents = ["x", "y"]\n[supports.base]\ncomponents = ["y", "z"]',
        "told half of the force there",
    ),
    "one of two halves": (
        PAIR.replace("-0.4, -0.4, 0.0]", "0, -0.4, 0]").replace("[-1, -1, -1]", "[0, -1, -1]"),
        "[supports.base]",
        '[supports.cut]\nface = "lower.u0"\ncomponents = ["x"]\n[supports.base]',
        "nothing holds upper.u0 there",
    ),
    "halves held elsewhere": (
        PAIR.replace("-0.4, -0.4, 0.0]", "0, -0.4, 0]").replace("[-1, -1, -1]", "[0, -1, -1]"),
        "[supports.base]",
        '[supports.cut]\nface = "lower.u0"\ncomponents = ["y"]\n[supports.base]',
        "nothing holds them there",
    ),
    "spans": (_GRADED, "", "", "lost in round-off"),
    "locks in bending": (SHEET, "", "", "times too stiff in bending"),
    "locks": (_RUBBER.replace("POISSON", "0.4999"), "", "", "some 5 % too large"),
    "locks next to 0.5": (_RUBBER.replace("POISSON", "0.4999999999999"), "", "", "or a Poisson's ratio that is lower"),
    "locks several times": (_RUBBER.replace("POISSON", "0.4999"), "order = 3", 'family = "L", order = 1', "several times too large"),
}
