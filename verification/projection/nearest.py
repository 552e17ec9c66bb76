"""The foot is the nearest point of the whole master, from any start: by an exhaustive search that shares nothing with the kernel's."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from projection.closed import face as ring_face
from projection.closest_points import Surface
from scipy.optimize import minimize
from scipy.spatial import cKDTree
from shapes import turned_sector

from isomortar.geometry.patch import FloatArray, Patch
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case


def _bent(kind: str, elements: int | tuple[int, int], thickness: float, height: FloatArray | None = None, fold: bool = False) -> Surface:
    """The upper face of a plate over the unit square, its control points raised by `height` or rolled into an S."""
    order = int(kind[1:])
    plate = box((0.0, 0.0, -thickness), (1.0, 1.0, 0.0))
    patch = mesh(plate, (kind[0],) * 3, (order, order, 1), (*np.broadcast_to(elements, 2), 1))  # type: ignore[arg-type]
    points = patch.control_points.copy()
    if height is not None:
        points[:, 2] += height[0] * np.sin(2 * np.pi * height[1] * points[:, 0]) * np.sin(2 * np.pi * height[1] * points[:, 1])
    if fold:
        turn = 2 * np.pi * points[:, 0]
        along = np.column_stack([0.8 * np.cos(2 * turn) + 0.3 / (2 * np.pi), np.full(len(turn), 1 / 6)])
        along /= np.linalg.norm(along, axis=1)[:, None]
        middle = np.column_stack([0.4 * np.sin(2 * turn) + 0.3 * points[:, 0], turn / 6])
        points[:, 0], points[:, 2] = (middle + points[:, 2:] * np.column_stack([-along[:, 1], along[:, 0]])).T
    return Surface(Patch(patch.directions, points, patch.weights), "w1")


def _pole(kind: str) -> Surface:
    """The outer face of a part of a sphere up to its pole, where an edge is collapsed."""
    part = turned_sector(0.0, 0.3, 0.7, (-0.5, np.pi / 2), 1.2)
    return Surface(mesh(part, (kind[0],) * 3, (int(kind[1:]),) * 3, (3, 3, 2)), "v1")  # type: ignore[arg-type]


#: Masters by class: wavy ones, with several near points within an element too; with knot lines of the second direction alone;
#: folded; thin; with a pole; closed, from inside and outside.
MASTERS = {
    "wavy N2": lambda: _bent("N2", 8, 0.5, np.array([0.12, 2.0])),
    "wavy N3": lambda: _bent("N3", 8, 0.5, np.array([0.12, 2.0])),
    "wavy N4": lambda: _bent("N4", 3, 0.5, np.array([0.5, 1.5])),
    "wavy L1": lambda: _bent("L1", 8, 0.5, np.array([0.12, 2.0])),
    "wavy L2": lambda: _bent("L2", 8, 0.5, np.array([0.12, 2.0])),
    "one row N2": lambda: _bent("N2", (1, 8), 0.5, np.array([0.12, 1.0])),
    "one row L2": lambda: _bent("L2", (1, 8), 0.5, np.array([0.12, 1.0])),
    "folded N2": lambda: _bent("N2", 12, 0.1, fold=True),
    "folded N3": lambda: _bent("N3", 12, 0.1, fold=True),
    "thin N2": lambda: _bent("N2", 6, 1e-3, np.array([0.05, 1.0])),
    "pole N2": lambda: _pole("N2"),
    "pole N3": lambda: _pole("N3"),
    "inside a ring": lambda: ring_face("N2", "v0"),
    "round a ring": lambda: ring_face("N3", "v1"),
}
#: Samples along each side of the exhaustive search, and the number of points by tier.
SAMPLES, POINTS = 401, {"gate": 300, "nightly": 100_000}


def exhaustive(face: Surface, targets: FloatArray, feet: FloatArray) -> FloatArray:
    """By how much a point of the face is nearer to each target than its foot; refined where a sample comes within a cell of that."""
    u, v = (np.linspace(low, high, SAMPLES) for low, high in face.ends.T)
    grid = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
    points = face.points(grid)
    least, nearest = cKDTree(points).query(targets)
    distance = np.linalg.norm(face.points(feet) - targets, axis=1)
    excess = distance - least
    apart = np.linalg.norm(points[nearest] - face.points(feet), axis=1)
    cell = np.linalg.norm(np.diff(points.reshape(SAMPLES, SAMPLES, 3), axis=0), axis=2).max()
    for q in np.flatnonzero((apart > 4 * cell) & (excess > -(cell**2) / np.maximum(distance, cell))):
        refined = minimize(
            lambda xi, q=q: float(np.sum((face.points(xi[None])[0] - targets[q]) ** 2)), grid[nearest[q]], bounds=face.ends.T
        )
        excess[q] = distance[q] - np.sqrt(refined.fun)
    return excess


def too_deep(face: Surface, targets: FloatArray, feet: FloatArray) -> NDArray[np.bool_]:
    """Which targets are behind the face by more than the body's depth below their feet."""
    across = Surface(face.patch, f"{face.face[0]}{1 - int(face.face[1])}", face.closed)
    foot = face.points(feet)
    depth = across.points(feet) - foot
    way = targets - foot
    return (np.sum(way * depth, axis=1) > 0) & (np.linalg.norm(way, axis=1) > np.linalg.norm(depth, axis=1))


