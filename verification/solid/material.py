"""The solid's forces and tangent on one element: against the stored energy, under rigid motion, and near the reference state."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import get_args

import mpmath
import numpy as np
from numpy.typing import NDArray

from isomortar import _bindings, _twin
from isomortar._arrays import BodyArrays, MaterialLaw
from isomortar.errors import FoldedElementError
from isomortar.geometry.patch import FloatArray, Patch
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import LAGRANGE, NURBS, Bound, case
from isomortar.model.entities import Body, Material, Problem
from isomortar.model.numbering import Numbering, patch_arrays
from isomortar.model.solid import Solid

MATERIAL = Material()
#: Every law, and those that do not change with a turn.
LAWED = {law: Material(law=law) for law in get_args(MaterialLaw)}
OBJECTIVE = [law for law in LAWED if law != "linear-elastic"]
EPSILON = float(np.finfo(float).eps)
CUBE = box((0, 0, 0), (1, 1, 1))
VOLUME_RATIOS = (0.05, 0.3, 1.0, 4.0, 20.0)


def forces(patch: Patch, positions: FloatArray, points: int, material: Material = MATERIAL) -> FloatArray:
    """The kernel's internal forces, shape (control points, 3)."""
    found = np.zeros_like(positions)
    arrays = patch_arrays(patch, np.arange(len(positions), dtype=np.int32))
    body = BodyArrays(arrays, (points,) * 3, patch.control_points)
    _bindings.add_body(body, material.arrays, np.ascontiguousarray(positions), found)
    return found


def stress(gradient: FloatArray, material: Material = MATERIAL) -> FloatArray:
    """The kernel's P at a deformation gradient: of the unit cube it is the sum of forces times places."""
    return forces(CUBE, CUBE.control_points @ gradient.T, 2, material).T @ CUBE.control_points


def energy(f: NDArray[np.complex128], material: Material) -> complex:
    """Stored energy per reference volume (docs/method.md)."""
    strain, volume = (f + f.T) / 2 - np.eye(3), f[0] @ np.cross(f[1], f[2])
    isochoric = material.shear / 2 * (volume ** (-2 / 3) * (f**2).sum() - 3)
    return {
        "neo-hookean": material.bulk / 2 * np.log(volume) ** 2 + isochoric,
        "neo-hookean-j": material.bulk / 2 * (volume - 1) ** 2 + isochoric,
        "linear-elastic": (material.bulk / 2 - material.shear / 3) * np.trace(strain) ** 2 + material.shear * (strain**2).sum(),
    }[material.law]


def energy_slope(gradient: FloatArray, material: Material) -> FloatArray:
    """dW/dF by complex steps, which lose no digits."""
    slope = np.empty((3, 3))
    for i, j in np.ndindex(3, 3):
        f = gradient.astype(complex)
        f[i, j] += 1e-30j
        slope[i, j] = energy(f, material).imag / 1e-30
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
    grid={"law": list(LAWED), "volume_ratio": list(VOLUME_RATIOS)},
    bounds={
        "error": Bound(at_most=200 * EPSILON, reason="round-off: dozens of operations, times the condition of F, at most 4, twice"),
        "at points": Bound(at_most=200 * EPSILON, reason="round-off: as above"),
    },
)
def stress_of_energy(law: str, volume_ratio: float) -> dict[str, float]:
    """Largest error over random deformations, as a share of the moduli times the inverse of F, or of P if that is larger.

    Of what forces on a cube make of P, and of what the kernel says P is at a point.
    """
    material, worst = LAWED[law], np.zeros(2)
    for f in random_gradients(volume_ratio):
        exact = energy_slope(f, material)
        size = max(np.abs(exact).max(), material.bulk * np.linalg.norm(np.linalg.inv(f), 2))
        point = _bindings.material_stress(material.arrays, (f - np.eye(3))[None])[0]
        found = [np.abs(p - exact).max() / size for p in (stress(f, material), point)]
        worst = np.maximum(worst, found)
    return {"error": float(worst[0]), "at points": float(worst[1])}


