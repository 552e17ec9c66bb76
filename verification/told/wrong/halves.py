"""Scenes that are not symmetric."""

from __future__ import annotations

PLANE = """
format = 1
[bodies.block]
geometry = { kind = "box", lower = [-0.5, 2.0, 0.0], upper = [0.5, 2.8, 0.5] }
mesh = { family = "L", order = [2, 2, 1], elements = [4, 4, 2] }
[contacts.floor]
slave = "block.w0"
plane = {}
friction = 0.2
[supports.top]
face = "block.w1"
centre = [0.1, 2.5, 0.3]
[solver]
newton_tolerance = 1e-12
complementarity_tolerance = 1e-12
[[stages]]
name = "press"
steps = 2
motions.top.translate = [0, 0, -0.04]
"""
BOX = 'kind = "box", lower = [-0.5, 2.0, 0.0], upper = [0.5, 2.8, 0.5]'
RING = 'kind = "ring", inner = 0.3, outer = 0.5, width = 1, axis = "z"'
BESIDE = """[bodies.lower]
geometry = { kind = "box", lower = [-0.5, 2.0, -0.6], upper = [0.5, 2.8, -0.1] }
mesh = { elements = [4, 4, 2] }
"""
PUSH = '[[stages]]\nname = "push"\nsteps = 2\nmotions.top.translate = [0.1, 0, 0]\n'
TURN = '[[stages]]\nname = "turn"\nsteps = 1\nmotions.top.rotate = 20.0\n'

REFUSED = {
    "off the middle": (PLANE, "x = 0.1", "bodies.block", "is not its own mirror image in the plane x = 0.1"),
    "on one side": (
        PLANE,
        "x = -0.5",
        "bodies.block",
        "it is all on one side: symmetry takes whole bodies, and halves them. Give the whole",
    ),
    "closed": (
        PLANE.replace(BOX, RING).replace('family = "L", order = [2, 2, 1], ', ""),
        "x = 0.0",
        "bodies.block",
        "a closed body never is, as it begins on one side. Give half of it",
    ),
    "an odd number": (
        PLANE.replace("[4, 4, 2]", "[5, 4, 2]"),
        "x = 0.0",
        "bodies.block.mesh.elements",
        "is 5 in direction u, which the plane x = 0 halves; allowed there: even numbers",
    ),
    "a motion": (PLANE + PUSH, "x = 0.0", "stages.push.motions.top.translate", "goes along x, through the plane x = 0"),
    "a turn": (PLANE + TURN, "x = 0.0", "stages.turn.motions.top.rotate", "turns out of the plane x = 0"),
    "a rigid plane": (
        PLANE.replace("plane = {}", "plane = { normal = [0.1, 0, 1], point = [0, 0, -1] }"),
        "x = 0.0",
        "contacts.floor.plane",
        "is not its own mirror image in the plane x = 0",
    ),
    "a rigid plane, the other way": (
        PLANE.replace("plane = {}", "plane = { normal = [-0.1, 0, 1], point = [0, 0, -1] }"),
        "x = 0.0",
        "contacts.floor.plane",
        "is not its own mirror image in the plane x = 0",
    ),
    "a face beside": (
        PLANE.replace('face = "block.w1"', 'face = "block.u1"'),
        "x = 0.0",
        "supports.top.face",
        "a face beside the plane x = 0",
    ),
    "a name": (
        PLANE.replace("[supports.top]", "[supports.symmetry-x-block]").replace("motions.top", "motions.symmetry-x-block"),
        "x = 0.0",
        "supports.symmetry-x-block",
        "is what symmetry calls a support of its own",
    ),
    "no axis": (PLANE, "a = 0.0", "symmetry", "is 'a'; allowed: 'x', 'y' or 'z'"),
    "not finite": (PLANE, "x = nan", "symmetry.x", "finite"),
}
