"""Where methods of enforcement constrain, and with which weights: against SciPy's splines, and Chebyshev's theory."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from patch_tests.contact import functions
from patch_tests.subcells import FEW, TURNS, turned
from scipy.interpolate import BSpline, make_interp_spline

from isomortar._bindings import FunctionArrays
from isomortar.geometry.patch import Direction, Family, FloatArray
from isomortar.geometry.primitives import box, ring
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.model.enforcement import SlaveSide, slave_side
from isomortar.model.enforcement.demko import abscissae
from isomortar.model.enforcement.side import PointSide
from isomortar.model.entities import Body, Contact, Enforcement, Face, Material, Problem, RigidPlane, Stage
from isomortar.model.numbering import Numbering

#: Methods at points.
POINTWISE: tuple[Enforcement, ...] = ("kts", "knots", "greville", "demko")
PLANE = RigidPlane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
SIZE = (2.0, 0.7)
ELEMENTS = (4, 3)


def side_of(body: Body, face: str, method: Enforcement, quadrature: int) -> SlaveSide:
    """The slave side of a body's face."""
    contact = Contact("c", Face(body.name, face), PLANE, 0.0, (quadrature, quadrature), enforcement=method)
    problem = Problem("tables", (body,), (contact,), (), (Stage("none", 1),))
    return slave_side(contact, problem, Numbering(problem))


def plate(family: Family, order: int) -> Body:
    """A box; its lower face has functions of a family and order in both directions."""
    patch = mesh(box((0.0, 0.0, 0.0), (*SIZE, 1.0)), (family, family, "N"), (order, order, 1), (*ELEMENTS, 1))
    return Body("plate", patch, Material(), (2, 2, 2))


