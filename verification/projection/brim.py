"""The brim: a share of the outer elements by which a face goes on beyond its edges, to each side."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from projection.closest_points import Surface
from projection.poles import OUTER, turned
from projection.poles import face as dome_face

from isomortar.geometry.patch import FloatArray
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case

#: The brim, and shares of it at which targets are.
BRIM, WITHIN, BEYOND = 0.1, 0.9, 1.1
#: Elements of the plate, which lies over a square of sides 1 off the origin; its knots do not begin at 0.
ELEMENTS, CORNER = (3, 2), (2.0, -1.5)


def plate() -> Surface:
    """The upper face of a flat plate whose parameters are its coordinates."""
    patch = mesh(box((*CORNER, -1.0), (CORNER[0] + 1.0, CORNER[1] + 1.0, 0.0)), ("N",) * 3, (2, 2, 1), (*ELEMENTS, 1))
    directions = tuple(replace(d, knots=d.knots + shift) for d, shift in zip(patch.directions, (*CORNER, 0.0), strict=True))
    return Surface(replace(patch, directions=directions), "w1")  # type: ignore[arg-type]


def beside(share: float) -> FloatArray:
    """Places off all edges and corners by a share of the brim, shape (8, 2)."""
    low, high = np.array(CORNER), np.array(CORNER) + 1.0
    beyond = share * BRIM / np.array(ELEMENTS)
    ends = [np.array([low[a] - beyond[a], low[a] + 0.4, high[a] + beyond[a]]) for a in (0, 1)]
    return np.delete(np.stack(np.meshgrid(*ends), axis=-1).reshape(-1, 2), 4, axis=0)


@case(
    claim="Beyond each edge and corner of a face there are feet up to its brim and none farther out.",
    bounds={
        "foot": Bound(at_most=2e-15, reason="round-off: of coordinates of size two; the plate is flat, its parameters are lengths"),
        "within": Bound(at_least=1.0, at_most=1.0, reason="definition: share of targets that have a foot on the brim"),
        "beyond": Bound(at_most=0.0, reason="definition: share of targets farther out that have one"),
        "without": Bound(at_most=0.0, reason="definition: share of targets that have one where there is no brim"),
    },
)
def brim() -> dict[str, float]:
    """Largest distance from the feet; shares found within the brim, beyond it, and without one."""
    face = plate()

    def at(share: float) -> FloatArray:
        return np.column_stack([beside(share), np.full(8, 0.1)])

    with_brim = replace(face, brim=BRIM)
    within, beyond, without = with_brim.project(at(WITHIN)), with_brim.project(at(BEYOND)), face.project(at(WITHIN))
    return {
        "foot": float(np.abs(within.xi - beside(WITHIN)).max()),
        "within": float(np.mean(within.found)),
        "beyond": float(np.mean(beyond.found)),
        "without": float(np.mean(without.found)),
    }


@case(
    claim="A dome has a brim beyond its open edge alone: none round the pole, none at the seam, and none between its elements.",
    grid={"way": ["high first", "low first", "high second", "low second"]},
    bounds={
        "foot": Bound(at_most=2e-14, reason="round-off: of the sphere's points; an arc goes on beyond its end as the same circle"),
        "elsewhere": Bound(at_most=0.0, reason="definition: feet that differ, off the edge, from those without a brim"),
        "within": Bound(at_least=1.0, at_most=1.0, reason="definition: share of targets that have a foot on the brim"),
        "beyond": Bound(at_most=0.0, reason="definition: share of targets farther out that have one"),
        "without": Bound(at_most=0.0, reason="definition: share of targets that have one where there is no brim"),
    },
)
def brim_of_a_dome(way: str) -> dict[str, float]:
    """Largest distance from the feet on the brim; feet that it changes elsewhere; shares found within it, beyond it, and without one."""
    face, random = turned(dome_face("N2"), way), np.random.default_rng(3)
    edge = float(np.arcsin(face.patch.control_points[face.patch.face_points(face.face), 2].min() / OUTER))  # the lowest latitude
    angle = np.concatenate([random.uniform(0.0, 2 * np.pi, 40), np.arange(8) * np.pi / 4])

    def ring(latitude: float | FloatArray) -> FloatArray:
        return np.column_stack([np.cos(latitude) * np.cos(angle), np.cos(latitude) * np.sin(angle), np.sin(latitude) * np.ones(len(angle))])

    on_it, too_far = ring(edge - 0.01), ring(edge - 0.2)
    with_brim = replace(face, brim=BRIM)
    within = with_brim.project(1.1 * OUTER * on_it)
    own = np.concatenate(
        [ring(random.uniform(edge, np.pi / 2, len(angle))), ring(np.pi / 2 - 1e-9), ring(random.uniform(edge, 1.5, len(angle)))]
    )
    same, other = (one.project(1.1 * OUTER * own) for one in (with_brim, face))
    return {
        "foot": float(np.linalg.norm(face.points(within.xi) - OUTER * on_it, axis=1).max()),
        "elsewhere": float(np.count_nonzero(np.any(same.xi != other.xi, axis=1) | (same.found != other.found))),
        "within": float(np.mean(within.found)),
        "beyond": float(np.mean(with_brim.project(1.1 * OUTER * too_far).found)),
        "without": float(np.mean(face.project(1.1 * OUTER * on_it).found)),
    }
