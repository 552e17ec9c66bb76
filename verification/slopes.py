"""Rate at which an error falls, with its interval: for errors that scatter about a line, which no order of four meshes stands for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import stats

from isomortar.geometry.patch import FloatArray


def fall(counts: Sequence[float] | FloatArray, errors: Sequence[float] | FloatArray) -> dict[str, float]:
    """Order at which errors fall with a count of elements, and the ends of its 95 % interval, from the scatter.

    Student's, of the regression of log(error) on log(count), as `isomortar.harness.orders` takes it.

    Returns
    -------
    dict
        ``order``, ``low``, ``high``.
    """
    line = stats.linregress(np.log(counts), np.log(errors))
    order, half = -float(line.slope), float(stats.t.ppf(0.975, len(counts) - 2) * line.stderr)
    return {"order": order, "low": order - half, "high": order + half}
