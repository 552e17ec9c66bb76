"""Spheres, boxes and hulls that rule out elements of a master, against Bezier points of splinepy's and points of the surface."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import splinepy
from projection.closest_points import Surface
from projection.nearest import MASTERS
from scipy.interpolate import BPoly

from isomortar import _twin
from isomortar._codes import WORK
from isomortar.geometry.patch import FloatArray, Patch
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case

#: Points of an element along each direction.
SAMPLES = 9
#: Curvature, times the size of the face, below which differences see nothing but round-off.
FLAT = 1e-4


def beziers(face: Surface) -> tuple[FloatArray, bool]:
    """Bezier points of the elements, shape (elements, second, first, 3), and whether weights differ."""
    first, second = face.patch.face_directions(face.face)
    numbers = face.patch.face_points(face.face)
    if first.family == "L":
        return np.array([_interpolated(face, (u, v)) for v in _spans(second.boundaries) for u in _spans(first.boundaries)]), False
    weights = face.patch.weights[numbers]
    spline = splinepy.NURBS([first.order, second.order], [first.knots, second.knots], face.patch.control_points[numbers], weights[:, None])
    shape = (-1, second.order + 1, first.order + 1, 3)
    return np.array([part.control_points for part in spline.extract.beziers()]).reshape(shape), bool(np.ptp(weights) > 0)


def _spans(boundaries: FloatArray) -> list[tuple[float, float]]:
    return list(pairwise(boundaries))


def _interpolated(face: Surface, element: tuple[tuple[float, float], tuple[float, float]]) -> FloatArray:
    """Bezier points, shape (second, first, 3), of a polynomial element from its values at Chebyshev's points."""
    orders = [d.order for d in face.patch.face_directions(face.face)]
    shares = [0.5 - 0.5 * np.cos(np.pi * (np.arange(p + 1) + 0.5) / (p + 1)) for p in orders]
    u, v = (low + share * (high - low) for share, (low, high) in zip(shares, element, strict=True))
    values = face.points(np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2)).reshape(len(v), len(u), 3)
    first, second = (np.linalg.inv(BPoly(np.eye(p + 1)[:, None], [0.0, 1.0])(share)) for p, share in zip(orders, shares, strict=True))
    return np.einsum("jl,ik,lkx->jix", second, first, values)


def bound_of_curvature(bezier: FloatArray) -> float:
    """Second differences over the product of first ones, these along their means (theory 3.17)."""
    steps = [np.diff(bezier, axis=axis) for axis in (1, 0)]
    orders = np.array([bezier.shape[1] - 1, bezier.shape[0] - 1])
    means = [step[[0, -1]].sum(axis=(0, 1)) if axis == 0 else step[:, [0, -1]].sum(axis=(0, 1)) for axis, step in enumerate(steps)]
    least = [p * np.min(step @ mean) / np.linalg.norm(mean) for p, step, mean in zip(orders, steps, means, strict=True)]
    if not np.min(least) > 0:
        return float(np.finfo(float).max)
    bends = [(0, 0, np.diff(steps[0], axis=1)), (0, 1, np.diff(steps[0], axis=0)), (1, 1, np.diff(steps[1], axis=0))]
    factors = [orders[a] * (orders[b] - (a == b)) / (least[a] * least[b]) for a, b, _ in bends]
    return float(np.max([f * np.linalg.norm(bend, axis=-1).max(initial=0.0) for f, (_, _, bend) in zip(factors, bends, strict=True)]))


def across(bezier: FloatArray) -> FloatArray:
    """Unit normal of the diagonals of an element's corners."""
    normal: FloatArray = np.cross(bezier[-1, -1] - bezier[0, 0], bezier[-1, 0] - bezier[0, -1])
    return normal / np.linalg.norm(normal)


def curvature(face: Surface, xi: FloatArray, span: FloatArray) -> float:
    """Most that the derivatives of a surface turn or stretch: |S,ab| / (|a_a| |a_b|) by differences of its tangents."""
    step = 1e-5 * span
    tangents = [face.tangents(xi, a) for a in (0, 1)]
    worst = 0.0
    for b in (0, 1):
        shift = step * np.eye(2)[b]
        for a in (0, 1):
            change = (face.tangents(xi + shift, a) - face.tangents(xi - shift, a)) / (2 * step[b])
            lengths = np.linalg.norm(tangents[a], axis=1) * np.linalg.norm(tangents[b], axis=1)
            worst = np.maximum(worst, np.max(np.linalg.norm(change, axis=1) / lengths))
    return float(worst)


