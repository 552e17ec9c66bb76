"""Rigid bodies that cannot be."""

from __future__ import annotations

# A block on a rigid die of two boxes side by side; each case below changes one place.
GOOD = """
format = 1
glue = [["left.u1", "right.u0"]]
materials.rubber = { young = 5 }
materials.cork = {}
[bodies.block]
material = "rubber"
geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }
mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
[bodies.left]
rigid = true
geometry = { kind = "box", lower = [-1, -1, -1], upper = [0.5, 2, 0] }
mesh = { order = 1, elements = [1, 2, 1] }
[bodies.right]
rigid = true
geometry = { kind = "box", lower = [0.5, -1, -1], upper = [2, 2, 0] }
mesh = { order = 1, elements = [2, 2, 1] }
[contacts.die]
slave = "block.w0"
master = ["left.w1", "right.w1"]
[supports.top]
face = "block.w1"
[supports.die]
face = "right.w0"
centre = [0.5, 0.5, -1]
[[stages]]
name = "press"
steps = 2
motions.die = { translate = [0, 0, 0.04], rotate = 4 }
"""

#: What is changed, the field that the error names, and a part of its text.
WRONG = {
    "material": (
        'rigid = true\ngeometry = { kind = "box", lower = [0.5',
        'rigid = true\nmaterial = "cork"\ngeometry = { kind = "box", lower = [0.5',
        "bodies.right",
        "but has material;",
    ),
    "quadrature": (
        "elements = [2, 2, 1] }\n[contacts",
        "elements = [2, 2, 1], quadrature = 3 }\n[contacts",
        "bodies.right",
        "but has mesh.quadrature;",
    ),
    "no word": (
        'rigid = true\ngeometry = { kind = "box", lower = [0.5',
        'rigid = 1\ngeometry = { kind = "box", lower = [0.5',
        "bodies.right.rigid",
        "allowed: ",
    ),
    "two supports": (
        "[supports.die]",
        '[supports.other]\nface = "left.u0"\n[supports.die]',
        "supports.die.face",
        "goes as a whole with support 'other'",
    ),
    "components": ("centre = [0.5", 'components = ["z"]\ncentre = [0.5', "supports.die.components", "are z, but body 'right' is rigid"),
    "glued to what deforms": (
        'rigid = true\ngeometry = { kind = "box", lower = [0.5',
        'material = "cork"\ngeometry = { kind = "box", lower = [0.5',
        "glue.0",
        "joins right.u0 to left.u1 of a rigid body",
    ),
    "both rigid": (
        '[bodies.block]\nmaterial = "rubber"',
        "[bodies.block]\nrigid = true",
        "contacts.die.slave",
        "is block.w0, of a rigid body, and its master is rigid too",
    ),
    "on a plane": (
        'slave = "block.w0"\nmaster = ["left.w1", "right.w1"]',
        'slave = "left.w0"\nplane = { point = [0, 0, -1] }',
        "contacts.die.slave",
        "is left.w0, of a rigid body",
    ),
}
