"""Faces from pole to pole: elements that end at both, and others."""

from __future__ import annotations

import numpy as np
from projection.closest_points import Surface
from projection.from_a_pole import gaps_of
from projection.nearest import exhaustive
from projection.poles import turned

from isomortar.geometry.patch import Direction, Patch
from isomortar.harness import Bound, case


def spindle(elements: int) -> Surface:
    """The outer face of a body about the z-axis, whose poles, at z = 1 and -1, are vertices; so many elements from one to the other."""
    along = Direction("N", 2, np.pad(np.linspace(0.0, 1.0, elements + 1), 2, mode="edge"))
    across = Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))
    round_it = Direction("N", 2, np.pad(np.arange(7.0), 2, mode="edge"))
    angle = 2 * np.pi * (np.arange(round_it.count) % (round_it.count - 1)) / (round_it.count - 1)
    height = np.linspace(-1.0, 1.0, along.count)
    profile = np.column_stack([0.8 * (1.0 - height**2), height])
    points = np.zeros((round_it.count, 2, along.count, 3))
    points[..., 0], points[..., 1] = (profile[:, 0] * f(angle)[:, None, None] for f in (np.cos, np.sin))
    points[..., 2] = profile[:, 1]
    points[:, 0] *= 0.5
    return Surface(Patch((along, across, round_it), points.reshape(-1, 3), np.ones(points[..., 0].size)), "v1", closed="w")


@case(
    claim="Of a face from pole to pole each pole is the foot of what is in its cone, from any start, were both in one element; what is "
    "beside the body has its nearest point.",
    grid={"way": ["high first", "low first", "high second", "low second"], "elements": [1, 2]},
    bounds={
        "foot": Bound(at_most=2e-16, reason="round-off: of the vertex, which is the nearest point of all in its cone of normals"),
        "gap": Bound(at_most=1e-15, reason="round-off: of the distance from the vertex"),
        "nearer": Bound(at_most=1e-12, reason="round-off: of points and distances, all of size one"),
    },
)
def of_a_spindle(way: str, elements: int) -> dict[str, float]:
    """Largest distance of feet from the poles, of gaps from the distance; by how much another point is nearer to targets beside it."""
    face, random = turned(spindle(elements), way), np.random.default_rng(6)
    low, high = face.ends
    end = np.where(np.arange(24) % 2 == 0, 1.0, -1.0)
    beyond = np.column_stack([random.uniform(-0.05, 0.05, (24, 2)), end * random.uniform(1.1, 1.5, 24)])
    poles = np.column_stack([np.zeros((24, 2)), end])
    beside = np.column_stack([random.uniform(-1.0, 1.0, (8, 2)), random.uniform(-1.3, 1.3, 8)])
    beside[:, :2] *= 1.1 / np.linalg.norm(beside[:, :2], axis=1)[:, None]
    apart = gap = nearer = 0.0
    for starts in (None, low + random.uniform(0.0, 1.0, (24, 2)) * (high - low)):
        feet = face.project(beyond, starts)
        apart = float(np.maximum(apart, np.linalg.norm(face.points(feet.xi) - poles, axis=1).max()))
        gap = float(np.maximum(gap, np.abs(gaps_of(face, beyond, feet) + np.linalg.norm(beyond - poles, axis=1)).max()))
        nearer = float(np.maximum(nearer, exhaustive(face, beside, face.project(beside, None if starts is None else starts[:8]).xi).max()))
    return {"foot": apart, "gap": gap, "nearer": nearer}
