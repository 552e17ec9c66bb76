"""Supports that push a slave's control points along a rigid plane, and those that no longer hold, by what the scene says of them."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.model.held import held_by
from isomortar.model.numbering import Numbering
from isomortar.model.pairs import Pair
from isomortar.model.supports import Supports
from isomortar.scene import Scene

#: A block on an oblique plane, of which one side is moved with its edge on the plane.
SCENE = """
format = 1
bodies.block = {{ geometry = {{ kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }}, mesh = {{ order = 2, elements = 2 }} }}
contacts.floor = {{ slave = "block.w0", plane = {{ normal = [0, 0, 2], tangent = [0.6, 0.8, 0] }}, friction = 0.3 }}
supports.top = {{ face = "block.w1", stages = ["push", "on"] }}
supports.side = {{ face = "block.u0", stages = ["push"] }}
supports.edge = {{ edge = "block.u1.w1", stages = ["push", "rest"] }}
supports.back = {{ face = "block.v1", components = ["x"], stages = ["rest", "on", "end"] }}
stages = [
    {{ name = "push", steps = 1, motions.side.translate = {way}, motions.top.translate = {way}, motions.edge.translate = {way} }},
    {{ name = "rest", steps = 1 }},
    {{ name = "on", steps = 1 }},
    {{ name = "end", steps = 1 }},
]
"""
#: Supports that held before each stage, and do not in it.
RELEASED: tuple[list[str], ...] = ([], ["top", "side"], ["side", "edge"], ["top", "side", "edge"])


@case(
    claim="Control points are pushed along a plane in the direction of their supports' motion, a unit vector however far that goes.",
    tier="gate",
    bounds={
        "pushed": Bound(at_most=1e-12, reason="round-off: a direction of two components"),
        "beside": Bound(0.0, 0.0, "definition: others are not pushed"),
    },
)
def directions() -> dict[str, float]:
    """Largest differences of directions, of short and long ways, and the largest of those of points that no support moves."""
    pushed = beside = 0.0
    across = np.array([[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0]])  # the plane's tangent, and its normal times that
    for way in (np.array([0.001, 0.0, 0.0]), np.array([-0.03, 0.04, 0.0]), np.array([0.0, 2.0, 0.0])):
        problem = Scene.from_toml(SCENE.format(way=way.tolist())).problem()
        numbering = Numbering(problem)
        pair = Pair(problem.contacts[0], problem, numbering)
        found = held_by(Supports(problem, numbering), pair, numbering.reference, 1.0).pushed
        held = numbering.reference[pair.slave.point, 0] < 1e-12
        pushed = float(np.maximum(pushed, np.abs(found[held] - across @ way / np.linalg.norm(way)).max()))
        beside = float(np.maximum(beside, np.abs(found[~held]).max()))
    return {"pushed": pushed, "beside": beside}


@case(
    claim="Supports that are said to be released are those that held in some stage before, and do not any more.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: stages in which others are named")},
)
def released() -> dict[str, float]:
    """How many of four."""
    problem = Scene.from_toml(SCENE.format(way=[0.001, 0.0, 0.0])).problem()
    numbering = Numbering(problem)
    found = [Supports(problem, numbering, stage).released({"block"}) for stage in range(len(problem.stages))]
    return {"wrong": float(sum(names != expected for names, expected in zip(found, RELEASED, strict=True)))}
