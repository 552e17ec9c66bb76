"""Closest-point projection onto curved faces: exact from any start, and a defined result where there is no ordinary one."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from shapes import cylinder_sector, turned_sector

from isomortar import _bindings
from isomortar._arguments import LongArray
from isomortar._bindings import FaceArrays, Projections, SlaveArrays
from isomortar._codes import WORK
from isomortar.geometry.patch import FloatArray, Patch
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, Shown, case
from isomortar.model.numbering import patch_arrays, same_points

#: Doubts: statuses of isomortar_base_status.
LOST, NOT_THE_ONLY_ONE = 3, 4
#: Number of what a search does most among the counts.
_SEARCHED = WORK.index("evaluations to order 2")
RADIUS, INNER, MAJOR, TURN = 0.7, 0.3, 2.0, 1.2
SECTION = (-0.5, 0.8)
#: Coarse patch, and the face that is projected onto.
PATCHES = {
    "cylinder": (cylinder_sector(INNER, RADIUS, TURN, 1.0), "u1"),
    "sphere": (turned_sector(0.0, INNER, RADIUS, SECTION, TURN), "v1"),
    "torus": (turned_sector(MAJOR, INNER, RADIUS, SECTION, TURN), "v1"),
}


@dataclass(frozen=True)
class Surface:
    """A face with the kernel's view of it; along `closed` (u, v or w) the last row of control points is the first one.

    `brim`: share of its outer elements by which it goes on beyond its edges.
    """

    patch: Patch
    face: str
    closed: str | None = None
    brim: float = 0.0

    @property
    def ends(self) -> FloatArray:
        """Lower and upper bounds of both coordinates, shape (2, 2)."""
        return np.array([d.boundaries[[0, -1]] for d in self.patch.face_directions(self.face)]).T

    def points(self, xi: FloatArray) -> FloatArray:
        """Points at coordinates, shape (n, 3)."""
        functions, control_points = self._functions(xi)
        return np.einsum("qa,qai->qi", functions[:, 0], control_points)

    def tangents(self, xi: FloatArray, direction: int) -> FloatArray:
        """Derivatives of the points by coordinate 0 or 1, shape (n, 3)."""
        functions, control_points = self._functions(xi)
        return np.einsum("qa,qai->qi", functions[:, 1 + direction], control_points)

    def _functions(self, xi: FloatArray) -> tuple[FloatArray, FloatArray]:
        arrays = patch_arrays(self.patch, np.arange(len(self.patch.weights), dtype=np.int32))
        nodes, values = _bindings.surface_functions(arrays, "uvw".index(self.face[0]) + 1, int(self.face[1]), np.ascontiguousarray(xi))
        return values, self.patch.control_points[self.patch.face_points(self.face)][nodes]

    def project(
        self, targets: FloatArray, starts: FloatArray | None = None, counts: LongArray | None = None, near: Projections | None = None
    ) -> Projections:
        """The kernel's projections: each target is a slave of one quadrature point; without starts from its coarse search.

        What that takes is added to `counts`; the search begins at feet that are `near`.
        """
        n, own = len(targets), len(self.patch.weights)
        slave = SlaveArrays.of_points(np.arange(own, own + n, dtype=np.int32))
        positions = np.ascontiguousarray(np.concatenate([self.patch.control_points, targets]))
        had = np.full(n, starts is not None, dtype=np.int32)
        origin = np.zeros((n, 2)) if starts is None else np.ascontiguousarray(starts)
        return _bindings.project_points(slave, self.master(), positions, origin, had, counts=counts, near=near)

    def master(self) -> FaceArrays:
        """The face as the kernel's master."""
        arrays = patch_arrays(self.patch, same_points(self.patch, self.closed))
        return FaceArrays(arrays, "uvw".index(self.face[0]) + 1, int(self.face[1]), brim=self.brim)

    def sampled_distance(self, targets: FloatArray, count: int = 81) -> FloatArray:
        """Least distance of each target to a grid of points, shape (n,)."""
        u, v = (np.linspace(low, high, count) for low, high in self.ends.T)
        grid = self.points(np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2))
        return np.array([np.linalg.norm(grid - target, axis=1).min() for target in targets])


