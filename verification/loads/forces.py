"""Forces of loads at control points, against what they are known to sum to, and the work and the tangent of a pressure."""

from __future__ import annotations

from itertools import permutations, product

import numpy as np
from geometry.bodies import BODIES, refined
from shapes import cylinder_sector, cylinder_volume

from isomortar.geometry.patch import FACES, Family, FloatArray, Patch
from isomortar.geometry.primitives import bowl, box, ring
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, Shown, case
from isomortar.model.entities import Body, Load, Material, Problem, Stage
from isomortar.model.loads import Loads, control_areas, control_volumes
from isomortar.model.numbering import Numbering
from isomortar.solve.system import block_product

#: Families and orders of the meshes.
KINDS = ("N1", "N2", "N3", "N4", "N5", "L1", "L2", "L3", "L4")
_LOWER, _UPPER = (-0.2, 0.1, 0.3), (0.9, 0.8, 1.1)
_SIZE, _WEIGHT = 0.7, (0.3, -0.2, -1.1)
_ROUND_OFF = "round-off: sums over the control points and quadrature points of a face"


def loaded(patch: Patch, kind: str, faces: tuple[str, ...], closed: str | None = None, pressure: float = _SIZE) -> tuple[Loads, Numbering]:
    """A body of some kind under one pressure on some of its faces, and its weight."""
    order = int(kind[1:])
    orders = tuple(max(order, direction.order) if kind[0] == "N" else order for direction in patch.directions)
    family: Family = "N" if kind[0] == "N" else "L"
    fine = mesh(patch, (family,) * 3, orders, (8, 2, 2) if closed else (2, 3, 2))
    body = Body("body", fine, Material(), (order + 2,) * 3, closed)  # type: ignore[arg-type]
    loads = [Load(face, "pressure", "body", face, (pressure,), (1.0,)) for face in faces]
    loads.append(Load("weight", "weight", "body", None, _WEIGHT, (1.0,)))
    problem = Problem("loaded", (body,), (), (), (Stage("stage", 1),), loads=tuple(loads))
    numbering = Numbering(problem)
    return Loads(problem, numbering), numbering


def pressing(loads: Loads, positions: FloatArray) -> FloatArray:
    """Forces of all pressures."""
    return sum(loads.forces(positions, 1.0)[:-1], np.zeros_like(positions))


def moved(numbering: Numbering) -> FloatArray:
    """Positions off the reference ones by a tenth, at random."""
    return numbering.reference + 0.1 * np.random.default_rng(1).standard_normal(numbering.reference.shape)


@case(
    claim="The tangent of a pressure is the derivative of its forces.",
    tier="gate",
    grid={"kind": KINDS},
    bounds={"error": Bound(at_most=1e-12, reason="round-off: forces are products of two positions, so that differences are exact")},
)
def tangent(kind: str) -> dict[str, float]:
    """Largest error of a product of the tangent with a field over its size, on each face of a box and of a ring, moved at random."""
    errors = []
    for patch, faces, closed in (
        (box(_LOWER, _UPPER), FACES, None),
        (ring((0.0, 0.0, 0.0), 0.5, 1.0, 0.4), ("v0", "v1", "w0", "w1"), "u"),
    ):
        for face in faces:
            loads, numbering = loaded(patch, kind, (face,), closed)
            positions, along = moved(numbering), np.random.default_rng(2).standard_normal(numbering.reference.shape)
            ((pattern, values),) = loads.tangents(positions, 1.0)
            exact = 0.5 * (pressing(loads, positions + along) - pressing(loads, positions - along))
            errors.append(np.linalg.norm(block_product(pattern, values, along) - exact) / np.linalg.norm(exact))
    return {"error": float(max(errors))}


@case(
    claim="A pressure all round a body, or on a face whose edge stays, does no work over a closed way.",
    tier="gate",
    grid={"kind": KINDS, "faces": ("all", "one")},
    bounds={
        "work": Bound(at_most=1e-13, reason="theory: the work is that of a change of volume, and integrals of polynomials are exact"),
        "least": Bound(at_least=1e-3, reason="definition: the way is told only by a pressure that works on its parts"),
    },
)
def closed_way(kind: str, faces: str) -> dict[str, float]:
    """Work of the pressure round an ellipse in the space of all positions over the sum of its sizes; that sum over pressure times volume.

    Forces are products of two positions, so that the work by angle is a trigonometric polynomial of order three: sixteen angles are exact.
    """
    patch = box(_LOWER, _UPPER)
    loads, numbering = loaded(patch, kind, FACES if faces == "all" else ("w1",))
    random, reference = np.random.default_rng(3), numbering.reference
    one, other = 0.1 * random.standard_normal((2, *reference.shape))
    if faces == "one":
        edge = np.any(np.abs(reference[:, None, :2] - np.array([_LOWER[:2], _UPPER[:2]])) < 1e-12, axis=(1, 2))
        one[edge] = other[edge] = 0.0
    works = []
    for angle in 2.0 * np.pi * np.arange(16) / 16:
        positions = reference + np.cos(angle) * one + np.sin(angle) * other
        works.append(float(np.sum(pressing(loads, positions) * (np.cos(angle) * other - np.sin(angle) * one))) * 2.0 * np.pi / 16)
    size, volume = float(np.abs(works).sum()), float(np.prod(np.subtract(_UPPER, _LOWER)))
    return {"work": abs(sum(works)) / size, "least": size / (_SIZE * volume)}


