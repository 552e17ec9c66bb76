"""Feet on C0 lines of closed masters: on the seam of a polygon, and on a ridge that runs in a circle, where no angle may be nearer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from projection.closed import INNER, OUTER, PERIOD, WIDTH, swapped
from projection.closest_points import NOT_THE_ONLY_ONE, Surface

from isomortar import _bindings
from isomortar._bindings import Projections, SlaveArrays
from isomortar.geometry.patch import FloatArray
from isomortar.geometry.primitives import ring
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case

#: Corners of the polygon, and the angle by which the normal turns at each of them.
CORNERS = 8
TURN = 2.0 * np.pi / CORNERS
#: Height of the ridge in the ring's bore, and how steep it is.
RIDGE = 0.1
STEEP = RIDGE / (0.5 * WIDTH)
STARTS = 6


def polygon(order: str) -> Surface:
    """The outer face of a ring of straight elements, whose corners are on the circle, the first and last on the seam."""
    patch = mesh(ring((0.0, 0.0, 0.0), INNER, OUTER, WIDTH), ("L", "L", "L"), (1, 1, 1), (CORNERS, 1, 2))
    face = Surface(patch, "v1", closed="u")
    return face if order == "as it is" else swapped(face)


def bore(order: str) -> Surface:
    """The inner face of a ring with a ridge half-way along its axis, which is exactly round."""
    patch = mesh(ring((0.0, 0.0, 0.0), INNER, OUTER, WIDTH), ("N", "N", "L"), (2, 1, 1), (8, 1, 2))
    points = patch.control_points.copy()
    inside = patch.face_points("v0")
    middle = inside[np.abs(points[inside, 1]) < 1e-12 * WIDTH]
    points[np.ix_(middle, [0, 2])] *= (INNER - RIDGE) / INNER
    face = Surface(replace(patch, control_points=points), "v0", closed="u")
    return face if order == "as it is" else swapped(face)


def about(radius: FloatArray, y: FloatArray, angle: FloatArray) -> FloatArray:
    """Points at a distance from the rings' axis and at an angle about it from their seam, shape (n, 3)."""
    return np.column_stack([radius * np.sin(angle), y, radius * np.cos(angle)])


def projected(face: Surface, targets: FloatArray) -> list[Projections]:
    """Feet from the coarse search, and from random starts."""
    low, high = face.ends
    random = np.random.default_rng(len(targets))
    starts = low + random.uniform(0.0, 1.0, (STARTS, len(targets), 2)) * (high - low)
    return [face.project(targets), *(face.project(targets, xi) for xi in starts)]


def gap(face: Surface, targets: FloatArray, projections: Projections) -> FloatArray:
    """What the kernel takes for the gaps, shape (n,)."""
    own = len(face.patch.weights)
    slave = SlaveArrays.of_points(np.arange(own, own + len(targets), dtype=np.int32))
    positions = np.ascontiguousarray(np.concatenate([face.patch.control_points, targets]))
    return _bindings.control_quantities(slave, face.master(), positions, projections).gap


@case(
    claim="Above a corner of a closed polygon the foot is the corner, from any start, and stays there as its point moves; on its seam too.",
    tier="gate",
    grid={"order": ["as it is", "swapped"], "corner": [0, 1, CORNERS - 1]},
    bounds={
        "fixed": Bound(at_most=0.0, reason="theory: feet that are on the corner, or beside it, and are not said to be"),
        "foot": Bound(at_most=1e-14, reason="round-off: of coordinates of size one"),
        "gap": Bound(at_most=1e-14, reason="round-off: the distance from the corner, or from a straight element"),
        "element": Bound(at_most=0.0, reason="definition: a foot on a line belongs to the element before it, on the seam to the last"),
    },
)
def corners(order: str, corner: int) -> dict[str, float]:
    """Largest errors over points round a corner, from all starts."""
    face = polygon(order)
    along = int(np.argmax(face.ends[1]))
    off = np.concatenate([np.linspace(-0.48, 0.48, 25), np.linspace(0.53, 0.9, 7), -np.linspace(0.53, 0.9, 7)]) * TURN
    distance, at = 10.0 ** -np.linspace(1.0, 3.0, len(off)), about(np.array([OUTER]), np.zeros(1), np.array([corner * TURN]))[0]
    y = 0.4 * WIDTH * np.sin(np.arange(len(off)))
    targets = at + about(distance, y, corner * TURN + off)
    on = np.abs(off) < 0.5 * TURN
    beside = np.clip(off, -0.5 * TURN, 0.5 * TURN)
    worst = np.zeros(4)
    for feet in projected(face, targets):
        there = face.points(feet.xi)
        found = [
            np.count_nonzero((feet.fixed[:, along] == 1) != on) + np.count_nonzero((feet.found != 1) | (feet.doubt != 0)),
            np.linalg.norm(there[on] - at - about(np.zeros(on.sum()), y[on], off[on]), axis=1).max(),
            np.abs(np.abs(gap(face, targets, feet)) - distance * np.cos(off - beside)).max(),
            np.abs(feet.xi[on, along] - (corner or CORNERS) * PERIOD / CORNERS).max() > 1e-12,
        ]
        worst = np.maximum(worst, found)
    return dict(zip(("fixed", "foot", "gap", "element"), map(float, worst), strict=True))


@case(
    claim="Above a ridge that runs in a circle a point has its foot on the ridge at its own angle, however near to the circle's axis; on "
    "the axis all angles are as near, and the foot is doubted.",
    tier="gate",
    grid={"order": ["as it is", "swapped"]},
    bounds={
        "foot": Bound(at_most=1e-14, reason="round-off: of the angle, times how much farther the ridge is than the axis"),
        "doubted": Bound(at_most=0.0, reason="definition: feet beside the axis that are doubted, or not found"),
        "believed": Bound(at_most=0.0, reason="theory: feet on the axis that are not: the distance has no least value along the ridge"),
        "fixed": Bound(at_most=0.0, reason="theory: feet on the ridge that are not said to be, in one coordinate alone"),
    },
)
def round_ridge(order: str) -> dict[str, float]:
    """Points off the axis and on it, from all starts."""
    face, round_ = bore(order), INNER - RIDGE
    along = int(np.argmax(face.ends[1]))
    radius = np.concatenate([np.geomspace(1e-6, 0.9, 30) * round_, np.zeros(10)])
    angle = np.linspace(0.1, 6.2, len(radius))
    y = 0.8 * STEEP * (round_ - radius) * np.sin(7.0 * angle)
    targets, off = about(radius, y, angle), radius > 0.0
    foot = about(np.full(len(radius), round_), np.zeros(len(radius)), angle)
    worst = np.zeros(4)
    for feet in projected(face, targets):
        error = np.linalg.norm(face.points(feet.xi) - foot, axis=1)[off] * radius[off] / round_
        found = [
            error.max(),
            np.count_nonzero((feet.found != 1)[off] | (feet.doubt != 0)[off]),
            np.count_nonzero(~off & (feet.doubt != NOT_THE_ONLY_ONE)),
            np.count_nonzero((feet.fixed[off, 1 - along] != 1) | (feet.fixed[off, along] != 0)),
        ]
        worst = np.maximum(worst, found)
    return dict(zip(("foot", "doubted", "believed", "fixed"), map(float, worst), strict=True))
