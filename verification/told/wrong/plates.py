"""Moments that supports cannot exert, and stages in which they cannot hold."""

from __future__ import annotations

# A pad on a plane, pressed by a plate that tilts, after a stage in which its sides were held; each case below changes one place.
GOOD = """
format = 1
[bodies.pad]
geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }
mesh = { order = 2, elements = [2, 2, 1] }
[contacts.floor]
slave = "pad.w0"
plane = {}
friction = 0.3
[supports.top]
face = "pad.w1"
force.z = -0.3
moment = 0.02
centre = [0.5, 0.5, 0.5]
axis = [0, 1, 0]
[supports.beside]
face = "pad.w1"
stages = ["before"]
[[stages]]
name = "before"
steps = 2
motions.beside.translate = [0, 0, -0.01]
[[stages]]
name = "press"
steps = 3
motions.top.translate = [0.01, 0, 0]
"""
GOOD = GOOD.replace("axis = [0, 1, 0]\n", 'axis = [0, 1, 0]\nstages = ["press"]\n')

# What is replaced, by what, the field that the error names, and a part of its text.
WRONG = {
    "not a number": ("moment = 0.02", "moment = nan", "supports.top.moment", "allowed: a finite number"),
    "by component": ("moment = 0.02", "moment.y = 0", "supports.top", "turns about one axis; allowed: moment, a number"),
    "a vector": ("moment = 0.02", "moment = [0, 1, 0]", "supports.top", "turns about one axis; allowed: moment, a number"),
    "turned too": (
        "motions.top.translate = [0.01, 0, 0]", "motions.top.rotate = 5",
        "stages.press.motions.top.rotate", "turns support 'top', and so does",
    ),
    "free across": (
        'moment = 0.02', 'moment = 0.02\ncomponents = ["y"]', "supports.top.moment", "turns the face, of which x go free",
    ),
    "turns beside": ('stages = ["before"]', 'components = ["x"]', "supports.top.moment", "that support 'beside' holds or moves along x"),
    "no such stage": ('stages = ["before"]', 'stages = ["after"]', "supports.beside.stages", "there is no stage 'after'; allowed: before"),
    "in no stage": ('stages = ["before"]', "stages = []", "supports.beside.stages", "has 0 entries"),
    "moves where it does not hold": (
        "motions.top.translate", "motions.beside.translate", "stages.press.motions.beside", "which does not hold in that stage",
    ),
    "factor where it does not hold": (
        "motions.beside.translate = [0, 0, -0.01]", "loads.top = 1", "stages.before.loads.top", "does not hold in that stage",
    ),
}  # fmt: skip

#: A body in two stages, in the second of which nothing holds it.
LEFT = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
bodies.block.mesh.order = 1
supports.base = { face = "block.w0", stages = ["one"] }
stages = [{ name = "one", steps = 1 }, { name = "two", steps = 1 }]
"""

#: A pipe on a plane without friction, which rolls away where nothing holds it.
ROLLS = """
format = 1
bodies.pipe.geometry = { kind = "ring", inner = 0.7, outer = 1, width = 0.25 }
bodies.pipe.mesh = { order = [2, 2, 1], elements = [16, 1, 1] }
contacts.floor = { slave = "pipe.v1", plane = { point = [0, 0, -1] }, friction = 0 }
supports.side = { face = "pipe.w0", components = ["y"] }
supports.hold = { face = "pipe.v0", stages = ["touch"] }
loads.own = { body = "pipe", weight = [0, 0, -0.1] }
solver.max_cuts = 2
stages = [{ name = "touch", steps = 1, motions.hold.translate = [0, 0, -0.01] }, { name = "let-go", steps = 1 }]
"""
#: A bar that is bent by a moment about a horizontal axis, cut by a plane of symmetry.
HALVED = """
format = 1
bodies.bar.geometry = { kind = "box", lower = [0, -1, 0], upper = [2, 1, 0.6] }
bodies.bar.mesh = { family = "L", order = 2, elements = [2, 2, 1] }
supports.wall.face = "bar.u0"
supports.end = { face = "bar.u1", force.z = 0.1, moment = 0.2, axis = [0, 1, 0], centre = [2, 0, 0.3] }
stages = [{ name = "bend", steps = 2 }]
"""
#: The same for other scenes: the text, the field that the error names, and a part of its text.
ELSEWHERE = {
    "axis through the face": (
        LEFT.replace('stages = ["one"]', "moment = 0, axis = [0, 1, 0]").replace("upper = [1, 1, 1]", "upper = [1e-9, 1, 1]"),
        "supports.base.axis", "is along the line, or through the point,",
    ),
    "axis along the edge": (
        HALVED.replace('face = "bar.u1"', 'edge = "bar.u1.w1"'), "supports.end.axis", "how far they turn is not told",
    ),
    "nothing holds it": (LEFT, "bodies.block", "'block' is free to move in stage 'two'"),
    "rigid": (LEFT.replace("mesh.order = 1", "mesh.order = 1\nbodies.block.rigid = true"), "supports.base.stages", "'block' is rigid"),
    "out of the plane": (
        HALVED.replace("axis = [0, 1, 0]", "axis = [1, 0, 0]") + "symmetry = { y = 0.0 }\n",
        "supports.end.moment", "turns out of the plane",
    ),
}  # fmt: skip