@case(
    claim="A pressure, or suction, makes the force that it has to: size times area along the inward normal, none all round a body.",
    tier="gate",
    grid={"kind": KINDS},
    bounds={
        "face": Bound(at_most=1e-13, reason=_ROUND_OFF),
        "underside": Bound(at_most=1e-13, reason="theory: of a polynomial face the projected area, exactly; " + _ROUND_OFF),
        "all round": Bound(at_most=1e-13, reason="theory: a closed surface has no area vector; " + _ROUND_OFF),
        "moment": Bound(at_most=1e-13, reason="theory: nor does a pressure turn it; " + _ROUND_OFF),
        "ring": Shown("sides of a ring: of rational functions the quadrature is not exact"),
    },
)
def resultants(kind: str) -> dict[str, float]:
    """Relative errors of forces on faces of a box at rest, on a bowl's underside, and all round a box moved at random, with the moment."""
    patch = box(_LOWER, _UPPER)
    sides = np.subtract(_UPPER, _LOWER)
    errors = []
    for (number, face), pressure in product(enumerate(FACES), (_SIZE, -_SIZE)):
        loads, numbering = loaded(patch, kind, (face,), pressure=pressure)
        axis, way = number // 2, 1.0 if face[1] == "0" else -1.0
        exact = way * pressure * np.prod(np.delete(sides, axis)) * np.eye(3)[axis]
        errors.append(float(np.linalg.norm(pressing(loads, numbering.reference).sum(axis=0) - exact) / np.linalg.norm(exact)))
    loads, numbering = loaded(bowl((0.1, 0.2), 0.5, 0.0, 0.2, 1.0), kind, ("w0",))
    under = pressing(loads, numbering.reference).sum(axis=0)
    loads, numbering = loaded(patch, kind, FACES)
    forces, positions = pressing(loads, moved(numbering)), moved(numbering)
    size = float(np.abs(forces).sum())
    loads, numbering = loaded(ring((0.0, 0.0, 0.0), 0.5, 1.0, 0.4), kind, ("w0",), "u")
    side = np.linalg.norm(pressing(loads, numbering.reference).sum(axis=0)) / (_SIZE * np.pi * 0.75)
    return {
        "face": max(errors),
        "underside": float(np.linalg.norm(under - [0.0, 0.0, _SIZE]) / _SIZE),
        "all round": float(np.linalg.norm(forces.sum(axis=0)) / size),
        "moment": float(np.linalg.norm(np.cross(positions, forces).sum(axis=0)) / size),
        "ring": float(abs(side - 1.0)),
    }


@case(
    claim="Weight is what a body's volume says.",
    tier="gate",
    grid={"kind": KINDS},
    bounds={
        "box": Bound(at_most=1e-13, reason=_ROUND_OFF),
        "bowl": Bound(at_most=1e-13, reason="theory: a polynomial body's volume is exact; " + _ROUND_OFF),
        "arm": Bound(at_most=1e-13, reason="theory: the weight acts at the centre; " + _ROUND_OFF),
    },
)
def weight(kind: str) -> dict[str, float]:
    """Relative errors of the weights of a box and a bowl, and of where that of the box acts over its size."""
    loads, numbering = loaded(box(_LOWER, _UPPER), kind, ())
    (forces,) = loads.forces(numbering.reference, 1.0)
    volume = float(np.prod(np.subtract(_UPPER, _LOWER)))
    centre = np.mean([_LOWER, _UPPER], axis=0)
    turning = np.cross(numbering.reference - centre, forces).sum(axis=0)
    of_bowl, _ = loaded(bowl((0.0, 0.0), 0.5, 0.0, 0.2, 1.0), kind if kind != "L1" else "L2", ())
    (bowls,) = of_bowl.forces(numbering.reference, 1.0)
    return {
        "box": float(np.linalg.norm(forces.sum(axis=0) / volume - _WEIGHT) / np.linalg.norm(_WEIGHT)),
        "bowl": float(np.linalg.norm(bowls.sum(axis=0) / (1.0 - 0.2 * 2.0 / 3.0) - _WEIGHT) / np.linalg.norm(_WEIGHT)),
        "arm": float(np.linalg.norm(turning) / (volume * np.linalg.norm(_WEIGHT))),
    }