@case(
    claim="No point of an element is outside its sphere, box or hull; boxes are tight; the bound of the curvature is one.",
    tier="gate",
    grid={"master": ["wavy N4", "wavy L2", "one row N2", "folded N3", "thin N2", "inside a ring", "round a ring"]},
    bounds={
        "corner": Bound(at_most=1e-13, reason="round-off: Bezier points, by share of the face's size"),
        "sample": Bound(at_most=1e-14, reason="round-off: points of the grid"),
        "sphere": Bound(at_most=1e-14, reason="definition: how far points are outside"),
        "box": Bound(at_most=1e-14, reason="definition: how far points are outside"),
        "aligned": Bound(at_most=1e-12, reason="definition: sine of the angle between a box's third axis and the normal of the diagonals"),
        "slack": Bound(at_most=1e-8, reason="definition: the box touches the hull but for its margin, the sphere the box"),
        "formula": Bound(at_most=1e-10, reason="round-off: of second differences; (3.17) in NumPy on these points"),
        "exceeded": Bound(at_most=1.0, reason="definition: curvature at points of the surface over its bound"),
    },
)
def hulls(master: str) -> dict[str, float]:
    """How far the kernel's hulls are from what they have to be."""
    face = MASTERS[master]()
    found = _twin.surface_hulls(face.master(), face.patch.control_points)
    expected, rational = beziers(face)
    size = float(np.ptp(expected, axis=(0, 1, 2)).max())
    flat = expected.reshape(found.corner.shape)
    directions = face.patch.face_directions(face.face)
    elements = [(u, v) for v in _spans(directions[1].boundaries) for u in _spans(directions[0].boundaries)]
    shares = np.linspace(0.0, 1.0, SAMPLES)
    worst = dict.fromkeys(("sample", "sphere", "box", "aligned", "slack", "formula", "exceeded"), 0.0)
    for e, element in enumerate(elements):
        low, span = np.array(element)[:, 0], np.diff(element).ravel()
        inside = low + span * np.stack(np.meshgrid(shares, shares), axis=-1).reshape(-1, 2)
        grid = low + span * np.stack(np.meshgrid(*[np.linspace(0, 1, d.order + 1) for d in directions]), axis=-1).reshape(-1, 2)
        points = face.points(inside)
        local, corners = ((p - found.centre[e]) @ found.frame[e].T for p in (points, flat[e]))
        bound = bound_of_curvature(expected[e])
        measured = {
            "sample": np.abs(found.sample[e] - face.points(grid)).max() / size,
            "sphere": np.max(np.linalg.norm(points - found.centre[e], axis=1) - found.radius[e]) / size,
            "box": np.max(np.abs(local) - found.half[e]) / size + np.abs(found.frame[e] @ found.frame[e].T - np.eye(3)).max(),
            "aligned": np.linalg.norm(np.cross(found.frame[e][2], across(expected[e]))),
            "slack": (np.max(found.half[e] - np.abs(corners).max(axis=0)) + abs(found.radius[e] - np.linalg.norm(found.half[e]))) / size,
            "formula": abs(found.curvature[e] - bound) / (bound + 1.0 / size),
            "exceeded": 0.0 if rational else curvature(face, low + 0.9 * (inside - low) + 0.05 * span, span) / (bound + FLAT / size),
        }
        worst = {name: np.maximum(worst[name], value) for name, value in measured.items()}
    return {"corner": float(np.abs(found.corner - flat).max() / size), **{name: float(value) for name, value in worst.items()}}


@case(
    claim="A point over a sample of an element is looked for there first, and found by a look at that element, with orders that differ.",
    tier="gate",
    grid={"orders": ("2, 3", "3, 2", "4, 2", "3, 5")},
    bounds={
        "foot": Bound(at_most=1e-13, reason="round-off: targets are on normals of samples"),
        "elements": Bound(1.0, 1.0, "definition: all others are ruled out by the distance to the sample"),
        "evaluations": Bound(1.0, 1.0, "definition: the search stands where the distance is least, and sees that once"),
    },
)
def from_samples(orders: str) -> dict[str, float]:
    """Largest error of feet, and elements and places that are looked at for each target."""
    first, second = map(int, orders.split(","))
    plate = mesh(box((0.0, 0.0, -0.5), (1.0, 1.0, 0.0)), ("N",) * 3, (first, second, 1), (3, 2, 1))
    points = plate.control_points.copy()
    points[:, 2] += 0.05 * np.sin(4.0 * points[:, 0]) * np.cos(3.0 * points[:, 1])
    face = Surface(Patch(plate.directions, points, plate.weights), "w1")
    inner = [np.setdiff1d(np.arange(p * n), p * np.arange(n)) / (p * n) for p, n in ((first, 3), (second, 2))]
    places = np.stack(np.meshgrid(*inner), axis=-1).reshape(-1, 2)
    normals = np.cross(face.tangents(places, 0), face.tangents(places, 1))
    counts = np.zeros(len(WORK), dtype=np.int64)
    targets = face.points(places) + 0.01 * normals / np.linalg.norm(normals, axis=1)[:, None]
    found = face.project(targets, None, counts)
    looks = dict(zip(WORK, counts / len(targets), strict=True))
    return {
        "foot": float(np.abs(found.xi - places).max()),
        "elements": float(looks["elements searched"]),
        "evaluations": float(looks["evaluations to order 2"]),
    }
