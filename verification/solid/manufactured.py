"""Manufactured solutions in finite deformation of a cylinder sector.

All three components of the displacement vary with radius and angle, and vanish on the curved and the cut faces. A sector that goes on
along its axis for ever is one element whose two ends move alike, so that fine meshes cost seconds; in a deep one the displacement varies
along the axis too and vanishes at its ends. The stress P follows in closed form, and the load of a function N is the integral of
P : grad N: what a body force of -div P does. Functions, geometry, load and errors are computed here, independently of the kernel; forces
and tangent are the kernel's.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import get_args

import numpy as np
from scipy import sparse
from scipy.interpolate import BSpline
from scipy.sparse.linalg import SuperLU, splu
from shapes import cylinder_sector

from isomortar._arrays import MaterialLaw
from isomortar.geometry.patch import FACES, Direction, FloatArray, IntArray, Patch
from isomortar.geometry.refinement import mesh
from isomortar.harness import Convergence, Order, case
from isomortar.model.entities import Body, Material, Problem
from isomortar.model.numbering import Numbering
from isomortar.model.pattern import element_points
from isomortar.model.solid import Solid

INNER, OUTER, ANGLE = 1.0, 2.0, np.pi / 3
#: Lengths along the axis: of one element, and of a deep sector.
HEIGHT, DEPTH = 0.5, 1.5
#: The displacement is this vector times a function between 0 and 1; its gradient reaches a half.
AMPLITUDE = np.array([0.12, -0.10, 0.15])
#: Gauss points beyond the order in every integral, and beyond that for the error of the quadrature.
POINTS, MORE = 2, 2
#: Elements that are evaluated in one go.
AT_ONCE = 32


@dataclass(frozen=True)
class Solution:
    """A manufactured solution: its displacement and gradient at points of shape (n, 3), shapes (n, 3) and (n, 3, 3), and the body.

    `deep`: elements along the axis as along the others, and its ends held; else one element with ends that move alike.
    """

    displacement: Callable[[FloatArray], tuple[FloatArray, FloatArray]]
    material: Material = field(default_factory=Material)
    deep: bool = False


def plane(x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The same at every height."""
    radius, angle = np.hypot(x[:, 0], x[:, 1]), np.arctan2(x[:, 1], x[:, 0])
    places = np.pi * np.stack([(radius - INNER) / (OUTER - INNER), angle / ANGLE])
    (s, t), (ds, dt) = np.sin(places), np.pi * np.cos(places)
    outward = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    around = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], axis=1)
    gradient = (ds * t / (OUTER - INNER))[:, None] * outward + (s * dt / (ANGLE * radius))[:, None] * around
    return (s * t)[:, None] * AMPLITUDE, AMPLITUDE[:, None] * gradient[:, None, :]


