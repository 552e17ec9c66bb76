"""Which of some points is nearest, wherever all of them are: by the differences of coordinates, one by one."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.nearest import nearest
from isomortar.harness import Bound, case


@case(
    claim="Of many points the one that is nearest is found, near the origin and far from it, as far as coordinates have digits.",
    tier="gate",
    grid={"distance": (0.0, 1e4, 1e8, 1e12)},
    bounds={"farther": Bound(0.0, 0.0, "definition: points for which another one is nearer, by more than the last bits of a distance")},
)
def next_to(distance: float) -> dict[str, float]:
    """How many of some hundred."""
    random = np.random.default_rng(12)
    points, others = (distance * np.array([1.0, -0.7, 0.4]) + random.random((n, 3)) for n in (300, 900))
    apart = np.sqrt(((points[:, None, :] - others[None, :, :]) ** 2).sum(axis=2))
    found = apart[np.arange(len(points)), nearest(points, others)]
    return {"farther": float(np.count_nonzero(found > apart.min(axis=1) + 1e-7))}
