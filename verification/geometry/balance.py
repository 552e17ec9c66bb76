"""A homogeneous deformation leaves the built-in bodies in balance, at poles and where faces are one line or one point, too."""

from __future__ import annotations

import numpy as np
from geometry.bodies import BODIES, refined
from patch_tests.bulk import GRADIENT, MATERIAL, SHIFT
from transforms import orientations, permuted, reversed_along

from isomortar import _bindings
from isomortar._bindings import BodyArrays
from isomortar.geometry.faces import cells
from isomortar.geometry.patch import FACES, IntArray, Patch
from isomortar.geometry.primitives import box, ring, sphere
from isomortar.harness import LAGRANGE, NURBS, Bound, case
from isomortar.model.numbering import patch_arrays, same_points

#: Points per direction that integrate rational functions of these bodies to round-off.
MANY = 20
#: A face of less than this share of the largest one's area is a line or a point: what is there lies inside, or on other faces.
NO_AREA = 1e-9


def inside(body: str, kind: str) -> IntArray:
    """Control points, by the first of those that are the same, that are on no face with an area, seams left out."""
    patch, closed = refined(body, kind), BODIES[body].closed or ""
    areas = {face: float(cells(patch, face).areas.sum()) for face in FACES}
    outer = [face for face in FACES if face[0] not in closed and areas[face] > NO_AREA * np.max(list(areas.values()))]
    first = same_points(patch, BODIES[body].closed)
    return np.setdiff1d(first, np.concatenate([first[patch.face_points(face)] for face in outer]))


@case(
    claim="The built-in bodies pass the patch test: homogeneously deformed, no control point inside bears a force.",
    grid={"body": list(BODIES), "kind": NURBS + LAGRANGE},
    tier=lambda body, kind: "gate" if kind in ("N2", "L2") else "nightly",  # noqa: ARG005
    bounds={
        "residual": Bound(at_most=1e-12, reason="round-off: with 20 points per direction the quadrature of these bodies is exact to it"),
        "inside": Bound(at_least=1.0, reason="definition: there is something to be in balance"),
        "apart": Bound(at_least=0.0, at_most=0.0, reason="definition: control points at one place are one, or the body would open there"),
    },
)
def homogeneous(body: str, kind: str) -> dict[str, float]:
    """Largest force at a control point inside over the largest at any, their number, and how many more points there are than places."""
    patch, within = refined(body, kind), inside(body, kind)
    reference = patch.control_points
    forces = np.zeros_like(reference)
    arrays = patch_arrays(patch, same_points(patch, BODIES[body].closed))
    positions = np.ascontiguousarray(reference @ GRADIENT.T + SHIFT)
    _bindings.add_body(BodyArrays(arrays, (MANY,) * 3, reference), MATERIAL.arrays, positions, forces)
    places = np.unique(np.round(reference / np.ptp(reference), 10), axis=0)
    return {
        "residual": float(np.abs(forces[within]).max() / np.abs(forces).max()),
        "inside": float(len(within)),
        "apart": float(len(np.unique(arrays.point)) - len(places)),
    }


#: Corners of a cube, counted along x first, that are taken to another one: bodies of one element with fewer corners.
COLLAPSED = {
    "wedge": {1: 0, 5: 4},
    "wedge, across": {1: 4, 0: 4},
    "pyramid": {5: 4, 6: 4, 7: 4},
    "tetrahedron": {5: 4, 6: 4, 7: 4, 3: 2},
}


def collapsed(body: str) -> Patch:
    """A cube of one element of which some corners are others."""
    cube = box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    points = cube.control_points.copy()
    for corner, other in COLLAPSED[body].items():
        points[corner] = points[other]
    return Patch(cube.directions, points, cube.weights)


@case(
    claim="Control points at one place are one, whichever edges meet there and however the directions of a body are named.",
    tier="gate",
    grid={"body": list(COLLAPSED)},
    bounds={"apart": Bound(at_least=0.0, at_most=0.0, reason="definition: the body would open there")},
)
def one_place(body: str) -> dict[str, object]:
    """How many more control points there are than places, by the ways to name and run the directions."""
    patch, apart = collapsed(body), []
    for order, axes in orientations():
        named = reversed_along(permuted(patch, order), axes)
        apart.append(float(len(np.unique(same_points(named, None))) - len(np.unique(named.control_points, axis=0))))
    return {"apart": np.array(apart)}


@case(
    claim="So they are in any unit of length: ends of rings and rows of poles that meet to round-off are one, and no others.",
    tier="gate",
    bounds={"others": Bound(0.0, 0.0, "definition: control points that are one in another unit, or are not any more")},
)
def one_place_in_any_unit() -> dict[str, float]:
    """How many, of a ball and a ring in no special place, in units twelve decades apart."""
    turn = np.linalg.qr(np.array([[0.3, -1.1, 0.7], [0.9, 0.4, -0.2], [-0.5, 0.8, 1.3]]))[0]
    bodies = ((sphere((0.3, 0.1, -0.2), 0.25, 1.0), "u"), (ring((0.3, 0.1, -0.2), 0.25, 1.0, 0.5), "u"))
    others = 0
    for patch, closed in bodies:
        here = same_points(patch, closed)
        for unit in (1e-12, 1.0, 1e12):
            there = Patch(patch.directions, unit * patch.control_points @ turn.T, patch.weights)
            others += int(np.count_nonzero(same_points(there, closed) != here))
    return {"others": float(others)}
