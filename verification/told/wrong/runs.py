"""Scenes that run, and what is doubtful of how they go."""

from __future__ import annotations

from told.wrong.contacts import PAIR, PRESS, RINGS, TYRE

#: With elements that carry its narrow contact.
PRESSED = PRESS.replace("[2, 2, 1]", "[4, 4, 1]")
#: A law of small strains.
LINEAR = PRESS.replace("[bodies.block]", '[materials.steel]\nlaw = "linear-elastic"\n[bodies.block]')
#: A column that is free to widen: by this law it gives way at 0.38 of its height, and is as narrow as high from there on.
SHRINKING = """
format = 1
materials.foam = { young = 1.0, poisson = 0.3, law = "neo-hookean-j" }
bodies.b = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh.elements = [2, 2, 1] }
contacts.c = { slave = "b.w0", plane = {}, friction = 0 }
supports.top = { face = "b.w1", components = ["z"] }
supports.x = { face = "b.u0", components = ["x"] }
supports.y = { face = "b.v0", components = ["y"] }
stages = [{ name = "press", steps = 7, motions.top.translate = [0, 0, -0.7] }]
"""


def staged(text: str, *stages: tuple[int, str, str]) -> str:
    """A scene with other stages: load steps, and the translation and turn of its top."""
    text = text.replace('face = "block.w1"', 'face = "block.w1"\naxis = [0, 1, 0]\ncentre = [0, 0, 0.8]')
    tables = [f'name = "{k}"\nsteps = {n}\nmotions.top = {{ translate = {u}, rotate = {a} }}' for k, (n, u, a) in enumerate(stages)]
    return text[: text.index("[[stages]]")] + "".join(f"[[stages]]\n{table}\n" for table in tables)


