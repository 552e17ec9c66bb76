"""What the search for feet works with: points with their derivatives, the sample of an element to begin at, elements that are ruled out.

Wrong ones cost steps and searches; the feet that are found in the end are the same.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from projection.closest_points import Surface
from projection.in_extended_precision import FACES, targets_of
from scipy.optimize import nnls

from isomortar import _bindings, _twin
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case

#: Points beside a face, and by how much the hull of an element may be farther than a foot, though it is not ruled out.
POINTS, SLACK = 150, 1.01
#: Masters of many elements, or with several feet in one.
MASTERS = ("wavy N2", "wavy N4", "wavy L2", "folded N2", "inside a ring", "round a ring", "dome N2")


@case(
    claim="The search for feet takes the surface's points, tangents and second derivatives as they are, with uneven weights too.",
    grid={"master": ["wavy N2", "wavy N4", "wavy L2", "one row N2", "round a ring", "pole N3"]},
    bounds={"error": Bound(at_most=1e-13, reason="round-off: of sums over an element's functions, by the largest of each derivative")},
)
def derivatives(master: str) -> dict[str, float]:
    """Largest difference of a derivative from that by the table of functions, which is held against 40 digits by `basis/digits`."""
    face, random = FACES[master](), np.random.default_rng(7)
    if face.patch.directions[0].family == "N":
        face = replace(face, patch=replace(face.patch, weights=face.patch.weights * 10.0 ** random.uniform(-1, 1, len(face.patch.weights))))
    low, high = face.ends
    xi = low + random.uniform(0.0, 1.0, (POINTS, 2)) * (high - low)
    onto, points = face.master(), face.patch.control_points
    nodes, functions = _bindings.surface_functions(onto.patch, onto.axis, onto.side, xi)
    expected = np.einsum("qda,qak->qdk", functions[:, :6], points[face.patch.face_points(face.face)][nodes])
    found = _twin.surface_points(onto, points, xi)
    return {"error": float(np.max(np.abs(found - expected).max(axis=(0, 2)) / np.abs(expected).max(axis=(0, 2))))}


def _distance(corners: FloatArray, x: FloatArray) -> float:
    """Distance of a point from the convex hull of others, of about that size: shares of the corners that add up to one, all but."""
    sum_of_shares = 1e4 * np.linalg.norm(corners - x, axis=1).max()
    shares, _ = nnls(np.vstack([(corners - x).T, np.full(len(corners), sum_of_shares)]), np.array([0.0, 0.0, 0.0, sum_of_shares]))
    return float(np.linalg.norm(shares @ (corners - x)))


def _grids(face: Surface) -> FloatArray:
    """Coordinates of the samples of each element, shape (elements, samples, 2)."""
    lines = [
        [low + (high - low) * np.linspace(0.0, 1.0, d.order + 1) for low, high in zip(d.boundaries, d.boundaries[1:], strict=False)]
        for d in face.patch.face_directions(face.face)
    ]
    return np.array([np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2) for v in lines[1] for u in lines[0]])


@case(
    claim="An element is searched from its sample that is nearest to the point; none that holds a nearer place than the foot is ruled out, "
    "and of the others all but a few whose hulls are farther.",
    grid={"master": list(MASTERS)},
    bounds={
        "sample": Bound(at_most=1e-12, reason="round-off: how much nearer another sample is, by the largest distance"),
        "wrongly": Bound(at_most=0.0, reason="definition: elements that are ruled out, with a sample nearer than the foot"),
        "in vain": Bound(at_most=0.05, reason="theory: six planes of Gilbert's method are not quite the hull; elements for each point"),
    },
)
def elements(master: str) -> dict[str, float]:
    """How much nearer other samples are than those taken; elements ruled out wrongly, and those for each point that might have been."""
    face = FACES[master]()
    onto, points, targets = face.master(), face.patch.control_points, targets_of(face, POINTS)
    ways = face.points(face.project(targets).xi) - targets
    xi, farther = _twin.surface_prospects(onto, points, targets, ways)
    grids, hulls = _grids(face), _twin.surface_hulls(onto, points)
    samples = face.points(grids.reshape(-1, 2)).reshape(*grids.shape[:2], 3)
    nearest = np.array([np.linalg.norm(samples - x, axis=2).min(axis=1) for x in targets])
    taken = np.linalg.norm(face.points(xi.reshape(-1, 2)).reshape(*xi.shape[:2], 3) - targets[:, None], axis=2)
    distance = np.linalg.norm(ways, axis=1)
    vain = [_distance(hulls.corner[e], targets[q]) > SLACK * distance[q] for q, e in np.argwhere(farther == 0)]
    return {
        "sample": float(np.abs(taken - nearest).max() / nearest.max()),
        "wrongly": float(np.sum((farther == 1) & (nearest < distance[:, None] * (1.0 - 1e-12)))),
        "in vain": float(np.sum(vain) / POINTS),
    }
