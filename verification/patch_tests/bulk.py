"""Bulk patch test: an affine motion of a distorted mesh leaves its interior control points in balance.

With rational functions the integrals are not polynomials: the residual falls with the number of Gauss points, to round-off. Lagrange
elements have no weights; theirs are polynomials of up to three times the order.
"""

from __future__ import annotations

import numpy as np

from isomortar import _bindings
from isomortar._bindings import BodyArrays
from isomortar.geometry.patch import FloatArray, Patch
from isomortar.geometry.primitives import box
from isomortar.geometry.quadrature import volume_points
from isomortar.geometry.refinement import mesh
from isomortar.harness import LAGRANGE, NURBS, Bound, Curve, Shown, case
from isomortar.model.entities import Material
from isomortar.model.numbering import patch_arrays

MATERIAL = Material()
#: A motion with large stretch, shear and rotation; its determinant is positive.
GRADIENT = np.array([[1.2, 0.3, -0.1], [-0.2, 0.9, 0.25], [0.15, -0.1, 1.1]])
SHIFT = np.array([0.3, -2.0, 0.7])
#: Inner control points move by up to this share of their distance; weights lie between 1/2^SPREAD and 2^SPREAD.
DISTORTION, SPREAD = 0.03, 0.5
ELEMENTS = (2, 3, 2)


def distorted(kind: str) -> Patch:
    """A box of that discretisation with inner control points, and the weights of NURBS, at random."""
    family, order = kind[0], int(kind[1:])
    patch = mesh(box((0, 0, 0), (1.0, 1.4, 0.8)), (family,) * 3, (order,) * 3, ELEMENTS)  # type: ignore[arg-type]
    random = np.random.default_rng(order)
    points = patch.control_points.copy()
    spacing = np.ptp(points, axis=0) / (np.array(patch.shape) - 1)
    inner = interior(patch)
    points[inner] += DISTORTION * spacing * random.uniform(-1.0, 1.0, (len(inner), 3))
    weights = 2.0 ** random.uniform(-SPREAD, SPREAD, len(points))
    return Patch(patch.directions, points, weights if family == "N" else patch.weights)


def interior(patch: Patch) -> np.ndarray:
    """Numbers of the control points on no face."""
    faces = [patch.face_points(direction + end) for direction in "uvw" for end in "01"]
    return np.setdiff1d(np.arange(len(patch.weights)), np.concatenate(faces))


def residual(patch: Patch, gauss: tuple[int, int, int]) -> float:
    """Largest force at an interior control point over the largest at any, after the affine motion."""
    reference = patch.control_points
    positions: FloatArray = np.ascontiguousarray(reference @ GRADIENT.T + SHIFT)
    forces = np.zeros_like(reference)
    arrays = BodyArrays(patch_arrays(patch, np.arange(len(reference), dtype=np.int32)), gauss, reference)
    _bindings.add_body(arrays, MATERIAL.arrays, positions, forces)
    return float(np.abs(forces[interior(patch)]).max() / np.abs(forces).max())


@case(
    claim="A uniform stress leaves the interior of a distorted mesh in balance to round-off.",
    tier="gate",
    grid={"kind": NURBS + LAGRANGE},
    bounds={
        "residual": Bound(at_most=1e-12, reason="round-off: with 20 points per direction the quadrature of these weights is exact to it"),
        "default": Shown(reason="quadrature: the default number of points: rational integrals are not exact"),
    },
)
def affine_motion(kind: str) -> dict[str, float]:
    """Relative force at interior control points, with 20 points and with the default number."""
    patch = distorted(kind)
    default = tuple(volume_points(direction) for direction in patch.directions)
    return {"residual": residual(patch, (20, 20, 20)), "default": residual(patch, default)}  # type: ignore[arg-type]


@case(
    claim="The imbalance of a uniform stress falls with the number of Gauss points.",
    tier="nightly",
    grid={"kind": NURBS + LAGRANGE},
    bounds={
        "curve": Shown(reason="quadrature: rational integrands, geometric convergence to round-off"),
        "last": Bound(at_most=1e-12, reason="round-off: with 20 points per direction the quadrature of these weights is exact to it"),
    },
)
def affine_motion_against_points(kind: str) -> dict[str, object]:
    """Relative force at interior control points for 2 to 20 points per direction, and that with 20."""
    patch = distorted(kind)
    points = [2, 3, 4, 6, 8, 10, 12, 16, 20]
    residuals = [residual(patch, (n, n, n)) for n in points]
    return {"curve": Curve(points, residuals, "points per direction", "relative residual"), "last": residuals[-1]}
