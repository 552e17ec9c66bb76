"""The solid's forces and tangent on one element: against the stored energy, under rigid motion, and near the reference state."""

from __future__ import annotations

import mpmath
import numpy as np

from isomortar import _bindings, _twin
from isomortar.geometry.patch import FloatArray, Patch
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import LAGRANGE, NURBS, Bound, case
from isomortar.model.entities import Body, Material, Problem
from isomortar.model.numbering import Numbering, patch_arrays
from isomortar.model.solid import Solid

MATERIAL = Material()
EPSILON = float(np.finfo(float).eps)
CUBE = box((0, 0, 0), (1, 1, 1))
VOLUME_RATIOS = (0.05, 0.3, 1.0, 4.0, 20.0)


def forces(patch: Patch, positions: FloatArray, points: int) -> FloatArray:
    """The kernel's internal forces, shape (control points, 3)."""
    found = np.zeros_like(positions)
    arrays = patch_arrays(patch, np.arange(len(positions), dtype=np.int32))
    _bindings.add_body(arrays, (points,) * 3, MATERIAL.bulk, MATERIAL.shear, np.ascontiguousarray(positions), patch.control_points, found)
    return found


def stress(gradient: FloatArray) -> FloatArray:
    """The kernel's P at a deformation gradient: of the unit cube it is the sum of forces times places."""
    return forces(CUBE, CUBE.control_points @ gradient.T, 2).T @ CUBE.control_points


def energy_slope(gradient: FloatArray) -> FloatArray:
    """dW/dF of W = A1/2 (ln J)^2 + A2/2 (J^(-2/3) tr F^T F - 3) by complex steps, which lose no digits."""
    slope = np.empty((3, 3))
    for i, j in np.ndindex(3, 3):
        f = gradient.astype(complex)
        f[i, j] += 1e-30j
        volume = f[0] @ np.cross(f[1], f[2])
        energy = MATERIAL.bulk / 2 * np.log(volume) ** 2 + MATERIAL.shear / 2 * (volume ** (-2 / 3) * (f**2).sum() - 3)
        slope[i, j] = energy.imag / 1e-30
    return slope


def random_gradients(volume_ratio: float) -> FloatArray:
    """Deformation gradients with that determinant, stretches between 1/2 and 2 apart from it, shape (20, 3, 3)."""
    random = np.random.default_rng(int(100 * volume_ratio))
    found = []
    for _ in range(20):
        left, right = (np.linalg.qr(random.standard_normal((3, 3)))[0] for _ in range(2))
        stretches = 2.0 ** random.uniform(-1, 1, 3)
        turn = np.sign(np.linalg.det(left) * np.linalg.det(right))
        found.append(turn * left * (stretches * np.cbrt(volume_ratio / np.prod(stretches))) @ right)
    return np.array(found)


@case(
    claim="The stress is the slope of the stored energy, P = dW/dF.",
    tier="gate",
    grid={"volume_ratio": list(VOLUME_RATIOS)},
    bounds={"error": Bound(at_most=200 * EPSILON, reason="round-off: dozens of operations, times the condition of F, at most 4, twice")},
)
def stress_of_energy(volume_ratio: float) -> dict[str, float]:
    """Largest error over random deformations, as a share of the moduli times the inverse of F, or of P if that is larger."""
    worst = 0.0
    for f in random_gradients(volume_ratio):
        exact = energy_slope(f)
        size = max(np.abs(exact).max(), MATERIAL.bulk * np.linalg.norm(np.linalg.inv(f), 2))
        worst = float(np.maximum(worst, np.abs(stress(f) - exact).max() / size))
    return {"error": worst}


def curved_element(kind: str) -> Patch:
    """One element with control points moved, and weights of NURBS spread, at random."""
    family, order = kind[0], int(kind[1:])
    patch = mesh(CUBE, (family,) * 3, (order,) * 3, (1, 1, 1))  # type: ignore[arg-type]
    random = np.random.default_rng(order)
    points = patch.control_points + 0.1 / order * random.uniform(-1, 1, patch.control_points.shape)
    return Patch(patch.directions, points, random.uniform(0.5, 2.0, len(points)) if family == "N" else patch.weights)


