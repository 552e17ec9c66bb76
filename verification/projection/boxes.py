"""Boxes that tell whether bodies are apart: they hold all that functions of some spread make of control points, and depths no less."""

from __future__ import annotations

import re

import numpy as np

from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.solve.apart import Box, Separation
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger


@case(
    claim="A box about control points holds every sum of them whose coefficients add up to one, and their sizes to no more than a spread.",
    tier="gate",
    grid={"spread": (1.0, 1.5, 4.0)},
    bounds={
        "outside": Bound(at_most=1e-12, reason="round-off: of sums of two points, over the largest extent"),
        "loose": Bound(at_most=1e-12, reason="definition: each side is met by a sum of two points; round-off"),
    },
)
def boxes(spread: float) -> dict[str, float]:
    """How far such sums are outside the box at most, and its sides from the farthest of them, of long and flat sets of points."""
    random, outside, loose = np.random.default_rng(8), 0.0, 0.0
    for extent in ((1.0, 1.0, 1.0), (1.0, 0.1, 0.01), (0.01, 1.0, 0.1), (0.0, 1.0, 5.0)):
        points = random.uniform(-1.0, 1.0, (12, 3)) * extent + random.uniform(-2.0, 2.0, 3)
        box = Box.about(points, spread)
        one, other = points[:, None], points[None, :]
        sums = (0.5 * (1.0 + spread) * one + 0.5 * (1.0 - spread) * other).reshape(-1, 3)
        low, high = sums.min(axis=0), sums.max(axis=0)
        outside = float(np.max([outside, *(box.low - low), *(high - box.high)]))
        loose = float(np.max([loose, *np.abs(box.low - low), *np.abs(box.high - high)]))
    return {"outside": outside, "loose": loose}


#: A master whose lower side is farther from its upper one at one end than at the other.
WEDGE = """
format = 1
bodies.slave.geometry = { kind = "box", lower = [3.2, 0, 9], upper = [3.8, 1, 10] }
bodies.master.geometry = { kind = "wedge", bottom = [0, 4], top = [3, 4], y = [0, 1], z = [-2, 0] }
bodies.master.mesh = { family = "FAMILY", order = ORDER, elements = 2 }
contacts.c = { slave = "slave.w0", master = "master.w1" }
supports = { top.face = "slave.w1", below.face = "master.w0" }
stages = [{ name = "rest", steps = 1 }]
"""

#: A master whose lower face has other weights than its upper one: lines that cross it lean, by up to 2.
LEANING = re.sub(
    r"bodies\.master\..*\nbodies\.master\..*",
    "bodies.master.rigid = true\nbodies.master.patch = { order = 1, weights = [1, 9, 1, 9, 1, 1, 1, 1], "
    "knots = [[0, 0, 1, 1], [0, 0, 1, 1], [0, 0, 1, 1]], control_points = "
    "[[0, 0, -0.2], [4, 0, -0.2], [0, 1, -0.2], [4, 1, -0.2], [0, 0, 0], [4, 0, 0], [0, 1, 0], [4, 1, 0]] }",
    WEDGE,
)


@case(
    claim="What is told of how deep a master is goes for all of it, and is no more than its functions' sizes ask for.",
    tier="gate",
    grid={"family": ("N", "L"), "order": (1, 2)},
    bounds={
        "missed": Bound(at_most=1e-12, reason="definition: nowhere is more of the body below; round-off"),
        "more": Bound(at_most=1.0 + 1e-12, reason="theory: Lagrange functions of order p add up to 2^(p - 1) in size by direction"),
    },
)
def depths(family: str, order: int) -> dict[str, float]:
    """How much deeper the master is than what is told, and this over its depth and the sizes of its functions."""
    equilibrium = Equilibrium(Scene.from_toml(WEDGE.replace("FAMILY", family).replace("ORDER", str(order))).problem(), Ledger())
    told = Separation(equilibrium.pairs[0].pair)._depth(equilibrium.numbering.reference)
    deepest = float(np.hypot(3.0, 2.0))  # at the edge of both sides
    spread = 4.0 ** (order - 1) if family == "L" else 1.0
    return {"missed": float(np.maximum(deepest - told, 0.0)), "more": told / deepest / spread}


@case(
    claim="A master whose faces have different weights is no less deep than lines that cross it are long, and at most its diagonal.",
    tier="gate",
    bounds={
        "missed": Bound(at_most=1e-12, reason="definition: nowhere is more of the body below; round-off"),
        "more": Bound(at_most=1.0 + 1e-12, reason="definition: no two points are farther apart; over the diagonal"),
    },
)
def leaning_depths() -> dict[str, float]:
    """By how much the longest line is longer than what is told, and this over the diagonal."""
    equilibrium = Equilibrium(Scene.from_toml(LEANING).problem(), Ledger())
    told = Separation(equilibrium.pairs[0].pair)._depth(equilibrium.numbering.reference)
    above = np.linspace(0.0, 4.0, 401)
    below = 36.0 * above / (4.0 + 8.0 * above)
    longest = float(np.hypot(below - above, 0.2).max())
    return {"missed": float(np.maximum(longest - told, 0.0)), "more": told / float(np.linalg.norm([4.0, 1.0, 0.2]))}
