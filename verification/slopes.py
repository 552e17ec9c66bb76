"""Rate at which an error falls, with its interval: for errors that scatter about a line, which no order of four meshes stands for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.harness.orders import regression


def fall(counts: Sequence[float] | FloatArray, errors: Sequence[float] | FloatArray) -> dict[str, float]:
    """Order at which errors fall with a count of elements, and the ends of its 95 % interval, from the scatter.

    Student's, of the regression of log(error) on log(count), as `isomortar.harness.orders` takes it.

    Returns
    -------
    dict
        ``order``, ``low``, ``high``.
    """
    slope, half = regression(np.log(counts), np.log(errors))
    return {"order": -slope, "low": -slope - half, "high": -slope + half}
