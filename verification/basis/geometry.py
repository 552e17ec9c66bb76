"""Exact shapes as the kernel integrates them, and what order elevation and knot insertion leave of them: everything."""

from __future__ import annotations

import numpy as np
from shapes import cylinder_sector, cylinder_volume, turned_area, turned_sector, turned_volume

from isomortar import _bindings
from isomortar._bindings import BodyArrays
from isomortar.geometry.patch import FloatArray, Patch
from isomortar.geometry.primitives import box, ring
from isomortar.geometry.quadrature import contact_points, volume_points
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, Shown, case
from isomortar.model.entities import Material
from isomortar.model.numbering import patch_arrays

MATERIAL = Material()
#: Points per direction that integrate a quarter of a circle to round-off.
MANY = 12
SECTION = (-0.4, 1.1)
#: Edges of a skew block, rows: no two of its directions are at right angles.
EDGES = np.array([[1.0, 0.2, 0.1], [0.5, 0.9, -0.2], [0.3, -0.1, 0.8]])


def skew_block() -> Patch:
    """A block with these edges."""
    cube = box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    return Patch(cube.directions, cube.control_points @ EDGES, cube.weights)


#: Patch, curved face, volume, area of that face.
SHAPES = {
    "cylinder": (
        cylinder_sector(0.5, 2.0, 1.2, 3.0), "u1", cylinder_volume(0.5, 2.0, 1.2, 3.0), 2.0 * 1.2 * 3.0,
    ),
    "ring": (
        ring((0.1, 0.2, 0.3), 0.3, 0.5, 0.4), "v1", np.pi * (0.5**2 - 0.3**2) * 0.4, 2 * np.pi * 0.5 * 0.4,
    ),
    "torus": (
        turned_sector(2.0, 0.4, 0.7, SECTION, 1.3), "v1", turned_volume(2.0, 0.4, 0.7, SECTION, 1.3),
        turned_area(2.0, 0.7, SECTION, 1.3),
    ),
    "sphere": (
        turned_sector(0.0, 0.5, 1.0, SECTION, 1.3), "v1", turned_volume(0.0, 0.5, 1.0, SECTION, 1.3),
        turned_area(0.0, 1.0, SECTION, 1.3),
    ),
    "skew": (
        skew_block(), "w1", float(np.linalg.det(EDGES)), float(np.linalg.norm(np.cross(EDGES[0], EDGES[1]))),
    ),
}  # fmt: skip


def refined(shape: str, order: int) -> Patch:
    """The shape with all directions of that order and two elements for each of its own."""
    patch = SHAPES[shape][0]
    return mesh(patch, ("N",) * 3, (order,) * 3, [2 * d.elements for d in patch.directions])


def volume(patch: Patch, gauss: tuple[int, int, int]) -> float:
    """From the work of a uniform stress: swollen by s, the internal forces do 9 A1 ln(s)/s V along the reference positions."""
    reference, s = patch.control_points, 1.5
    forces = np.zeros_like(reference)
    arrays = BodyArrays(patch_arrays(patch, np.arange(len(reference), dtype=np.int32)), gauss, reference)
    _bindings.add_body(arrays, MATERIAL.arrays, s * reference, forces)
    return float(np.vdot(forces, reference)) / (9 * MATERIAL.bulk * np.log(s) / s)


def area(patch: Patch, face: str, gauss: tuple[int, int]) -> float:
    """Sum of the areas of all quadrature points of a face."""
    arrays = patch_arrays(patch, np.arange(len(patch.weights), dtype=np.int32))
    axis, side = "uvw".index(face[0]) + 1, int(face[1])
    return float(_bindings.slave_tables(arrays, axis, side, gauss, patch.control_points)[3].sum())


def surface(patch: Patch, face: str, xi: FloatArray) -> FloatArray:
    """Points of a face, as the kernel's functions give them, shape (n, 3)."""
    arrays = patch_arrays(patch, np.arange(len(patch.weights), dtype=np.int32))
    nodes, functions = _bindings.surface_functions(arrays, "uvw".index(face[0]) + 1, int(face[1]), xi)
    return np.einsum("qa,qai->qi", functions[:, 0], patch.control_points[patch.face_points(face)][nodes])


_SUM = "round-off: a sum over all quadrature points, whose own number is enough for it"


@case(
    claim="Sectors of cylinder, ring, torus and sphere, and a skew block have their exact volume and area at any order.",
    tier="gate",
    grid={"shape": list(SHAPES), "order": [2, 3, 5]},
    bounds={
        "volume": Bound(at_most=2e-13, reason=_SUM),
        "area": Bound(at_most=2e-13, reason=_SUM),
        "default_volume": Shown(reason="quadrature: what the default number of points makes of rational integrands"),
        "default_area": Shown(reason="quadrature: what the default number of points makes of rational integrands"),
    },
)
def exact_measure(shape: str, order: int) -> dict[str, float]:
    """Relative errors of volume and area with many points and with the default number."""
    patch, (_, face, exact_volume, exact_area) = refined(shape, order), SHAPES[shape]
    u, v, w = (volume_points(direction) for direction in patch.directions)
    first, second = (contact_points(direction) for direction in patch.face_directions(face))
    return {
        "volume": abs(volume(patch, (MANY,) * 3) / exact_volume - 1),
        "area": abs(area(patch, face, (MANY,) * 2) / exact_area - 1),
        "default_volume": abs(volume(patch, (u, v, w)) / exact_volume - 1),
        "default_area": abs(area(patch, face, (first, second)) / exact_area - 1),
    }


@case(
    claim="Order elevation and knot insertion leave every point of a face where it was.",
    tier="gate",
    grid={"shape": list(SHAPES), "order": [2, 3, 4, 5, 6]},
    bounds={"distance": Bound(at_most=1e-13, reason="round-off: of the refined control points, as a share of the body's size")},
)
def refinement_keeps_shape(shape: str, order: int) -> dict[str, float]:
    """Largest distance between points of one coordinate on the coarse and on the refined face."""
    coarse, face = SHAPES[shape][:2]
    fine = refined(shape, order)
    ends = [direction.boundaries[[0, -1]] for direction in coarse.face_directions(face)]
    xi = np.column_stack([np.random.default_rng(3).uniform(low, high, 40) for low, high in ends])
    gap = np.linalg.norm(surface(fine, face, xi) - surface(coarse, face, xi), axis=1).max()
    return {"distance": float(gap / np.linalg.norm(np.ptp(coarse.control_points, axis=0)))}
