"""Weights of a patch, of which ratios alone count: what is too light beside the heaviest one is refused, in any unit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.primitives import box
from isomortar.harness import Bound, case

#: Ratios of one weight to the others, and whether it is too light: beside the last bit of one.
RATIOS = ((1.0, False), (1e-10, False), (3e-16, False), (1e-16, True), (1e-30, True))


@case(
    claim="A control point that is too light to count beside the heaviest one is refused by its number, whatever the unit of weights is.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: patches that are refused, or not, and should not be, or for another control point")},
)
def lightest() -> dict[str, float]:
    """How many of patches with a light control point anywhere, in units from 1e-12 to 1e30."""
    patch, wrong = box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), 0
    for ratio, refused in RATIOS:
        for unit in (1e-12, 1e-3, 1.0, 1e10, 1e30):
            for number in (0, 5, 7):
                weights = np.full(8, unit)
                weights[number] *= ratio
                try:
                    replace(patch, weights=weights)
                    wrong += refused
                except InputError as error:
                    wrong += not refused or f"weight {number} is" not in str(error)
    return {"wrong": float(wrong)}
