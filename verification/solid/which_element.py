"""A folded element is named by its number, wherever in the body it is."""

from __future__ import annotations

import numpy as np
from solid.material import CUBE, forces

from isomortar.errors import FoldedElementError
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case

#: Elements in each direction, no two alike.
ELEMENTS = (4, 3, 2)


@case(
    claim="Whichever element is folded, that one is named: numbers run fastest along the first direction.",
    bounds={"other": Bound(0.0, 0.0, "definition: elements that are folded where none is named, or another")},
)
def which_element() -> dict[str, float]:
    """How many of the elements, each folded alone: its middle node, which no other has, is moved beyond its sides."""
    patch = mesh(CUBE, ("L", "L", "L"), (2, 2, 2), ELEMENTS)
    numbers = np.arange(len(patch.control_points)).reshape([2 * n + 1 for n in ELEMENTS], order="F")
    other = 0
    for e, (k, j, i) in enumerate(np.ndindex(ELEMENTS[::-1])):
        positions = patch.control_points.copy()
        positions[numbers[2 * i + 1, 2 * j + 1, 2 * k + 1]] += 1.0
        try:
            forces(patch, positions, 3)
        except FoldedElementError as error:
            other += error.place != e
        else:
            other += 1
    return {"other": float(other)}
