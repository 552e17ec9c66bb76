"""Which constraint stands where: Greville's places, the functions that weight averages, and control points at a seam."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from enforcement.tables import ELEMENTS, POINTWISE, SIZE, at_points, plate, side_of
from patch_tests.contact import functions, knots

from isomortar.geometry.primitives import ring
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.model.enforcement.side import PointSide
from isomortar.model.entities import Body, Enforcement, Material

_ROUND_OFF = Bound(at_most=1e-13, reason="round-off: of sums over some tens of numbers")
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
