"""Closed masters: their seam is a line like the others, for feet, slips and whole scenes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise, product

import numpy as np
from projection.closest_points import Surface

from isomortar._bindings import find_climbs
from isomortar.geometry.patch import FloatArray, IntArray, Patch
from isomortar.geometry.primitives import ring
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.model.plates import rotation
from isomortar.scene import Scene
from isomortar.solve.contact import Kinematics, PairMechanics
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger

INNER, OUTER, WIDTH = 0.3, 0.5, 0.4
#: Parameter length of the ring: one unit a quarter.
PERIOD = 4.0


def face(kind: str, side: str, begin: float = 0.0) -> Surface:
    """A face of a closed ring about the y-axis: `side` is v0, the inner one, or v1; its coordinate round may `begin` anywhere."""
    patch = mesh(ring((0.0, 0.0, 0.0), INNER, OUTER, WIDTH), (kind[0],) * 3, (int(kind[1:]), 1, 1), (8, 1, 2))  # type: ignore[arg-type]
    round_it, across, along = patch.directions
    directions = replace(round_it, knots=round_it.knots + begin), across, along
    return Surface(replace(patch, directions=directions), side, closed="u")


def targets(side: str, angle: FloatArray, seed: int) -> FloatArray:
    """Points at angles from the seam, off the face on both of its sides."""
    random = np.random.default_rng(seed)
    radius = (INNER if side == "v0" else OUTER) + random.uniform(-0.05, 0.05, len(angle))
    return np.column_stack([radius * np.sin(angle), random.uniform(-0.19, 0.19, len(angle)), radius * np.cos(angle)])


@case(
    claim="A foot beyond the seam of a closed ring is found, and slips over the seam are those over any other joint of the ring.",
    tier="gate",
    grid={"kind": ["N2", "N3", "L2"], "side": ["v0", "v1"], "begin": [0.0, -1.5, 2.5]},
    bounds={
        "found": Bound(at_least=1.0, at_most=1.0, reason="definition: round the ring there is no edge"),
        "distance": Bound(at_most=1e-14, reason="round-off: the quarters of the ring are the same, turned"),
        "slip": Bound(at_most=1e-13, reason="round-off: of coordinates up to 7"),
        "moved": Bound(at_least=0.05, reason="definition: every point has moved, half of them over the seam"),
    },
)
def over_the_seam(kind: str, side: str, begin: float) -> dict[str, float]:
    """Points that move over the seam to and fro, beside the same ones over the next joint: share found, differences, least slip."""
    master, quarter = face(kind, side, begin), np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
    angle = np.linspace(-0.3, 0.3, 100)
    before, after = targets(side, angle, 1), targets(side, -0.9 * angle - 0.1 * np.sign(angle), 1)
    slips, distances, found = [], [], []
    for turn in (np.eye(3), quarter):
        start = master.project(before @ turn)
        end = master.project(after @ turn, start.xi)
        found += [start.found, end.found]
        slips.append(end.slip)
        distances.append(np.linalg.norm(master.points(end.xi) - after @ turn, axis=1))
    return {
        "found": float(np.mean(found)),
        "distance": float(np.abs(distances[0] - distances[1]).max()),
        "slip": float(np.abs(slips[0] - slips[1]).max()),
        "moved": float(np.abs(slips[0][:, 1]).min()),
    }


def swapped(surface: Surface) -> Surface:
    """The same face with its coordinates in the other order."""
    patch, (u, v, w) = surface.patch, surface.patch.directions
    points = patch.control_points.reshape(w.count, v.count, u.count, 3).transpose(2, 1, 0, 3).reshape(-1, 3)
    weights = patch.weights.reshape(w.count, v.count, u.count).transpose(2, 1, 0).ravel()
    return Surface(Patch((w, v, u), points, weights), surface.face, closed={"u": "w", "w": "u"}[str(surface.closed)])


@case(
    claim="A ring that is closed along one coordinate ends along the other, whichever that is: feet are up to its edges, not beyond.",
    tier="gate",
    grid={"kind": ["N2", "L2"], "side": ["v0", "v1"], "order": ["as it is", "swapped"]},
    bounds={
        "inside": Bound(at_least=1.0, at_most=1.0, reason="definition: share found of the points before the edges"),
        "beyond": Bound(at_least=0.0, at_most=0.0, reason="definition: share found of those behind them"),
        "along": Bound(at_most=1e-14, reason="round-off: the closest point of a ring is at the same place along its axis"),
    },
)
def edges_of_a_ring(kind: str, side: str, order: str) -> dict[str, float]:
    """Shares of points that are found, from a cold start and from random ones; how far feet are from their points along the ring's axis."""
    master = face(kind, side) if order == "as it is" else swapped(face(kind, side))
    points, random = targets(side, np.linspace(0.0, 2.0 * np.pi, 120, endpoint=False), 1), np.random.default_rng(2)
    off, low, high = 10.0 ** random.uniform(-9.0, -1.0, len(points)), *master.ends
    starts = low + random.uniform(0.0, 1.0, (len(points), 2)) * (high - low)
    found: dict[float, list[IntArray]] = {-1.0: [], 1.0: []}
    along = []
    for way, xi in product(found, (None, starts)):
        points[:, 1] = np.where(np.arange(len(points)) % 2, 1.0, -1.0) * (0.5 * WIDTH + way * off)
        feet = master.project(points, xi)
        found[way].append(feet.found)
        if way < 0:
            along.append(np.abs(master.points(feet.xi) - points)[:, 1].max())
    return {"inside": float(np.mean(found[-1.0])), "beyond": float(np.mean(found[1.0])), "along": float(np.max(along))}


