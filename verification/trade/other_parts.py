"""What is wanted of a field is not known from a run of another part of the scene, by planes of symmetry: not where contact ends either."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.trade.want import wanted


@case(
    claim="Fields of a slave's face, and where contact ends on it, are no numbers of a run that has another part of it.",
    grid={"quantity": ("pressure", "traction", "edge")},
    bounds={"told": Bound(0.0, 0.0, "definition: values of a run of another part that are numbers, or of the same part that are none")},
)
def other_parts(quantity: str) -> dict[str, float]:
    """How many, of a face of five cells."""
    want = wanted(f"{quantity}.floor", Scene.load("press").problem())
    field = {"counts": [5], "pressure": np.arange(5.0), "traction": np.arange(5.0)}
    whole, half = field | {"images": 1}, field | {"images": 2}
    return {"told": float(np.isfinite(want.values(half, whole)).sum() + np.isnan(want.values(whole, whole)).sum())}
