"""Faces that cannot be glued."""

from __future__ import annotations

# Two halves of a block side by side, and a body of its own; each case below changes one place.
GOOD = """
format = 1
glue = [["a.u1", "b.u0"]]
bodies.a = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = 2, elements = [1, 2, 1] } }
bodies.b = { geometry = { kind = "box", lower = [1, 0, 0], upper = [2, 1, 1] }, mesh = { order = 2, elements = [1, 2, 1] } }
bodies.c = { geometry = { kind = "box", lower = [5, 0, 0], upper = [6, 1, 1] } }
contacts.floor = { slave = "a.w0", plane = { point = [0, 0, -0.1] } }
supports.left = { face = "a.u0" }
supports.alone = { face = "c.u0" }
stages = [{ name = "pull", steps = 2, motions.left.translate = [0.1, 0, 0] }]
"""
PATCHED = """bodies.b.patch = { order = 1, knots = [[0, 0, 1, 1], [0, 0, KNOT, 1, 1], [0, 0, 1, 1]], control_points = [
    [1, 0, 0], [2, 0, 0], [1, MIDDLE, 0], [2, 0.5, 0], [1, 1, 0], [2, 1, 0],
    [1, 0, 1], [2, 0, 1], [1, MIDDLE, 1], [2, 0.5, 1], [1, 1, 1], [2, 1, 1]], weights = [1, 1, WEIGHT, 1, 1, 1, 1, 1, 1, 1, 1, 1] }
bodies.b.mesh = {}"""
B = GOOD.splitlines()[4]
PLAIN = GOOD.replace(B, PATCHED).replace("order = 2, elements = [1, 2, 1]", "order = 1, elements = [1, 2, 1]")


def patched(knot: str = "0.5", middle: str = "0.5", weight: str = "1") -> str:
    """The scene with a second half that is given point by point."""
    return PLAIN.replace("KNOT", knot).replace("MIDDLE", middle).replace("WEIGHT", weight)


#: The scene, the field that the error names, and a part of its text.
WRONG = {
    "nobody": (GOOD.replace('"b.u0"', '"d.u0"'), "glue.0", "there is no body 'd'; allowed: BODY.FACE with BODY one of a, b, c"),
    "no face": (GOOD.replace('"b.u0"', '"b.u2"'), "glue.0", "b has no face 'u2'"),
    "three faces": (GOOD.replace('"b.u0"]', '"b.u0", "c.u0"]'), "glue.0", "allowed: at most 2"),
    "itself": (GOOD.replace('"b.u0"', '"a.u0"'), "glue.0", "joins two faces of 'a'; a body that meets itself is closed: bodies.a.closed"),
    "twice": (GOOD.replace('["a.u1",', '["b.u0", "a.u1"], ["a.u1",'), "glue.1", "joins a.u1 to b.u0, and it is glued to b.u0 already"),
    "apart": (GOOD.replace('"b.u0"', '"c.u0"'), "glue.0", "do not conform: corners are up to 4 apart (at 1, 0, 0)"),
    "another face": (GOOD.replace('"b.u0"', '"b.u1"'), "glue.0", "corners are up to 1 apart"),
    "order": (
        GOOD.replace(B, B.replace("order = 2", "order = [2, 2, 3]")),
        "glue.0",
        "a has order 2 along w, b order 3 along w. Glued faces share",
    ),
    "family": (
        GOOD.replace(B, B.replace("order = 2", 'family = "L", order = 2')),
        "glue.0",
        "a has family N along v, b family L along v",
    ),
    "elements": (
        GOOD.replace(B, B.replace("[1, 2, 1]", "[1, 3, 1]")),
        "glue.0",
        "a has 2 elements along v, b 3 elements along v",
    ),
    "knots": (patched(knot="0.4"), "glue.0", "knots of a along v and those of b along v differ by up to 0.1 of their range"),
    "weights": (patched(weight="1.5"), "glue.0", "weights, over that of a corner, differ by up to 0.333 of their size (at 1, 0.5, 0)"),
    "points": (patched(middle="0.501"), "glue.0", "control points are up to 0.001 apart (at 1, 0.5, 0)"),
    "inside": (
        GOOD.replace('"a.w0"', '"a.u1"'),
        "contacts.floor.slave",
        "is a.u1, which is glued to b.u0: it lies inside; name an outer face",
    ),
    "free": (GOOD.replace('"a.u0"', '"c.u1"'), "bodies.a", "body 'a' (glued to 'b') is free"),
    "turns": (
        GOOD.replace("contacts.floor", "#").replace('"a.u0" }', '"a.u0", components = ["x"] }'),
        "bodies.a",
        "body 'a' (glued to 'b') is free to move",
    ),
    "conflict": (
        GOOD.replace("supports.left", 'supports.front = { face = "b.v0" }\nsupports.left').replace('u0" }', 'v0" }'),
        "supports.left",
        "prescribes x of 3 control points (the first at 1, 0, 0) that support 'front' moves differently",
    ),
}
