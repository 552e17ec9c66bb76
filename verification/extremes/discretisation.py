"""The discretisation itself: stability of the constraint, conditioning of control quantities, ellipticity of the material."""

from __future__ import annotations

import numpy as np
from extreme_scenes import YOUNG, changed, column, loaded, ran
from scipy import linalg
from scipy.interpolate import BSpline

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, Shown, case
from isomortar.model.entities import Material
from isomortar.scene import Scene
from isomortar.scene.toml_text import dump
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger


def spline_knots(order: int, elements: int) -> FloatArray:
    """Open knots over [0, 1] of elements of one length."""
    return np.concatenate([np.zeros(order), np.linspace(0.0, 1.0, elements + 1), np.ones(order)])


def masses(order: int, elements: int, other_elements: int) -> FloatArray:
    """Integrals over the unit square of products of B-splines of one order on two meshes, first direction fastest."""
    both = [spline_knots(order, n) for n in (elements, other_elements)]
    ends = np.unique(np.round(np.concatenate(both), 12))
    points, weights = np.polynomial.legendre.leggauss(order + 1)
    x = (0.5 * (ends[1:] + ends[:-1])[:, None] + 0.5 * np.diff(ends)[:, None] * points).ravel()
    w = (0.5 * np.diff(ends)[:, None] * weights).ravel()
    first, second = (BSpline.design_matrix(x, knots, order).toarray() for knots in both)
    line = first.T @ (w[:, None] * second)
    return np.kron(line, line)


def stiffness(equilibrium: Equilibrium, positions: FloatArray) -> FloatArray:
    """The solid's tangent as a full matrix, shape (control points, 3, control points, 3)."""
    pattern = equilibrium.solid.pattern
    _, blocks = equilibrium.solid.forces_and_tangent(positions)
    count = len(positions)
    rows = np.repeat(np.arange(count), np.diff(pattern.start))
    full = np.zeros((count, 3, count, 3))
    full[rows, :, pattern.column, :] = blocks
    return full


def equilibrium_of(order: int, elements: tuple[int, int, int], young: float = YOUNG) -> Equilibrium:
    """A unit cube, pressed on a plane."""
    data = changed(column(young=young), {"bodies.b.mesh": {"order": [order] * 3, "elements": list(elements)}})
    return Equilibrium(Scene.from_toml(dump(data)).problem(), Ledger())


def compliance(order: int, elements: int, young: float) -> FloatArray:
    """Displacements along z that forces along z cause on the lower face of a cube whose upper face is held; shape (n, n)."""
    equilibrium = equilibrium_of(order, (elements, elements, 2), young)
    patch = equilibrium.problem.bodies[0].patch
    count = len(patch.weights)
    full = stiffness(equilibrium, patch.control_points).reshape(3 * count, 3 * count)
    held = (3 * patch.face_points("w1")[:, None] + np.arange(3)).ravel()
    free = np.setdiff1d(np.arange(3 * count), held)
    places = np.searchsorted(free, 3 * patch.face_points("w0") + 2)
    forces = np.zeros((len(free), len(places)))
    forces[places, np.arange(len(places))] = 1.0
    found: FloatArray = linalg.solve(full[np.ix_(free, free)], forces, assume_a="sym")[places]
    return found


def inf_sup(order: int, slave: int, young: float = YOUNG, master: int = 0, master_young: float = YOUNG) -> float:
    """Inf-sup constant of the pressures in the norm of the inverse stiffness, of a cube on a rigid plane or (`master` > 0) on a cube.

    The smallest of ``sqrt(p B K^-1 B^T p / (h/E p M p))`` over control pressures p, with the size h of the slave's elements, the smaller
    modulus E and the mass matrix M: the usual norm of pressures that depends on the mesh.
    """
    mass = masses(order, slave, slave)
    energy = mass @ compliance(order, slave, young) @ mass
    if master:
        mixed = masses(order, slave, master)
        energy = energy + mixed @ compliance(order, master, master_young) @ mixed.T
    scale = 1.0 / (slave * (min(young, master_young) if master else young))
    return float(np.sqrt(linalg.eigh(energy, scale * mass, eigvals_only=True)[0]))


@case(
    claim="The constraint is stable: finer meshes leave its inf-sup constant.",
    tier=lambda order: "gate" if order == 2 else "nightly",
    grid={"order": (1, 2, 3, 4)},
    bounds={
        "coarse": Shown("theory: positive; the constant of 3 x 3 elements"),
        "fine": Shown("theory: positive; the constant of 6 x 6 elements"),
        "kept": Bound(at_least=0.5**0.5, reason="theory: a stable pair tends to keep its constant, an unstable one loses a half; between"),
    },
)
def stability(order: int) -> dict[str, float]:
    """A cube on a rigid plane."""
    coarse, fine = inf_sup(order, 3), inf_sup(order, 6)
    return {"coarse": coarse, "fine": fine, "kept": fine / coarse}


_NO_WORSE = {"slave finer and softer": (6, 1.0, 3, 1e3), "slave finer, alike": (6, 1.0, 3, 1.0)}
_PAIRS = _NO_WORSE | {
    "slave coarser and stiffer": (3, 1e3, 6, 1.0),
    "slave finer and stiffer": (6, 1e3, 3, 1.0),
}


