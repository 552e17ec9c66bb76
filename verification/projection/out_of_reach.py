"""Pairs that no foot is sought for, as slave and master are apart: never where a point bears, and always where a plane is clear."""

from __future__ import annotations

import numpy as np

from isomortar import _bindings
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.solve.apart import Separation
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.feet import gaps
from isomortar.solve.timing import Ledger

#: A block, and what it may meet: a plane far from the middle of the bodies, or another block.
SCENE = """
format = 1
bodies.slave.geometry = {{ kind = "box", lower = [-0.3, -0.2, 0], upper = [0.3, 0.2, 0.4] }}
bodies.slave.mesh = {{ order = [2, 2, 1], elements = [2, 2, 1] }}
bodies.other.geometry = {{ kind = "box", lower = [-1, -1, -0.5], upper = [1, 1, 0] }}
bodies.other.mesh = {{ order = [2, 2, 1], elements = [3, 3, 1] }}
contacts.c = {{ slave = "slave.w0", {master} }}
supports = {{ top.face = "slave.w1", base.face = "other.w0" }}
stages = [{{ name = "one", steps = 1 }}]
"""
NORMAL, POINT = np.array([0.36, -0.48, 0.8]), np.array([-1.0, 2.0, -3.0])
MASTERS = {
    "plane": f"plane = {{ point = {POINT.tolist()}, normal = {(3.0 * NORMAL).tolist()} }}",
    "face": 'master = "other.w1", projection = "closest"',
}


def turn(random: np.random.Generator) -> FloatArray:
    """A rotation by chance."""
    found, _ = np.linalg.qr(random.normal(size=(3, 3)))
    return np.asarray(found * np.linalg.det(found))


@case(
    claim="No point bears of a pair that is said to be apart; of a block and a plane it is said wherever all of the block is in front.",
    tier="gate",
    grid={"master": tuple(MASTERS)},
    bounds={
        "bears": Bound(0.0, 0.0, "definition: places where a point bears, and the pair is said to be apart"),
        "unsaid": Bound(0.0, 0.0, "definition: places in front of a plane, a hundredth and more, where it is not said"),
        "apart": Bound(at_least=10.0, reason="definition: of 60 places some are apart, or nothing is told"),
        "near": Bound(at_least=10.0, reason="definition: and at some points bear"),
    },
)
def apart(master: str) -> dict[str, float]:
    """How many of 60 places by chance are told wrongly, are apart, and have points that bear."""
    equilibrium = Equilibrium(Scene.from_toml(SCENE.format(master=MASTERS[master])).problem(), Ledger())
    (pair,), numbering = equilibrium.pairs, equilibrium.numbering
    arrays, separation = pair.pair, Separation(pair.pair)
    nowhere = np.zeros((len(arrays.slave.area), 2)), np.zeros(len(arrays.slave.area), dtype=np.int32)
    own, random = np.unique(numbering.points["slave"]), np.random.default_rng(3)
    found = {"bears": 0, "unsaid": 0, "apart": 0, "near": 0}
    for _ in range(60):
        positions = numbering.reference.copy()
        block = (positions[own] - positions[own].mean(axis=0)) @ turn(random).T
        if master == "plane":  # within a half of it, wherever along it
            place = POINT + np.cross(NORMAL, random.normal(size=3)) + random.uniform(-0.5, 0.5) * NORMAL
        else:
            place = random.uniform((-1.5, -1.5, -0.6), (1.5, 1.5, 1.2))
        positions[own] = block + place - equilibrium.origin
        separation.begin(positions, acts=False)
        said = separation.holds(positions)
        feet = _bindings.project_points(arrays.slave, arrays.master, positions, *nowhere)
        bears = bool(np.any((gaps(arrays, positions, feet) > 0.0) & (feet.found > 0)))
        face = positions[arrays.slave.point] + equilibrium.origin
        clear = master == "plane" and float(((face - POINT) @ NORMAL).min()) > 0.01
        found["bears"] += said and bears
        found["unsaid"] += clear and not said
        found["apart"] += said
        found["near"] += bears
    return {name: float(count) for name, count in found.items()}


@case(
    claim="Whether a block and its master are apart is the same whichever of them has moved there; never where one may have passed through "
    "the other on the way, nor where some pressure acted before.",
    tier="gate",
    bounds={
        "other": Bound(0.0, 0.0, "definition: ways of which it is said of one that moves, and not of the other"),
        "through": Bound(0.0, 0.0, "definition: ways through the master of which it is said"),
        "acted": Bound(0.0, 0.0, "definition: ways of which it is said with pressures at their start"),
        "apart": Bound(at_least=10.0, reason="definition: of 60 ways some are apart, or nothing is told"),
    },
)
def who_moves() -> dict[str, float]:
    """How many of 60 ways by chance, of which half go through the master, are told wrongly, and how many are apart."""
    equilibrium = Equilibrium(Scene.from_toml(SCENE.format(master=MASTERS["face"])).problem(), Ledger())
    separation, numbering, random = Separation(equilibrium.pairs[0].pair), equilibrium.numbering, np.random.default_rng(7)

    def said(start: FloatArray, end: FloatArray, body: str, acts: bool = False) -> bool:
        """Of a block at two places from the master, where one body moves."""
        places = []
        for place in (start, end):
            positions = numbering.reference.copy()
            positions[np.unique(numbering.points[body])] += place if body == "slave" else -place
            places.append(positions)
        separation.begin(places[0], acts)
        return separation.holds(places[1])

    found = {"other": 0, "through": 0, "acted": 0, "apart": 0}
    for k in range(60):
        start, end = random.uniform((-2.5, -2.5, 0.6), (2.5, 2.5, 3.0), (2, 3))
        if k % 2:  # through the master's middle
            start, end = np.array([0.3, 0.3, 1.0]) * start / 2.5, np.array([0.1, 0.1, -1.0]) * end
        slave = said(start, end, "slave")
        found["other"] += slave != said(start, end, "other")
        found["through"] += k % 2 == 1 and slave
        found["acted"] += said(start, end, "slave", acts=True)
        found["apart"] += slave
    return {name: float(count) for name, count in found.items()}