def surface(shape: str, family: str, order: int, hollow: bool = False) -> Surface:
    """A refined face (`hollow`: that across the body); Lagrange faces are faceted, with lines that are only continuous."""
    patch, face = PATCHES[shape]
    face = f"{face[0]}0" if hollow else face
    elements = [1 if d.order == 1 and shape != "cylinder" else 3 for d in patch.directions]
    return Surface(mesh(patch, (family,) * 3, (order,) * 3, elements), face)  # type: ignore[arg-type]


def normal(shape: str, points: FloatArray) -> FloatArray:
    """Outward unit normals of the exact surface, shape (n, 3)."""
    across = points[:, :2] / np.linalg.norm(points[:, :2], axis=1)[:, None]
    flat = np.column_stack([across, np.zeros(len(points))])
    if shape == "cylinder":
        return flat
    return (points - (MAJOR if shape == "torus" else 0.0) * flat) / RADIUS


@case(
    claim="Points off an exact cylinder, sphere or torus are projected onto the foot of their normal, from any start.",
    tier="gate",
    grid={"shape": list(PATCHES), "order": [2, 3, 4]},
    bounds={
        "foot": Bound(at_most=2e-14, reason="round-off: of the surface's points; Newton's method ends below it"),
        "found": Bound(at_least=1.0, at_most=1.0, reason="definition: every target has its foot inside the patch"),
    },
)
def exact_foot(shape: str, order: int) -> dict[str, float]:
    """Largest distance from the foot, over targets inside elements, on knot lines, on either side, and random starts; share found."""
    face = surface(shape, "N", order)
    low, high = face.ends
    random = np.random.default_rng(order)
    share = np.concatenate([random.uniform(0.02, 0.98, (40, 2)), [[1 / 3, 0.4], [0.4, 2 / 3], [1 / 3, 1 / 3], [2 / 3, 1 / 3]]])
    feet = face.points(low + share * (high - low))
    targets = feet + random.uniform(-0.3, 0.3, (len(feet), 1)) * normal(shape, feet)
    worst, found = 0.0, []
    for starts in (None, *(low + random.uniform(0, 1, (len(feet), 2)) * (high - low) for _ in range(5))):
        projections = face.project(targets, starts)
        worst = float(np.maximum(worst, np.linalg.norm(face.points(projections.xi) - feet, axis=1).max()))
        found.append(projections.found)
    return {"foot": worst, "found": float(np.mean(found))}


@case(
    claim="A search that begins at feet of other positions ends at the same feet, sooner, and slips count from the start all the same.",
    tier="gate",
    grid={"shape": list(PATCHES), "order": [2, 3, 4], "had": [0, 1]},
    bounds=lambda **settings: {
        "foot": Bound(at_most=2e-14, reason="round-off: of the surface's points; Newton's method ends below it"),
        "found": Bound(at_least=1.0, at_most=1.0, reason="definition: every target has its foot inside the patch"),
        "slip": Bound(at_most=1e-15, reason="definition: from the start, zero without one; one subtraction"),
        "cold": Bound(
            at_most=10.0 * (1 - settings["had"]),
            reason="definition: targets without a foot of either kind are searched for on all elements",
        ),
        "evaluations": Bound(
            at_most=0.8 if settings["had"] else 1.0, reason="theory: Newton's method squares its error, and begins with a hundredth of it"
        ),
    },
)
def from_other_feet(shape: str, order: int, had: int) -> dict[str, float]:
    """Targets that have moved on from feet which are known but for the first ten, and far from where slips count."""
    face = surface(shape, "N", order)
    low, high = face.ends
    random = np.random.default_rng(order)
    places = [low + (random.uniform(0.25, 0.6, (1, 2)) + random.uniform(0.0, 0.1, (40, 2))) * (high - low)]
    places += [places[0] + move * (high - low) for move in (0.1, 0.101)]
    feet = [face.points(xi) for xi in places]
    off = random.uniform(-0.1, 0.1, (40, 1))
    start, near, _ = (face.project(foot + off * normal(shape, foot)) for foot in feet)
    near = replace(near, found=np.where(np.arange(40) < 10, 0, near.found).astype(np.int32))
    counts, targets = np.zeros((2, len(WORK)), dtype=np.int64), feet[2] + off * normal(shape, feet[2])
    found = [face.project(targets, start.xi if had else None, count, other) for count, other in zip(counts, (None, near), strict=True)]
    slip = had * (found[1].xi - start.xi)
    return {
        "foot": float(np.max([np.linalg.norm(face.points(one.xi) - feet[2], axis=1) for one in found])),
        "found": float(np.mean([one.found for one in found])),
        "slip": float(np.abs(found[1].slip - slip).max()),
        "cold": float(counts[1, WORK.index("cold projections")]),
        "evaluations": float(counts[1, _SEARCHED] / counts[0, _SEARCHED]),
    }


