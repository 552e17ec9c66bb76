"""Loads that cannot be meant."""

from __future__ import annotations

# Two blocks that are glued, on a rigid die, under loads of all kinds; each case below changes one place.
GOOD = """
format = 1
glue = [["left.u1", "right.u0"]]
[bodies.left]
geometry = { kind = "box", lower = [-1, -1, 0.02], upper = [0, 1, 0.5] }
mesh = { order = 2, elements = [2, 2, 1] }
[bodies.right]
geometry = { kind = "box", lower = [0, -1, 0.02], upper = [1, 1, 0.5] }
mesh = { order = 2, elements = [2, 2, 1] }
[bodies.die]
rigid = true
geometry = { kind = "box", lower = [-2, -2, -1], upper = [2, 2, 0] }
mesh = { order = 1 }
[bodies.thick]
geometry = { kind = "box", lower = [5, 5, 0], upper = [6, 6, 1] }
mesh = { order = 2, contact_order = 4 }
[contacts.die]
slave = ["left.w0", "right.w0"]
master = "die.w1"
[contacts.floor]
slave = "thick.w0"
plane = { point = [0, 0, -1] }
[supports.west]
face = "left.u0"
components = ["x", "y"]
[supports.thick]
face = "thick.w1"
[loads.own]
body = "right"
weight = [0, 0, -0.2]
[loads.wind]
face = "left.w1"
pressure = 0.1
[loads.pull]
face = "right.u1"
traction = [0, 0, -0.05]
[[stages]]
name = "settle"
steps = 2
[[stages]]
name = "gust"
steps = 2
loads = { wind = 2.0, pull = 1.0 }
"""

# What is replaced, by what, the field that the error names, and a part of its text.
WRONG = {
    "no body": ('body = "right"', 'body = "write"', "loads.own.body", "there is no body 'write'; allowed: right"),
    "no face": ('face = "right.u1"', 'face = "right.u2"', "loads.pull.face", "right has no face 'u2'"),
    "no size": ("pressure = 0.1", "", "loads.wind", "has no size; allowed: exactly one of"),
    "two sizes": ("pressure = 0.1", "pressure = 0.1\ntraction = [1, 0, 0]", "loads.wind", "has pressure and traction"),
    "weight on a face": ('body = "right"', 'face = "right.u1"', "loads.own", "is a weight; allowed: body, and no face"),
    "pressure on a body": ('face = "left.w1"', 'body = "left"', "loads.wind", "is a pressure; allowed: face, and no body"),
    "not a number": ("pressure = 0.1", "pressure = nan", "loads.wind.pressure", "allowed: a finite number"),
    "two components": ("[0, 0, -0.05]", "[0, -0.05]", "loads.pull.traction", "allowed: a list of 3 numbers"),
    "unknown key": ("pressure = 0.1", "pressures = 0.1", "loads.wind.pressures", "unknown key; allowed here: pressure"),
    "no load": ("{ wind = 2.0,", "{ window = 2.0,", "stages.gust.loads.window", "nor a support with a force or a moment; allowed: wind"),
    "no factor": ("{ wind = 2.0,", "{ wind = inf,", "stages.gust.loads.wind", "allowed: a finite number"),
    "absurd pressure": ("pressure = 0.1", "pressure = -1e200", "loads.wind.pressure", "is 1e+200 large; allowed: up to 1e+11, "),
    "absurd weight": ("weight = [0, 0, -0.2]", "weight = [0, 0, 1e160]", "loads.own.weight", "allowed: up to 5e+10, "),
    "absurd factor": ("{ wind = 2.0,", "{ wind = 1e300,", "stages.gust.loads.wind", "allowed: up to 1e+12, "),
    "rigid": ('body = "right"', 'body = "die"', "loads.own.body", "is on body 'die', which is rigid"),
    "face of a rigid body": ('face = "left.w1"', 'face = "die.w0"', "loads.wind.face", "is on body 'die', which is rigid"),
    "inside": ('face = "left.w1"', 'face = "left.u1"', "loads.wind.face", "which is glued to right.u0"),
    "held altogether": ('face = "left.w1"', 'face = "thick.w1"', "loads.wind.face", "the pressure would do nothing"),
    "held component": (
        'face = "right.u1"\ntraction = [0, 0, -0.05]', 'face = "left.u0"\ntraction = [0, 2, -1]', "loads.pull.traction", "acts along y",
    ),
    "beside a raised face": ('face = "left.w1"', 'face = "thick.u0"', "loads.wind.face", "functions of 'thick' are of another order at w0"),
}  # fmt: skip

#: A block that is cut by a plane of symmetry.
HALVED = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, -1, 0], upper = [2, 1, 0.6] }, mesh = { elements = [2, 2, 1] } }
symmetry = { y = 0.0 }
supports.wall.face = "block.u0"
loads.LOAD
stages = [{ name = "load", steps = 1 }]
"""
UNEVEN = {
    "through the plane": ('own = { body = "block", weight = [0, 1, 0] }', "loads.own.weight", "acts along y, through the plane y = 0"),
    "beside the plane": ('wind = { face = "block.v1", pressure = 1 }', "loads.wind.face", "a face beside the plane y = 0"),
}