@case(
    claim="The constraint of two bodies is as stable as the slave's alone, where the slave is not the stiffer one; else it is shown.",
    tier="nightly",
    grid={"order": (2, 3), "pair": tuple(_PAIRS)},
    bounds=lambda pair, **_: {
        "constant": Shown("theory: positive; the constant of the pair"),
        "of the slave alone": Bound(at_least=0.999 if pair in _NO_WORSE else 0.0, reason="theory: a master only yields"),
    },
)
def stability_of_pairs(order: int, pair: str) -> dict[str, float]:
    """Two cubes; a thousand times stiffer or alike, on 3 x 3 and 6 x 6 elements."""
    slave, young, master, master_young = _PAIRS[pair]
    constant = inf_sup(order, slave, YOUNG * young, master, YOUNG * master_young)
    return {"constant": constant, "of the slave alone": constant / inf_sup(order, 6)}


@case(
    claim="The mass matrix, by which gaps and pressures of control points belong together, is no worse conditioned than theory allows.",
    tier="nightly",
    grid={"order": (1, 2, 3, 4, 6, 8, 10)},
    bounds=lambda order: {
        "condition": Bound(
            at_most=float(((order + 1) * 2.0 ** (order + 1)) ** 4),
            reason="theory: the condition of a basis of B-splines is at most k 2^k (Scherer and Shadrin), squared, and for two directions",
        )
    },
)
def conditioning(order: int) -> dict[str, float]:
    """Condition of the mass matrix on 8 x 8 elements, its diagonal scaled to one."""
    mass = masses(order, 8, 8)
    scale = 1.0 / np.sqrt(np.diag(mass))
    return {"condition": float(np.linalg.cond(scale[:, None] * mass * scale))}


def chequerboard(pressures: FloatArray) -> float:
    """Share of the alternating pattern of signs in control pressures that are square."""
    side = round(len(pressures) ** 0.5)
    signs = (-1.0) ** np.add.outer(np.arange(side), np.arange(side)).ravel()
    return float(abs(signs @ pressures) / np.abs(pressures).sum())


@case(
    claim="Control pressures of a uniform state are uniform; the chequerboard in those under a curved body is shown.",
    tier=lambda order: "gate" if order == 3 else "nightly",
    grid={"order": (1, 2, 3, 4, 5)},
    bounds={
        "uniform": Bound(at_most=1e-6, reason="round-off: Newton stops at 1e-9, and the basis is ill-conditioned at high orders"),
        "curved": Shown("discretisation: the share of an alternating pattern under a press"),
        "above field": Shown("discretisation: largest control pressure over the largest pressure at a quadrature point"),
        "least pressure": Bound(at_least=0.0, reason="theory: functions and control pressures are not negative, and so is no pressure"),
    },
)
def chequerboards(order: int) -> dict[str, float]:
    """The column of four by four elements, and a bowl on a plane."""
    flat = ran(changed(column(), {"bodies.b.mesh": {"order": [order] * 3, "elements": [4, 4, 1]}}))
    curved = ran(changed(loaded("coarse-press"), {"bodies.block.mesh.order": [max(order, 2), max(order, 2), 1]}))
    field = curved.held["curves/contacts/floor/pressure_field"]
    pressures = curved.held["states/contacts/floor/pressure"]
    uniform = flat.held["states/contacts/f/pressure"][-1]
    return {
        "uniform": float(np.ptp(uniform) / uniform.mean()),
        "curved": chequerboard(pressures[-1]),
        "above field": float(pressures[-1].max() / field[-1, 1]),
        "least pressure": float(field.min() / field.max()),
    }


def acoustic(gradient: FloatArray) -> FloatArray:
    """Smallest eigenvalue of the acoustic tensor by direction, of the kernel's own tangent; directions cover a half sphere."""
    equilibrium = equilibrium_of(1, (1, 1, 1))
    places = equilibrium.problem.bodies[0].patch.control_points
    moduli = np.einsum("aj,aibk,bl->ijkl", places, stiffness(equilibrium, np.ascontiguousarray(places @ gradient.T)), places)
    k = np.arange(400) + 0.5
    height, angle = k / 400, np.pi * (1 + 5**0.5) * k
    level = np.sqrt(1 - height**2)
    directions = np.concatenate([np.eye(3), np.stack([level * np.cos(angle), level * np.sin(angle), height], axis=1)])
    tensors = np.einsum("nj,ijkl,nl->nik", directions, moduli, directions)
    found: FloatArray = np.linalg.eigvalsh(tensors)[:, 0]
    return found


@case(
    claim="The material is elliptic where its closed form is: a dilatation loses it at J = exp(1 + 4/3 shear/bulk), and there alone.",
    tier="gate",
    grid={"ratio": (0.01, 0.1, 0.5, 1.0, 2.0, 4.0, 5.0, 20.0)},
    bounds=lambda ratio: {
        "error": Bound(at_most=1e-10, reason="round-off: sums over eight points; entries of the tangent are up to 25 times the result"),
        "elliptic": (lambda is_: Bound(at_least=is_, at_most=is_, reason="theory: sign of min(shear, bulk (1 - ln J) + 4/3 shear)"))(
            float(np.log(ratio) < 1.0 + 4.0 / 3.0 * Material().shear / Material().bulk)
        ),
    },
)
def dilatation(ratio: float) -> dict[str, float]:
    """Smallest eigenvalue of the acoustic tensor at F = J^(1/3) I, over 403 directions, against ``J^(-2/3) min(...)``."""
    material = Material()
    right = ratio ** (-2.0 / 3.0) * min(material.shear, material.bulk * (1.0 - np.log(ratio)) + 4.0 / 3.0 * material.shear)
    found = acoustic(np.eye(3) * np.cbrt(ratio))
    size = ratio ** (-2.0 / 3.0) * material.shear
    return {"error": float(np.abs(found - right).max() / size), "elliptic": float(found.min() > 0.0)}