def solid(x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The plane one times a sine of the height: no direction in which nothing changes."""
    flat, slope = plane(x)
    place = np.pi * x[:, 2] / DEPTH
    gradient = slope * np.sin(place)[:, None, None]
    gradient[:, :, 2] += flat * (np.pi / DEPTH * np.cos(place))[:, None]
    return flat * np.sin(place)[:, None], gradient


def stress(gradient: FloatArray, material: Material) -> FloatArray:
    """First Piola stress (theory 8.3) of displacement gradients, shape (n, 3, 3)."""
    f = np.eye(3) + gradient
    if material.law == "linear-elastic":
        strain = (gradient + np.swapaxes(gradient, 1, 2)) / 2
        spherical = np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(3)
        return (material.bulk - 2 / 3 * material.shear) * spherical + 2 * material.shear * strain
    j = np.linalg.det(f)[:, None, None]
    inverse = np.swapaxes(np.linalg.inv(f), 1, 2)
    square = np.einsum("nij,nij->n", f, f)[:, None, None]
    swelling = np.log(j) if material.law == "neo-hookean" else j * (j - 1)
    return material.bulk * swelling * inverse + material.shear * j ** (-2 / 3) * (f - square / 3 * inverse)


def lines(direction: Direction, count: int) -> list[tuple[FloatArray, FloatArray, FloatArray]]:
    """Values and slopes of the functions of each element at its Gauss points, shape (points, order + 1), and Gauss weights."""
    t, gauss = np.polynomial.legendre.leggauss(count)
    p, tables = direction.order, []
    for low, high in pairwise(direction.boundaries):
        u, half = low + (high - low) * (t + 1) / 2, (high - low) / 2
        if direction.family == "N":
            first = int(np.searchsorted(direction.knots, low, side="right")) - 1 - p
            functions = [BSpline(direction.knots, np.eye(direction.count)[first + a], p) for a in range(p + 1)]
            values, slopes = [np.column_stack([f(u, nu) for f in functions]) for nu in (0, 1)]
        else:
            nodes = np.linspace(-1, 1, p + 1)
            coefficients = np.linalg.inv(np.vander(nodes, increasing=True))
            powers = np.vander(t, p + 1, increasing=True)
            derivatives = np.column_stack([np.zeros(count)] + [k * powers[:, k - 1] for k in range(1, p + 1)])
            values, slopes = powers @ coefficients, derivatives @ coefficients / half
        tables.append((values, slopes, gauss * half))
    return tables


def elements(patch: Patch, points: IntArray, gauss: tuple[int, ...]) -> Iterator[tuple[IntArray, FloatArray, FloatArray, FloatArray]]:
    """For some elements at a time their control points, functions (e, points, a), these by position (e, points, a, 3), and volumes."""
    tables = [
        [np.stack(of_each) for of_each in zip(*lines(direction, count), strict=True)]
        for direction, count in zip(patch.directions, gauss, strict=True)
    ]
    numbers = element_points(patch, points)
    shape = [direction.elements for direction in patch.directions]
    for some in np.array_split(np.arange(len(numbers)), -(-len(numbers) // AT_ONCE)):
        places = np.unravel_index(some, shape, order="F")
        (u, du, gu), (v, dv, gv), (w, dw, gw) = ([part[i] for part in table] for table, i in zip(tables, places, strict=True))
        nodes = numbers[some]
        weights = patch.weights[nodes][:, None]

        def product(a: FloatArray, b: FloatArray, c: FloatArray, weights: FloatArray = weights) -> FloatArray:
            return np.einsum("ekc,ejb,eia->ekjicba", c, b, a).reshape(len(weights), -1, weights.shape[2]) * weights

        top = product(u, v, w)
        slopes = np.stack([product(du, v, w), product(u, dv, w), product(u, v, dw)], axis=3)
        total = top.sum(axis=2)[..., None]
        functions = top / total
        parametric = (slopes - functions[..., None] * slopes.sum(axis=2)[:, :, None]) / total[..., None]
        jacobian = patch.control_points[nodes].swapaxes(1, 2)[:, None] @ parametric
        volume = np.einsum("ek,ej,ei->ekji", gw, gv, gu).reshape(len(some), -1) * np.linalg.det(jacobian)
        yield nodes, functions, parametric @ np.linalg.inv(jacobian), volume


def at_points(solution: Solution, places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Displacements and their gradients at places, shape (e, points, 3)."""
    u, gradient = solution.displacement(places.reshape(-1, 3))
    return u.reshape(places.shape), gradient.reshape(*places.shape, 3)


def load(solution: Solution, patch: Patch, points: IntArray, gauss: tuple[int, ...]) -> FloatArray:
    """The manufactured load, shape (control points, 3)."""
    total = np.zeros_like(patch.control_points)
    for nodes, functions, gradients, volume in elements(patch, points, gauss):
        _, gradient = at_points(solution, functions @ patch.control_points[nodes])
        exact = stress(gradient.reshape(-1, 3, 3), solution.material).reshape(gradient.shape)
        np.add.at(total, nodes, (gradients @ (volume[..., None, None] * exact).swapaxes(2, 3)).sum(axis=1))
    return total


def norms(solution: Solution | None, patch: Patch, points: IntArray, field: FloatArray, gauss: tuple[int, ...]) -> FloatArray:
    """L2 norms of a displacement field and of its gradient; of their errors where there is a solution."""
    squares = np.zeros(2)
    for nodes, functions, gradients, volume in elements(patch, points, gauss):
        value, slope = functions @ field[nodes], field[nodes].swapaxes(1, 2)[:, None] @ gradients
        if solution:
            u, gradient = at_points(solution, functions @ patch.control_points[nodes])
            value, slope = value - u, slope - gradient
        squares += [np.sum(volume * (value**2).sum(axis=2)), np.sum(volume * (slope**2).sum(axis=(2, 3)))]
    return np.sqrt(squares)


def discretised(kind: str, count: int, deep: bool) -> Patch:
    """The sector with `count` elements along radius and angle, along the axis as many or one.

    N1 can not hold an arc: its control points are on it like those of L1, with weights that vary smoothly.
    """
    family, order = ("L", 1) if kind == "N1" else (kind[0], int(kind[1:]))
    coarse = cylinder_sector(INNER, OUTER, ANGLE, DEPTH if deep else HEIGHT)
    along = (order, count) if deep else (1, 1)
    patch = mesh(coarse, (family,) * 3, (order, order, along[0]), (count, count, along[1]))  # type: ignore[arg-type]
    if kind != "N1":
        return patch
    u, v, w = (Direction("N", 1, np.concatenate([d.knots[:1], d.knots, d.knots[-1:]])) for d in patch.directions)
    return Patch((u, v, w), patch.control_points, np.exp(0.5 * np.sin(2 * patch.control_points[:, :2].sum(axis=1))))


def unknowns(patch: Patch, deep: bool) -> sparse.csc_array:
    """All displacements from the free ones: none on the curved and the cut faces, at the ends of the axis none or the same."""
    if deep:
        every = np.arange(len(patch.weights))
        inner = np.setdiff1d(every, np.concatenate([patch.face_points(face) for face in FACES]))
        return sparse.eye_array(3 * len(every), format="csc")[:, (3 * inner[:, None] + np.arange(3)).ravel()]
    layer = patch.shape[0] * patch.shape[1]
    held = np.unique(np.concatenate([patch.face_points(face) for face in ("u0", "u1", "v0", "v1")]))
    free = (3 * np.setdiff1d(np.arange(layer), held)[:, None] + np.arange(3)).ravel()
    return sparse.vstack([sparse.eye_array(3 * layer, format="csc")[:, free]] * 2, format="csc")


def solved(patch: Patch, solid: Solid, wanted: FloatArray, spread: sparse.csc_array) -> tuple[FloatArray, SuperLU]:
    """Displacements in balance with a load, and the factors of the tangent there."""
    field = np.zeros_like(patch.control_points)
    for _ in range(20):
        forces, tangent = solid.forces_and_tangent(patch.control_points + field)
        matrix = sparse.bsr_array((tangent, solid.pattern.column, solid.pattern.start)).tocsc()
        factors = splu((spread.T @ matrix @ spread).tocsc())
        step = spread @ factors.solve(spread.T @ (wanted - forces).ravel())
        field = field + step.reshape(-1, 3)
        if np.abs(step).max() < 1e-12:
            return field, factors
    raise RuntimeError("Newton's method does not converge")


def errors(solution: Solution, kind: str, count: int) -> tuple[FloatArray, FloatArray]:
    """Errors of displacement and gradient with `count` elements a side, and what the quadrature makes of them."""
    patch, deep = discretised(kind, count, solution.deep), solution.deep
    gauss, more = (_points(int(kind[1:]) + POINTS + extra, deep) for extra in (0, MORE))
    coarse, fine = (Problem("manufactured", (Body("body", patch, solution.material, g),), (), (), ()) for g in (gauss, more))
    numbering = Numbering(coarse)
    points, spread = numbering.points["body"], unknowns(patch, deep)
    field, factors = solved(patch, Solid(coarse, numbering), load(solution, patch, points, gauss), spread)
    missing = load(solution, patch, points, more) - Solid(fine, numbering).forces(patch.control_points + field)
    change = (spread @ factors.solve(spread.T @ missing.ravel())).reshape(-1, 3)
    return norms(solution, patch, points, field, more), norms(None, patch, points, change, gauss)


def _points(count: int, deep: bool) -> tuple[int, int, int]:
    return count, count, count if deep else 2


def convergence(solution: Solution, kind: str, counts: Sequence[int]) -> dict[str, Convergence]:
    """L2 norms of the errors of displacement and displacement gradient."""
    found, quadrature = (np.array(both) for both in zip(*[errors(solution, kind, count) for count in counts], strict=True))
    sizes = 1.0 / np.array(counts)
    return {name: Convergence(sizes, found[:, i], {"quadrature": quadrature[:, i]}) for i, name in enumerate(("L2", "H1"))}


def best_orders(kind: str) -> dict[str, Order]:
    """Orders of best approximation."""
    return {
        "L2": Order(int(kind[1:]) + 1, reason="theory: best approximation by order p, smooth solution, convex section"),
        "H1": Order(int(kind[1:]), reason="theory: best approximation by order p, smooth solution"),
    }


#: Elements a side, by discretisation: the errors of smooth functions bend for longer, so that they need finer meshes.
MESHES = {
    "N1": (6, 9, 13, 18), "N2": (12, 16, 22, 30), "N3": (12, 16, 20, 26), "N4": (14, 18, 23, 29),
    "N5": (23, 28, 34, 41), "L1": (6, 9, 13, 18), "L2": (4, 6, 9, 13), "L3": (4, 6, 8, 11), "L4": (4, 5, 7, 9),
}  # fmt: skip
DEEP_MESHES = {"N1": (4, 5, 7, 10), "L1": (4, 5, 7, 10), "L2": (3, 4, 5, 7)}


@case(
    claim="The error of a manufactured solution in finite deformation falls with order p + 1, that of its gradient with order p.",
    tier=lambda kind: "gate" if kind in ("N1", "N2", "L1", "L2", "L3") else "nightly",
    grid={"kind": list(MESHES)},
    bounds=best_orders,
)
def orders(kind: str) -> dict[str, Convergence]:
    """Errors of a solution that is the same at every height."""
    return convergence(Solution(plane), kind, MESHES[kind])


@case(
    claim="So it does where the solution varies in all three directions.",
    tier=lambda kind: "gate" if kind == "L1" else "nightly",
    grid={"kind": list(DEEP_MESHES)},
    bounds=best_orders,
)
def orders_in_space(kind: str) -> dict[str, Convergence]:
    """Errors of a solution that varies along the axis too."""
    return convergence(Solution(solid, deep=True), kind, DEEP_MESHES[kind])


@case(
    claim="So it does with every material law.",
    tier=lambda kind, **_: "gate" if kind == "N1" else "nightly",
    grid={"kind": ["N1", "N2", "L2"], "law": [law for law in get_args(MaterialLaw) if law != Material().law]},
    bounds=lambda kind, law: best_orders(kind),  # noqa: ARG005
)
def orders_of_law(kind: str, law: MaterialLaw) -> dict[str, Convergence]:
    """Errors of the solution that is the same at every height."""
    return convergence(Solution(plane, Material(law=law)), kind, MESHES[kind])
