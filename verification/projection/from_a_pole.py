"""What is seen from a pole of a face that is not the same all round: cones of unequal sectors, corners of blocks, egg-shaped domes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from projection.closest_points import Surface
from projection.in_extended_precision import given
from projection.poles import INNER, starts, turned
from projection.poles import face as dome_face
from scipy.interpolate import BSpline
from scipy.optimize import minimize_scalar

from isomortar import _bindings
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.harness import Bound, case

WAYS = ("high first", "low first", "high second", "low second")
TARGETS = 90


def cone(order: int, rim: FloatArray, below: FloatArray) -> Surface:
    """The upper face of a body, of straight lines from the origin to control points of a rim; its lower face is `below`."""
    line = Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))
    elements = len(rim) - order + 1
    round_it = Direction("N", order, np.pad(np.arange(elements + 1.0), order, mode="edge"))
    points = np.zeros((len(rim) + 1, 2, 2, 3))
    points[:, 1, 0] = np.vstack([rim, rim[:1]])
    points[:, 0] = points[:, 1] + below
    return Surface(Patch((line, line, round_it), points.reshape(-1, 3), np.ones(4 * len(points))), "v1", closed="w")


def unequal(order: int) -> FloatArray:
    """A rim of unequal radii and heights."""
    random = np.random.default_rng(order)
    count = 5 + order
    angle = 2 * np.pi * np.arange(count) / count
    radius = random.uniform(0.6, 1.4, count)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), -random.uniform(0.1, 0.9, count)])


def nearest(order: int, rim: FloatArray, target: FloatArray) -> tuple[FloatArray, bool]:
    """The cone's nearest point, and whether it is plain: not near its end, nor as near as another line of the cone."""
    count = len(rim) + 1
    knots = np.pad(np.arange(count - order + 1.0), order, mode="edge")
    curve = BSpline(knots, np.vstack([rim, rim[:1]]), order)

    def fall(at: float) -> float:
        to = curve(at)
        return float(target @ to / np.linalg.norm(to))

    places = np.linspace(0.0, count - order, 40 * (count - order) + 1)
    sampled = np.array([fall(at) for at in places])
    peaks = np.flatnonzero((sampled >= np.roll(sampled, 1)) & (sampled >= np.roll(sampled, -1)))
    best = peaks[np.argmax(sampled[peaks])]
    size = float(np.linalg.norm(target))
    if sampled[best] < -0.05 * size:
        return np.zeros(3), True
    low, high = places[np.maximum(best - 1, 0)], places[np.minimum(best + 1, len(places) - 1)]
    at = float(minimize_scalar(lambda at: -fall(at), bounds=(low, high), method="bounded", options={"xatol": 1e-12}).x)
    way = fall(at)
    others = sampled[peaks][np.abs(places[peaks] - at) > 0.3]
    plain = 0.05 * size < way < 0.8 * float(np.linalg.norm(curve(at))) and bool(np.all(others < way - 0.05 * size))
    return way * curve(at) / np.linalg.norm(curve(at)), plain


@case(
    claim="From the vertex of a cone of unequal sectors, at any end of either direction, feet are the nearest points of the cone's lines: "
    "the vertex where none comes nearer, and there the gap is its distance.",
    grid={"order": [1, 2, 3], "way": list(WAYS)},
    bounds={
        "foot": Bound(at_most=1e-7, reason="round-off: the distance is flat at its least, SciPy's minimum has half of the digits"),
        "gap": Bound(at_most=1e-15, reason="round-off: of the distance from the vertex"),
        "at the vertex": Bound(at_least=10.0, at_most=float(TARGETS), reason="definition: so many targets are in its cone"),
        "beside it": Bound(at_least=10.0, at_most=float(TARGETS), reason="definition: so many targets are nearer to a line of the cone"),
    },
)
def of_unequal_sectors(order: int, way: str) -> dict[str, float]:
    """Largest distance of feet from SciPy's, from any start, from the pole and from none; of gaps at the vertex; targets of each kind."""
    rim = unequal(order)
    face = turned(cone(order, rim, np.array([0.0, 0.0, -2.0])), way)
    random = np.random.default_rng(11)
    targets = random.uniform(-0.4, 0.4, (TARGETS, 3)) + np.array([0.0, 0.0, 0.1])
    targets[::2] *= [0.2, 0.2, 1.0]  # more of them in the cone of the vertex
    found = [nearest(order, rim, target) for target in targets]
    plain = np.array([one[1] for one in found])
    targets, feet = targets[plain], np.array([one[0] for one in found])[plain]
    vertex = np.all(feet == 0.0, axis=1)
    worst = gap = 0.0
    for xi in (None, starts(face, len(targets), 12)):
        projections = face.project(targets, xi)
        worst = float(np.maximum(worst, np.linalg.norm(face.points(projections.xi) - feet, axis=1).max()))
        gaps = gaps_of(face, targets, projections)
        gap = float(np.maximum(gap, np.abs(gaps + np.linalg.norm(targets, axis=1))[vertex].max()))
    return {"foot": worst, "gap": gap, "at the vertex": float(np.sum(vertex)), "beside it": float(np.sum(~vertex))}


