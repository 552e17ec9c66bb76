"""Feet along averaged normals: near the master the one that a search of all elements finds, from any start, and as far as there are any."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from friction.virtual_work import areas
from projection.closest_points import Surface

from isomortar.errors import LostProjectionError
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import ContactState
from isomortar.solve.timing import Ledger

#: Height and number of the waves along each side: a radius of curvature of 0.13 on their tops.
HEIGHT, WAVES = 0.05, 2
#: A block above a plate, whose upper face is raised to hills and hollows.
_SCENE = """
format = 1
bodies.slave = {{ geometry = {{ kind = "box", lower = [0.3, 0.3, 0.0], upper = [0.7, 0.7, 0.6] }}, \
mesh = {{ order = [2, 2, 1], elements = [3, 3, 1] }} }}
bodies.plate = {{ geometry = {{ kind = "box", lower = [0, 0, -0.5], upper = [1, 1, 0] }}, \
mesh = {{ family = "L", order = [{order}, {order}, 1], elements = [{elements}, {elements}, 1] }} }}
contacts.pair = {{ slave = "slave.w0", master = "plate.w1", projection = "averaged", subcells = 0 }}
supports = {{ top.face = "slave.w1", base.face = "plate.w0" }}
stages = [{{ name = "rest", steps = 1 }}]
"""


def over_waves(order: int, lift: float) -> tuple[Equilibrium, FloatArray]:
    """The block at a height over hills and hollows: what computes it, and positions of all control points."""
    problem = Scene.from_toml(_SCENE.format(order=order, elements=16 // order)).problem()
    equilibrium = Equilibrium(problem, Ledger())
    numbers, positions = equilibrium.numbering.points, equilibrium.numbering.reference.copy()
    top = numbers["plate"][problem.body("plate").patch.face_points("w1")]
    positions[top, 2] = HEIGHT * np.prod(np.sin(2 * np.pi * WAVES * positions[top, :2]), axis=1)
    positions[numbers["slave"], 2] += lift
    return equilibrium, positions


@case(
    claim="At gaps below the radius of curvature of a wavy master the foot along averaged normals is the same from any start.",
    tier="gate",
    grid={"order": [1, 2], "lift": [-0.02, 0.05, 0.1]},
    bounds={
        "foot": Bound(at_most=1e-12, reason="round-off: Newton's method from either side ends where nothing moves"),
        "found": Bound(at_least=1.0, at_most=1.0, reason="definition: the block is above the middle of the plate, whatever the start"),
        "near": Bound(at_least=0.02, at_most=0.17, reason="definition: largest distance of a point from its foot"),
    },
)
def from_any_start(order: int, lift: float) -> dict[str, float]:
    """Largest distance of feet from those of no start, for starts anywhere and a part of a wave aside; least share found; distance."""
    equilibrium, positions = over_waves(order, lift)
    problem, pair, numbers = equilibrium.problem, equilibrium.pairs[0], equilibrium.numbering.points
    plate, block = problem.body("plate").patch, problem.body("slave").patch
    surface = Surface(replace(plate, control_points=positions[numbers["plate"]]), "w1")
    state = equilibrium.initial_state().contacts[0]
    shape, random = state.projection.shape, np.random.default_rng(order)

    def feet(start: ContactState) -> tuple[np.ndarray, np.ndarray]:
        found = pair.kinematics(positions, start).projections
        return surface.points(found.xi), found.found

    cold, first = feet(replace(state, projected=np.zeros_like(state.projected)))
    starts = [random.uniform(0.0, 1.0, shape) for _ in range(2)]
    starts += [np.clip(state.projection + part / WAVES * random.choice([-1.0, 1.0], shape), 0.0, 1.0) for part in (0.25, 0.5, 1.0)]
    warm = [feet(replace(state, projection=xi, projected=np.ones_like(state.projected))) for xi in starts]
    points = areas(problem)[0] @ positions[numbers["slave"][block.face_points("w0")]]
    return {
        "foot": float(np.max([np.linalg.norm(there - cold, axis=1) for there, _ in warm])),
        "found": float(np.min([np.mean(found) for found in (first, *(found for _, found in warm))])),
        "near": float(np.linalg.norm(points - cold, axis=1).max()),
    }


#: About which the block is turned: the middle of its lower face.
MIDDLE = np.array([0.5, 0.5, 0.0])
#: What is given of a place beside a limit of theory 3.30: a gap as a share of the face's diagonal, or the angle between the faces, degrees.
LIMITS = {"open": (-0.499, -0.501), "closed": (0.099, 0.101), "turned": (78.4, 78.6)}


@case(
    claim="Along averaged normals feet are up to half the face's diagonal away, a tenth of it deep, and where both sides face each other.",
    tier="gate",
    grid={"limit": list(LIMITS), "order": [1, 2]},
    bounds={
        "within": Bound(at_least=1.0, at_most=1.0, reason="definition: share of points that have a foot just below the limit"),
        "beyond": Bound(at_least=0.0, at_most=0.0, reason="definition: share of points that have a foot just above the limit"),
    },
)
def scope(limit: str, order: int) -> dict[str, float]:
    """Shares of slave points that are found on a flat plate, from no start and from where they are."""
    equilibrium = Equilibrium(Scene.from_toml(_SCENE.format(order=order, elements=4)).problem(), Ledger())
    pair, slave, reference = equilibrium.pairs[0], equilibrium.numbering.points["slave"], equilibrium.numbering.reference
    start = equilibrium.initial_state().contacts[0]

    def found(value: float) -> list[float]:
        positions = reference.copy()
        if limit == "turned":
            angle, arms = np.deg2rad(value), reference[slave] - MIDDLE
            x, z = np.cos(angle) * arms[:, 0] + np.sin(angle) * arms[:, 2], np.cos(angle) * arms[:, 2] - np.sin(angle) * arms[:, 0]
            positions[slave] = MIDDLE + np.column_stack([x, arms[:, 1], z + 0.3])
        else:
            positions[slave, 2] -= value * np.sqrt(2.0)
        return [share(positions, one) for one in (replace(start, projected=np.zeros_like(start.projected)), start)]

    def share(positions: FloatArray, one: ContactState) -> float:
        try:
            return float(np.mean(pair.kinematics(positions, one).projections.found))
        except LostProjectionError:  # a point that was there before
            return 0.0

    within, beyond = LIMITS[limit]
    return {"within": min(found(within)), "beyond": max(found(beyond))}