@case(
    claim="A deformation that folds, or leaves no volume, is refused, by the element and at a point.",
    tier="gate",
    grid={"law": list(LAWED), "volume_ratio": (0.0, -1e-9, -0.5, -4.0)},
    bounds={name: Bound(1.0, 1.0, "definition: 1 where it is refused as folded") for name in ("element", "point")},
)
def folded(law: str, volume_ratio: float) -> dict[str, float]:
    """Whether diag(1, 1, J) is refused."""
    f, material = np.diag([1.0, 1.0, volume_ratio]), LAWED[law]

    def refused(compute: Callable[[], object]) -> float:
        try:
            compute()
        except FoldedElementError:
            return 1.0
        return 0.0

    return {
        "element": refused(lambda: forces(CUBE, CUBE.control_points @ f.T, 1, material)),  # one point: J is exact there
        "point": refused(lambda: _bindings.material_stress(material.arrays, (f - np.eye(3))[None])),
    }


def curved_element(kind: str) -> Patch:
    """One element with control points moved, and weights of NURBS spread, at random."""
    return curved(kind[0], (int(kind[1:]),) * 3, (1, 1, 1))


def curved(family: str, orders: tuple[int, int, int], elements: tuple[int, int, int]) -> Patch:
    """The same of several elements, of orders by direction."""
    patch, order = mesh(CUBE, (family,) * 3, orders, elements), max(orders)  # type: ignore[arg-type]
    random = np.random.default_rng(order)
    points = patch.control_points + 0.1 / (order * max(elements)) * random.uniform(-1, 1, patch.control_points.shape)
    return Patch(patch.directions, points, random.uniform(0.5, 2.0, len(points)) if family == "N" else patch.weights)


@case(
    claim="The tangent is the derivative of the forces, at volume ratios from 0.05 to 20.",
    tier=lambda kind, law, **_: "gate" if law == MATERIAL.law or kind == "N2" else "nightly",
    grid={"kind": ["N1", "N2", "N3", "L1", "L2"], "law": list(LAWED), "volume_ratio": list(VOLUME_RATIOS)},
    bounds={
        "error": Bound(at_most=1e-12, reason="round-off: sums over quadrature points in double precision; the differences are quadruple"),
        "asymmetry": Bound(at_most=1e-13, reason="theory: a stored energy has symmetric second derivatives; round-off of their sums"),
    },
)
def tangent(kind: str, law: str, volume_ratio: float) -> dict[str, float]:
    """Largest error of tangent times direction against differences in quadruple precision; asymmetry; both as shares of the largest."""
    return tangent_errors(curved_element(kind), LAWED[law], volume_ratio)


