"""Penalties in the log of a load step: those of the first contact, which no other one changes."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: Two pads on planes of their own, the second one softer and wider.
HEAD = """
format = 1
solver.method = "METHOD"
materials = { hard = { young = 8 }, soft = { young = 1 } }
"""
FIRST = """
bodies.one = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }, mesh = { order = 2 }, material = "hard" }
contacts.one = { slave = "one.w0", plane = { point = [0, 0, -0.01] }, friction = 0.3 }
supports.one.face = "one.w1"
"""
SECOND = """
bodies.two = { geometry = { kind = "box", lower = [3, 0, 0], upper = [6, 3, 0.5] }, mesh = { order = 2 }, material = "soft" }
contacts.two = { slave = "two.w0", plane = { point = [0, 0, -0.01] }, friction = 0.3 }
supports.two.face = "two.w1"
"""
STAGES = '\n[[stages]]\nname = "press"\nsteps = 1\n'
MOTION = "motions.{}.translate = [0, 0, {}]\n"
#: Onto the plane, and away from it.
DOWN, UP = -0.02, 0.02


def penalties(method: str, *parts: tuple[str, str], way: float = DOWN) -> tuple[float, float]:
    """Those of the first augmentation, normal and tangential."""
    text = HEAD.replace("METHOD", method) + "".join(part for _, part in parts) + STAGES
    text += "".join(MOTION.format(name, way) for name, _ in parts)
    (result,) = Simulation(Scene.from_toml(text).problem()).run()
    return result.augmentations[0].penalty_normal, result.augmentations[0].penalty_tangential


@case(
    claim="The log of a load step has the penalties of its first contact, whatever other ones there are, and whether it touches or not.",
    tier="gate",
    grid={"method": ("uzawa", "monolithic")},
    bounds={
        "normal": Bound(at_most=1e-12, reason="round-off: the same body and its contact"),
        "tangential": Bound(at_most=1e-12, reason="round-off: the same body and its contact"),
        "open": Bound(at_most=1e-12, reason="definition: they are those of body and face, and both begin apart"),
        "second": Bound(at_least=0.1, reason="definition: those of the second contact are others"),
    },
)
def of_first(method: str) -> dict[str, float]:
    """Penalties of both off those of the first alone, of that while it rises, and of the second alone, relative to them."""
    first, second = ("one", FIRST), ("two", SECOND)
    alone, both, other = (penalties(method, *parts) for parts in ((first,), (first, second), (second,)))
    risen = penalties(method, first, way=UP)
    return {
        "open": float(np.max([abs(risen[k] / alone[k] - 1.0) for k in range(2)])),
        "normal": abs(both[0] / alone[0] - 1.0),
        "tangential": abs(both[1] / alone[1] - 1.0),
        "second": abs(other[0] / alone[0] - 1.0),
    }
