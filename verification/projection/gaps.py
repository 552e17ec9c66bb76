"""What follows from a foot is of that foot: the gap is its distance, and contact forces act there, along the way to it."""

from __future__ import annotations

import numpy as np
from projection.closest_points import NOT_THE_ONLY_ONE, Surface
from projection.in_extended_precision import FACES, given, targets_of
from projection.poles import face as dome_face
from projection.poles import turned

from isomortar import _bindings
from isomortar._arrays import Pattern, Response
from isomortar._codes import PointState
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.harness import Bound, case

#: Of all classes, and with a pole at any end.
MASTERS = FACES | {f"dome, {way}": lambda way=way: turned(dome_face("N2"), way) for way in ("high first", "low first", "low second")}
TARGETS = 80


def across(face: Surface, xi: FloatArray) -> FloatArray:
    """Ways from places of a face through its body, to the face across."""
    return Surface(face.patch, f"{face.face[0]}{1 - int(face.face[1])}", face.closed).points(xi) - face.points(xi)


@case(
    claim="Gaps are distances from feet, negative outside the body; what acts on a point acts back on its foot, along the way there.",
    grid={"master": list(MASTERS)},
    bounds={
        "gap": Bound(at_most=1e-13, reason="round-off: of positions, by share of the face's size"),
        "force": Bound(at_most=1e-13, reason="definition: actio est reactio; what is left of forces, by share of their sum"),
        "moment": Bound(at_most=1e-13, reason="definition: the same of moments, by the face's size"),
        "acting": Bound(at_least=10.0, at_most=float(TARGETS), reason="definition: so many points have a foot that follows them"),
    },
)
def gaps_and_forces(master: str) -> dict[str, float]:
    """Largest difference of a gap from the distance; what is left of forces and moments of random pressures; how many points have any."""
    face = MASTERS[master]()
    targets = targets_of(face, TARGETS)
    slave, onto, positions, origin, had = given(face, targets, 1.0, None)
    feet = _bindings.project_points(slave, onto, positions, origin, had)
    control = _bindings.control_quantities(slave, onto, positions, feet)
    acting = feet.followed == 1
    way, size = face.points(feet.xi) - targets, float(np.ptp(positions, axis=0).max())
    outside = np.sum(way * across(face, feet.xi), axis=1) > 0.0
    gap = np.linalg.norm(way, axis=1) * np.where(outside, -1.0, 1.0)
    pressure = np.where(acting, np.random.default_rng(6).uniform(0.5, 1.5, TARGETS), 0.0)
    state, none = np.where(acting, np.int32(PointState.STICK), np.int32(PointState.OPEN)), np.zeros((TARGETS, 2))
    response = Response(pressure, none, state, np.zeros(TARGETS), np.zeros((TARGETS, 6, 2)), none)
    forces = np.zeros_like(positions)
    _bindings.contact_forces(slave, onto, positions, feet, response, forces)
    return {
        "gap": float(np.abs(control.gap - gap)[acting].max() / size),
        "force": float(np.linalg.norm(forces.sum(axis=0)) / pressure.sum()),
        "moment": float(np.linalg.norm(np.cross(positions, forces).sum(axis=0)) / pressure.sum() / size),
        "acting": float(acting.sum()),
    }


def trough() -> Surface:
    """The upper face of a body below z = x^2, 0 < y < 1."""
    line, curve = (Direction("N", order, np.repeat([0.0, 1.0], order + 1)) for order in (1, 2))
    points = np.zeros((2, 2, 3, 3))
    points[..., 0] = [-1.0, 0.0, 1.0]
    points[:, 1, :, 1] = 1.0
    points[..., 2] = np.array([1.0, -1.0, 1.0]) - np.array([2.0, 0.0])[:, None, None]
    return Surface(Patch((curve, line, line), points.reshape(-1, 3), np.ones(12)), "w1")


@case(
    claim="What bears no pressure adds nothing to the tangent, not even where a foot has no direction: at the centre of curvature.",
    bounds={
        "doubted": Bound(at_least=1.0, at_most=1.0, reason="definition: at the centre places beside the foot are as near"),
        "tangent": Bound(at_most=0.0, reason="definition: of no pressure, and of no traction"),
        "rows": Bound(
            at_least=np.sqrt(2.0), at_most=np.sqrt(2.0) + 1e-15, reason="definition: a gap changes by what its point and foot part"
        ),
    },
)
def without_pressure() -> dict[str, float]:
    """Whether the foot below the centre is doubted, largest block of the tangent, and the size of the gap's row."""
    face = trough()
    slave, onto, positions, origin, had = given(face, np.array([[0.0, 0.5, 0.5]]), 1.0, None)
    feet = _bindings.project_points(slave, onto, positions, origin, had)
    count, none = len(positions), np.zeros((1, 2))
    response = Response(np.zeros(1), none, np.ones(1, dtype=np.int32), np.zeros(1), np.zeros((1, 6, 2)), none)
    every = np.arange(count, dtype=np.int32)
    all_of_one, all_of_all = (Pattern(np.arange(n + 1, dtype=np.int32) * np.int32(count), np.tile(every, n)) for n in (1, count))
    rows, tangent = np.zeros((count, 1, 3)), np.zeros((count * count, 3, 3))
    _bindings.contact_blocks(slave, onto, positions, feet, False, response, all_of_one, rows, all_of_all, tangent)
    foot = rows[: len(face.patch.weights)].sum(axis=0)
    return {
        "doubted": float(feet.doubt[0] == NOT_THE_ONLY_ONE),
        "tangent": float(np.abs(tangent).max()),
        "rows": float(np.hypot(np.linalg.norm(rows[-1]), np.linalg.norm(foot))),
    }
