"""Slave faces much larger than their masters: how far they are apart, and how deep they are in each other, is told as of others."""

from __future__ import annotations

from isomortar.harness import Bound, case
from isomortar.model.stance import stance
from isomortar.scene import Scene

#: A plate on a block, that has other faces too.
PLATE = """
format = 1
bodies.plate.geometry = { kind = "box", lower = [-HALF, -HALF, GAP], upper = [HALF, HALF, TOP] }
bodies.plate.mesh = { order = 2, elements = [3, 3, 1] }
bodies.block.geometry = { kind = "box", lower = [-0.5, -0.4, -0.5], upper = [0.5, 0.4, 0] }
bodies.block.mesh = { order = 2, elements = [4, 4, 1] }
contacts.c = { slave = "plate.w0", master = "block.w1" }
supports = { top.face = "plate.w1", base.face = "block.w0" }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.02] }]
"""


@case(
    claim="Of a plate and a much smaller block it is known how far it is above it, or how deep in it, and which way the block is.",
    tier="gate",
    grid={"half": (0.6, 3.0, 10.0, 50.0, 1e4), "gap": (0.0, 0.01, 2.0, -0.01, -0.1)},
    bounds={
        "gap": Bound(at_most=0.03, reason="discretisation: from middles of cells, those beside the block less their half, over its width"),
        "depth": Bound(at_most=1e-12, reason="round-off: the plate is flat"),
        "turned": Bound(at_most=1e-12, reason="round-off: down is the way from the plate to the block"),
    },
)
def above(half: float, gap: float) -> dict[str, float]:
    """What is off of either, over the width of the block, 1, and of the way."""
    text = PLATE.replace("HALF", str(half)).replace("GAP", str(gap)).replace("TOP", str(gap + 0.5))
    problem = Scene.from_toml(text).problem()
    found = stance(problem, problem.contacts[0])
    return {
        "gap": abs(found.gap - (gap if gap > 0.0 else 0.0)),
        "depth": abs(found.depth - (-gap if gap < 0.0 else 0.0)),
        "turned": abs(float(found.towards[2]) + 1.0),
    }