@case(
    claim="Weights and tractions on built-in bodies, whole ones and those with poles among them, are what volumes and areas say; "
    "weights act at their centres.",
    grid={"body": list(BODIES)},
    bounds={
        "weight": Bound(at_most=1e-12, reason="quadrature: many points an element; round-off"),
        "arm": Bound(at_most=1e-12, reason="quadrature: the same"),
        "traction": Bound(at_most=1e-5, reason="quadrature: faces of arcs have the points of polynomials, and one more for weights"),
    },
)
def on_built_in_bodies(body: str) -> dict[str, float]:
    """Relative errors of the forces; of the weight's moment over weight times size."""
    built, patch, value = BODIES[body], refined(body, "N2"), np.array(_WEIGHT)
    loads = (Load("own", "weight", "body", None, _WEIGHT, (1.0,)), Load("pull", "traction", "body", built.curved, _WEIGHT, (1.0,)))
    one = Body("body", patch, Material(), (12, 12, 12), built.closed)
    problem = Problem("loaded", (one,), (), (), (Stage("stage", 1),), loads=loads)
    numbering = Numbering(problem)
    own, pull = Loads(problem, numbering).forces(numbering.reference, 1.0)
    (volume, first, _), size = built.moments(), float(np.linalg.norm(value))
    turning = np.cross(numbering.reference, own).sum(axis=0) - np.cross(first, value)
    return {
        "weight": float(np.linalg.norm(own.sum(axis=0) / volume - value)) / size,
        "arm": float(np.linalg.norm(turning)) / (volume * size * one.size),
        "traction": float(np.linalg.norm(pull.sum(axis=0) / built.area - value)) / size,
    }


@case(
    claim="Each direction has a rule of its own: of a box with three orders, and no more Gauss points than each needs, the shares of the "
    "control points in volume and areas are products of those along its directions, which knots tell.",
    tier="gate",
    grid={"orders": [" ".join(orders) for orders in permutations("135")]},
    bounds={
        "volumes": Bound(at_most=1e-14, reason="theory: rules of n points are exact to order 2 n - 1; " + _ROUND_OFF),
        "areas": Bound(at_most=1e-14, reason="theory: the same on each face; " + _ROUND_OFF),
    },
)
def shares(orders: str) -> dict[str, float]:
    """Largest error of a share over the largest of them."""
    of = tuple(map(int, orders.split()))
    patch = mesh(box(_LOWER, _UPPER), ("N", "N", "N"), of, (2, 3, 4))
    body = Body("body", patch, Material(), tuple((order + 2) // 2 for order in of))  # type: ignore[arg-type]
    along = []
    for direction, length in zip(patch.directions, np.subtract(_UPPER, _LOWER), strict=True):
        p, knots = direction.order, direction.knots
        along.append(length * (knots[p + 1 :] - knots[: -p - 1]) / ((p + 1) * (knots[-1] - knots[0])))
    u, v, w = along
    exact = np.einsum("i,j,k->kji", u, v, w).ravel()
    areas = []
    for face in FACES:
        first, second = (along[patch.directions.index(direction)] for direction in patch.face_directions(face))
        of_face = np.zeros(len(exact))
        of_face[patch.face_points(face)] = np.outer(second, first).ravel()
        areas.append(np.abs(control_areas(patch, face) - of_face).max() / of_face.max())
    return {"volumes": float(np.abs(control_volumes(body) - exact).max() / exact.max()), "areas": float(np.max(areas))}


@case(
    claim="Control points of a body whose weights differ share its volume, and these shares have the moment of it: functions sum to one.",
    tier="gate",
    bounds={
        "volume": Bound(at_most=1e-13, reason="theory: twelve points a direction leave nothing of an arc's functions; round-off"),
        "moment": Bound(at_most=1e-13, reason="theory: places are sums of the same functions; as above"),
        "weights": Bound(at_least=0.05, reason="definition: weights differ"),
    },
)
def weighted_shares() -> dict[str, float]:
    """Relative errors of the sums over a sector of a hollow cylinder, and by how much its weights differ."""
    inner, outer, angle, height = 1.0, 2.0, 1.2, 0.7
    patch = mesh(cylinder_sector(inner, outer, angle, height), ("N", "N", "N"), (1, 2, 3), (2, 3, 2))
    shares = control_volumes(Body("sector", patch, Material(), (12, 12, 12)))
    volume, arm = cylinder_volume(inner, outer, angle, height), (outer**3 - inner**3) / 3.0 * height
    moment = np.array([arm * np.sin(angle), arm * (1.0 - np.cos(angle)), volume * height / 2.0])
    return {
        "volume": abs(float(shares.sum()) / volume - 1.0),
        "moment": float(np.abs(shares @ patch.control_points - moment).max() / np.abs(moment).max()),
        "weights": float(np.ptp(patch.weights)),
    }
