"""Faces of Lagrange elements as cells: the same as those of NURBS, where the body is the same one, and not their nodes alone."""

from __future__ import annotations

from itertools import product

import numpy as np

from isomortar.geometry.faces import cells
from isomortar.geometry.patch import FACES, Family
from isomortar.geometry.primitives import bowl, ring
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case

_FAMILIES: tuple[Family, Family] = ("N", "L")
#: Bodies with the directions that elements of Lagrange's follow exactly, and elements that are not all of one length.
BODIES = {
    "bowl": (bowl((0.1, -0.2), 0.4, 0.0, 0.1, 0.5), (True, True, True), (4, 2, 1)),
    "ring": (ring((0.0, 0.1, 0.0), 0.5, 1.0, 0.7, (20.0, 200.0), "y"), (False, True, True), (4, 2, 1)),
}


@case(
    claim="What is judged of faces before a run does not depend on the family of a mesh of the same body: cells lie between nodes, too.",
    tier="gate",
    grid={"body": tuple(BODIES), "order": (2, 3)},
    bounds={
        "apart": Bound(at_most=1e-13, reason="round-off: of functions of either family, by the size of the body"),
        "tried": Bound(at_least=12.0, reason="definition: or nothing is compared"),
    },
)
def lagrange_faces(body: str, order: int) -> dict[str, float]:
    """Largest distance of centres of cells, and how many faces of how many meshes."""
    patch, exact, elements = BODIES[body]
    orders, grading, apart, tried = (order,) * 3, (2.0, 1.0, 0.5), 0.0, 0
    whole = mesh(patch, ("N", "N", "N"), orders, elements, grading)
    for families in product(*(_FAMILIES if can else _FAMILIES[:1] for can in exact)):
        other = mesh(patch, families, orders, elements, grading)
        for face in FACES:
            one, same = cells(whole, face).centres, cells(other, face).centres
            apart = float(np.max([apart, np.abs(one - same).max()]))
            tried += 1
    return {"apart": apart, "tried": float(tried)}
