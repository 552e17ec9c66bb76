"""Contacts that cannot be meant, and unusual ones that can be."""

from __future__ import annotations

PRESS = """
format = 1
[bodies.block]
geometry = { kind = "bowl", half_width = 0.5, bottom = 0.0, rise = 0.2, top = 0.8 }
mesh = { elements = [2, 2, 1] }
[contacts.floor]
slave = "block.w0"
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
[supports.top]
face = "block.w1"
[[stages]]
name = "press"
steps = 1
motions.top = { translate = [0, 0, -0.1], rotate = 0 }
"""
BLOCK = """
[bodies.upper]
geometry = { kind = "box", lower = [-0.4, -0.4, 0.0], upper = [0.4, 0.4, 0.6] }
mesh = { elements = [2, 2, 1] }
"""
PAIR = (
    "format = 1"
    + BLOCK
    + """
[bodies.lower]
geometry = { kind = "box", lower = [-1, -1, -1], upper = [1, 1, 0] }
mesh = { elements = [2, 2, 1] }
[contacts.pair]
slave = "upper.w0"
master = "lower.w1"
[supports.top]
face = "upper.w1"
[supports.base]
face = "lower.w0"
[[stages]]
name = "press"
steps = 1
motions.top.translate = [0, 0, -0.1]
"""
)
RINGS = """
format = 1
[bodies.inside]
geometry = { kind = "ring", inner = 0.5, outer = 1.02, width = 0.5 }
mesh = { elements = [16, 1, 1] }
[bodies.outside]
geometry = { kind = "ring", inner = 1.0, outer = 1.5, width = 0.5 }
mesh = { elements = [16, 1, 1] }
[contacts.fit]
slave = "inside.v1"
projection = "closest"
master = "outside.v0"
[supports.hub]
face = "inside.v0"
[supports.rim]
face = "outside.v1"
[[stages]]
name = "fit"
steps = 1
"""
TYRE = """
format = 1
[bodies.tyre]
geometry = { kind = "ring", centre = [0, 0, 1], inner = 0.5, outer = 1.0, width = 0.5 }
mesh = { elements = [16, 1, 1] }
[contacts.road]
slave = "tyre.v1"
plane = { normal = [0, 0, 1] }
[supports.rim]
face = "tyre.v0"
centre = [0, 0, 1]
axis = [0, 1, 0]
[[stages]]
name = "roll"
steps = 1
motions.rim = { translate = [0.5, 0, 0], rotate = 30 }
"""
WEDGE = """
[bodies.upper.patch]
order = [1, 1, 1]
knots = [[0, 0, 1, 1], [0, 0, 1, 1], [0, 0, 1, 1]]
control_points = [[0, 0, 0.3], [1, 0, 0.3], [0, 1, 0], [1, 1, 0], [0, 0, 0.3], [1, 0, 0.3], [0, 1, 0.6], [1, 1, 0.6]]
"""

