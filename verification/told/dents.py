"""What is said of constraints at points that are too far apart for a body, against the mortar method on the same meshes."""

from __future__ import annotations

import functools
import re

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: Two blocks, one on the other, that are pressed without friction: all pressures are alike.
SCENE = """
format = 1
materials = { upper = { young = 100, poisson = 0.3 }, lower = { young = YOUNG, poisson = 0.3 } }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.01] }]
[bodies]
block = { material = "upper", geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, HEIGHT] }, mesh = SLAVE }
base = { material = "lower", geometry = { kind = "box", lower = [0, 0, -DEPTH], upper = [1, 1, 0] }, mesh = MASTER }
[contacts]
floor = { slave = "block.w0", master = "base.w1", friction = 0, enforcement = "WAY" }
[supports]
top = { face = "block.w1", components = ["z"] }
under = { face = "base.w0", components = ["z"] }
left = { face = "block.u0", components = ["x"] }
below = { face = "base.u0", components = ["x"] }
front = { face = "block.v0", components = ["y"] }
behind = { face = "base.v0", components = ["y"] }
"""
#: Height, depth of the base, and its modulus.
SHAPES = {
    "column": (1.0, 1.0, 100.0),
    "flat": (0.3, 0.3, 100.0),
    "flat base": (1.0, 0.2, 100.0),
    "soft": (1.0, 1.0, 10.0),
}
#: Orders and elements of the slave, and elements of the master, of order 2; none: a rigid plane.
SLAVES, MASTERS = ((1, 1), (1, 3), (1, 8), (2, 2), (3, 2), (4, 3)), (0, 4, 9)


def scene(shape: str, way: str, slave: tuple[int, int], elements: int) -> Scene:
    """One of them."""
    height, depth, young = SHAPES[shape]
    words = {"YOUNG": young, "HEIGHT": height, "DEPTH": depth, "WAY": way}
    words["SLAVE"] = f"{{ order = [{slave[0]}, {slave[0]}, 1], elements = [{slave[1]}, {slave[1]}, 1] }}"
    words["MASTER"] = f"{{ order = [2, 2, 1], elements = [{elements}, {elements}, 1] }}"
    text = (
        SCENE
        if elements
        else re.sub('(base|under|below|behind) = .*|master = "base.w1"', "", SCENE).replace(" , friction", " plane = {}, friction")
    )
    for word, value in words.items():
        text = text.replace(word, str(value))
    return Scene.from_toml(text)


@functools.cache
def force(shape: str, way: str, slave: tuple[int, int], elements: int) -> float:
    """What presses the blocks together."""
    (step,) = Simulation(scene(shape, way, slave, elements).problem()).run()
    return abs(float(step.reactions[0].force[2]))


def told(made: Scene) -> float:
    """By how much it is said to be too small; zero: nothing is said."""
    simulation = Simulation(made.problem())
    said = re.findall(r"comes through between them: forces may be some (\S+) % too small", "\n".join(simulation.doubts()))
    return float(said[0]) / 100.0 if said else 0.0


@case(
    claim="Where constraints at points make forces too small by a twentieth because a body comes through between them, that is told, with "
    "the order of by how much; where they do by less than a thousandth, nothing is.",
    tier=lambda way: "gate" if way == "knots" else "nightly",
    grid={"way": ("knots", "greville", "demko")},
    bounds={
        "untold": Bound(0.0, 0.0, "definition: forces too small by a twentieth of which nothing is said"),
        "wrongly told": Bound(0.0, 0.0, "definition: forces that are too small by less than a thousandth of which it is said"),
        "too little": Bound(at_most=10.0, reason="definition: an order of magnitude is told; what is true over that, from 2 % on"),
        "too much": Bound(at_most=10.0, reason="definition: likewise, what is told over what is true"),
    },
)
def dents(way: str) -> dict[str, float]:
    """Counts and largest ratios over shapes and meshes."""
    counts, little, much = np.zeros(2), [0.0], [0.0]
    for shape in SHAPES:
        for slave in SLAVES:
            for elements in MASTERS:
                off = 1.0 - force(shape, way, slave, elements) / force(shape, "mortar", slave, elements)
                said = told(scene(shape, way, slave, elements))
                counts += off > 0.05 and not said, off < 0.001 and said > 0.0
                if said and off > 0.02:
                    little.append(off / said)
                    much.append(said / off)
    return {
        "untold": float(counts[0]),
        "wrongly told": float(counts[1]),
        "too little": float(np.max(little)),
        "too much": float(np.max(much)),
    }