@case(
    claim="The tangent is the derivative of the forces, at volume ratios from 0.05 to 20.",
    tier="gate",
    grid={"kind": ["N1", "N2", "N3", "L1", "L2"], "volume_ratio": list(VOLUME_RATIOS)},
    bounds={
        "error": Bound(at_most=1e-12, reason="round-off: sums over quadrature points in double precision; the differences are quadruple"),
        "asymmetry": Bound(at_most=1e-13, reason="theory: a stored energy has symmetric second derivatives; round-off of their sums"),
    },
)
def tangent(kind: str, volume_ratio: float) -> dict[str, float]:
    """Largest error of tangent times direction against differences in quadruple precision; asymmetry; both as shares of the largest."""
    patch = curved_element(kind)
    gauss = (int(kind[1:]) + 1,) * 3
    problem = Problem("tangent", (Body("body", patch, MATERIAL, gauss),), (), (), ())
    numbering = Numbering(problem)
    solid, worst, asymmetry = Solid(problem, numbering), 0.0, 0.0
    n = numbering.count
    for seed, f in enumerate(random_gradients(volume_ratio)[:3]):
        random = np.random.default_rng(seed)
        bend = 0.02 * np.cbrt(volume_ratio) / int(kind[1:]) * random.uniform(-1, 1, (n, 3))
        positions = np.ascontiguousarray(numbering.reference @ f.T + bend)
        _, blocks = solid.forces_and_tangent(positions)
        rows = np.repeat(np.arange(n), np.diff(solid.pattern.start))
        matrix = np.zeros((n, 3, n, 3))
        matrix[rows, :, solid.pattern.column, :] = blocks
        along = random.standard_normal((n, 3))
        exact = _twin.solid_difference(
            numbering.patch_arrays(problem.bodies[0]), gauss, MATERIAL.bulk, MATERIAL.shear, positions, along, numbering.reference
        )
        worst = float(np.maximum(worst, np.abs(np.einsum("aibk,bk->ai", matrix, along) - exact).max() / np.abs(exact).max()))
        square = matrix.reshape(3 * n, 3 * n)
        asymmetry = float(np.maximum(asymmetry, np.abs(square - square.T).max() / np.abs(square).max()))
    return {"error": worst, "asymmetry": asymmetry}


@case(
    claim="Forces turn with the body, and a rigid motion makes none.",
    tier="gate",
    grid={"kind": NURBS + LAGRANGE},
    bounds={
        "objectivity": Bound(at_most=1e-12, reason="round-off: of the turned positions, times the stiffness"),
        "rigid": Bound(at_most=1e-13, reason="round-off: of the turned positions, times the stiffness"),
    },
)
def rigid_motion(kind: str) -> dict[str, float]:
    """Change of the forces by a turn, and forces after a turn and a shift alone, as shares of those of strains of about one."""
    patch = curved_element(kind)
    points = int(kind[1:]) + 1
    random = np.random.default_rng(7)
    turn = np.linalg.qr(random.standard_normal((3, 3)))[0]
    turn *= np.linalg.det(turn)
    strained = patch.control_points @ random_gradients(1.0)[0].T
    before = forces(patch, strained, points)
    size = np.abs(before).max()
    after = forces(patch, strained @ turn.T, points)
    rigid = forces(patch, patch.control_points @ turn.T + [0.5, -0.3, 0.2], points)
    return {"objectivity": float(np.abs(after - before @ turn.T).max() / size), "rigid": float(np.abs(rigid).max() / size)}


@case(
    claim="At strains of 1e-9 the stress has all its digits.",
    tier="gate",
    bounds={"error": Bound(at_most=50 * EPSILON, reason="round-off: the displacements are exact in binary, and J - 1 is summed from them")},
)
def small_strain() -> dict[str, float]:
    """Largest error of P against 50 digits, as a share of its largest entry, over random displacement gradients of 2^-30."""
    worst = 0.0
    for seed in range(10):
        h = np.random.default_rng(seed).integers(-32, 33, (3, 3)) * 2.0**-35
        found = stress(np.eye(3) + h)
        with mpmath.workdps(50):
            f = mpmath.matrix((np.eye(3) + h).tolist())
            volume, inverse = mpmath.det(f), (f**-1).T
            square = mpmath.fsum(x**2 for x in f)
            exact = MATERIAL.bulk * mpmath.log(volume) * inverse
            exact += MATERIAL.shear * volume ** (mpmath.mpf(-2) / 3) * (f - square / 3 * inverse)
            wanted = np.array(exact.tolist(), dtype=float)
        worst = float(np.maximum(worst, np.abs(found - wanted).max() / np.abs(wanted).max()))
    return {"error": worst}
