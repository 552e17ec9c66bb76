"""The solid by plain loops over elements and points, as theory 1 writes it: what sum factorisation must give.

Forces are summed point by point with SciPy's B-splines; the tangent's product with a direction is their complex-step derivative.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from scipy.interpolate import BSpline

from isomortar import _bindings
from isomortar._bindings import BodyArrays, Pattern
from isomortar.geometry.patch import Direction, Patch
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.model.entities import Material
from isomortar.model.numbering import patch_arrays

MATERIAL = Material(10.0, 0.3)


def distorted_body(order: tuple[int, int, int], elements: tuple[int, int, int], spread: float) -> Patch:
    """A distorted box of elements of unequal lengths, with weights between exp(-spread) and exp(spread)."""
    rng = np.random.default_rng(5)
    patch = mesh(box((0.0, 0.0, 0.0), (1.0, 0.7, 1.2)), ("N", "N", "N"), order, elements, (1.4, 0.8, 1.2))
    shaken = patch.control_points + 0.03 / max(elements) * rng.standard_normal(patch.control_points.shape)
    return replace(patch, control_points=shaken, weights=np.exp(rng.uniform(-spread, spread, patch.weights.shape)))


def line(direction: Direction, element: int, points: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Gauss weights, values and slopes of all functions of a direction at the points of one element: (point, function)."""
    low, high = direction.boundaries[element : element + 2]
    x, weights = np.polynomial.legendre.leggauss(points)
    x = low + (high - low) * (x + 1.0) / 2.0
    splines = BSpline(direction.knots, np.eye(direction.count), direction.order)
    return weights * (high - low) / 2.0, splines(x), splines.derivative()(x)


def samples_of(patch: Patch, points: tuple[int, int, int]) -> list[tuple[float, np.ndarray, np.ndarray]]:
    """Of every point the volume, all functions and their gradients in the reference configuration, shape (control points, 3)."""
    found = []
    w = patch.weights.ravel()
    for element in product(*(range(d.elements) for d in patch.directions)):
        lines = [line(d, e, n) for d, e, n in zip(patch.directions, element, points, strict=True)]
        for q in product(*(range(n) for n in points)):
            one, two, three = ((values[i], slopes[i]) for (_, values, slopes), i in zip(lines, q, strict=True))
            kinds = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
            b = [w * np.einsum("i,j,k->kji", one[d], two[e], three[f]).ravel() for d, e, f in kinds]
            total = b[0].sum()
            parametric = np.column_stack([(b[d] - b[0] * b[d].sum() / total) / total for d in (1, 2, 3)])
            map_ = patch.control_points.T @ parametric
            volume = float(np.prod([weights[i] for (weights, _, _), i in zip(lines, q, strict=True)]) * np.linalg.det(map_))
            found.append((volume, b[0] / total, parametric @ np.linalg.inv(map_)))
    return found


def plain_forces(samples: list[tuple[float, np.ndarray, np.ndarray]], positions: np.ndarray) -> np.ndarray:
    """Internal forces at real or complex positions."""
    forces = np.zeros_like(positions)
    for volume, _, gradient in samples:
        f = positions.T @ gradient
        jacobian, b = np.linalg.det(f), f @ f.T
        spherical = MATERIAL.bulk * np.log(jacobian) * np.eye(3)
        stress = spherical + MATERIAL.shear * jacobian ** (-2.0 / 3.0) * (b - np.trace(b) / 3.0 * np.eye(3))
        forces += volume * gradient @ (stress @ np.linalg.inv(f).T).T
    return forces


#: Order, elements and Gauss points. Elements are computed four side by side: rows of one to seven; 343 of order 1 are more than a batch of
#: tangents on one or two threads.
BODIES = [
    ((3, 1, 2), (2, 2, 1), (5, 2, 3)),
    ((1, 4, 1), (1, 3, 2), (3, 5, 2)),
    ((2, 2, 5), (1, 1, 2), (4, 3, 6)),
    ((1, 2, 1), (1, 1, 1), (1, 2, 9)),
    ((2, 1, 1), (3, 1, 1), (4, 1, 2)),
    ((1, 1, 3), (1, 5, 1), (2, 2, 7)),
    ((2, 2, 1), (1, 1, 7), (3, 3, 2)),
    ((1, 1, 1), (7, 7, 7), (2, 2, 2)),
]


@pytest.mark.parametrize("spread", [0.9, 0.0], ids=["rational", "polynomial"])
@pytest.mark.parametrize(("order", "elements", "points"), BODIES)
def test_forces_and_tangent(
    order: tuple[int, int, int], elements: tuple[int, int, int], points: tuple[int, int, int], spread: float
) -> None:
    patch = distorted_body(order, elements, spread)
    n = len(patch.control_points)
    arrays = patch_arrays(patch, np.arange(n, dtype=np.int32))
    rng = np.random.default_rng(6)
    positions = patch.control_points + 0.03 / max(elements) * rng.standard_normal((n, 3))
    pattern = Pattern(np.arange(0, n * n + 1, n, dtype=np.int32), np.tile(np.arange(n, dtype=np.int32), n))
    forces, blocks = np.zeros((n, 3)), np.zeros((n * n, 3, 3))
    body = BodyArrays(arrays, points, patch.control_points)
    _bindings.add_body(body, MATERIAL.arrays, positions, forces, pattern, blocks)
    tangent = blocks.reshape(n, n, 3, 3).transpose(0, 2, 1, 3).reshape(3 * n, 3 * n)

    samples = samples_of(patch, points)
    plain = plain_forces(samples, positions)
    assert np.linalg.norm(forces - plain) < 1e-13 * np.linalg.norm(plain)
    along = rng.standard_normal((n, 3))
    step = 1e-30
    slope = plain_forces(samples, positions + 1j * step * along).imag / step
    assert np.linalg.norm(tangent @ along.ravel() - slope.ravel()) < 1e-13 * np.linalg.norm(slope)
    shares = sum(volume * functions for volume, functions, _ in samples)
    assert np.linalg.norm(_bindings.control_volumes(body) - shares) < 1e-13 * np.linalg.norm(shares)
