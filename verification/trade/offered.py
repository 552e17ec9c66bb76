"""What dials offer of scenes in other units, and of bodies that are glued."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from trade.over_refined import GLUED

from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.trade.advice import VARIANTS
from isomortar.trade.knobs import KNOBS, changed, contact_places, dials_of

#: A block of size L and modulus E, pressed onto another one of these.
PRESSED = """
format = 1
materials.m.young = {young}
bodies.block = {{ material = "m", geometry = {{ kind = "box", lower = [0, 0, 0], upper = [{size}, {size}, {size}] }} }}
bodies.base = {{ material = "m", geometry = {{ kind = "box", lower = [0, 0, -{size}], upper = [{size}, {size}, 0] }} }}
contacts.c = {{ slave = "block.w0", master = "base.w1", friction = 0.3 }}
supports.top.face = "block.w1"
supports.under.face = "base.w0"
stages = [{{ name = "press", steps = 1, motions.top.translate = [0, 0, -{step}] }}]
"""
#: Size and modulus.
UNITS = ((1.0, 1.0), (1000.0, 1.0), (1.0, 1e4), (1000.0, 100.0))
#: Three glued bodies: both ends in contact; one, and the other end of a higher order along one of the directions that no contact has.
_SIDES = GLUED.replace("CONTACT", "ring.v1").replace(
    "[contacts]\n", '[contacts]\nother = { slave = "end.w1", plane = { point = [0, 0, 2], normal = [0, 0, -1] } }\n'
)
OF_GLUED = (
    _SIDES,
    GLUED.replace("CONTACT", "ring.v1").replace("elements = [1, 1, 3], order = 1 }", "elements = [1, 1, 3], order = [3, 1, 1] }"),
)


@case(
    claim="Lengths of elastic slip and products of smooth contact that are tried are as large beside a scene in any units: the first are "
    "lengths, the second pressures times lengths.",
    tier="gate",
    bounds={
        "off": Bound(at_most=1e-12, reason="round-off: of powers of ten, which change no digit of what is rounded to one"),
        "tried": Bound(at_least=2.0, reason="definition: or nothing but none is tried of one of them"),
    },
)
def in_units() -> dict[str, float]:
    """The largest relative difference of what is tried beside that in the first units, and how many of either are tried at least."""
    tried = []
    for size, young in UNITS:
        scene = Scene.from_toml(PRESSED.format(size=size, young=young, step=0.01 * size))
        dials = {dial.name: dial.settings for dial in dials_of(scene, (), KNOBS)}
        units = {"elastic slip of c": size, "smoothing of c": size * young}
        tried.append([[float(setting.label) / unit for setting in dials[name]] for name, unit in units.items()])
    off = [
        abs(x - y) / y
        for other in tried[1:]
        for ours, first in zip(other, tried[0], strict=True)
        for x, y in zip(ours, first, strict=True)
        if y > 0
    ]
    return {"off": float(np.max(off)), "tried": float(np.min([sum(x > 0.0 for x in of) for of in tried[0]]))}


@case(
    claim="Directions that have to share their mesh are turned by one dial, however many of their faces are in contact; lower orders "
    "across a contact raise none.",
    tier="gate",
    bounds={
        "twice": Bound(0.0, 0.0, "definition: directions that two dials turn"),
        "raised": Bound(0.0, 0.0, "definition: directions that a lower order raises"),
        "lowered": Bound(2.0, 2.0, "definition: orders one and two of the one direction of order three that no contact has"),
    },
)
def of_glued() -> dict[str, float]:
    """How many of each, of all scenes."""
    twice = raised = lowered = 0
    for own in map(Scene.from_toml, OF_GLUED):
        twice += sum(len(one & other) for one, other in combinations(contact_places(own), 2))
        for setting in (s for dial in dials_of(own, (), VARIANTS) if "across" in dial.name for s in dial.settings[: dial.own]):
            for body, other in zip(own.whole().bodies, changed(own, [setting]).whole().bodies, strict=True):
                orders = [(a.order, b.order) for a, b in zip(body.patch.directions, other.patch.directions, strict=True)]
                raised += sum(after > before for before, after in orders)
                lowered += sum(after < before for before, after in orders)
    return {"twice": float(twice), "raised": float(raised), "lowered": float(lowered)}