@case(
    claim="Beyond the edge of a patch there is no projection, and at its corners the nearest point is the corner.",
    tier="gate",
    grid={"shape": list(PATCHES), "kind": ["N2", "N3", "N4"]},
    bounds={
        "found": Bound(at_most=0.0, reason="definition: a target beyond the edge takes no part in contact"),
        "outside": Bound(at_most=0.0, reason="definition: coordinates stay within the patch"),
        "corner": Bound(at_most=1e-7, reason="round-off: the distance is flat at its least, its foot has half of the digits"),
    },
)
def edges_and_corners(shape: str, kind: str) -> dict[str, float]:
    """Targets beyond the corners that are found, how far coordinates leave the patch, and feet of targets above the corners."""
    face = surface(shape, kind[0], int(kind[1:]))
    low, high = face.ends
    corners = np.array([[low[0], low[1]], [high[0], low[1]], [low[0], high[1]], [high[0], high[1]]])
    places = face.points(corners)
    inwards = face.points(0.9 * corners + 0.1 * (low + high) / 2) - places
    beyond = face.project(places - 2.0 * inwards)
    above = face.project(places - 1e-9 * inwards + 0.1 * normal(shape, places))
    xi = np.concatenate([beyond.xi, above.xi])
    return {
        "found": float(np.sum(beyond.found)),
        "outside": float(np.max([np.max(low - xi), np.max(xi - high), 0.0])),
        "corner": float(np.linalg.norm(face.points(above.xi) - places, axis=1).max()),
    }


@case(
    claim="Beyond the edge of a patch, the search ends at the nearest place of the edge.",
    tier="gate",
    grid={"shape": list(PATCHES), "kind": ["N2", "N3", "N4"]},
    bounds={
        "found": Bound(at_most=0.0, reason="definition: a target beyond the edge takes no part in contact"),
        "foot": Bound(at_most=2e-14, reason="round-off: of the surface's points; Newton's method along the edge ends below it"),
    },
)
def along_edges(shape: str, kind: str) -> dict[str, float]:
    """Targets that are found, and largest distance from the foot: targets lie off the four edges, along and above the surface."""
    face = surface(shape, kind[0], int(kind[1:]))
    low, high = face.ends
    found, worst = 0, 0.0
    for a, end in ((0, low), (0, high), (1, low), (1, high)):
        xi = low + np.random.default_rng(a).uniform(0.1, 0.9, (20, 2)) * (high - low)
        start = xi.copy()
        xi[:, a] = end[a]
        feet = face.points(xi)
        outwards = np.cross(face.tangents(xi, 1 - a), normal(shape, feet))
        outwards *= np.sign(np.einsum("qi,qi->q", outwards, feet - face.points(start)))[:, None]
        targets = feet + 0.2 * outwards / np.linalg.norm(outwards, axis=1)[:, None] + 0.1 * normal(shape, feet)
        projections = face.project(targets, start)
        found += int(projections.found.sum())
        worst = float(np.maximum(worst, np.linalg.norm(face.points(projections.xi) - feet, axis=1).max()))
    return {"found": float(found), "foot": worst}


