"""Feet in double precision are those in extended precision, by the twin, which watches bounds and contracts on its way."""

from __future__ import annotations

import numpy as np
from projection.along_normals import over_waves
from projection.closest_points import Surface
from projection.nearest import MASTERS
from projection.poles import face as dome_face

from isomortar import _bindings, _twin
from isomortar._bindings import Projections, SlaveArrays
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case

#: Of all classes, and a dome up to its pole with the collapsed edge in the middle of the face, and the cone that it is when raised.
FACES = {**MASTERS, "dome N2": lambda: dome_face("N2"), "cone N3": lambda: dome_face("N3", raised=0.1)}
#: Targets on a face and beside it, and unit lengths.
TARGETS, LENGTHS = 12, (1e-3, 1.0, 1e3)


def targets_of(face: Surface, random: np.random.Generator) -> FloatArray:
    """Random places in a box about the face."""
    corners = face.patch.control_points[face.patch.face_points(face.face)]
    margin = 0.15 * np.ptp(corners, axis=0).max()
    return random.uniform(corners.min(axis=0) - margin, corners.max(axis=0) + margin, (TARGETS, 3))


def both_feet(face: Surface, places: FloatArray, length: float, seed: int | None) -> tuple[Projections, Projections]:
    """The kernel's and the twin's feet of places, all lengths in a unit; from random starts by a seed, or from none."""
    count, own = len(places), len(face.patch.weights)
    slave = SlaveArrays.of_points(np.arange(own, own + count, dtype=np.int32))
    positions = length * np.concatenate([face.patch.control_points, places])
    low, high = face.ends
    origin = low + np.random.default_rng(seed).uniform(0.0, 1.0, (count, 2)) * (high - low)
    had = np.full(count, seed is not None, dtype=np.int32)
    one, other = (project(slave, face.master(), positions, origin, had) for project in (_bindings.project_points, _twin.project_points))
    return one, other


def differ(one: Projections, other: Projections) -> float:
    """How many feet are of another kind."""
    return float(np.sum((one.found != other.found) | (one.doubt != other.doubt) | np.any(one.fixed != other.fixed, axis=1)))


@case(
    claim="Feet in double precision are those in extended precision, and the same in any unit of length, from any start and from none.",
    grid={"master": list(FACES)},
    bounds={
        "distance": Bound(at_most=1e-13, reason="round-off: of distances, by share of the face's size"),
        "foot": Bound(at_most=1e-7, reason="round-off: the distance is flat at its least; half of the digits of a foot"),
        "unit": Bound(at_most=1e-7, reason="round-off: of feet from those in the first unit"),
        "differ": Bound(at_most=0.0, reason="definition: found, doubted and fixed are no matter of round-off at random places"),
        "found": Bound(at_least=0.05, at_most=1.0, reason="definition: feet of none would not differ"),
    },
)
def feet(master: str) -> dict[str, float]:
    """Largest differences of distances and feet by share of the face's size, number of feet of another kind, share found."""
    face = FACES[master]()
    size = float(np.ptp(face.patch.control_points, axis=0).max())
    targets = targets_of(face, np.random.default_rng(3))
    worst = dict.fromkeys(("distance", "foot", "unit", "differ"), 0.0)
    share = 0.0
    for seed in (None, 4):
        first, _ = both_feet(face, targets, LENGTHS[0], seed)
        for length in LENGTHS:
            one, other = both_feet(face, targets, length, seed)
            places = [face.points(feet.xi) for feet in (one, other, first)]
            ways = [np.linalg.norm(place - targets, axis=1) for place in places]
            found = (one.found == 1) & (one.doubt == 0)
            measured = {
                "distance": np.abs(ways[0] - ways[1])[found].max(initial=0.0) / size,
                "foot": np.linalg.norm(places[0] - places[1], axis=1)[found].max(initial=0.0) / size,
                "unit": np.linalg.norm(places[0] - places[2], axis=1)[found].max(initial=0.0) / size,
                "differ": worst["differ"] + differ(one, other) + differ(one, first),
            }
            worst = {key: float(np.maximum(worst[key], value)) for key, value in measured.items()}
        if seed is None:
            share = float(np.mean(found))
            targets = targets[one.found == 1]  # from a start, what is deeper than the body is refused as a whole
    return worst | {"found": share}


@case(
    claim="Feet along averaged normals are those in extended precision, and the same in any unit of length, from any start and from none.",
    grid={"order": [1, 2]},
    bounds={
        "foot": Bound(at_most=1e-13, reason="round-off: of coordinates of size one; Newton's method ends where nothing moves"),
        "unit": Bound(at_most=1e-13, reason="round-off: of coordinates from those in the first unit"),
        "differ": Bound(at_most=0.0, reason="definition: found, doubted and fixed are no matter of round-off at general places"),
        "found": Bound(at_least=1.0, at_most=1.0, reason="definition: the block is above the middle of the plate"),
    },
)
def feet_along_normals(order: int) -> dict[str, float]:
    """Largest differences of coordinates, number of feet of another kind, share found; from none and from random starts."""
    equilibrium, positions = over_waves(order, 0.05)
    pair = equilibrium.pairs[0].pair
    count = len(pair.slave.area)
    starts = np.random.default_rng(order).uniform(0.0, 1.0, (count, 2))
    worst = dict.fromkeys(("foot", "unit", "differ"), 0.0)
    found = 1.0
    for had in (0, 1):
        origin = pair.slave, pair.master, starts, np.full(count, had, dtype=np.int32)
        twin = _twin.project_points(*origin[:2], positions, *origin[2:])
        units = [_bindings.project_points(*origin[:2], length * positions, *origin[2:]) for length in LENGTHS]
        measured = {
            "foot": np.abs(units[LENGTHS.index(1.0)].xi - twin.xi).max(),
            "unit": np.max([np.abs(one.xi - units[0].xi).max() for one in units]),
            "differ": worst["differ"] + sum(differ(one, twin) for one in units),
        }
        worst = {key: float(np.maximum(worst[key], value)) for key, value in measured.items()}
        found = float(np.minimum(found, np.min([np.mean(one.found) for one in (*units, twin)])))
    return worst | {"found": found}