@case(
    claim="So it is where orders and numbers of elements differ by direction, whichever direction has which.",
    tier="gate",
    grid={"family": ["N", "L"], "orders": ["123", "132", "213", "231", "312", "321"]},
    bounds={
        "error": Bound(at_most=1e-12, reason="round-off: sums over quadrature points in double precision; the differences are quadruple"),
        "asymmetry": Bound(at_most=1e-13, reason="theory: a stored energy has symmetric second derivatives; round-off of their sums"),
    },
)
def tangent_by_direction(family: str, orders: str) -> dict[str, float]:
    """The same numbers of a curved block of two elements along the direction of the highest order."""
    u, v, w = map(int, orders)
    return tangent_errors(curved(family, (u, v, w), (1 + u // 3, 1 + v // 3, 1 + w // 3)), MATERIAL, 1.0)


def tangent_errors(patch: Patch, material: Material, volume_ratio: float) -> dict[str, float]:
    """Largest error of tangent times direction against differences in quadruple precision; asymmetry; both as shares of the largest."""
    gauss = (patch.directions[0].order + 1, patch.directions[1].order + 1, patch.directions[2].order + 1)
    order = max(gauss) - 1
    problem = Problem("tangent", (Body("body", patch, material, gauss),), (), (), ())
    numbering = Numbering(problem)
    solid, worst, asymmetry = Solid(problem, numbering), 0.0, 0.0
    n = numbering.count
    for seed, f in enumerate(random_gradients(volume_ratio)[:3]):
        random = np.random.default_rng(seed)
        bend = 0.02 * np.cbrt(volume_ratio) / order * random.uniform(-1, 1, (n, 3))
        positions = np.ascontiguousarray(numbering.reference @ f.T + bend)
        _, blocks = solid.forces_and_tangent(positions)
        rows = np.repeat(np.arange(n), np.diff(solid.pattern.start))
        matrix = np.zeros((n, 3, n, 3))
        matrix[rows, :, solid.pattern.column, :] = blocks
        along = random.standard_normal((n, 3))
        exact = _twin.solid_difference(numbering.body_arrays(problem.bodies[0]), material.arrays, positions, along)
        worst = float(np.maximum(worst, np.abs(np.einsum("aibk,bk->ai", matrix, along) - exact).max() / np.abs(exact).max()))
        square = matrix.reshape(3 * n, 3 * n)
        asymmetry = float(np.maximum(asymmetry, np.abs(square - square.T).max() / np.abs(square).max()))
    return {"error": worst, "asymmetry": asymmetry}


@case(
    claim="Forces turn with the body, and a rigid motion makes none.",
    tier=lambda kind, law: "gate" if law == MATERIAL.law or kind == "N2" else "nightly",
    grid={"kind": NURBS + LAGRANGE, "law": OBJECTIVE},
    bounds={
        "objectivity": Bound(at_most=1e-12, reason="round-off: of the turned positions, times the stiffness"),
        "rigid": Bound(at_most=1e-13, reason="round-off: of the turned positions, times the stiffness"),
    },
)
def rigid_motion(kind: str, law: str) -> dict[str, float]:
    """Change of the forces by a turn, and forces after a turn and a shift alone, as shares of those of strains of about one."""
    patch = curved_element(kind)
    points = int(kind[1:]) + 1
    random = np.random.default_rng(7)
    turn = np.linalg.qr(random.standard_normal((3, 3)))[0]
    turn *= np.linalg.det(turn)
    strained = patch.control_points @ random_gradients(1.0)[0].T
    places = strained, strained @ turn.T, patch.control_points @ turn.T + [0.5, -0.3, 0.2]
    before, after, rigid = (forces(patch, np.ascontiguousarray(place), points, LAWED[law]) for place in places)
    size = np.abs(before).max()
    return {"objectivity": float(np.abs(after - before @ turn.T).max() / size), "rigid": float(np.abs(rigid).max() / size)}


@case(
    claim="Far from the origin, and far from where it was, along any axis, a body has the same forces to the last digit.",
    grid={"kind": ["N2", "L2"], "axis": [0, 1, 2]},
    bounds=dict.fromkeys(
        ("change", "moved"), Bound(0.0, 0.0, "definition: of places whose digits all fit the shift too, only differences count")
    ),
)
def far_away(kind: str, axis: int) -> dict[str, float]:
    """Largest change of the forces by a shift of both configurations, or of the present one, by 2^20; places are multiples of 2^-20."""
    patch = curved_element(kind)
    here = np.round(patch.control_points * 2.0**20) / 2.0**20
    strained = np.round(here @ random_gradients(1.0)[0].T * 2.0**20) / 2.0**20
    shift = 2.0**20 * np.eye(3)[axis]
    points = int(kind[1:]) + 1
    places = ((here, strained), (here + shift, strained + shift), (here, strained + shift))
    near, far, moved = (forces(replace(patch, control_points=before), now, points) for before, now in places)
    return {"change": float(np.abs(far - near).max()), "moved": float(np.abs(moved - near).max())}


def many_digits(f: mpmath.matrix, material: Material) -> mpmath.matrix:
    """P at a deformation gradient with as many digits as mpmath works with."""
    volume, inverse, unit = mpmath.det(f), (f**-1).T, mpmath.eye(3)
    shape = material.shear * volume ** (mpmath.mpf(-2) / 3) * (f - mpmath.fsum(x**2 for x in f) / 3 * inverse)
    if material.law == "linear-elastic":
        strain = (f + f.T) / 2 - unit
        spherical = (material.bulk - 2 * mpmath.mpf(material.shear) / 3) * sum(strain[i, i] for i in range(3))
        return spherical * unit + 2 * material.shear * strain
    return shape + material.bulk * (mpmath.log(volume) if material.law == "neo-hookean" else volume * (volume - 1)) * inverse


@case(
    claim="At strains of 1e-9 the stress has all its digits.",
    tier="gate",
    grid={"law": list(LAWED)},
    bounds={"error": Bound(at_most=50 * EPSILON, reason="round-off: the displacements are exact in binary, and J - 1 is summed from them")},
)
def small_strain(law: str) -> dict[str, float]:
    """Largest error of P against 50 digits, as a share of its largest entry, over random displacement gradients of 2^-30."""
    material, worst = LAWED[law], 0.0
    for seed in range(10):
        h = np.random.default_rng(seed).integers(-32, 33, (3, 3)) * 2.0**-35
        found = stress(np.eye(3) + h, material)
        with mpmath.workdps(50):
            f = mpmath.matrix((np.eye(3) + h).tolist())
            wanted = np.array(many_digits(f, material).tolist(), dtype=float)
        worst = float(np.maximum(worst, np.abs(found - wanted).max() / np.abs(wanted).max()))
    return {"error": worst}
