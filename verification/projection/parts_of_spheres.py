"""Parts of a sphere, and of a disc, that end at its pole: there they have an edge that is one point, and beside it nothing is below."""

from __future__ import annotations

from itertools import product

import numpy as np
from projection.closest_points import Surface

from isomortar.errors import LostProjectionError
from isomortar.geometry.primitives import ring, sphere
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case

#: Points round the pole, and how far from it at most, as an angle.
TARGETS, FAR = 200, 0.5


@case(
    claim="Round the pole of a part of a sphere what is above the part has its foot there, and all else is beside it, however it is made.",
    grid={"kind": ("N2", "N3", "L2", "L3"), "degrees": (90.0, 180.0, 270.0)},
    bounds={
        "other": Bound(0.0, 0.0, "definition: points that are above the part and have no foot, or beside it and have one"),
        "foot": Bound(at_most=2e-3, reason="discretisation: Lagrange's elements are beside the sphere by as much; they meet its edges"),
    },
)
def round_a_pole(kind: str, degrees: float) -> dict[str, float]:
    """How many points, and the largest distance of a foot from the way to the centre; `degrees`: how far round the part goes."""
    order = int(kind[1:])
    part = mesh(sphere((0.0, 0.0, 0.0), 0.5, 1.0, (0.0, 90.0), (0.0, degrees)), (kind[0],) * 3, (order, 1, order), (12, 1, 6))  # type: ignore[arg-type]
    random = np.random.default_rng(order)
    angle, off, radius = random.uniform(0.0, 2.0 * np.pi, TARGETS), random.uniform(0.0, FAR, TARGETS), random.uniform(0.9, 1.2, TARGETS)
    targets = np.column_stack([np.sin(off) * np.cos(angle), np.sin(off) * np.sin(angle), np.cos(off)]) * radius[:, None]
    face = Surface(part, "v1")
    found = face.project(targets)
    above, there = angle < np.radians(degrees), found.found == 1
    apart = face.points(found.xi) - targets / np.linalg.norm(targets, axis=1)[:, None]
    return {"other": float(np.count_nonzero(above != there)), "foot": float(np.linalg.norm(apart[above & there], axis=1).max())}


@case(
    claim="Round the middle of a part of a disc, the end of a cylinder, what is above the part has its foot there, and all else is beside "
    "it, on either end.",
    grid={"kind": ("N2", "N3", "L2"), "degrees": (90.0, 180.0, 270.0), "face": ("w0", "w1")},
    bounds={
        "other": Bound(0.0, 0.0, "definition: points that are above the part and have no foot, or beside it and have one"),
        "foot": Bound(at_most=1e-9, reason="round-off: a disc is flat; coordinates beside the middle have fewer digits"),
    },
)
def round_a_middle(kind: str, degrees: float, face: str) -> dict[str, float]:
    """How many points, and the largest distance of a foot from the point straight below; `degrees`: how far round the part goes."""
    order = int(kind[1:])
    part = mesh(ring((0.0, 0.0, 0.0), 0.0, 1.0, 0.5, (0.0, degrees), "z"), (kind[0],) * 3, (order, order, 1), (12, 4, 1))  # type: ignore[arg-type]
    random = np.random.default_rng(order)
    angle, off = random.uniform(0.0, 2.0 * np.pi, TARGETS), random.uniform(0.01, FAR, TARGETS)
    out = np.array([0.0, 0.0, 1.0 if face == "w0" else -1.0])
    below = np.column_stack([off * np.cos(angle), off * np.sin(angle), np.zeros(TARGETS)]) + 0.25 * out
    found = Surface(part, face).project(below + 0.1 * out)
    above, there = angle < np.radians(degrees), found.found == 1
    feet = Surface(part, face).points(found.xi)
    return {"other": float(np.count_nonzero(above != there)), "foot": float(np.linalg.norm((feet - below)[above & there], axis=1).max())}


@case(
    claim="Above the pole of a part of a sphere there is no normal, from any start, and that is said.",
    bounds={"other": Bound(0.0, 0.0, "definition: points of which something else is said, or nothing")},
)
def above_the_pole() -> dict[str, float]:
    """How many, outside the sphere and inside, from no start and from one."""
    part = mesh(sphere((0.0, 0.0, 0.0), 0.5, 1.0, (0.0, 90.0), (0.0, 90.0)), ("N",) * 3, (2, 1, 2), (2, 1, 2))
    said = []
    for height, start in product((0.95, 1.1), (None, np.full((1, 2), 0.4))):
        try:
            said.append(str(Surface(part, "v1").project(np.array([[0.0, 0.0, height]]), start).found))
        except LostProjectionError as error:
            said.append(str(error))
    return {"other": float(sum("the master has no normal" not in words for words in said))}