WRONG_FACE = PAIR.replace('"lower.w1"', '"lower.w0"')
#: It tilts on its way, so that a first look does not know where it goes.
FAR_SIDE = WRONG_FACE.replace("-0.1]\n", "-0.7]\nmotions.top.rotate = 1\n").replace('"upper.w1"', '"upper.w1"\naxis = [0, 1, 0]')
OTHER_FACE = PRESS.replace('slave = "block.w0"', 'slave = "block.w1"').replace(
    'face = "block.w1"', 'face = "block.w0"\naxis = [0, 1, 0]\ncentre = [0, 0, 0.8]'
)
#: Forces on control points at corners are negative where their functions are, though all of the pressure presses.
DIE = """
format = 1
[bodies.block]
geometry = { kind = "box", lower = [-0.5, -0.3, 0.0], upper = [0.5, 0.3, 0.4] }
mesh = { family = "L", order = [2, 2, 1], elements = [2, 2, 2] }
[bodies.die]
rigid = true
geometry = { kind = "bowl", half_width = 0.6, bottom = 0.4, rise = 0.1, top = 0.8 }
[contacts.die]
slave = "block.w1"
master = "die.w0"
friction = 0.0
[supports.floor]
face = "block.w0"
[supports.die]
face = "die.w1"
[[stages]]
name = "press"
steps = 1
motions.die.translate = [0, 0, -0.04]
"""
DOWN, UP, STAY = "[0, 0, -0.1]", "[0, 0, 0.3]", "[0, 0, 0]"
PLATE = """
format = 1
[bodies.b]
geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, THICKNESS] }
mesh = { order = [4, 1, 2], elements = [2, 1, 1] }
[supports.root]
face = "b.u0"
TIP
[[stages]]
name = "move"
steps = 1
MOTION
"""
#: A ball that is pressed onto a plane beside its poles, on elements of a quarter of its circumference.
BALL = """
format = 1
[bodies.ball]
geometry = { kind = "sphere", centre = [0, 0, 0.5], inner = 0.2, outer = 0.5, axis = "x" }
mesh = { order = 2, elements = [4, 1, 4] }
[contacts.floor]
slave = "ball.v1"
plane = {}
[supports.core]
face = "ball.v0"
[[stages]]
name = "press"
steps = 2
motions.core.translate = [0, 0, -0.05]
"""
#: A tyre that is 0.02 deep in its road.
LOW_TYRE = TYRE.replace("normal = [0, 0, 1]", "point = [0, 0, 0.02], normal = [0, 0, 1]")
#: Scene, and the contact's and words of the warnings of a run of it: none for sound ones.
RUNS = {
    "pressed": (staged(PRESSED, (2, DOWN, "0"), (2, STAY, "0")), []),
    "pressed by elements that are too long": (
        staged(PRESS, (2, DOWN, "0"), (2, STAY, "0")),
        ["load step 2, the last of"],
    ),
    "lifted at the end": (staged(PRESSED, (2, DOWN, "0"), (1, UP, "0")), []),
    "lifted and pressed again": (staged(PRESSED, (1, DOWN, "0"), (3, UP, "0"), (1, "[0, 0, -0.3]", "0")), []),
    "lifted for good": (staged(PRESSED, (2, DOWN, "0"), (3, UP, "0")), ["opened in load step 3 and stayed open"]),
    "rolling": (  # by an element: its averaged gaps are open where control points are beside the lowest line
        LOW_TYRE.replace("[16, 1, 1]", "[24, 1, 1]").replace("rotate = 30", "rotate = 15"),
        [],
    ),
    "rolling by elements that are too long": (LOW_TYRE.replace("rotate = 30", "rotate = 22.5"), ["load step 1, the last of"]),
    "slid off": (
        staged(PAIR, (2, "[0, 0, -0.05]", "0"), (10, "[2.5, 0, 0]", "0")),
        [
            "too long for it",
            "left the master",
            "coefficients are large of which little is over it",
            "wholly beside",
            "opened in load step 8",
        ],
    ),
    "slid off in one load step": (staged(PAIR, (1, DOWN, "0"), (1, "[0, 2.5, 0]", "0")), ["wholly beside"]),
    "beside from the first load step on": (staged(PAIR, (1, "[0, 2.5, 0]", "0")), ["wholly beside", "never closed"]),
    "turned over and pushed through": (
        staged(PRESS, (1, "[0, 0, 1]", "0"), (4, STAY, "180"), (4, "[0, 0, -2.7]", "0")),
        ["it pulls", "is behind the plane of contact 'floor'"],
    ),
    "turned over and pressed": (staged(OTHER_FACE, (4, "[0, 0, 0.5]", "180"), (2, "[0, 0, -1.35]", "0")), []),
    "far side of the master": (FAR_SIDE, ["it pulls", "keeps its face upper.v0 from it"]),
    "far side of the master, by Uzawa": (FAR_SIDE + '[solver]\nmethod = "uzawa"', ["it pulls", "keeps its face upper.v0 from it"]),
    "outside of a ring": (
        RINGS.replace('"outside.v0"', '"outside.v1"'),
        ["it pulls", "keeps its face inside.w0 from it", "keeps its face outside.v0 from it"],
    ),
    "shrink fit": (RINGS, []),
    "small strains": (LINEAR.replace("[2, 2, 1]", "[4, 4, 1]"), []),
    "small strains that are large": (
        LINEAR.replace("-0.1]", "-0.3]").replace("[2, 2, 1]", "[4, 4, 1]"),
        ["load step 1: its law, linear-elastic"],
    ),
    "small strains, turned": (staged(LINEAR, (3, "[0, 0, 0.1]", "-9")), ["a strain of 0.0057 here", "never closed"]),
    "shrunk": (SHRINKING, ["load step 7: it is pressed to 0.034 of its volume, and below 0.4 its law"]),
    "not shrunk": (SHRINKING.replace("-0.7]", "-0.45]"), []),
    "quadratic Lagrange elements pressed within": (DIE, []),
    "pressed in between constraints": (BALL, ["never closed: it was open at the end of every load step, although slave points were up to"]),
    "pressed in where constraints see it": (BALL.replace("[4, 1, 4]", "[24, 1, 24]"), []),
    "pressed within, averaged normals": (DIE.replace("friction", 'projection = "averaged"\nfriction'), []),
}
