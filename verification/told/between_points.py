"""What is said of constraints at points that bodies come through between, against forces of averages on finer slaves."""

from __future__ import annotations

import re

import numpy as np
from told.narrow import BALL, depth
from told.runs import Heard

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: Two thick half pipes that cross each other at a right angle.
CROSSED = """
format = 1
materials.m = { young = 10, poisson = 0.3 }
bodies.a.geometry = { kind = "ring", inner = 0.4, outer = 1, width = 1.2, centre = [0, 0, -1], angles = [-90, 90], axis = "y" }
bodies.a.mesh = { order = 2, elements = [16, 2, 8] }
bodies.b.geometry = { kind = "ring", inner = 0.4, outer = 1, width = 1.2, centre = [0, 0, 1], angles = [180, 360], axis = "x" }
bodies.b.mesh = { order = 2, elements = [16, 2, 8] }
contacts.c = { slave = "a.v1", master = "b.v1", friction = 0, enforcement = "greville" }
supports = { base.face = "a.v0", top.face = "b.v0" }
stages = [{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.1] }, { name = "hold", steps = 1 }]
"""
BETWEEN = re.compile(
    r"contact 'c', load step (\d+), the last of stage '\w+': its constraints, at points of its slave a\.\w\d, are too far apart for what "
    r"presses, .*may be (off by a third, too small or too large|off by about (\S+) %), pressures by more\. "
    r'Take contacts\.c\.enforcement = "mortar"'
)
Changes = tuple[str, ...]


def run(text: str, changes: Changes) -> tuple[list[re.Match[str]], float]:
    """What is said of points in a run, and the force at its end."""
    heard = Heard()
    *_, last = Simulation(Scene.from_toml(text, overrides=changes).problem(), heard).run()
    return [found for words in heard.said if (found := BETWEEN.search(words))], abs(float(last.contacts[0].force_slave[2]))


def crossed(enforcement: str, around: int, along: int) -> Changes:
    """That of both pipes."""
    meshes = tuple(f"bodies.{body}.mesh.elements=[{around}, 2, {along}]" for body in "ab")
    return (f'contacts.c.enforcement="{enforcement}"', *meshes)


#: A slave of order 3, whose elements are too long for the ball.
ORDER_3: Changes = ("bodies.a.mesh.order=3", "bodies.a.mesh.elements=[7, 7, 4]")
#: Crossed pipes by constraints, elements around and along, and whether these are too few.
PIPES: dict[str, tuple[str, int, int, bool]] = {
    "greville": ("greville", 12, 13, True),
    "demko": ("demko", 16, 11, True),
    "knots": ("knots", 10, 7, True),
    "greville, finer": ("greville", 20, 9, False),
    "knots, finer": ("knots", 16, 8, False),
    "averages": ("mortar", 16, 11, False),
}


@case(
    claim="Crossed cylinders whose constraints at points are too far apart are told to press with too small a force, once, by about as "
    "much as it is; of others, whose force is right, nothing is said.",
    tier="gate",
    grid={"pipes": tuple(PIPES)},
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: sentences more or less than one of those too coarse, none of the others"),
        "told over off": Bound(at_least=0.7, at_most=1.5, reason="definition: an estimate, of which the first digit counts"),
        "off": Bound(at_most=0.05, reason="definition: of those of which nothing is said"),
    },
)
def pipes(pipes: str) -> dict[str, float]:
    """What is said, and how far forces are off that of averages."""
    enforcement, around, along, coarse = PIPES[pipes]
    _, true = run(CROSSED, crossed("mortar", 20, 10))
    found, force = run(CROSSED, crossed(enforcement, around, along))
    off, told = 1.0 - force / true, [0.01 * float(words[3]) for words in found if words[3]]
    return {
        "wrong": abs(len(told) - float(coarse)) + len(found) - len(told),
        "told over off": (told[0] / off if told else 0.0) if coarse else 1.0,
        "off": 0.0 if coarse else abs(off),
    }


@case(
    claim="A ball that no estimate is known of, as between points it is farther inside than forces press it in, is told to be off either "
    "way, once; on a finer slave it is not.",
    tier="gate",
    bounds={
        "said": Bound(1.0, 1.0, "definition: sentences of the coarse slave, which tell no share"),
        "off": Bound(at_least=0.1, reason="definition: or there is nothing to tell of"),
        "others": Bound(0.0, 0.0, "definition: sentences of the fine slave"),
        "left": Bound(at_most=0.05, reason="definition: what its force is off by"),
    },
)
def beyond_estimate() -> dict[str, float]:
    """Of order 3, whose points are farthest from their neighbours' middles."""
    changes = ('contacts.c.enforcement="greville"', depth(0.03))
    _, true = run(BALL, (depth(0.03), "bodies.a.mesh.elements=[20, 20, 4]"))
    found, force = run(BALL, (*changes, *ORDER_3))
    others, fine = run(BALL, (*changes, *ORDER_3, "bodies.a.mesh.elements=[14, 14, 4]"))
    return {
        "said": float(sum(words[3] is None for words in found)),
        "off": float(np.abs(force / true - 1.0)),
        "others": float(len(others)),
        "left": float(np.abs(fine / true - 1.0)),
    }


#: Half a ring that a rigid plane presses, which bends far more than it is dented.
RING = """
format = 1
materials.m = { young = 10, poisson = 0.3 }
bodies.a.geometry = { kind = "ring", inner = 0.94, outer = 1, width = 0.2, angles = [-90, 90], axis = "y" }
bodies.a.mesh = { order = 2, elements = [20, 1, 1] }
contacts.c = { slave = "a.v1", plane = { point = [0, 0, 1], normal = [0, 0, -1] }, friction = 0, enforcement = "greville" }
supports = { low.face = "a.u0", high.face = "a.u1" }
stages = [{ name = "press", steps = 2, motions = { low.translate = [0, 0, 0.2], high.translate = [0, 0, 0.2] } }]
"""


@case(
    claim="Of a half ring that bends, whose points are far apart beside what it is dented, the force is right, and nothing is said.",
    tier="gate",
    bounds={
        "said": Bound(0.0, 0.0, "definition: sentences on its points"),
        "off": Bound(at_most=0.05, reason="definition: what its force is off by, of which nothing is said"),
    },
)
def half_ring() -> dict[str, float]:
    """Against one of averages with twice as many elements."""
    found, force = run(RING, ())
    _, true = run(RING, ('contacts.c.enforcement="mortar"', "bodies.a.mesh.elements=[40, 1, 1]"))
    return {"said": float(len(found)), "off": float(np.abs(force / true - 1.0))}
