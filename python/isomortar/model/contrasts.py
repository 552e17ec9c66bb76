"""How different the elements of a body are: double precision bears contrasts of some decades only."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.patch import FloatArray, Patch


def element_lengths(patch: Patch) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Lengths of a patch's elements along u, v and w, where they are longest across that: a pole makes no element short (theory 9.5).

    Each is the way along the control points over an element's span, shape (elements,).
    """
    points = patch.control_points.reshape(*patch.shape, 3, order="F")
    u, v, w = (_along(patch, points, axis) for axis in range(3))
    return u, v, w


def _along(patch: Patch, points: FloatArray, axis: int) -> FloatArray:
    direction = patch.directions[axis]
    steps = np.linalg.norm(np.diff(points, axis=axis), axis=-1).max(axis=tuple(k for k in range(3) if k != axis))
    if direction.family == "L":
        return steps.reshape(direction.elements, direction.order).sum(axis=1)
    spans = np.diff(direction.knots[1:-1])
    over = np.arange(len(steps))[:, None] + np.arange(direction.order)  # each goes over `order` spans, as far over each as that is long
    shares = steps[:, None] * spans[over] / spans[over].sum(axis=1, keepdims=True)
    length = np.zeros(len(spans))
    np.add.at(length, over, shares)
    return length[spans > 0.0]
