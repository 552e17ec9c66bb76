"""What is said of narrow contact with thin layers, against forces of finer ones."""

from __future__ import annotations

import re

from told.narrow import STRIP, depth, run

from isomortar.harness import Bound, case

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
