"""Which constraint stands where: Greville's places, the functions that weight averages, and control points at a seam."""

from __future__ import annotations

from dataclasses import replace
from typing import cast

import numpy as np
from enforcement.tables import ELEMENTS, POINTWISE, SIZE, at_points, plate, side_of
from patch_tests.contact import functions, knots

from isomortar.geometry.patch import FloatArray
from isomortar.geometry.primitives import box, ring
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.model.enforcement import SlaveSide, slave_side
from isomortar.model.enforcement.integration import integrated
from isomortar.model.enforcement.side import PointSide
from isomortar.model.entities import Body, Contact, Enforcement, Face, Material, Problem, Stage
from isomortar.model.numbering import Numbering

_ROUND_OFF = Bound(at_most=1e-13, reason="round-off: of sums over some tens of numbers")
#: Of a unit cube of order 2, along x, y and z.
ELEMENTS_OF_CUBE = (4, 3, 2)
KINDS = ("N1", "N2", "N3", "N5")


@case(
    claim="Greville's constraints stand at means of inner knots, in the order of the control points.",
    tier="gate",
    grid={"kind": KINDS},
    bounds={"place": _ROUND_OFF},
)
def greville_places(kind: str) -> dict[str, float]:
    """Largest distance of a constraint from its place, by the face's coordinates."""
    order = int(kind[1:])
    side = side_of(plate("N", order), "w0", "greville", order + 1)
    assert isinstance(side, PointSide)
    lines = [knots(order, n) for n in ELEMENTS]
    first, second = ([line[i + 1 : i + order + 1].mean() for i in range(n + order)] for n, line in zip(ELEMENTS, lines, strict=True))
    expected = np.stack(np.meshgrid(first, second), axis=-1).reshape(-1, 2)
    return {"place": float(np.abs(side.places - expected).max())}


@case(
    claim="A constraint of the mortar method is weighted with its own control point's function.",
    tier="gate",
    grid={"kind": KINDS},
    bounds={"weights": _ROUND_OFF},
)
def mortar_weights(kind: str) -> dict[str, float]:
    """Largest error of the test functions at the quadrature points, against SciPy's splines."""
    order = int(kind[1:])
    side = side_of(plate("N", order), "w0", "mortar", order + 1)
    points = 0.5 * (1.0 + np.polynomial.legendre.leggauss(order + 1)[0])
    places = [((np.arange(n)[:, None] + points) / n).ravel() for n in ELEMENTS]
    first, second = (functions(order, n, at).reshape(n, order + 1, -1) for n, at in zip(ELEMENTS, places, strict=True))
    expected = np.einsum("fri,eqj->ferqij", second, first).reshape(-1, first.shape[2] * second.shape[2])
    return {"weights": float(np.abs(at_points(side.arrays.test) - expected).max())}


@case(
    claim="Where a face meets itself each control point has the constraint at its own place as the nearest one.",
    tier="gate",
    bounds={"apart": _ROUND_OFF},
)
def nearest_at_a_seam() -> dict[str, float]:
    """Largest distance, by the face's coordinates, of a control point's place from its constraint at Greville's abscissae."""
    patch = mesh(ring((0.0, 0.0, 0.0), 0.5, 1.0, 0.4), ("N", "N", "N"), (2, 1, 2), (8, 1, 2))
    side = side_of(Body("ring", patch, Material(), (2, 2, 2), closed="u"), "v1", "greville", 8)
    assert isinstance(side, PointSide)
    return {"apart": float(np.abs(side.places[side.nearest] - side.control_places).max())}


@case(
    claim="Areas of constraints at points have the face's own first moments: a pressure that varies linearly has the right resultant, and "
    "turns about the right axis.",
    tier="gate",
    grid={"method": POINTWISE, "kind": KINDS},
    bounds={"area": _ROUND_OFF, "moment": _ROUND_OFF},
)
def first_moments(method: Enforcement, kind: str) -> dict[str, float]:
    """Relative errors of the sums of areas, and of areas times coordinates u and v, on a plate half as wide again at u = 1 as at u = 0."""
    order = int(kind[1:])
    body = plate("N", order)
    points = body.patch.control_points.copy()
    points[:, 1] *= 1.0 + 0.5 * points[:, 0] / SIZE[0]
    side = side_of(replace(body, patch=replace(body.patch, control_points=points)), "w0", method, order + 1)
    assert isinstance(side, PointSide)
    area, found = side.area, side.area @ side.places
    expected = SIZE[0] * SIZE[1] * np.array([1.0 / 2.0 + 0.5 / 3.0, 1.25 / 2.0])  # the width is 1 + u / 2
    whole = 1.25 * SIZE[0] * SIZE[1]
    return {"area": abs(float(area.sum()) / whole - 1.0), "moment": float(np.abs(found / expected - 1.0).max())}