@case(
    claim="The foot of a random point is the nearest point of the whole master, from any start; one deeper than the body has none.",
    tier=lambda master, points: "gate" if points == POINTS["gate"] else "nightly",  # noqa: ARG005
    grid={"master": list(MASTERS), "points": list(POINTS.values())},
    bounds={
        "nearer": Bound(at_most=1e-9, reason="definition: no point of the master may be nearer; half the digits of a least distance"),
        "apart": Bound(at_most=1e-7, reason="round-off: the distance is flat at its least; half of the digits of a foot"),
        "deep": Bound(at_most=0.0, reason="definition: what is behind the body takes no part"),
        "found": Bound(at_least=0.05, at_most=0.95, reason="definition: points lie beside the master too"),
    },
)
def nearest_foot(master: str, points: int) -> dict[str, float]:
    """Most that a point is nearer than a foot, feet from random starts apart from those from none, too deep and found, share found."""
    face = MASTERS[master]()
    low, high = face.ends
    random = np.random.default_rng(points)
    corners = face.patch.control_points[face.patch.face_points(face.face)]
    targets = random.uniform(corners.min(axis=0) - 0.3, corners.max(axis=0) + 0.3, (points, 3))
    cold = face.project(targets)
    deep = too_deep(face, targets, cold.xi)
    starts = low + random.uniform(0, 1, (points, 2)) * (high - low)
    warm, found = face.project(targets[~deep], starts[~deep]), cold.found[~deep]
    ways = face.points(warm.xi) - targets[~deep], face.points(cold.xi[~deep]) - targets[~deep]
    both = (warm.found == 1) & (found == 1)
    excess = np.abs(np.linalg.norm(ways[0], axis=1) - np.linalg.norm(ways[1], axis=1))
    return {
        "nearer": float(np.maximum(excess.max(), exhaustive(face, targets, cold.xi).max())),
        "apart": float(np.linalg.norm(ways[0] - ways[1], axis=1)[both].max()) + float(np.sum(warm.found != found)),
        "deep": float(np.sum(cold.found[deep])),
        "found": float(np.mean(cold.found)),
    }


def _beside_lines(face: Surface, count: int, seed: int) -> tuple[FloatArray, FloatArray]:
    """Points on the hollow side of C0 lines, near to both elements there, and starts in either of them."""
    random = np.random.default_rng(seed)
    elements = int(face.patch.directions[0].elements)
    across = random.integers(0, 2, count)
    xi = random.uniform(0.0, 1.0, (count, 2))
    xi[np.arange(count), across] = random.integers(1, elements, count) / elements
    line, shift = face.points(xi), 1e-4 * np.eye(2)[across]
    sides = [face.points(xi + sign * shift) - line for sign in (-1.0, 1.0)]
    hollow = np.sum([side / np.linalg.norm(side, axis=1)[:, None] for side in sides], axis=0)
    kinked = np.linalg.norm(hollow, axis=1) > 0.02
    distance = 10.0 ** random.uniform(-3.0, -1.3, (count, 1))
    way = hollow[kinked] / np.linalg.norm(hollow[kinked], axis=1)[:, None] + 0.1 * random.normal(size=(np.sum(kinked), 3))
    starts = xi + random.uniform(-1.0, 1.0, (count, 2)) / elements
    return line[kinked] + distance[kinked] * way, np.clip(starts, 0.0, 1.0)[kinked]


@case(
    claim="Of the feet on both sides of a hollow kink the nearer one is found, from either side, however near to the kink.",
    tier="gate",
    grid={"kind": ["L1", "L2"]},
    bounds={
        "nearer": Bound(at_most=1e-9, reason="definition: no point of the master may be nearer; half the digits of a least distance"),
        "points": Bound(at_least=400, at_most=1000, reason="definition: so many were looked at"),
    },
)
def beside_lines(kind: str) -> dict[str, float]:
    """Most that a point is nearer than a foot from a near start or from none; how many points."""
    face = _bent(kind, 6, 0.8, np.array([0.3, 2.0]))
    targets, starts = _beside_lines(face, 1000, seed=1)
    near, cold = (face.points(face.project(targets, start).xi) - targets for start in (starts, None))
    apart = np.abs(np.linalg.norm(near, axis=1) - np.linalg.norm(cold, axis=1)).max()
    excess = exhaustive(face, targets, face.project(targets).xi).max()
    return {"nearer": float(np.maximum(apart, excess)), "points": float(len(targets))}


#: Elements between a foot and its start, from one end of a strip to the other.
LONG = 40


@case(
    claim="A foot any number of elements from its start is found, whichever direction the knot lines on the way belong to.",
    tier="gate",
    grid={"kind": ["N2", "L1", "L2"], "along": ["u", "v", "both"]},
    bounds={
        "foot": Bound(at_most=1e-14, reason="round-off: of coordinates of size one; the plate is flat, its parameters are lengths"),
        "found": Bound(at_least=1.0, at_most=1.0, reason="definition: targets are above the plate"),
    },
)
def far_from_the_start(kind: str, along: str) -> dict[str, float]:
    """Largest distance of feet at one end of a flat plate, from starts at the other end, and the share found."""
    count = {"u": (LONG, 1), "v": (1, LONG), "both": (LONG, LONG)}[along]
    face = _bent(kind, count, 0.5)
    random = np.random.default_rng(7)
    feet = random.uniform(0.0, 1.0, (20, 2))
    starts = feet.copy()
    for a in range(2):
        if count[a] == LONG:
            feet[:, a], starts[:, a] = random.uniform(0.0, 1.0 / LONG, 20), random.uniform(1.0 - 1.0 / LONG, 1.0, 20)
    feet[::2], starts[::2] = starts[::2], feet[::2].copy()
    projections = face.project(np.column_stack([feet, random.uniform(-0.3, 0.3, 20)]), starts)
    return {"foot": float(np.abs(projections.xi - feet).max()), "found": float(np.mean(projections.found))}
