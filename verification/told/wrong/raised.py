"""Orders that a face in contact cannot have."""

from __future__ import annotations

# A block between a plate and a base that is glued to another; each case below changes one place.
GOOD = """
format = 1
[bodies.block]
geometry = { kind = "bowl", half_width = 0.4, bottom = 0.01, rise = 0.1, top = 0.6 }
mesh = { order = [2, 2, 1], elements = [2, 2, 1], contact_order = 3 }
[bodies.base]
geometry = { kind = "box", lower = [-0.5, -0.5, -0.5], upper = [0.5, 0.5, 0] }
mesh = { order = [2, 1, 1], elements = [2, 3, 1], contact_order = 3 }
[contacts.pair]
slave = "block.w0"
master = "base.w1"
friction = 0.2
projection = "closest"
[supports.top]
face = "block.w1"
[supports.ground]
face = "base.w0"
[[stages]]
name = "press"
steps = 2
motions.top.translate = [0.01, 0, -0.05]
"""
_BESIDE = """
[bodies.beside]
geometry = { kind = "box", lower = [0.5, -0.5, -0.5], upper = [1, 0.5, 0] }
mesh = { order = [2, 1, 1], elements = [2, 3, 1] }
[contacts.pair]"""
#: What is changed, the field that the error names, and a part of its text.
WRONG = {
    "not above the order": ("1], contact_order = 3", "1], contact_order = 2", "block.mesh.contact_order", "2 along w0; allowed there: 3"),
    "too high": ("1], contact_order = 3", "1], contact_order = 11", "block.mesh.contact_order", "11 along w0"),
    "Lagrange elements": ("order = [2, 1, 1]", 'family = ["L", "N", "N"], order = [2, 1, 1]', "base.mesh.contact_order", "of NURBS"),
    "no face in contact": (
        "[contacts.pair]", _BESIDE.replace("3, 1]", "3, 1], contact_order = 3"), "beside.mesh.contact_order", "'beside' has none",
    ),
    "two faces in contact": (
        "[contacts.pair]", _BESIDE.replace("[con", '[contacts.side]\nslave = "base.u1"\nmaster = "beside.u0"\n[con'),
        "base.mesh.contact_order", "of 'base' are u1, w1",
    ),
    "rigid": ("[bodies.base]", "[bodies.base]\nrigid = true", "base.mesh.contact_order", "the body is rigid"),
    "glued": ("[contacts.pair]", _BESIDE, "glue.0", "joins 'base', whose order at w1"),
}  # fmt: skip


def wrong(name: str) -> str:
    """A scene with a fault."""
    old, new, *_ = WRONG[name]
    text = GOOD.replace(old, new, 1)
    return text.replace("format = 1", 'format = 1\nglue = [["base.u1", "beside.u0"]]') if name == "glued" else text
