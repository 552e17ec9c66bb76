"""The brim: a share of the outer elements by which a face goes on beyond its edges, to each side."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from projection.closest_points import Surface

from isomortar import _bindings
from isomortar._bindings import SlaveArrays
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
    own = len(face.patch.weights)

    def feet(share: float, brim: float) -> _bindings.Projections:
        places = np.column_stack([beside(share), np.full(8, 0.1)])
        slave = SlaveArrays.of_points(np.arange(own, own + 8, dtype=np.int32))
        positions = np.concatenate([face.patch.control_points, places])
        return _bindings.project_points(slave, replace(face.master(), brim=brim), positions, np.zeros((8, 2)), np.zeros(8, dtype=np.int32))

    within, beyond, without = feet(WITHIN, BRIM), feet(BEYOND, BRIM), feet(WITHIN, 0.0)
    return {
        "foot": float(np.abs(within.xi - beside(WITHIN)).max()),
        "within": float(np.mean(within.found)),
        "beyond": float(np.mean(beyond.found)),
        "without": float(np.mean(without.found)),
    }