#: A block above a closed ring of Lagrange elements, across the ring's seam.
_ACROSS = """
format = 1
bodies.block = {{ geometry = {{ kind = "box", lower = [-0.15, -0.12, 0.49], upper = [0.15, 0.12, 0.7] }}, mesh = {{ order = [2, 2, 1], \
elements = [4, 2, 1] }} }}
bodies.ring = {{ geometry = {{ kind = "ring", inner = 0.3, outer = 0.5, width = 0.4 }}, \
mesh = {{ family = "L", order = [{order}, 1, {order}], elements = [16, 1, 2] }} }}
contacts.tread = {{ slave = "block.w0", master = "ring.v1", friction = 0.3, projection = "{projection}" }}
supports = {{ top.face = "block.w1", hub.face = "ring.v0" }}
stages = [{{ name = "rest", steps = 1 }}]
"""


def slid(projection: str, order: int, begin: float, end: float, dents: float = 0.0) -> tuple[PairMechanics, FloatArray, Kinematics]:
    """The block at an angle from where its middle is above the seam, slid there from another one: pair, positions, and kinematics.

    The ring may have `dents`, a share of its radius: the same in each quarter, and not their own mirror images.
    """
    equilibrium = Equilibrium(Scene.from_toml(_ACROSS.format(projection=projection, order=order)).problem(), Ledger())
    pair, start = equilibrium.pairs[0], equilibrium.initial_state().contacts[0]
    block = np.unique(equilibrium.numbering.points["block"])
    nothing = np.zeros_like(start.projected)
    x, _, z = equilibrium.numbering.reference.T
    angle, uneven = np.arctan2(x, z), np.ones((len(x), 1))
    uneven[:, 0] += dents * (np.sin(4.0 * angle) + np.sin(8.0 * angle + 1.0))
    uneven[block] = 1.0

    def turned(place: float) -> FloatArray:
        positions = uneven * equilibrium.numbering.reference
        positions[block] = positions[block] @ rotation(np.array([0.0, 1.0, 0.0]), place).T
        return positions

    before = pair.kinematics(turned(begin), replace(start, projected=nothing)).projections
    positions = turned(end)
    return pair, positions, pair.kinematics(positions, replace(start, projection=before.xi, projected=before.found))


@case(
    claim="Whichever way feet are found, a slave over the seam of a closed ring has the gaps, slips and weights that it has anywhere else.",
    tier="gate",
    grid={"projection": ["closest", "averaged"], "order": [1, 2]},
    bounds={
        "found": Bound(at_least=1.0, at_most=1.0, reason="definition: round the ring there is no edge"),
        "gap": Bound(at_most=1e-14, reason="round-off: the quarters of the ring are the same, turned"),
        "slip": Bound(at_most=1e-13, reason="round-off: of coordinates up to 4"),
        "weight": Bound(at_most=1e-14, reason="round-off: the same areas"),
        "seam": Bound(at_least=0.2, at_most=0.8, reason="definition: points are on both sides of the seam"),
        "over": Bound(at_least=1.0, reason="definition: points have gone over the seam"),
    },
)
def slave_over_the_seam(projection: str, order: int) -> dict[str, float]:
    """Share found, largest differences from the same a quarter on, share of points behind the seam, and how many have gone over it."""
    over, elsewhere = (slid(projection, order, place - 0.1, place)[2] for place in (0.05, 0.05 + 0.5 * np.pi))
    first = {name: np.abs(getattr(over.control, name) - getattr(elsewhere.control, name)).max() for name in ("gap", "slip", "weight")}
    xi, origin = over.projections.xi[:, 1], over.projections.origin[:, 1]
    return {name: float(value) for name, value in first.items()} | {
        "found": float(np.mean([over.projections.found, elsewhere.projections.found])),
        "seam": float(np.mean(xi < 0.5 * PERIOD)),
        "over": float(np.sum(np.abs(xi - origin) > 0.5 * PERIOD)),
    }