def _points(side: SlaveSide, reference: FloatArray) -> FloatArray:
    """Where the quadrature points of a slave are, shape (points, 3)."""
    shape = side.arrays.shape
    nodes = np.repeat(shape.nodes, len(shape.values) // len(shape.nodes), axis=0)
    return np.einsum("qa,qai->qi", shape.values, reference[side.arrays.point[nodes]])


@case(
    claim="Contacts have as many quadrature points along each direction of the slave as they are given.",
    tier="gate",
    grid={"face": ("u1", "v0", "w0"), "way": ("mortar", "dual", "kts", "cells")},
    bounds={"wrong": Bound(0.0, 0.0, "definition: the first number is of the first direction after that across the face, in turns")},
)
def points_along(face: str, way: str) -> dict[str, float]:
    """Directions along which there are other points than those of Gauss's rule in each element, of given numbers."""
    counts = (3, 5)
    patch = mesh(box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), ("N", "N", "N"), (2, 2, 2), ELEMENTS_OF_CUBE)
    axis = "uvw".index(face[0])
    shift = np.eye(3)[axis] * (1.0 if face[1] == "1" else -1.0)
    master = replace(patch, control_points=patch.control_points + shift)
    bodies = tuple(Body(name, one, Material(), (3, 3, 3)) for name, one in (("slave", patch), ("master", master)))
    enforcement = cast("Enforcement", "mortar" if way == "cells" else way)
    other = Face("master", face[0] + "10"[int(face[1])])
    contact = Contact("c", Face("slave", face), other, 0.0, counts, enforcement=enforcement, subcells=int(way == "cells"))
    problem = Problem("points", bodies, (contact,), (), (Stage("none", 1),))
    numbering = Numbering(problem)
    found = _points(slave_side(contact, problem, numbering), numbering.reference)
    wrong = 0
    for count, along in zip(counts, ((axis + 1) % 3, (axis + 2) % 3), strict=True):
        each = ELEMENTS_OF_CUBE[along]
        expected = (np.arange(each)[:, None] + 0.5 * (1.0 + np.polynomial.legendre.leggauss(count)[0])).ravel() / each
        places = np.unique(np.round(found[:, along], 12))
        wrong += len(places) != len(expected) or float(np.abs(places - expected).max()) > 1e-11
    return {"wrong": float(wrong)}


@case(
    claim="Cells get points enough along each direction for products of its own functions with those of either side, and one more at most.",
    tier="gate",
    grid={"face": ("u1", "v0", "w0"), "master": (1, 3)},
    bounds={"wrong": Bound(0.0, 0.0, "theory: Gauss's rule of n points is exact up to order 2 n - 1")},
)
def points_of_cells(face: str, master: int) -> dict[str, float]:
    """Directions along which there are fewer, or many more."""
    orders, axis = (1, 5, 2), "uvw".index(face[0])
    cube = box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    slave, other = (mesh(cube, ("N", "N", "N"), of, elements) for of, elements in ((orders, (2, 2, 2)), ((master,) * 3, (3, 3, 3))))
    shift = np.eye(3)[axis] * (1.0 if face[1] == "1" else -1.0)
    patches = {"slave": slave, "master": replace(other, control_points=other.control_points + shift)}
    bodies = tuple(Body(name, patch, Material(), (7, 7, 7)) for name, patch in patches.items())
    contact = Contact("c", Face("slave", face), Face("master", face[0] + "10"[int(face[1])]), 0.0, (1, 1))
    found = integrated(contact, Problem("points", bodies, (contact,), (), (Stage("none", 1),))).quadrature
    products = [orders[along] + max(orders[along], master) for along in ((axis + 1) % 3, (axis + 2) % 3)]
    return {"wrong": float(sum(not order <= 2 * points - 1 <= order + 3 for points, order in zip(found, products, strict=True)))}
