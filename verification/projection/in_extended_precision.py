"""Feet in double precision are those in extended precision, by the twin, which watches bounds and contracts on its way."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from projection.along_normals import over_waves
from projection.closest_points import Surface
from projection.nearest import MASTERS
from projection.poles import face as dome_face

from isomortar import _bindings, _twin
from isomortar._bindings import FaceArrays, Projections, SlaveArrays
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.harness import Bound, case
from isomortar.harness.cases import Claim

#: Of all classes, and a dome up to its pole with the collapsed edge in the middle of the face, and the cone that it is when raised.
FACES = {**MASTERS, "dome N2": lambda: dome_face("N2"), "cone N3": lambda: dome_face("N3", raised=0.1)}
#: Targets on a face and beside it, for both precisions and for units; unit lengths.
TARGETS, MANY, LENGTHS = 24, 300, (1e-4, 1.0, 1e4)


def targets_of(face: Surface, count: int) -> FloatArray:
    """Random places in a box about the face."""
    corners = face.patch.control_points[face.patch.face_points(face.face)]
    margin = 0.15 * np.ptp(corners, axis=0).max()
    return np.random.default_rng(3).uniform(corners.min(axis=0) - margin, corners.max(axis=0) + margin, (count, 3))


def given(
    face: Surface, places: FloatArray, length: float, seed: int | None
) -> tuple[SlaveArrays, FaceArrays, FloatArray, FloatArray, IntArray]:
    """What a projection asks for: places as slave points, all lengths in a unit, random starts by a seed, or none."""
    count, own = len(places), len(face.patch.weights)
    slave = SlaveArrays.of_points(np.arange(own, own + count, dtype=np.int32))
    positions = length * np.concatenate([face.patch.control_points, places])
    low, high = face.ends
    origin = low + np.random.default_rng(seed).uniform(0.0, 1.0, (count, 2)) * (high - low)
    return slave, face.master(), positions, origin, np.full(count, seed is not None, dtype=np.int32)


def differ(one: Projections, other: Projections) -> float:
    """How many feet are of another kind."""
    return float(np.sum((one.found != other.found) | (one.doubt != other.doubt) | np.any(one.fixed != other.fixed, axis=1)))


def apart(face: Surface, one: Projections, other: Projections) -> float:
    """Largest distance of feet from others, of those that follow their points."""
    found = (one.found == 1) & (one.doubt == 0)
    return float(np.linalg.norm(face.points(one.xi) - face.points(other.xi), axis=1)[found].max(initial=0.0))


_SAME: Mapping[str, Claim] = {
    "foot": Bound(at_most=1e-13, reason="round-off: Newton's method ends below it; by share of the face's size"),
    "differ": Bound(at_most=0.0, reason="definition: found, doubted and fixed are no matter of round-off at random places"),
    "found": Bound(at_least=0.05, at_most=1.0, reason="definition: feet of none would not differ"),
}


@case(
    claim="Feet in double precision are those in extended precision, from any start and from none.",
    grid={"master": list(FACES)},
    bounds=_SAME,
)
def feet(master: str) -> dict[str, float]:
    """Largest difference of feet by share of the face's size, number of feet of another kind, share found."""
    face = FACES[master]()
    size = float(np.ptp(face.patch.control_points, axis=0).max())
    cold, far, near = _in_both(face, targets_of(face, TARGETS), None)
    _, far_again, near_again = _in_both(face, targets_of(face, TARGETS)[cold.found == 1], 4)  # deeper than the body: refused as a whole
    return {"foot": float(np.maximum(far, far_again)) / size, "differ": near + near_again, "found": float(np.mean(cold.found))}


def _in_both(face: Surface, places: FloatArray, seed: int | None) -> tuple[Projections, float, float]:
    one, other = (project(*given(face, places, 1.0, seed)) for project in (_bindings.project_points, _twin.project_points))
    return one, apart(face, one, other), differ(one, other)


@case(
    claim="Feet are the same in any unit of length, from any start and from none.",
    grid={"master": list(FACES)},
    bounds=_SAME,
)
def in_any_unit(master: str) -> dict[str, float]:
    """Largest difference of feet by share of the face's size, number of feet of another kind, share found."""
    face = FACES[master]()
    size = float(np.ptp(face.patch.control_points, axis=0).max())
    targets, worst, others = targets_of(face, MANY), 0.0, 0.0
    share = np.mean(_bindings.project_points(*given(face, targets, 1.0, None)).found)
    for seed in (None, 4):
        one, *more = (_bindings.project_points(*given(face, targets, length, seed)) for length in LENGTHS)
        worst = float(np.max([worst, *(apart(face, one, other) for other in more)]))
        others += sum(differ(one, other) for other in more)
        targets = targets[one.found == 1]  # from a start, what is deeper than the body is refused as a whole
    return {"foot": worst / size, "differ": others, "found": float(share)}


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