# Scene, what is replaced, by what, the key that the error names, and a part of its text.
WRONG = {
    "absurd cohesion": (
        PRESS,
        "[supports.top]",
        "cohesion = 1e200\n[supports.top]",
        "contacts.floor.cohesion",
        "is 1e+200; allowed: up to 1e+100",
    ),
    "normal turned round": (PRESS, "normal = [0, 0, 1]", "normal = [0, 0, -1]", "contacts.floor.plane.normal", "turn it round, [0, 0, 1]"),
    "normal turned round, with a gap": (
        PRESS,
        "[0, 0, 0], normal = [0, 0, 1]",
        "[0, 0, -0.3], normal = [0, 0, -1]",
        "contacts.floor.plane.normal",
        "behind",
    ),
    "normal turned round, turning": (
        PRESS.replace("rotate = 0", "rotate = 60"),
        "normal = [0, 0, 1]",
        "normal = [0, 0, -1]",
        "contacts.floor.plane.normal",
        "turn it round",
    ),
    "normal of a rolling tyre turned round": (
        TYRE,
        "[0, 0, 1] }\n[supports",
        "[0, 0, -1] }\n[supports",
        "contacts.road.plane.normal",
        "its body is 2 thick",
    ),
    "wrong face on a plane": (PRESS, '"block.w0"', '"block.w1"', "contacts.floor.slave", "looks away from its master"),
    "wrong slave face": (PAIR, '"upper.w0"', '"upper.w1"', "contacts.pair.slave", "upper.w1 looks away from its master"),
    "wrong master face": (PAIR, '"lower.w1"', '"lower.w0"', "contacts.pair.slave", "looks away from its master"),
    "far too deep": (
        PAIR,
        "lower = [-0.4, -0.4, 0.0], upper = [0.4, 0.4, 0.6]",
        "lower = [-0.4, -0.4, -0.58], upper = [0.4, 0.4, 0.02]",
        "contacts.pair.master",
        "passed through each other",
    ),
    "the same twice": (
        PAIR,
        "[supports.top]",
        '[contacts.again]\nslave = "upper.w0"\nmaster = "lower.w1"\n[supports.top]',
        "contacts.again",
        "same faces as contact 'pair'",
    ),
    "master without area": (
        PAIR.replace(BLOCK, WEDGE).replace('"upper.w0"', '"lower.u0"'),
        'master = "lower.w1"',
        'master = "upper.v0"',
        "contacts.pair.master",
        "a face of area",
    ),
    "slave without area": (PAIR.replace(BLOCK, WEDGE), '"upper.w0"', '"upper.v0"', "contacts.pair.slave", "a face of area"),
    "young underflows": (
        PRESS,
        "[bodies.block]",
        "[materials.m]\nyoung = 1e-300\n[bodies.block]",
        "bodies.block.material",
        "take other units",
    ),
    "young overflows": (
        PRESS,
        "[bodies.block]",
        "[materials.m]\nyoung = 1e200\n[bodies.block]",
        "bodies.block.material",
        "take other units",
    ),
    "size underflows": (
        PRESS,
        "half_width = 0.5, bottom = 0.0, rise = 0.2, top = 0.8",
        "half_width = 5e-90, bottom = 0.0, rise = 2e-90, top = 8e-90",
        "bodies.block",
        "unit of length",
    ),
    "tolerance": (
        PRESS,
        "[[stages]]",
        "[solver]\nnewton_tolerance = 10\n[[stages]]",
        "solver.newton_tolerance",
        "less than or equal to 0.001",
    ),
    "complementarity tolerance": (
        PRESS,
        "[[stages]]",
        "[solver]\ncomplementarity_tolerance = 1\n[[stages]]",
        "solver.complementarity_tolerance",
        "0.001",
    ),
    "augmentation tolerance": (
        PRESS,
        "[[stages]]",
        "[solver]\naugmentation_tolerance = 2.0\n[[stages]]",
        "solver.augmentation_tolerance",
        "0.1",
    ),
    "penalty": (PRESS, "[[stages]]", "[solver]\npenalty_normal = 1e200\n[[stages]]", "solver.penalty_normal", "less than or equal to"),
    "growth": (PRESS, "[[stages]]", "[solver]\npenalty_growth = 1e200\n[[stages]]", "solver.penalty_growth", "less than or equal to"),
    "cuts without end": (PRESS, "[[stages]]", "[solver]\nmax_cuts = 54\n[[stages]]", "solver.max_cuts", "less than or equal to 30"),
    "largest traction without friction": (
        PRESS,
        "[supports.top]",
        "friction = 0\ncohesion = 0.2\ntraction_max = 0.5\n[supports.top]",
        "contacts.floor.traction_max",
        "give that limit as the cohesion",
    ),
    "largest traction of nothing": (
        PRESS,
        "[supports.top]",
        "friction = 0\ntraction_max = 0.5\n[supports.top]",
        "contacts.floor.traction_max",
        "without friction tractions do not grow",
    ),
    "cohesion above the largest traction": (
        PRESS,
        "[supports.top]",
        "cohesion = 0.5\ntraction_max = 0.5\n[supports.top]",
        "contacts.floor.traction_max",
        "friction would have no say",
    ),
    "cohesion below zero": (
        PRESS,
        "[supports.top]",
        "cohesion = -0.1\n[supports.top]",
        "contacts.floor.cohesion",
        "greater than or equal to 0",
    ),
    "elastic slip without friction": (
        PRESS,
        "[supports.top]",
        "friction = 0\nelastic_slip = 0.1\n[supports.top]",
        "contacts.floor.elastic_slip",
        "no friction that could give way",
    ),
    "elastic slip of round-off": (
        PRESS,
        "[supports.top]",
        "elastic_slip = 1e-10\n[supports.top]",
        "contacts.floor.elastic_slip",
        "next to round-off",
    ),
    "smoothing from afar": (
        PRESS,
        "[supports.top]",
        "smoothing = 10\n[supports.top]",
        "contacts.floor.smoothing",
        "pressed away from afar",
    ),
    "smoothing and cohesion": (
        PRESS,
        "[supports.top]",
        "smoothing = 1e-3\ncohesion = 0.1\n[supports.top]",
        "contacts.floor.smoothing",
        "a cohesion, 0.1 here, would act there",
    ),
    "smoothing below zero": (
        PRESS,
        "[supports.top]",
        "smoothing = -1\n[supports.top]",
        "contacts.floor.smoothing",
        "greater than or equal to 0",
    ),
    "elastic slip below zero": (
        PRESS,
        "[supports.top]",
        "elastic_slip = -0.1\n[supports.top]",
        "contacts.floor.elastic_slip",
        "greater than or equal to 0",
    ),
    "largest traction of zero": (
        PRESS,
        "[supports.top]",
        "traction_max = 0\n[supports.top]",
        "contacts.floor.traction_max",
        "greater than 0",
    ),
    "averaged normals of a plane": (
        PRESS,
        "[supports.top]",
        'projection = "averaged"\n[supports.top]',
        "contacts.floor.projection",
        "one normal everywhere",
    ),
    "another projection": (
        PRESS,
        "[supports.top]",
        'projection = "nearest"\n[supports.top]',
        "contacts.floor.projection",
        "'closest' or 'averaged'",
    ),
    "friction overflows": (PRESS, "[supports.top]", "friction = 1e156\n[supports.top]", "contacts.floor.friction", "to 1e+100"),
    "no key of a contact": (PRESS, "[supports.top]", "[contacts.floor.nothing]\n[supports.top]", "contacts.floor.nothing", "unknown key"),
    "steps": (PRESS, "steps = 1", "steps = 1000000000000", "stages.press.steps", "less than or equal to 1000000"),
}

