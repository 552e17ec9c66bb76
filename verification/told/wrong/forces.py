"""Forces that supports cannot exert."""

from __future__ import annotations

# A pad above a rigid die, which a force presses down; each case below changes one place.
GOOD = """
format = 1
[bodies.pad]
geometry = { kind = "box", lower = [0, 0, 0.03], upper = [1, 1, 0.5] }
mesh = { order = 2, elements = [2, 2, 1] }
[bodies.die]
rigid = true
geometry = { kind = "box", lower = [-1, -1, -1], upper = [2, 2, 0] }
mesh = { order = 1 }
[contacts.die]
slave = "pad.w0"
master = "die.w1"
friction = 0.2
[supports.top]
face = "pad.w1"
force.z = -0.3
[supports.die]
face = "die.w0"
[[stages]]
name = "press"
steps = 2
[[stages]]
name = "drag"
steps = 2
motions.top.translate = [0.05, 0, 0]
loads.top = 1.5
"""

_BESIDE = '[supports.beside]\nface = "pad.u0"\n{}\n[supports.die]'
# What is replaced, by what, the field that the error names, and a part of its text.
WRONG = {
    "not a number": ("force.z = -0.3", "force.z = nan", "supports.top.force.z", "allowed: a finite number"),
    "absurd force": ("force.z = -0.3", "force.z = -1e160", "supports.top.force", "is 1e+160 large; allowed: up to "),
    "another component": ("force.z = -0.3", "force.w = -0.3", "supports.top.force.w", "unknown key; allowed here: x, y, z"),
    "by components too": (
        "force.z = -0.3", 'force.z = -0.3\ncomponents = ["y", "z"]', "supports.top", "prescribes z both by components and by force",
    ),
    "no components": ("force.z = -0.3", "force.z = -0.3\ncomponents = []", "supports.top.components", "has 0 entries"),
    "moved too": ("[0.05, 0, 0]", "[0.05, 0, -0.1]", "stages.drag.motions.top.translate", "moves support 'top' along z"),
    "moment": ("force.z = -0.3", "moment.y = 0", "supports.top", "turns about one axis; allowed: moment, a number"),
    "no such load": ("loads.top = 1.5", "loads.tip = 1.5", "stages.drag.loads.tip", "nor a support with a force or a moment; allowed: top"),
    "name of a load": (
        "[supports.die]", '[loads.top]\nface = "pad.u0"\npressure = 1\n[supports.die]', "supports.top", "is the name of a load as well",
    ),
    "prescribed beside": ("[supports.die]", _BESIDE.format('components = ["z"]'), "supports.top.force", "moves 4 control points along z"),
    "pressed beside": (
        "[supports.die]", _BESIDE.format('components = ["x"]\nforce.z = 1'), "supports.top.force", "and so does support 'beside'",
    ),
    "pressure on it": (
        "[supports.die]", '[loads.wind]\nface = "pad.w1"\npressure = 1\n[supports.die]', "loads.wind.face", "or their forces",
    ),
    "traction on it": (
        "[supports.die]", '[loads.pull]\nface = "pad.w1"\ntraction = [0, 0, 1]\n[supports.die]', "loads.pull.traction", "acts along z",
    ),
}  # fmt: skip

#: A block that is cut by a plane of symmetry.
HALVED = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, -1, 0], upper = [2, 1, 0.6] }
bodies.block.mesh = { family = "L", order = 2, elements = [2, 2, 1] }
supports.wall.face = "block.u0"
supports.end = { face = "block.u1", FORCE }
stages = [{ name = "load", steps = 1 }]
"""
