"""What is said of narrow contact with thin layers, against forces of finer ones."""

from __future__ import annotations

import re

import numpy as np
from told.narrow import STRIP, depth, run

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.told.during.softness import thinness

#: A layer below a cylinder of radius one, on a support, on two together, and glued to a body that is stiffer.
LAYER = STRIP.replace("[-1, 0, -1], upper = [1, 0.2, 0]", "[-1, 0, THICK], upper = [1, 0.2, 0]").replace("AT", "0")
_ON_BASE = 'supports.base.face = "a.w0"'
_ON_TWO = LAYER.replace(
    _ON_BASE, 'supports.base = { face = "a.w0", components = ["z"] }\nsupports.also = { face = "a.w0", components = ["x", "y"] }'
)
_GLUED = (
    LAYER.replace(
        "format = 1",
        """format = 1
glue = [["a.w0", "hard.w1"]]
materials.hard = { young = 1e4, poisson = 0.3 }
bodies.hard = { material = "hard", geometry = { kind = "box", lower = [-1, 0, -1], upper = [1, 0.2, THICK] }, mesh.order = 2 }
supports.behind = { face = "hard.v0", components = ["y"] }
supports.before = { face = "hard.v1", components = ["y"] }""",
    )
    .replace(_ON_BASE, 'supports.base.face = "hard.w0"')
    .replace("bodies.a = {", 'bodies.a = { material = "m",')
)
#: How thick each is, how deep that is pressed in, and how many elements are too few.
LAYERS: dict[str, tuple[str, float, float, int]] = {
    "a twentieth": (LAYER, 0.05, 0.02, 8),
    "a tenth": (LAYER, 0.1, 0.04, 6),
    "an odd number": (LAYER, 0.1, 0.015, 10),
    "a fifth": (LAYER, 0.2, 0.08, 3),
    "on two supports": (_ON_TWO, 0.05, 0.02, 8),
    "glued": (_GLUED, 0.05, 0.02, 8),
}


@case(
    claim="Contact of a cylinder with a thin layer that elements are too long for is told by about as much as the force is off: a layer "
    "gives way by less than a deep body, and depth between its control points costs more. Of elements a quarter as long nothing is said.",
    tier="gate",
    grid={"layer": tuple(LAYERS)},
    bounds={
        "said": Bound(1.0, 1.0, "definition: sentences of the coarse layer"),
        "off": Bound(at_least=0.3, reason="definition: share of the force that is missing: or there is nothing to tell of"),
        "told over off": Bound(at_least=0.7, at_most=1.5, reason="definition: an estimate, of which the first digit counts"),
        "others": Bound(0.0, 0.0, "definition: sentences of the fine layer"),
        "left": Bound(at_most=0.05, reason="definition: what the force of the fine layer is off by"),
    },
)
def layers(layer: str) -> dict[str, float]:
    """What is said of a coarse layer and of a fine one, and how far they are off one of 64 elements."""
    text, thick, way, elements = LAYERS[layer]

    def of(count: int) -> tuple[list[re.Match[str]], float]:
        meshes = [f"bodies.{body}.mesh.elements=[{count}, 1, 2]" for body in ("a", "hard") if f"bodies.{body} " in text]
        return run(text.replace("THICK", str(-thick)), (*meshes, depth(way)))

    (said, force), (others, right), (_, true) = of(elements), of(4 * elements), of(64)
    off = 1.0 - force / true
    return {
        "said": float(len(said)),
        "off": off,
        "told over off": 0.01 * float(said[0]["share"].removesuffix(" %")) / off if said else 0.0,
        "others": float(len(others)),
        "left": abs(right / true - 1.0),
    }


#: A body under a plane, above another one that it may be glued to; whatever holds it, and two stages.
UNDER = """
format = 1
GLUE
materials = { soft = { young = 1, poisson = POISSON }, other = { young = YOUNG, poisson = 0 } }
bodies.a = { material = "soft", geometry = { kind = "box", lower = [0, 0, -0.2], upper = [1, 1, 0] } }
bodies.b = { material = "other", geometry = { kind = "box", lower = [0, 0, -1], upper = [1, 1, -0.2] } }
contacts.c = { slave = "a.w1", plane = { normal = [0, 0, -1] } }
supports.foot.face = "b.w0"
HELD
stages = [{ name = "one", steps = 1 }, { name = "two", steps = 1 }]
"""
_TO_BELOW, _TO_ABOVE = 'glue = [["b.w1", "a.w0"]]', 'glue = [["a.w0", "b.w1"]]'
_HELD, _PARTLY = 'supports.a.face = "a.w0"', 'supports.a = { face = "a.w0", components = ["x", "z"] }'
_PRESSED = 'supports.a = { face = "a.w0", components = ["x", "y"], force.z = 0.1 }'
_IN_ONE, _BESIDE = 'supports.a = { face = "a.w0", stages = ["one"] }', 'supports.a.face = "a.u0"'
#: Glue, Poisson's ratio, the other body's modulus, what holds the first one, in which stage it is asked, and its
#: softness as a layer, over (1 - nu^2) / E of itself: none, where it is none.
HOLDING: tuple[tuple[str, float, float, str, int, float | None], ...] = (
    ("", 0.3, 1e6, _BESIDE, 0, None),
    ("", 0.3, 1.0, _HELD, 0, 0.4 / 0.49),
    ("", 0.49, 1.0, _HELD, 0, 0.35),
    ("", 0.0, 1.0, _PRESSED, 0, 1.0),
    ("", 0.3, 1.0, _PARTLY, 0, None),
    ("", 0.3, 1.0, _IN_ONE, 0, 0.4 / 0.49),
    ("", 0.3, 1.0, _IN_ONE, 1, None),
    (_TO_BELOW, 0.0, 9.9, "", 0, None),
    (_TO_BELOW, 0.0, 10.1, "", 0, 1.0),
    (_TO_ABOVE, 0.0, 10.1, "", 1, 1.0),
)


@case(
    claim="A body is a layer, as thick as it is, where supports together hold the face opposite its contact in that stage, or a body is "
    "glued there that is more than ten times as stiff; and as soft as what cannot go sideways, or hardly can.",
    tier="gate",
    bounds={"off": Bound(at_most=1e-12, reason="round-off: by closed form; 1 where a layer is none, or none is one")},
)
def as_layers() -> dict[str, float]:
    """The largest relative error."""
    off = []
    for glue, poisson, young, held, stage, soft in HOLDING:
        words = {"GLUE": glue, "POISSON": str(poisson), "YOUNG": str(young), "HELD": held}
        text = UNDER
        for word, value in words.items():
            text = text.replace(word, value)
        simulation = Simulation(Scene.from_toml(text).problem())
        equilibrium, (begun,) = simulation.equilibrium, simulation.state.contacts
        (mechanics,) = equilibrium.pairs
        projections = mechanics.kinematics(simulation.state.positions, begun).projections
        thin, _ = thinness(equilibrium.problem, equilibrium.numbering, mechanics.pair, projections, stage)
        expected = 0.0 if soft is None else 1.0 / (0.2 * soft)
        off.append(float(np.abs(thin - expected).max()) / (expected or 1.0))
    return {"off": float(np.max(off))}