@case(
    claim="Of a target as near to many places as to one, it is said that its foot does not follow it.",
    tier="gate",
    grid={"shape": ["cylinder", "sphere"], "order": [2, 3, 4]},
    bounds={"refused": Bound(at_least=1.0, at_most=1.0, reason="definition: on the axis, or at the centre, no place is the nearest")},
)
def equidistant(shape: str, order: int) -> dict[str, float]:
    """Share that is doubted on the axis of the cylinder and at the centre of the sphere, from the coarse search and from random starts."""
    face = surface(shape, "N", order, hollow=True)
    random = np.random.default_rng(1)
    refused = []
    for height in np.linspace(0.2, 0.8, 7):
        for origin in (None, face.ends[0] + random.uniform(0, 1, (1, 2)) * (face.ends[1] - face.ends[0])):
            projections = face.project(np.array([[0.0, 0.0, height * float(shape == "cylinder")]]), origin)
            refused.append((projections.found == 1) & (projections.doubt == NOT_THE_ONLY_ONE))
    return {"refused": float(np.mean(refused))}


@case(
    claim="Near the centres of curvature of a torus a target is projected at the right distance, or it is said to be lost.",
    tier="gate",
    grid={"order": [2, 3], "off": [1e-8, 1e-4]},
    bounds=lambda **settings: {
        "distance": Bound(
            at_most=1e-14 + 4 * settings["off"], reason="definition: the section is at one distance, but for twice the way off its centre"
        ),
        "lost": Shown(reason="theory: the distance is flat, and 100 steps of its slope over the metric need not reach its least"),
    },
)
def centres_of_curvature(order: int, off: float) -> dict[str, float]:
    """Largest error of the distance of settled targets, from random starts; share of the targets that are lost."""
    face = surface("torus", "N", order, hollow=True)
    random = np.random.default_rng(order)
    distances = []
    for angle in random.uniform(0.2, TURN - 0.2, 100):
        target = MAJOR * np.array([[np.cos(angle), np.sin(angle), 0.0]]) + off * random.uniform(-1, 1, (1, 3))
        projections = face.project(target, random.uniform(0.0, 1.0, (1, 2)))
        if projections.doubt[0] != LOST:
            distances.append(np.linalg.norm(face.points(projections.xi) - target))
    return {"distance": float(np.abs(np.array(distances) - INNER).max()), "lost": 1 - len(distances) / 100}


@case(
    claim="On a master with lines that are only continuous the projection is the nearest point, on such a line where it must be.",
    tier="gate",
    grid={"shape": list(PATCHES), "kind": ["L1", "L2"]},
    bounds={
        "excess": Bound(at_most=1e-13, reason="definition: no sampled point may be nearer"),
        "found": Bound(at_least=1.0, at_most=1.0, reason="definition: a line inside the patch is no edge"),
        "on_line": Bound(at_least=1e-6, at_most=1.0, reason="definition: some of the targets do have their foot on a line"),
    },
)
def continuous_lines(shape: str, kind: str) -> dict[str, float]:
    """Distance beyond that to a grid of samples; share found; share of feet on an inner line."""
    face = surface(shape, kind[0], int(kind[1:]))
    low, high = face.ends
    random = np.random.default_rng(5)
    share = random.uniform(0.15, 0.85, (60, 2))
    share[:30, 0], share[15:45, 1] = random.choice([1 / 3, 2 / 3], 30), random.choice([1 / 3, 2 / 3], 30)
    feet = face.points(low + share * (high - low))
    targets = feet + random.uniform(0.02, 0.3, (60, 1)) * normal(shape, feet)
    projections = face.project(targets)
    reached = np.linalg.norm(face.points(projections.xi) - targets, axis=1)
    lines = [d.boundaries[1:-1] for d in face.patch.face_directions(face.face)]
    on = [np.isclose(projections.xi[:, a, None], lines[a], rtol=0, atol=1e-13).any(axis=1) for a in (0, 1)]
    return {
        "excess": float(np.maximum(0.0, np.max(reached - face.sampled_distance(targets)))),
        "found": float(np.mean(projections.found)),
        "on_line": float(np.mean(on[0] | on[1])),
    }
