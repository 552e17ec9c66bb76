"""A folded element is named by its number, wherever in the body it is."""

from __future__ import annotations

import numpy as np
from solid.material import CUBE, forces

from isomortar import _bindings
from isomortar._bindings import BodyArrays
from isomortar.errors import FoldedElementError
from isomortar.geometry.patch import FloatArray, Patch
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.model.numbering import patch_arrays

#: Elements in each direction, no two alike: a few, and more than are computed at once, of which every so many are folded.
ELEMENTS = {"few": ((4, 3, 2), 1), "many": ((13, 12, 11), 107)}


def moved(patch: Patch, positions: FloatArray) -> None:
    """Forces of a body whose control points have gone somewhere."""
    forces(patch, positions, 3)


def volumes(patch: Patch, positions: FloatArray) -> None:
    """Volumes of the control points of a body that is somewhere else."""
    points = np.arange(len(positions), dtype=np.int32)
    _bindings.control_volumes(BodyArrays(patch_arrays(patch, points), (3, 3, 3), positions))


@case(
    claim="Whichever element is folded, that one is named, in forces and in volumes: numbers run fastest along the first direction.",
    grid={"size": tuple(ELEMENTS)},
    bounds={
        "other": Bound(0.0, 0.0, "definition: elements that are folded where none is named, or another"),
        "of volumes": Bound(0.0, 0.0, "definition: the same of a body that is folded at rest"),
    },
)
def which_element(size: str) -> dict[str, float]:
    """How many of the elements, each folded alone: its middle node, which no other has, is moved beyond its sides."""
    elements, apart = ELEMENTS[size]
    patch = mesh(CUBE, ("L", "L", "L"), (2, 2, 2), elements)
    numbers = np.arange(len(patch.control_points)).reshape([2 * n + 1 for n in elements], order="F")
    last, other = int(np.prod(elements)) - 1, np.zeros(2)
    for e in {*range(0, last, apart), last}:
        i, j, k = np.unravel_index(e, elements, order="F")
        positions = patch.control_points.copy()
        positions[numbers[2 * i + 1, 2 * j + 1, 2 * k + 1]] += 1.0
        for number, computed in enumerate((moved, volumes)):
            try:
                computed(patch, positions)
                other[number] += 1
            except FoldedElementError as error:
                other[number] += error.place != e
    return {"other": float(other[0]), "of volumes": float(other[1])}


@case(
    claim="An element that has no thickness at rest is folded, and named, whichever of those that are computed side by side it is: a "
    "determinant of nothing at all is as good as a negative one.",
    tier="gate",
    bounds={"other": Bound(0.0, 0.0, "definition: elements that are flat where none is named, or another")},
)
def flat_element() -> dict[str, float]:
    """How many of six in a row, the far end of one of which is brought to its near one, and all beyond as far with it."""
    patch, other = mesh(CUBE, ("L", "L", "L"), (1, 1, 1), (6, 1, 1)), 0
    along = np.rint(6.0 * (patch.control_points[:, 0] - patch.control_points[:, 0].min()) / np.ptp(patch.control_points[:, 0]))
    for e in range(6):
        positions = patch.control_points.copy()
        positions[:, 0] = np.where(along > e, along - 1.0, along)
        try:
            volumes(patch, positions)
            other += 1
        except FoldedElementError as error:
            other += error.place != e
    return {"other": float(other)}


#: Gauss points of an element along a direction.
GAUSS = np.polynomial.legendre.leggauss(3)[0] / 2.0 + 0.5


@case(
    claim="A body that is folded at rest is refused wherever in an element that is: at each of its corners alone, by the J that is least.",
    tier="gate",
    bounds={
        "taken": Bound(0.0, 0.0, "definition: corners of which nothing is said"),
        "least": Bound(at_most=5e-3, reason="round-off: three digits as text"),
        "alone": Bound(0.0, 0.0, "definition: corners at which more than one Gauss point is folded"),
    },
)
def each_corner() -> dict[str, float]:
    """How many of eight; largest relative difference of what is told from the least J at the Gauss points; wrong scenes."""
    patch, taken, least, alone = mesh(CUBE, ("L", "L", "L"), (1, 1, 1), (1, 1, 1)), 0, [0.0], 0
    places = np.stack(np.meshgrid(GAUSS, GAUSS, GAUSS, indexing="ij"), axis=-1).reshape(-1, 3)
    corners = np.array([[k & 1, k >> 1 & 1, k >> 2] for k in range(8)])
    shares = np.prod(np.where(corners == 1, places[:, None], 1.0 - places[:, None]), axis=-1)
    signs = 2.0 * corners - 1.0
    slopes = np.stack([shares * signs[:, j] / np.where(corners[:, j] == 1, places[:, None, j], 1.0 - places[:, None, j]) for j in range(3)])
    for k, corner in enumerate(corners):
        positions = patch.control_points.copy()
        positions[k] -= 0.5 * (2.0 * corner - 1.0)
        exact = np.linalg.det(np.einsum("jqa,ac->qcj", slopes, positions))
        alone += np.count_nonzero(exact <= 0.0) != 1
        try:
            volumes(patch, positions)
            taken += 1
        except FoldedElementError as error:
            told = float(str(error).partition("J = ")[2].partition(")")[0])
            least.append(abs(told / float(exact.min()) - 1.0))
    return {"taken": float(taken), "least": float(np.max(least)), "alone": float(alone)}
