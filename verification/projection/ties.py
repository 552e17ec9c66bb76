"""Two places that are equally near: from any start the foot is the same one of them, that of lower coordinates."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from projection.closest_points import Surface

from isomortar.geometry.patch import FloatArray
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case

#: Family and order, and elements: the middle is a line between elements, or that of one.
MASTERS = {"N2": 12, "N3": 8, "L2": 12, "N4": 3, "L4": 3}
TARGETS, STARTS, HEIGHT = 60, 8, 0.4
#: Feet that are nearer to each other are one: about a centre of curvature all places are as near.
APART = 5e-3


def trough(kind: str, axis: int) -> Surface:
    """The upper face of a plate over the unit square with waves along an axis, symmetric about a trough in the middle."""
    order, elements = int(kind[1:]), [2, 2, 1]
    elements[axis] = MASTERS[kind]
    plate = mesh(box((0.0, 0.0, -0.5), (1.0, 1.0, 0.0)), (kind[0],) * 3, (order, order, 1), elements)  # type: ignore[arg-type]
    points = plate.control_points.copy()
    points[:, 2] -= HEIGHT * np.cos(3 * np.pi * (points[:, axis] - 0.5))
    return Surface(replace(plate, control_points=points), "w1")


def in_the_middle(axis: int) -> FloatArray:
    """Targets above the trough, in its plane of symmetry; shape (n, 3)."""
    targets = np.random.default_rng(7 + axis).uniform([0.2, 0.2, -0.3], [0.8, 0.8, 0.2], (TARGETS, 3))
    targets[:, axis] = 0.5
    return targets


@case(
    claim="Of two feet equally near, on both sides of a plane of symmetry, all starts find that of the lower element or coordinate.",
    grid={"kind": list(MASTERS), "axis": [0, 1]},
    bounds={
        "other": Bound(at_most=0.0, reason="definition: targets of which a start finds another foot than the first"),
        "upper": Bound(at_most=0.0, reason="definition: targets whose foot is beyond the plane of symmetry, where coordinates are higher"),
        "ties": Bound(at_least=10.0, at_most=float(TARGETS), reason="definition: targets with two feet, or nothing is chosen"),
    },
)
def ties(kind: str, axis: int) -> dict[str, float]:
    """Targets by what is found for them, from no start and from random ones."""
    face = trough(kind, axis)
    targets, (low, high) = in_the_middle(axis), face.ends
    found = face.project(targets)
    targets = targets[found.found == 1]
    first = face.points(face.project(targets).xi)
    off = first[:, axis] - targets[:, axis]
    random = np.random.default_rng(8)
    starts = low + random.uniform(0.0, 1.0, (STARTS, len(targets), 2)) * (high - low)
    again = [face.points(face.project(targets, xi).xi) for xi in starts]
    other = np.any([np.linalg.norm(points - first, axis=1) > APART for points in again], axis=0)
    return {
        "other": float(np.count_nonzero(other)),
        "upper": float(np.count_nonzero(off > APART)),
        "ties": float(np.count_nonzero(np.abs(off) > APART)),
    }


def across_a_diagonal(kind: str) -> Surface:
    """The upper face of a plate over the unit square with waves across a diagonal of it, symmetric about a trough along that."""
    order, elements = int(kind[1:]), MASTERS[kind]
    plate = mesh(box((0.0, 0.0, -0.5), (1.0, 1.0, 0.0)), (kind[0],) * 3, (order, order, 1), (elements, elements, 1))  # type: ignore[arg-type]
    points = plate.control_points.copy()
    points[:, 2] -= HEIGHT * np.cos(3 * np.pi * (points[:, 0] - points[:, 1]))
    return Surface(replace(plate, control_points=points), "w1")


@case(
    claim="Of two feet equally near, neither of which is lower along both coordinates, all starts find that which is along the second.",
    grid={"kind": ["N2", "N3", "L2"]},
    bounds={
        "other": Bound(at_most=0.0, reason="definition: feet that are lower along the first coordinate"),
        "ties": Bound(at_least=10.0, reason="definition: or nothing is chosen"),
    },
)
def diagonal_ties(kind: str) -> dict[str, float]:
    """Feet of targets above the trough, from no start and from random ones."""
    face, random = across_a_diagonal(kind), np.random.default_rng(9)
    along, height = random.uniform(0.3, 0.7, TARGETS), random.uniform(-0.3, 0.2, TARGETS)
    targets = np.column_stack([along, along, height])
    feet = [face.project(targets)] + [face.project(targets, random.uniform(0.0, 1.0, (TARGETS, 2))) for _ in range(STARTS)]
    aside = np.concatenate([(points[:, 0] - points[:, 1])[found.found == 1] for found in feet for points in [face.points(found.xi)]])
    return {"other": float(np.count_nonzero(aside < -APART)), "ties": float(np.count_nonzero(aside > APART))}
