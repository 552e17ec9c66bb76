"""Supports on bodies of two orders: they hold what moves their face, edge or corner, and nothing else."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from isomortar.geometry.patch import FACES, Patch
from isomortar.geometry.primitives import bowl, box
from isomortar.geometry.refinement import mesh, raised_along
from isomortar.harness import Bound, case
from isomortar.model.entities import Body, Edge, Face, Material, Problem, Raised
from isomortar.model.numbering import Numbering

#: A bowl with other orders and other numbers of elements along each direction.
_ORDERS, _ELEMENTS = (2, 3, 2), (3, 2, 4)
_BOWL = mesh(bowl((0.1, 0.0), 0.5, 0.0, 0.2, 0.8), ("N", "N", "N"), _ORDERS, _ELEMENTS)


def raised(patch: Patch, face: str, order: int) -> Body:
    """A body of two orders."""
    return Body("bowl", raised_along(patch, face, order), Material(10.0), (6, 6, 6), raised=Raised(face, _ORDERS))


def farther(face: str, order: int) -> float:
    """By how much control points of a box, which are at their Greville abscissae, are farther from theirs than from the nearest one.

    It is long across the face, so that none of another row is nearer.
    """
    length = np.where(np.array(list("uvw")) == face[0], 20.0, 1.0)
    patch = mesh(box((0.0, 0.0, 0.0), tuple(length.tolist())), ("N", "N", "N"), _ORDERS, _ELEMENTS)
    body = raised(patch, face, order)
    rows = Numbering(Problem("box", (body,), (), (), ())).rows["bowl"]
    distances = np.linalg.norm(body.patch.control_points[:, None] - rows.reference, axis=2)
    return float((distances[np.arange(len(distances)), rows.nearest] - distances.min(axis=1)).max())


def places() -> list[Face]:
    """Faces, edges and corners of the bowl."""
    named = [faces for count in (1, 2, 3) for faces in combinations(FACES, count) if len({face[0] for face in faces}) == count]
    return [Face("bowl", faces[0]) if len(faces) == 1 else Edge("bowl", faces[0], faces[1:]) for faces in named]


@case(
    claim="A support on a body of two orders holds the control points whose functions are not zero at its face, edge or corner, and no "
    "others; each control point of the higher order goes with the nearest one.",
    tier="gate",
    grid={"face": FACES, "order": (3, 5)},
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: control points that are held and should not be, or the other way round"),
        "farther": Bound(at_most=1e-12, reason="round-off: of distances, where two are as near"),
        "places": Bound(26.0, 26.0, "definition: 6 faces, 12 edges, 8 corners"),
    },
)
def raised_faces(face: str, order: int) -> dict[str, float]:
    """How many, over all places; how far from theirs control points are, beyond the nearest."""
    body = raised(_BOWL, face, order)
    numbering = Numbering(Problem("bowl", (body,), (), (), ()))
    into = numbering.rows["bowl"].into.toarray()
    wrong = 0
    for place in places():
        moving = np.flatnonzero(np.any(into[body.patch.common_points(place.meeting)] != 0.0, axis=0))
        wrong += len(np.setxor1d(numbering.points_at(body, place), moving))
    return {"wrong": float(wrong), "farther": farther(face, order), "places": float(len(places()))}
