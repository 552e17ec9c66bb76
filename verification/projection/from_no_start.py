"""Surfaces with several feet of a point: the first projection finds the nearest, a search from a start never ends farther away."""

from __future__ import annotations

import numpy as np
from projection.closest_points import Surface

from isomortar import _bindings
from isomortar._bindings import FunctionArrays, SlaveArrays
from isomortar.geometry.patch import FloatArray, Patch
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case

#: Height and number of the waves along each side.
HEIGHT, WAVES = 0.12, 2


def waves(elements: int, steep: float = 1.0) -> Surface:
    """The upper face of a cubic block, raised to hills and hollows, so many times as `steep`."""
    patch = mesh(box((0.0, 0.0, -0.5), (1.0, 1.0, 0.0)), ("N",) * 3, (3, 3, 1), (elements, elements, 1))
    points: FloatArray = patch.control_points.copy()
    top = patch.face_points("w1")
    x, y = points[top, 0], points[top, 1]
    points[top, 2] = steep * HEIGHT * np.sin(2 * np.pi * WAVES * x) * np.sin(2 * np.pi * WAVES * y)
    return Surface(Patch(patch.directions, points, patch.weights), "w1")


@case(
    claim="Without a start, the nearest of all feet on a wavy surface is found.",
    tier="gate",
    bounds={
        "farther": Bound(at_most=1e-9, reason="definition: no point of a fine grid is nearer; Newton's method ends below this"),
        "found": Bound(at_least=1.0, at_most=1.0, reason="definition: targets above the middle have their feet inside"),
    },
)
def nearest_of_many() -> dict[str, float]:
    """By how much the foot is farther than the nearest of a grid, at most, and the share of targets that are found."""
    face = waves(8)
    random = np.random.default_rng(11)
    targets = np.column_stack([random.uniform(0.3, 0.7, (60, 2)), random.uniform(-0.05, 0.25, 60)])
    projections = face.project(targets)
    distance = np.linalg.norm(face.points(projections.xi) - targets, axis=1)
    nearest = face.sampled_distance(targets, 161)
    return {"farther": float(np.maximum(0.0, (distance - nearest).max())), "found": float(projections.found.mean())}


@case(
    claim="From any start on a wavy surface, the search ends no farther from the target than it began.",
    tier="gate",
    bounds={
        "farther": Bound(at_most=1e-14, reason="round-off: of the distances; every step and every change of element makes them smaller"),
        "nearer": Bound(at_least=0.1, reason="definition: a search that stands still is none; starts are a wave's length away"),
    },
)
def never_farther() -> dict[str, float]:
    """By how much the end is farther from the target than the start, at most, and nearer, in the mean."""
    face = waves(8)
    random = np.random.default_rng(12)
    targets = np.column_stack([random.uniform(0.2, 0.8, (300, 2)), random.uniform(-0.1, 0.4, 300)])
    starts = random.uniform(0.05, 0.95, (300, 2))
    ends = face.project(targets, starts).xi
    before, after = (np.linalg.norm(face.points(xi) - targets, axis=1) for xi in (starts, ends))
    return {"farther": float(np.maximum(0.0, (after - before).max())), "nearer": float((before - after).mean())}


@case(
    claim="Points of one element of a slave find the feet that each finds alone, from any start, however large the element is.",
    grid={"size": (0.1, 0.45)},
    bounds={
        "other": Bound(at_most=1e-13, reason="round-off: of the same search"),
        "moved": Bound(at_least=0.05, reason="definition: feet that are where the search began tell nothing"),
    },
)
def of_one_element(size: float) -> dict[str, float]:
    """Largest distance between the feet, and mean distance from the starts, of points near the surface within a square of some size."""
    face, random, count = waves(32, steep=4.0), np.random.default_rng(13), 100
    feet = 0.5 + size * random.uniform(-1.0, 1.0, (count, 2))
    targets = face.points(feet) + random.uniform(-0.02, 0.02, (count, 1)) * [0.0, 0.0, 1.0]
    starts = np.clip(feet + 0.1 * np.sign(random.uniform(-1.0, 1.0, (count, 2))), 0.0, 1.0)  # across a hill, for some
    own = len(face.patch.weights)
    together = FunctionArrays(np.arange(count, dtype=np.int32)[None].copy(), np.eye(count), count)
    points = np.arange(own, own + count, dtype=np.int32)
    slave = SlaveArrays(together, together, np.ones(count), points, np.zeros((count, 2, count)), 1)
    positions = np.concatenate([face.patch.control_points, targets])
    found = _bindings.project_points(slave, face.master(), positions, starts, np.ones(count, dtype=np.int32))
    places = [face.points(xi) for xi in (found.xi, face.project(targets, starts).xi, starts)]
    other, moved = (np.linalg.norm(places[0] - place, axis=1) for place in places[1:])
    return {"other": float(other.max()), "moved": float(moved.mean())}