#: Parts of a way round that ring, beginning before its seam: all of it is longer than three elements.
PARTS = np.linspace(-0.5, 0.8, 10)
#: Of a ring on which the way round the other side takes up something else.
DENTS = 0.01


def climbs(order: int, ways: Sequence[tuple[float, float]]) -> list[FloatArray]:
    """How far feet along averaged normals have climbed as the block slid from angles to others."""
    found = []
    for begin, end in ways:
        pair, positions, kinematics = slid("averaged", order, begin, end, DENTS)
        found.append(find_climbs(pair.pair.slave, pair.pair.master, positions, kinematics.projections))
    return found


@case(
    claim="How far feet climb along averaged normals is over the seam of a closed ring what it is anywhere else, in one go and in parts.",
    grid={"order": (1, 2)},
    bounds={
        "over the seam": Bound(at_most=1e-12, reason="round-off: the quarters of the ring are the same, turned"),
        "in parts": Bound(at_most=1e-7, reason="quadrature: unit normals are no polynomials; the parts have other Gauss points"),
        "least": Bound(at_least=1e-4, reason="definition: feet that climb nothing tell nothing"),
    },
)
def climbs_over_the_seam(order: int) -> dict[str, float]:
    """Largest differences from those a quarter on, and from the sum of the parts; mean size of all climbs."""
    ways, quarter = list(pairwise(PARTS)), 0.5 * np.pi
    whole, elsewhere = climbs(order, [(PARTS[0], PARTS[-1]), (PARTS[0] + quarter, PARTS[-1] + quarter)])
    return {
        "over the seam": float(np.abs(whole - elsewhere).max()),
        "in parts": float(np.abs(whole - np.sum(climbs(order, ways), axis=0)).max()),
        "least": float(np.abs(whole).mean()),
    }


#: A small wheel that rolls without sliding on a closed ring: inside it, and outside.
_WHEEL = """
format = 1
bodies.wheel = {{ geometry = {{ kind = "ring", centre = [0, 0, {height}], inner = 0.1, outer = {wheel}, width = 0.2 }}, \
mesh = {{ order = [2, 1, 1], elements = [16, 1, 1] }} }}
bodies.ring = {{ geometry = {{ kind = "ring", centre = [0, 0, 0], inner = 0.5, outer = 0.75, width = 0.3 }}, \
mesh = {{ order = [2, 1, 1], elements = [16, 1, 1] }} }}
contacts.tread = {{ slave = "wheel.v1", master = "ring.{face}", friction = 0.3 }}
supports.hub = {{ face = "wheel.v0", centre = [0, 0, {height}], axis = [0, 1, 0] }}
supports.ring = {{ face = "ring.{other}", centre = [0, 0, 0], axis = [0, 1, 0] }}
stages = [
  {{ name = "press", steps = 2, motions.hub.translate = [0, 0, {press}] }},
  {{ name = "roll", steps = {steps}, motions = {{ ring.rotate = {turn}, hub.rotate = {spin} }} }},
]
"""


#: Load steps a turn: 10 degrees of the ring.
STEPS = 36


def wheel(inside: bool, turns: int) -> Problem:
    """The wheel below the ring's highest point, where the seam is, or on it; both turn in their places, without sliding."""
    inner, outer, radius, apart = 0.5, 0.75, 0.2, 0.002
    height, press = (inner - radius - apart, 0.012) if inside else (outer + radius + apart, -0.012)
    ratio = inner / radius if inside else -outer / radius
    return Scene.from_toml(
        _WHEEL.format(
            height=height, wheel=radius, face="v0" if inside else "v1", other="v1" if inside else "v0", press=press,
            steps=STEPS * turns, turn=360 * turns, spin=360 * turns * ratio,
        )
    ).problem()  # fmt: skip


@case(
    claim="A wheel rolls three turns round a closed ring, inside and outside: no point is lost, and each turn is like the one before.",
    tier="nightly",
    grid={"inside": [True, False]},
    bounds={
        "outside": Bound(at_most=0.0, reason="definition: the ring is wider than the wheel, and round it there is no edge"),
        "press": Bound(at_most=1e-3, reason="definition: both meshes repeat each turn; what is left is the start of the friction"),
    },
)
def rolling(inside: bool) -> dict[str, float]:
    """Most points without a projection; difference of the last two turns' forces across the contact, relative to their mean."""
    steps = list(Simulation(wheel(inside, 3)).run())
    force = np.array([step.contacts[0].force_slave[2] for step in steps])
    last, before = force[-STEPS:], force[-2 * STEPS : -STEPS]
    return {
        "outside": float(np.max([step.contacts[0].excluded for step in steps])),
        "press": float(np.abs(last - before).max() / abs(last.mean())),
    }
