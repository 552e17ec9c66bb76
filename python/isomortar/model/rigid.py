"""What is left of a motion but for the rigid one that is nearest to it."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.patch import FloatArray


def deformation(before: FloatArray, after: FloatArray) -> FloatArray:
    """Ways of points but for the nearest rigid motion, whose turn is a polar decomposition, shape (points, 3)."""
    before, after = before - before.mean(axis=0), after - after.mean(axis=0)
    u, _, v = np.linalg.svd(before.T @ after)
    return np.asarray(after - before @ u @ np.diag([1.0, 1.0, np.linalg.det(u @ v)]) @ v)
