"""The least J of a body at its Gauss points, and that of the first element which is folded, as messages tell it."""

from __future__ import annotations

import re

import numpy as np
from solid.material import MATERIAL, curved

from isomortar import _bindings
from isomortar.errors import FoldedElementError
from isomortar.geometry.patch import FloatArray, Patch
from isomortar.harness import Bound, case
from isomortar.model.entities import Body
from isomortar.model.numbering import body_arrays
from isomortar.results.stress import deformation_gradient

#: Orders and elements by direction, and Gauss points of an element.
ORDERS, ELEMENTS, GAUSS = (1, 2, 3), (3, 2, 3), (3, 4, 5)


def at_points(patch: Patch, positions: FloatArray) -> FloatArray:
    """J at the Gauss points, by SciPy's splines, shape (elements, points of each); first direction fastest among both."""
    lines = []
    for direction, count in zip(patch.directions, GAUSS, strict=True):
        points, ends = np.polynomial.legendre.leggauss(count)[0], direction.boundaries
        lines.append((ends[:-1, None] + np.diff(ends)[:, None] * 0.5 * (1.0 + points)).ravel())
    jacobians = np.linalg.det(deformation_gradient(Body("body", patch, MATERIAL, GAUSS), positions, lines))
    by_line = jacobians.reshape([part for pair in zip(ELEMENTS, GAUSS, strict=True) for part in reversed(pair)], order="F")
    return by_line.transpose(1, 3, 5, 0, 2, 4).reshape(int(np.prod(ELEMENTS)), -1, order="F")


@case(
    claim="The least J of a body is that of all its Gauss points, and where elements are folded that of the first of them, as it is told.",
    grid={"family": ("N", "L"), "bend": (0.03, 0.3)},
    bounds={
        "least": Bound(at_most=1e-11, reason="round-off: determinants of gradients by other functions, where nothing is folded"),
        "told": Bound(at_most=6e-3, reason="definition: messages have three digits"),
        "place": Bound(0.0, 0.0, "definition: bodies of which another element is named, or none"),
        "not the last": Bound(at_least=1.0, reason="definition: bodies whose least J is in another element than the last one"),
    },
)
def at_gauss_points(family: str, bend: float) -> dict[str, float]:
    """Relative differences from J by other functions, the most of ten bodies that are bent at random."""
    patch = curved(family, ORDERS, ELEMENTS)
    arrays = body_arrays(Body("body", patch, MATERIAL, GAUSS))
    off, other, elsewhere = {"least": [0.0], "told": [0.0]}, 0, 0
    for seed in range(10):
        positions = patch.control_points + bend * np.random.default_rng(seed).uniform(-1, 1, patch.control_points.shape)
        least = at_points(patch, positions).min(axis=1)
        folded = np.flatnonzero(least <= 0.0)
        expected = float(least[folded[0]] if folded.size else least.min())
        elsewhere += int(np.argmin(least)) < len(least) - 1
        try:
            found = _bindings.add_body(arrays, MATERIAL.arrays, positions, np.zeros_like(positions))
            other += bool(folded.size)
        except FoldedElementError as error:
            found = float(re.findall(r"J = (\S+)\)", str(error))[0])
            other += not folded.size or error.place != folded[0]
        off["told" if folded.size else "least"].append(abs(found / expected - 1.0))
    return {name: float(np.max(apart)) for name, apart in off.items()} | {"place": float(other), "not the last": float(elsewhere)}