# Unusual, and right: scene, what is replaced, by what.
UNUSUAL = {
    "press": (PRESS, "", ""),
    "starting gap": (PRESS, "point = [0, 0, 0]", "point = [0, 0, -0.05]"),
    "overlap": (PRESS, "point = [0, 0, 0]", "point = [0, 0, 0.3]"),
    "plane at a slant": (PRESS, "normal = [0, 0, 1]", "normal = [0.5, 0.2, 1]"),
    "ceiling": (
        PRESS.replace('slave = "block.w0"', 'slave = "block.w1"').replace('"block.w1"\n[[', '"block.w0"\n[['),
        "[0, 0, 0], normal = [0, 0, 1]",
        "[0, 0, 0.8], normal = [0, 0, -1]",
    ),
    "pair": (PAIR, "", ""),
    "pair with an overlap": (PAIR, "-0.4, 0.0]", "-0.4, -0.2]"),
    "slave beside its master": (
        PAIR,
        "lower = [-0.4, -0.4, 0.0], upper = [0.4, 0.4, 0.6]",
        "lower = [1.4, -0.4, 0.0], upper = [2.4, 0.4, 0.6]",
    ),
    "a side that is tipped over": (PAIR, 'slave = "upper.w0"', 'slave = "upper.u0"'),
    "support on the contact face": (PRESS, "[supports.top]", '[supports.bottom]\nface = "block.w0"\n[supports.top]'),
    "rigid stamp": (PAIR, "[supports.top]", '[supports.stamp]\nface = "upper.w0"\n[supports.top]'),
    "sliding support on the contact face": (
        PRESS,
        "[supports.top]",
        '[supports.rail]\nface = "block.w0"\ncomponents = ["x"]\n[supports.top]',
    ),
    "both ways": (PAIR, "[supports.top]", '[contacts.back]\nslave = "lower.w1"\nmaster = "upper.w0"\n[supports.top]'),
    "shrink fit": (RINGS, "", ""),
    "cohesion alone": (PRESS, "[supports.top]", "friction = 0\ncohesion = 0.2\n[supports.top]"),
    "cohesion and a largest traction": (PRESS, "[supports.top]", "cohesion = 0.2\ntraction_max = 0.5\n[supports.top]"),
    "smoothing": (PRESS, "[supports.top]", "smoothing = 1e-3\n[supports.top]"),
    "elastic slip": (PRESS, "[supports.top]", "elastic_slip = 0.01\n[supports.top]"),
    "tyre": (TYRE, "", ""),
    "far below a plane that it is turned to": (TYRE, "normal = [0, 0, 1]", "point = [0, 0, -0.4]"),
}

LAGRANGE = PAIR.replace("mesh = { elements", 'mesh = { family = "L", elements')
