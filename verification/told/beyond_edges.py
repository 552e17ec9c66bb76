"""What is said of slaves whose elements go on beyond the edges of a narrow master, against forces of finer slaves."""

from __future__ import annotations

import re

import numpy as np
from told.runs import Heard

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A strip, and a punch of some half width that is pressed into it.
STRIP = """
format = 1
materials = { m = { young = 100, poisson = 0.3 }, k = { young = 100, poisson = 0.3 } }
bodies.s.material = "m"
bodies.s.geometry = { kind = "box", lower = [-2, 0, -2], upper = [2, 1, 0] }
bodies.s.mesh = { order = [2, 1, 2], elements = [4, 1, 2] }
bodies.p = { RIGID, geometry = { kind = "box", lower = [LEFT, -0.1, 0], upper = [RIGHT, 1.1, 0.5] }, mesh.elements = [8, 1, 4] }
contacts.c = { slave = "s.w1", master = "p.w0" }
supports.base.face = "s.w0"
supports.hand.face = "p.w1"
supports.front = { face = "s.v0", components = ["y"] }
supports.back = { face = "s.v1", components = ["y"] }
stages = [{ name = "press", steps = 1, motions.hand.translate = [0, 0, -0.02] }]
"""
#: The same of a block and a square punch.
BLOCK = (
    STRIP.replace("lower = [-2, 0, -2], upper = [2, 1, 0]", "lower = [-1, -1, -1], upper = [1, 1, 0]")
    .replace("-0.1, 0]", "LEFT, 0]").replace("1.1, 0.5]", "RIGHT, 0.5]")
    .replace("[8, 1, 4]", "[2, 2, 1]").partition("supports.front")[0] + STRIP[STRIP.index("stages") :]
)  # fmt: skip
#: A ring on a narrow foot, over which the other side of its face is as well; the foot is below, or at its seam.
RING = """
format = 1
materials.m = { young = 10, poisson = 0.3 }
bodies.s = { geometry = { kind = "ring", inner = 0.5, outer = 1, width = 1, centre = [0, 0, 1] }, mesh.elements = [8, 2, 2] }
bodies.p = { rigid = true, geometry = { kind = "box", lower = [-0.2, -1, LOW], upper = [0.2, 1, HIGH] } }
contacts.c = { slave = "s.v1", master = "p.SIDE", friction = 0.3 }
supports.foot.face = "p.OTHER"
supports.top.face = "s.v0"
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, WAY] }]
"""
BELOW = {"LOW": "-1", "HIGH": "0", "SIDE": "w1", "OTHER": "w0", "WAY": "-0.1"}
ABOVE = {"LOW": "2", "HIGH": "3", "SIDE": "w0", "OTHER": "w1", "WAY": "0.1"}
TOLD = re.compile(
    r"contact 'c', load step 1, the last of stage 'press': elements of its slave s\.\w1 are too long for its master, beyond whose edges "
    r"they go on: (.*) are over it, and too stiff\. Forces under given motions may be too large by about (\S+) %.* along "
    r"(\w(?: and \w)?) \(bodies\.s\."
)


def punch(text: str, half: float, soft: bool = False, at: float = 0.0) -> str:
    """A scene with a punch of some half width, rigid or not, at a place."""
    kind = 'material = "k"' if soft else "rigid = true"
    return text.replace("RIGID", kind).replace("LEFT", str(at - half)).replace("RIGHT", str(at + half))


def filled(text: str, words: dict[str, str]) -> str:
    """A text with some words in place of others."""
    for word, value in words.items():
        text = text.replace(word, value)
    return text


def run(text: str, elements: str, order: str = "[2, 1, 2]") -> tuple[list[tuple[str, ...]], float]:
    """What is said, and the force at the end."""
    changes, heard = [f"bodies.s.mesh.elements={elements}", f"bodies.s.mesh.order={order}"], Heard()
    *_, last = Simulation(Scene.from_toml(text, overrides=changes).problem(), heard).run()
    return [found.groups() for said in heard.said if (found := TOLD.search(said))], abs(float(last.contacts[0].force_slave[2]))


#: Slaves by order, elements, half width of the punch, and whether that is as soft as the slave.
COARSE: dict[str, tuple[str, str, float, bool]] = {
    "N1": ("[1, 1, 1]", "[16, 1, 8]", 0.1, False),
    "N2": ("[2, 1, 2]", "[4, 1, 2]", 0.1, False),
    "N2, soft": ("[2, 1, 2]", "[4, 1, 2]", 0.2, True),
    "N3": ("[3, 1, 3]", "[4, 1, 2]", 0.2, False),
}