def at_points(functions: FunctionArrays) -> FloatArray:
    """Values of all functions at the quadrature points, shape (points, functions)."""
    found = np.zeros((len(functions.values), functions.count))
    element = np.repeat(functions.nodes, len(functions.values) // len(functions.nodes), axis=0)
    np.put_along_axis(found, element.astype(np.int64), functions.values, axis=1)
    return found


def duals(order: int, elements: int, places: FloatArray) -> FloatArray:
    """Functions along a unit interval whose integrals with SciPy's are, in each element, these's own or zero, shape (places, functions).

    By Legendre's polynomials, which are orthogonal: with coefficients C of the functions the others have its inverse, transposed.
    """
    found = np.zeros((len(places), elements + order))
    element = np.minimum((places * elements).astype(int), elements - 1)
    points, weights = np.polynomial.legendre.leggauss(order + 1)
    scale = np.sqrt(2.0 * np.arange(order + 1) + 1.0)
    for e in range(elements):
        own = element == e
        values = functions(order, elements, (e + 0.5 * (1.0 + points)) / elements)[:, e : e + order + 1]
        coefficients = scale[:, None] * (np.polynomial.legendre.legvander(points, order).T @ (0.5 * weights[:, None] * values))
        polynomials = scale * np.polynomial.legendre.legvander(2.0 * (places[own] * elements - e) - 1.0, order)
        found[np.ix_(own, np.arange(e, e + order + 1))] = polynomials @ np.linalg.inv(coefficients).T * (0.5 * weights @ values)
    return found


def integrals(family: Family, order: int, elements: int) -> FloatArray:
    """Of the functions along a unit interval: by SciPy's antiderivatives, or by Gauss points of Lagrange polynomials."""
    if family == "N":
        knots = np.concatenate([np.zeros(order), np.linspace(0.0, 1.0, elements + 1), np.ones(order)])
        return np.array([BSpline(knots, row, order).integrate(0.0, 1.0) for row in np.eye(len(knots) - order - 1)], dtype=float)
    nodes = np.linspace(0.0, 1.0 / elements, order + 1)
    found = np.zeros(order * elements + 1)
    for a in range(order + 1):
        values = np.polynomial.Polynomial.fromroots(np.delete(nodes, a))
        share = (values.integ()(nodes[-1]) - values.integ()(0.0)) / values(nodes[a])
        found[a : a + order * elements : order] += share
    return found


_ROUND_OFF = Bound(at_most=1e-13, reason="round-off: of sums over some tens of points")


def weight_bounds(method: Enforcement, kind: str) -> dict[str, Bound]:  # noqa: ARG001
    """Knots are too few for the forces of every function."""
    return {"area": _ROUND_OFF} | ({} if method == "knots" else {"forces": _ROUND_OFF})


_WEIGHTS = "The areas of constraints at points add up to that of the face, and a uniform pressure's forces are exact, but for unique knots"


@case(
    claim=f"{_WEIGHTS}.",
    tier="gate",
    grid={"method": POINTWISE, "kind": ("N1", "N2", "N3", "N5")},
    bounds=weight_bounds,
)
def weights(method: Enforcement, kind: str) -> dict[str, float]:
    """Errors of the face's area, and of the largest force of a uniform pressure on a control point."""
    return missed(method, kind)


def missed(method: Enforcement, kind: str) -> dict[str, float]:
    """What areas miss of the whole one, and forces of the exact ones."""
    family: Family = "L" if kind[0] == "L" else "N"
    order = int(kind[1:])
    side = side_of(plate(family, order), "w0", method, order + 1)
    first, second = (integrals(family, order, n) * size for n, size in zip(ELEMENTS, SIZE, strict=True))
    exact = np.outer(second, first).ravel()
    assert isinstance(side, PointSide)
    forces = side.carriers.T @ side.area
    found = {"area": float(abs(side.area.sum() - SIZE[0] * SIZE[1]))}
    return found if method == "knots" else found | {"forces": float(np.abs(forces - exact).max() / exact.max())}


@case(
    claim=f"{_WEIGHTS}; of Lagrange elements too, which have no abscissae of Demko's.",
    tier="gate",
    grid={"method": ("kts", "knots", "greville"), "kind": ("L1", "L2", "L4")},
    bounds=weight_bounds,
)
def weights_of_nodes(method: Enforcement, kind: str) -> dict[str, float]:
    """Errors as those of `weights`."""
    return missed(method, kind)


@case(
    claim="On a ring, whose face meets itself, no constraint at a point is twice at the seam, those there and on other C0 lines are "
    "seen from both sides, and areas are those of the face.",
    tier="gate",
    grid={"method": POINTWISE},
    bounds={
        "twice": Bound(at_least=1e-3, reason="definition: places that are apart"),
        "sides": Bound(0.0, 0.0, "definition: constraints on lines that are seen from one side, or others that are from both"),
        "area": Bound(at_most=1e-9, reason="quadrature: of the length of arcs that are rational, with eight points"),
    },
)
def closed(method: Enforcement) -> dict[str, float]:
    """Least distance of two constraints, how many have other numbers of sides, and the error of the area."""
    patch = mesh(ring((0.0, 0.0, 0.0), 0.5, 1.0, 0.4), ("N", "N", "N"), (2, 1, 2), (8, 1, 2))
    side = side_of(Body("ring", patch, Material(), (2, 2, 2), closed="u"), "v1", method, 8)
    points = side.carriers @ patch.control_points[patch.face_points("v1")][_kept(patch.face_points("v1"), side)]
    apart = np.linalg.norm(points[:, None] - points, axis=2) + 10.0 * np.eye(len(points))
    round_it = patch.directions[0]  # the second coordinate of the face
    lines = np.append(round_it.c0_lines, round_it.boundaries[0])
    on_line = np.abs(side.places[:, 1, None] - lines).min(axis=1) < 1e-6
    sides = np.bincount(side.arrays.test.nodes.ravel())
    other = np.count_nonzero(sides != np.where(on_line, 2, 1))
    return {"twice": float(apart.min()), "sides": float(other), "area": abs(float(side.arrays.area.sum()) / (0.8 * np.pi) - 1.0)}


def _kept(face: np.ndarray, side: SlaveSide) -> np.ndarray:
    """Entries of a face that count: the last one along a closed direction does not."""
    rows = len(face) - side.carriers.shape[1]
    width = len(face) // rows
    return np.arange(len(face))[np.arange(len(face)) % width < width - 1]


@case(
    claim="Control values that are drawn keep constants, and the resultant of a pressure.",
    tier="gate",
    grid={"method": POINTWISE, "kind": ("N1", "N2", "N3")},
    bounds={"constant": _ROUND_OFF, "resultant": _ROUND_OFF},
)
def drawn(method: Enforcement, kind: str) -> dict[str, float]:
    """Errors of a constant, and of the resultant of random pressures by forces of the drawn field at the constraints."""
    side = side_of(plate("N", int(kind[1:])), "w0", method, int(kind[1:]) + 1)
    assert isinstance(side, PointSide)
    area, values = side.area, np.random.default_rng(1).random(side.carriers.shape[0])
    shown = side.carriers @ side.on_control_points(values)
    return {
        "constant": float(np.abs(side.on_control_points(np.ones(len(area))) - 1.0).max()),
        "resultant": abs(float(area @ shown / (area @ values)) - 1.0),
    }


_CONDITION = Bound(at_most=1e-10, reason="round-off: times the condition of an element's functions, up to 1e6 at order 5")


def dual_bounds(kind: str) -> dict[str, Bound]:
    """Of splines on even knots all values are known; in cells functions go on from one to the next."""
    more = {"N": ("known",), "c": ("spanned",)}.get(kind[0], ())
    return dict.fromkeys(("own", "unity", *more), _CONDITION)


@case(
    claim="Dual functions see of every function of the face its own area alone, and add up to one.",
    tier="gate",
    grid={"kind": ("N1", "N2", "N3", "N5", "L1", "L2", "L4", "ring", "cells")},
    bounds=dual_bounds,
)
def dual(kind: str) -> dict[str, float]:
    """Errors of integrals over the largest one, and, over the largest value, of the sum, and of values by SciPy's splines.

    `spanned`: how far they are, over several cells of an element, from any function of the element.
    """
    side = dual_side(kind)
    shape, test, area = at_points(side.arrays.shape), at_points(side.arrays.test), side.arrays.area
    own = area @ shape
    largest = np.abs(test).max()
    found = {
        "own": float(np.abs(test.T @ (area[:, None] * shape) - np.diag(own)).max() / own.max()),
        "unity": float(np.abs(test.sum(axis=1) - 1.0).max() / largest),
    }
    if kind[0] == "N":
        found["known"] = float(np.abs(test - dual_values(int(kind[1:]))).max() / largest)
    if kind == "cells":
        found["spanned"] = beside_span(side.arrays.shape, side.arrays.test)
    return found


def dual_side(kind: str) -> SlaveSide:
    """Of a plate, of a ring's inner face, which has weights and a seam, or of elements cut into cells."""
    if kind == "ring":
        patch = mesh(ring((0.0, 0.0, 0.0), 0.5, 1.0, 0.4), ("N", "N", "N"), (2, 1, 2), (8, 1, 2))
        return side_of(Body("ring", patch, Material(), (2, 2, 2), closed="u"), "v1", "dual", 8)
    if kind == "cells":
        given = turned(FEW, TURNS[0])
        return slave_side(replace(given.contacts[0], enforcement="dual"), given, Numbering(given))
    order = int(kind[1:])
    return side_of(plate("L" if kind[0] == "L" else "N", order), "w0", "dual", order + 1)


def dual_values(order: int) -> FloatArray:
    """Of a plate's dual functions at its quadrature points, shape (points, functions)."""
    points = 0.5 * (1.0 + np.polynomial.legendre.leggauss(order + 1)[0])
    first, second = (duals(order, n, ((np.arange(n)[:, None] + points) / n).ravel()).reshape(n, order + 1, -1) for n in ELEMENTS)
    return np.einsum("fri,eqj->ferqij", second, first).reshape(-1, first.shape[2] * second.shape[2])


def beside_span(shape: FunctionArrays, test: FunctionArrays) -> float:
    """Distance of the second functions from what the first span on an element, over their largest value."""
    far, size = [], len(shape.values) // len(shape.nodes)
    for nodes in np.unique(shape.nodes, axis=0):
        own = np.repeat(np.all(shape.nodes == nodes, axis=1), size)
        values = shape.values[own]
        far.append(test.values[own] - values @ np.linalg.lstsq(values, test.values[own], rcond=None)[0])
    return float(np.abs(np.concatenate(far)).max() / np.abs(test.values).max())


_LEVEL = Bound(
    at_most=1e-10, reason="theory: the Chebyshev spline is 1 at its extrema, and no larger anywhere; its exchange is stopped at 1e-12"
)


@case(
    claim="Demko's abscissae are the extrema of a spline that alternates between 1 and -1; of one element they are those of Chebyshev's.",
    tier="gate",
    grid={"order": (1, 2, 3, 4, 6, 10), "knots": ("one element", "even", "graded", "repeated")},
    bounds=lambda order, knots: dict.fromkeys(("above", "spread", *["chebyshev"] * (knots == "one element")), _LEVEL),  # noqa: ARG005
)
def demko(order: int, knots: str) -> dict[str, float]:
    """How far the spline is above 1 on 2000 places, how far from it at the abscissae, and distance from Chebyshev's points."""
    inner = {"one element": [], "even": [0.25, 0.5, 0.75], "graded": [0.02, 0.1, 0.4], "repeated": [0.3, *[0.5] * order, 0.8]}[knots]
    direction = Direction("N", order, np.array([*[0.0] * (order + 1), *inner, *[1.0] * (order + 1)]))
    places = abscissae(direction)
    spline = make_interp_spline(places, (-1.0) ** np.arange(len(places)), k=order, t=direction.knots)
    chebyshev = 0.5 - 0.5 * np.cos(np.pi * np.arange(order + 1) / order)
    found = {
        "above": float(np.maximum(0.0, np.abs(spline(np.linspace(0.0, 1.0, 2001))).max() - 1.0)),
        "spread": float(np.abs(np.abs(spline(places)) - 1.0).max()),
    }
    return found | ({"chebyshev": float(np.abs(places - chebyshev).max())} if knots == "one element" else {})