def gaps_of(face: Surface, targets: FloatArray, projections: _bindings.Projections) -> FloatArray:
    """Gaps of targets, each of which is a slave of one point, shape (n,)."""
    slave, master, positions, *_ = given(face, targets, 1.0, None)
    return _bindings.control_quantities(slave, master, positions, projections).gap


@case(
    claim="Above the corner of a block, on the normals of its faces as between them, the corner is the foot and the gap its distance.",
    grid={"way": list(WAYS)},
    bounds={
        "foot": Bound(at_most=0.0, reason="definition: no point of the block is nearer than the corner"),
        "gap": Bound(at_most=1e-15, reason="round-off: of the distance from the corner"),
    },
)
def of_a_block(way: str) -> dict[str, float]:
    """Largest distance of feet from the corner, and difference of gaps from the distance; edges of unequal lengths meet there."""
    face = turned(cone(1, -np.diag([0.5, 1.0, 3.0]), np.array([-0.4, -0.4, -0.4])), way)
    targets = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [0, 1, 1], [1, 0, 1], [1, 1, 1], [2, 1, 0], [1e-3, 0, 0]]) / 16
    projections = face.project(targets)
    gaps = gaps_of(face, targets, projections)
    return {
        "foot": float(np.abs(face.points(projections.xi)).max()),
        "gap": float(np.abs(gaps + np.linalg.norm(targets, axis=1)).max()),
    }


@case(
    claim="The pole of a dome is the foot of what is on its axis up to the centre of its largest curvature, in whichever direction; "
    "there, along one line alone, places beside it are as near.",
    grid={"way": list(WAYS), "side": ["x", "y", "between"]},
    bounds={
        "before": Bound(at_least=1.0, at_most=1.0, reason="definition: the pole is the only place so near"),
        "at the centre": Bound(at_most=0.0, reason="definition: 1 - distance times curvature is nothing there"),
        "foot": Bound(at_most=0.0, reason="definition: the pole is the nearest place"),
    },
)
def of_an_egg(way: str, side: str) -> dict[str, float]:
    """Share followed before the centre of curvature and at it, largest distance of feet from the pole; from the pole and from none."""
    smooth, share = dome_face("N2", "v0"), 0.8
    axis = np.array({"x": [1.0, 0.0], "y": [0.0, 1.0], "between": [0.5**0.5, 0.5**0.5]}[side])
    squeeze = np.eye(3)
    squeeze[:2, :2] -= (1.0 - share) * np.outer(axis, axis)
    egg = turned(replace(smooth, patch=replace(smooth.patch, control_points=smooth.patch.control_points @ squeeze)), way)
    pole, radius = np.array([0.0, 0.0, INNER]), share**2 * INNER
    at = np.full((1, 2), 0.3 * egg.ends[1])
    direction = 0 if way.endswith("first") else 1
    at[0, direction] = egg.ends[1 if way.startswith("high") else 0, direction]
    found: dict[float, list[float]] = {0.9: [], 1.0: []}
    worst = 0.0
    for part, followed in found.items():
        for start in (None, at):
            foot = egg.project(pole[None] - [[0.0, 0.0, part * radius]], start)
            followed.append(float(foot.followed[0]))
            worst = float(np.maximum(worst, np.linalg.norm(egg.points(foot.xi) - pole)))
    return {"before": float(np.mean(found[0.9])), "at the centre": float(np.mean(found[1.0])), "foot": worst}
