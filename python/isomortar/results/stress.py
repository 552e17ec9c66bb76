"""Deformation gradient and stress at points of a body, from its patch and the positions of its control points."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from isomortar import _bindings
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Body, Material
from isomortar.results.bezier import functions_at, rational_gradient


def deformation_gradient(body: Body, points: FloatArray, parameters: Sequence[FloatArray]) -> FloatArray:
    """F = dx/dX on a grid of parameters (theory 8.3).

    Parameters
    ----------
    body : Body
    points : ndarray, shape (n, 3)
        Positions of the patch's control points.
    parameters : sequence of three ndarray
        Along u, v, w; at an inner element boundary of them the element that begins there counts.

    Returns
    -------
    ndarray, shape (m, 3, 3)
        First direction fastest.
    """
    functions = [functions_at(d, x) for d, x in zip(body.patch.directions, parameters, strict=True)]
    both = np.column_stack([points, body.patch.control_points])
    _, gradient = rational_gradient(functions, body.patch.weights, both)
    return gradient[:, :3] @ np.linalg.inv(gradient[:, 3:])


def first_piola_stress(material: Material, deformation: FloatArray) -> FloatArray:
    """P of the material's law (theory 8.3), force per reference area.

    Parameters
    ----------
    material : Material
    deformation : ndarray, shape (..., 3, 3)
        F with det F > 0.

    Returns
    -------
    ndarray, shape (..., 3, 3)
    """
    gradient = np.ascontiguousarray(deformation.reshape(-1, 3, 3) - np.eye(3))
    return _bindings.material_stress(material.arrays, gradient).reshape(deformation.shape)


def cauchy_stress(material: Material, deformation: FloatArray) -> FloatArray:
    """Stress on the deformed body, force per deformed area: P F^T / det F; of small strains P itself, shape (..., 3, 3)."""
    first = first_piola_stress(material, deformation)
    if material.law == "linear-elastic":
        return first
    return first @ np.swapaxes(deformation, -1, -2) / np.linalg.det(deformation)[..., None, None]


def von_mises(stress: FloatArray) -> FloatArray:
    """Equivalent stress of von Mises: the norm of the deviator times the root of 3/2, shape (...,)."""
    deviator = stress - np.trace(stress, axis1=-2, axis2=-1)[..., None, None] / 3.0 * np.eye(3)
    return np.sqrt(1.5) * np.linalg.norm(deviator, axis=(-2, -1))
