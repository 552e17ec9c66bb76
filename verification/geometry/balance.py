"""A homogeneous deformation leaves the built-in bodies in balance, at poles and where faces are one line or one point, too."""

from __future__ import annotations

import numpy as np
from geometry.bodies import BODIES, refined
from patch_tests.bulk import GRADIENT, MATERIAL, SHIFT

from isomortar import _bindings
from isomortar.geometry.faces import cells
from isomortar.geometry.patch import FACES, IntArray
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
    _bindings.add_body(arrays, (MANY,) * 3, MATERIAL.arrays, np.ascontiguousarray(reference @ GRADIENT.T + SHIFT), reference, forces)
    places = np.unique(np.round(reference / np.ptp(reference), 10), axis=0)
    return {
        "residual": float(np.abs(forces[within]).max() / np.abs(forces).max()),
        "inside": float(len(within)),
        "apart": float(len(np.unique(arrays.point)) - len(places)),
    }
