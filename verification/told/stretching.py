"""What is said of thin bodies that loads and contact bend, or would bend if their elements did not lock, and of such as stretch."""

from __future__ import annotations

import re

import numpy as np
from told.runs import Heard

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

HEAD = 'format = 1\nmaterials.m = { young = 1, poisson = 0.3 }\nstages = [{ name = "bend", steps = 1 HAND }]\n'
_MESH = "bodies.b.mesh = { family = [FAMILY, 'N', 'N'], order = [ORDER, ACROSS, 2], elements = [MANY, WIDE, 1] }\n"
#: A part of a ring, held at both ends, at one, or so that it is half a pipe; a beam, a plate, a sheet with a thin skin.
RING = 'bodies.b.geometry = { kind = "ring", inner = INNER, outer = 1, width = 0.1, axis = "y", angles = ANGLES }\n' + _MESH
ONCE, BOTH = 'supports.wall.face = "b.u0"\n', 'supports = { wall.face = "b.u0", other.face = "b.u1" }\n'
PIPE = """supports.wall = { face = "b.u0", components = ["x", "y"] }
supports.edge = { edge = "b.u0.v0", components = ["z"] }
supports.other = { face = "b.u1", components = ["x", "y"] }
"""
BOX = 'bodies.b.geometry = { kind = "box", lower = [0, 0, 0], upper = [2, WIDTH, 0.02] }\n' + _MESH
ROUND = BOTH.replace(" }\n", ', n.face = "b.v0", m.face = "b.v1" }\n')
SKIN = """materials.h = { young = 1000, poisson = 0.3 }
bodies.b.material = "m"
bodies.c.material = "h"
bodies.c.geometry = { kind = "box", lower = [0, 0, 0.02], upper = [2, WIDTH, 0.022] }
bodies.c.mesh = { order = [ORDER, ACROSS, 2], elements = [MANY, WIDE, 1] }
glue = [["b.w1", "c.w0"]]
supports = { wall.face = "b.u0", other.face = "b.u1", over.face = "c.u0", end.face = "c.u1" }
"""
WITHIN, ABOVE = 'loads.p = { face = "b.v0", pressure = 1e-8 }\n', 'loads.p = { face = "b.w1", pressure = 1e-8 }\n'
WEIGHT = 'loads.p = { body = "b", weight = [0, 0, -1e-8] }\n'
#: A cylinder on the top of an arch, a bed below a beam that is pressed on it, more at one end, and a core that is squeezed within a pipe.
ROLL = """bodies.roll.rigid = true
bodies.roll.mesh = { order = 2, elements = [16, 1, 1] }
bodies.roll.geometry = { kind = "ring", inner = 0.05, outer = 0.2, width = 0.3, axis = "y", centre = [0, 0.05, 1.2], angles = [90, 270] }
supports = { hand.face = "roll.v0", wall.face = "b.u0", other.face = "b.u1" }
contacts.c = { slave = "roll.v1", master = "b.v1" }
"""
BED = """materials.s = { young = 1e-2, poisson = 0 }
bodies.b.material = "m"
bodies.bed.material = "s"
bodies.bed.geometry = { kind = "box", lower = [0, 0, -0.5], upper = [2, WIDTH, 0] }
bodies.bed.mesh = { order = [2, 1, 1], elements = [16, 1, 2] }
contacts.c = { slave = "b.w0", master = "bed.w1" }
supports.base.face = "bed.w0"
supports.x = { face = "b.u0", components = ["x"] }
supports.y = { face = "b.v0", components = ["y"] }
supports.end = { edge = "b.u1.w1", force.z = -1e-9 }
loads.p = { face = "b.w1", pressure = 1e-7 }
"""
CORE = (
    """materials.s = { young = 0.1, poisson = 0.45 }
bodies.b.material = "m"
bodies.core.material = "s"
bodies.core.geometry = { kind = "ring", inner = 0.3, outer = INNER, width = 0.5, axis = "y", angles = [0, 180] }
bodies.core.mesh = { order = 2, elements = [8, 2, 1] }
contacts.c = { slave = "b.v0", master = "core.v1" }
supports.low = { face = "core.w0", components = ["y"] }
supports.hand = { face = "core.w1", components = ["y"] }
supports.left = { face = "core.u0", components = ["x"] }
supports.right = { face = "core.u1", components = ["x"] }
supports.up = { edge = "core.u0.v0", components = ["z"] }
"""
    + PIPE
)
WAYS = {ROLL: "[0, 0, -0.02]", CORE: "[0, 2e-3, 0]"}
#: Bodies that lock: what they are and what acts, order, elements.
LOCK: dict[str, tuple[str, str, int, int]] = {
    "a quarter of one element, held once": (RING, ONCE + WITHIN, 2, 1),
    "a quarter of one element, held twice": (RING, BOTH + WITHIN, 2, 1),
    "of order 3": (RING, BOTH + WITHIN, 3, 1),
    "by its weight": (RING, BOTH + WEIGHT, 2, 1),
    "beam of order 3": (BOX, BOTH + ABOVE, 3, 1),
    "Lagrange beam": (BOX.replace("FAMILY", "'L'"), BOTH + ABOVE, 2, 2),
    "plate": (BOX.replace("WIDTH", "2").replace("ACROSS", "ORDER").replace("WIDE", "MANY"), ROUND + ABOVE, 2, 2),
    "skin": (BOX, SKIN + ABOVE.replace("b.w1", "b.w0"), 3, 1),
    "arch under a cylinder": (RING.replace("ANGLES", "[-90, 90]"), ROLL, 3, 2),
}
#: Others that do not, though they might by their elements.
FREE: dict[str, tuple[str, str, int, int]] = {
    "half a pipe": (RING.replace("ANGLES", "[0, 180]").replace("INNER", "0.999"), PIPE + WITHIN, 2, 2),
    "half a pipe of Lagrange elements": (RING.replace("ANGLES", "[0, 180]").replace("FAMILY", "'L'"), PIPE + WITHIN, 2, 4),
    "closed pipe": (RING.replace("ANGLES", "[0, 360]").replace("2], el", "4], el"), 'supports.low.face = "b.w0"\n' + WITHIN, 2, 8),
    "beam on a bed": (BOX, BED, 2, 2),
    "half a pipe round a core": (RING.replace("ANGLES", "[0, 180]").replace("width = 0.1", "width = 0.5"), CORE, 3, 2),
}
SAID = re.compile(r"body 'b', load step 1, the last of stage 'bend': it bends along \w, .* up to about ([\d. ]+) (times|%) too stiff")


