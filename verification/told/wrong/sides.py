"""Faces that make no side of a contact."""

from __future__ import annotations

# Four boxes round a line, of which three are glued in a row, and a block above them; each case below changes one place.
GOOD = """
format = 1
glue = [["a.u1", "b.u0"], ["a.v1", "c.v0"]]
bodies.a = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { elements = [1, 2, 1] } }
bodies.b = { geometry = { kind = "box", lower = [1, 0, 0], upper = [2, 1, 1] }, mesh = { elements = [2, 2, 1] } }
bodies.c = { geometry = { kind = "box", lower = [0, 1, 0], upper = [1, 2, 1] }, mesh = { elements = [1, 1, 1] } }
bodies.d = { geometry = { kind = "box", lower = [1, 1, 0], upper = [2, 2, 1] }, mesh = { elements = [2, 1, 1] } }
bodies.block = { geometry = { kind = "box", lower = [0.5, 0.25, 1], upper = [1.5, 0.75, 2] } }
contacts.pair = { slave = "block.w0", master = ["a.w1", "b.w1"] }
supports.low = { face = "a.w0" }
supports.far = { face = "d.w0" }
supports.top = { face = "block.w1" }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.02] }]
"""
ALL = '["a.w1", "b.w1", "c.w1", "d.w1"]'
PAIR = '["a.w1", "b.w1"]'

#: What is replaced, by what; the field that the error names, and a part of its text.
WRONG = {
    "no face": (PAIR, "[]", "contacts.pair.master", "has 0 entries; allowed: at least 1"),
    "nobody": (PAIR, '["a.w1", "e.w1"]', "contacts.pair.master", "there is no body 'e'"),
    "twice": (PAIR, '["a.w1", "b.w1", "a.w1"]', "contacts.pair.master", "names a.w1 twice"),
    "not glued": (PAIR, ALL, "contacts.pair.master", "a.w1, b.w1, c.w1, d.w1: d.w1 has no whole edge in common with the others"),
    "a corner only": (PAIR, '["b.w1", "c.w1"]', "contacts.pair.master", "b.w1, c.w1: c.w1 has no whole edge in common with the others"),
    "no rectangle": (PAIR, '["a.w1", "b.w1", "c.w1"]', "contacts.pair.master", "in 2 x 2 places there are 3"),
    "apart": (PAIR, '["a.w1", "b.u1"]', "contacts.pair.master", "a.w1, b.u1: b.u1 has no whole edge in common"),
    "inside": (PAIR, '["a.w1", "a.u1"]', "contacts.pair.master", "is a.u1, which is glued to b.u0"),
    "orders": (
        "mesh = { elements = [2, 2, 1] }",
        "mesh = { order = [3, 2, 2], elements = [2, 2, 1] }",
        "contacts.pair.master",
        "a.w1, b.w1: a.w1 has order 2 (N) along u, and b.w1, which goes on from there, order 3 (N) along u; give both the same",
    ),
    "both sides": ('"block.w0"', '["a.w1", "b.w1"]', "contacts.pair.master", "is the slave face 'a.w1, b.w1' itself"),
    "one on both sides": ('"block.w0"', '["b.w1"]', "contacts.pair.master", "has b.w1 in common with the slave"),
}
