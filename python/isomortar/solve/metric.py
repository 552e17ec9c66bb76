"""The discrete metric of control tractions: the master's tangents where the slave projects, averaged by test function (theory 4.2)."""

from __future__ import annotations

from typing import Any

import numpy as np

from isomortar._bindings import Control
from isomortar.geometry.patch import FloatArray


def contravariant(control: Control, traction: FloatArray) -> FloatArray:
    """Contravariant components of control tractions in the discrete metric, shape (..., constraints, 2) (theory 4.2)."""
    m11, m12, m22 = (control.metric / np.where(control.square > 0, control.square, 1.0)[:, None]).T
    determinant = m11 * m22 - m12**2
    scale = 1.0 / np.where(determinant > 0, determinant, 1.0)
    first, second = traction[..., 0], traction[..., 1]
    raised = np.empty_like(traction)
    raised[..., 0] = (m22 * first - m12 * second) * scale
    raised[..., 1] = (m11 * second - m12 * first) * scale
    return raised


def traction_squares(control: Control, traction: FloatArray) -> FloatArray:
    """Squared metric norm of control tractions, shape (..., constraints) (theory 4.2)."""
    return np.maximum(np.einsum("...a,...a->...", contravariant(control, traction), traction), 0.0)


def traction_norms(control: Control, traction: FloatArray) -> FloatArray:
    """Metric norm of control tractions, shape (..., constraints)."""
    return np.sqrt(traction_squares(control, traction))


def tangent_lengths(control: Control) -> FloatArray:
    """Typical lengths of the master's tangent vectors a_1, a_2 where the slave projects, shape (2,) (theory 6.4); 1 of none."""
    present = control.square > 0
    squared = control.metric[present][:, [0, 2]] / control.square[present, None]
    return np.sqrt(median(squared)) if np.any(present) else np.ones(2)


def median(values: FloatArray) -> Any:
    """Median over the first axis of one finite number or more; NumPy's own takes twenty times as long for a few hundred."""
    ordered = np.sort(values, axis=0)
    return 0.5 * (ordered[(len(ordered) - 1) // 2] + ordered[len(ordered) // 2])