def text(what: tuple[str, str, int, int], raised: int, times: int) -> str:
    """A scene of these, by a higher order and with so many times the elements."""
    body, acts, order, elements = what
    hand = next((f", motions.hand.translate = {way}" for of, way in WAYS.items() if of == acts), "")
    family = "'L'" if "'L'" in body and not raised else "'N'"
    made = (HEAD + body + acts).replace("'L'", "FAMILY")
    words = {"HAND": hand, "INNER": 0.98, "ANGLES": [0, 90], "WIDTH": 0.1, "ORDER": order + raised, "MANY": elements * times}
    for word, value in (words | {"ACROSS": 1, "WIDE": 1, "FAMILY": family}).items():
        made = made.replace(word, str(value))
    return made


def run(made: str) -> tuple[list[float], float]:
    """By how much a body is said to be too stiff, and its stiffness: force over way, or what acts over its work."""
    heard, problem = Heard(), Scene.from_toml(made).problem()
    simulation = Simulation(problem, heard)
    (result,) = simulation.run()
    said = [
        float(found[1].replace(" ", "")) * (1.0 if found[2] == "times" else 0.01) - (found[2] == "times")
        for words in heard.said
        if (found := SAID.search(words))
    ]
    for support, reaction in zip(problem.supports, result.reactions, strict=True):
        if support.name == "hand":
            return said, float(np.linalg.norm(reaction.force))
    equilibrium = simulation.equilibrium
    ways = result.state.positions - equilibrium.numbering.reference
    return said, 1.0 / float(np.sum(ways * sum(equilibrium.loads.forces(result.state.positions, 1.0))))


@case(
    claim="Thin bodies that pressures, weights and contact act on between their ends are told by about how much they are too stiff, beside "
    "those of an order by three higher; as well where they are so stiff that they but stretch.",
    tier="gate",
    grid={"scene": tuple(LOCK)},
    bounds={
        "told over off": Bound(at_least=0.5, at_most=2.0, reason="definition: an order of magnitude is told"),
        "off": Bound(at_least=0.4, reason="definition: by how much it is too stiff, or there is nothing to tell of"),
    },
)
def locked(scene: str) -> dict[str, float]:
    """What is told beside what is true."""
    said, stiffness = run(text(LOCK[scene], 0, 1))
    off = stiffness / run(text(LOCK[scene], 3, 2))[1] - 1.0
    return {"told over off": said[0] / off if said else 0.0, "off": off}


@case(
    claim="Thin bodies that stretch as they should, or that contact holds all along, are not told to be too stiff to bend.",
    tier="gate",
    grid={"scene": tuple(FREE)},
    bounds={
        "said": Bound(0.0, 0.0, "definition: sentences of it"),
        "off": Bound(at_most=0.1, reason="definition: by how much it is too stiff, or it should be told"),
    },
)
def not_locked(scene: str) -> dict[str, float]:
    """How often it is told, and what is true."""
    said, stiffness = run(text(FREE[scene], 0, 1))
    return {"said": float(len(said)), "off": abs(stiffness / run(text(FREE[scene], 3, 2))[1] - 1.0)}