@case(
    claim="Of a slave of each order whose elements go on beyond the edges of a narrow punch it is told, once, along the direction that "
    "is too coarse, and about by how much the force is too large; of one with finer elements, and right forces, nothing is said.",
    tier="gate",
    grid={"slave": tuple(COARSE)},
    bounds={
        "said": Bound(1.0, 1.0, "definition: sentences of the coarse slave, along u"),
        "off": Bound(at_least=0.08, reason="definition: share by which the force is too large: or there is nothing to tell of"),
        "told over off": Bound(at_least=0.5, at_most=4.0, reason="definition: an estimate, of which the order of magnitude counts"),
        "others": Bound(0.0, 0.0, "definition: sentences of the fine slave"),
        "left": Bound(at_most=0.1, reason="definition: what the force of the fine slave is off by"),
    },
)
def punches(slave: str) -> dict[str, float]:
    """What is said of both, and how far they are off one of order 2 and 80 elements."""
    order, elements, half, soft = COARSE[slave]
    text = punch(STRIP, half, soft, 0.13)
    _, right = run(text, "[80, 1, 40]")
    said, force = run(text, elements, order)
    others, finer = run(text, "[48, 1, 24]")
    off = force / right - 1.0
    told = float(said[0][1]) / 100.0 if said else 0.0
    along_u = [words for words in said if words[2] == "u" and "along v" not in words[0]]
    return {
        "said": float(len(along_u)),
        "off": off,
        "told over off": told / off,
        "others": float(len(others)),
        "left": abs(finer / right - 1.0),
    }


@case(
    claim="Of a square punch both directions are told; half of a strip, by a plane of symmetry, is told of as the whole is; nothing is "
    "said where a punch goes on beyond the slave, or is so soft that the slave need not follow.",
    tier="gate",
    bounds={
        "directions": Bound(1.0, 1.0, "definition: that u and v are told of a square punch"),
        "rings": Bound(1.0, 1.0, "definition: sentences of a ring on a foot below and of one at its seam, round it: the same"),
        "a half": Bound(at_most=0.0, reason="definition: shares that are told of a half less those of the whole, per cent"),
        "others": Bound(0.0, 0.0, "definition: sentences of a wide punch, and of a soft one"),
    },
)
def other_punches() -> dict[str, float]:
    """What is said of each."""
    square, _ = run(punch(BLOCK, 0.2), "[4, 4, 2]", "2")
    whole, _ = run(punch(STRIP, 0.2), "[4, 1, 2]")
    half, _ = run(punch(STRIP, 0.2) + "symmetry = { x = 0.0 }\n", "[4, 1, 2]")
    rings = [run(filled(RING, words), "[8, 2, 2]", "2")[0] for words in (BELOW, ABOVE)]
    wide, _ = run(punch(STRIP, 2.5), "[4, 1, 2]")
    soft, _ = run(punch(STRIP, 0.2, soft=True).replace("k = { young = 100,", "k = { young = 5,"), "[4, 1, 2]")
    apart = abs(float(half[0][1]) - float(whole[0][1])) if half and whole else np.inf
    return {
        "directions": float(bool(square) and square[0][2] == "u and v"),
        "rings": float(len({said[0] for said in rings})) if all(said and said[0][2] == "u" for said in rings) else np.inf,
        "a half": apart,
        "others": float(len(wide) + len(soft)),
    }


@case(
    claim="Of square punches both widths are told, within a quarter of an element in the mean, whatever their edges are near.",
    tier="gate",
    bounds={
        "other": Bound(0.0, 0.0, "definition: punches of which another number of sentences is said, or not to refine both ways"),
        "off": Bound(at_most=0.25, reason="definition: two of the eight parts of an element that are looked at; in elements"),
    },
)
def squares() -> dict[str, float]:
    """How many of four are told otherwise, and the largest difference of the mean of both widths."""
    other, off = 0, []
    for half in (0.17, 0.23, 0.3, 0.35):
        said, _ = run(punch(BLOCK, half), "[4, 4, 2]", "2")
        other += [words[2] for words in said] != ["u and v"]
        off += [abs(float(np.mean([float(width) for width in re.findall(r"(\S+) along", words[0])])) - 4.0 * half) for words in said]
    return {"other": float(other), "off": float(np.max(off, initial=0.0))}
