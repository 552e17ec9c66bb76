"""Feet on C0 lines: around a ridge and through a valley of the master gap and normal are continuous, from any start."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from shapes import roof

from isomortar import _bindings
from isomortar._bindings import FaceArrays, Projections, Response, SlaveArrays
from isomortar.geometry.patch import FloatArray, Patch
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.model.numbering import patch_arrays

#: Distance of the path from the line, and number of its points.
RADIUS, POINTS = 0.1, 401
#: Of the two faces of a roof against the horizontal.
SLOPE = 0.4
#: Distances from the line, from a tenth of an element to a hundred times the least that has a direction.
DISTANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8)
EPSILON = float(np.finfo(float).eps)


def feet(
    bend: str, order: int, targets: FloatArray, starts: FloatArray | None, across: int = 0
) -> tuple[Projections, FloatArray, FloatArray]:
    """Projections of points onto the upper face of a roof, their gaps, and the normals there (the forces of unit pressures)."""
    return feet_on(roof(order, SLOPE if bend == "valley" else -SLOPE, across), targets, starts)


def feet_on(patch: Patch, targets: FloatArray, starts: FloatArray | None) -> tuple[Projections, FloatArray, FloatArray]:
    """The same on face w1 of a patch."""
    own, n = len(patch.weights), len(targets)
    arrays = patch_arrays(patch, np.arange(own, dtype=np.int32))
    master = FaceArrays(arrays, 3, 1)
    slave = SlaveArrays.of_points(np.arange(own, own + n, dtype=np.int32))
    positions = np.ascontiguousarray(np.concatenate([patch.control_points, targets]))
    had = np.full(n, starts is not None, dtype=np.int32)
    projections = _bindings.project_points(slave, master, positions, np.zeros((n, 2)) if starts is None else starts, had)
    gap = _bindings.control_quantities(slave, master, positions, projections).gap
    ones, zeros, forces = np.ones(n), np.zeros((n, 2)), np.zeros_like(positions)
    response = Response(ones, zeros, np.ones(n, np.int32), ones, np.zeros((n, 6, 2)), zeros)
    _bindings.contact_forces(slave, master, positions, projections, response, forces)
    return projections, gap, -forces[own:]


@case(
    claim="Around a ridge outside the master, and through a valley inside it, gap and normal are continuous, from any start.",
    tier="gate",
    grid={"bend": ["ridge", "valley"], "order": [1, 2]},
    bounds={
        "gap": Bound(at_most=1e-14, reason="round-off: on the line the gap is the distance from it"),
        "gap's slope": Bound(at_most=1.0 + 1e-9, reason="theory: a distance changes by no more than the way gone"),
        "normal's turn": Bound(at_most=1.0 + 1e-6, reason="theory: about the line the normal turns with the point, on faces by less"),
        "foot": Bound(at_most=1e-12, reason="round-off: the distance has one least value"),
        "on the line": Bound(at_least=0.2, at_most=0.8, reason="definition: the path meets both faces and the line"),
        "element": Bound(at_most=0.0, reason="definition: a foot on a line belongs to the lower element, from any start"),
    },
)
def around(bend: str, order: int) -> dict[str, float]:
    """Along an arc about the line: errors of the gap on it, slopes of gap and normal, and what other starts change."""
    angle = np.linspace(-0.7, 0.7, POINTS)
    side = 1.0 if bend == "ridge" else -1.0
    targets = np.column_stack([RADIUS * np.sin(angle), 0.21 + 0.05 * angle, side * RADIUS * np.cos(angle)])
    projections, gap, normal = feet(bend, order, targets, None)
    on = projections.fixed[:, 0] == 1
    way = np.linalg.norm(np.diff(targets[:, [0, 2]], axis=0), axis=1)
    random = np.random.default_rng(order)
    others = [feet(bend, order, targets, random.uniform(0.0, 1.0, (POINTS, 2)))[0] for _ in range(10)]
    return {
        "gap": float(np.abs(gap[on] + side * RADIUS).max()),
        "gap's slope": float(np.max(np.abs(np.diff(gap)) / np.linalg.norm(np.diff(targets, axis=0), axis=1))),
        "normal's turn": float(np.max(np.linalg.norm(np.diff(normal, axis=0), axis=1) * RADIUS / way)),
        "foot": float(np.max([np.abs(other.xi - projections.xi).max() for other in others])),
        "on the line": float(on.mean()),
        "element": float(np.max([np.abs(other.element - projections.element)[on].max() for other in others])),
    }


@case(
    claim="However near to a line, and whichever coordinate runs across it, gap and normal are those of the two half planes.",
    tier="gate",
    grid={"bend": ["ridge", "valley"], "across": [0, 1]},
    bounds={
        "gap": Bound(at_most=20 * EPSILON, reason="round-off: of coordinates of size one"),
        "normal": Bound(at_most=20 * EPSILON, reason="round-off: of coordinates of size one, times the distance: that of a direction"),
        "fixed": Bound(at_most=0.0, reason="theory: feet are on the line within the angle between the faces' normals, else on a face"),
        "slip": Bound(at_most=50 * EPSILON, reason="round-off: along the line the foot is where the point is"),
    },
)
def near(bend: str, across: int) -> dict[str, float]:
    """Largest errors over arcs of all distances from the line; that of the normal times the distance."""
    side = 1.0 if bend == "ridge" else -1.0
    alpha = float(np.arctan(SLOPE))
    angle = np.concatenate([np.linspace(-0.95, 0.95, 39) * alpha, np.linspace(1.05, 1.9, 18) * alpha, -np.linspace(1.05, 1.9, 18) * alpha])
    turned = np.clip(angle, -alpha, alpha)
    errors: dict[str, list[float]] = {"gap": [], "normal": [], "fixed": [], "slip": []}
    for distance in DISTANCES:
        along = 0.31 + 0.05 * angle
        targets = np.column_stack([distance * np.sin(angle), along, side * distance * np.cos(angle)])
        normals = np.column_stack([side * np.sin(turned), np.zeros_like(angle), np.cos(turned)])
        if across:
            targets, normals = targets[:, [1, 0, 2]], normals[:, [1, 0, 2]]
        projections, gap, normal = feet(bend, 1, targets, None, across)
        errors["gap"].append(np.abs(gap + side * distance * np.cos(angle - turned)).max())
        errors["normal"].append(distance * np.abs(normal - normals).max())
        errors["fixed"].append(np.abs(projections.fixed[:, across] - (np.abs(angle) < alpha)).max())
        errors["slip"].append(np.abs(projections.xi[:, 1 - across] - along).max())
    return {name: float(np.max(values)) for name, values in errors.items()}


@case(
    claim="A point beside the end of a ridge has no foot, from any start: on a line in one coordinate, beyond the edge in the other.",
    tier="gate",
    grid={"order": [1, 2], "across": [0, 1]},
    bounds={
        "found": Bound(at_most=0, reason="definition: the nearest point of the master is at its edge"),
        "lost": Bound(at_most=0, reason="definition: as far within the edge each point has its foot, on the line"),
    },
)
def beside_the_end(order: int, across: int) -> dict[str, float]:
    """Points round the line, beside both ends and within them by as much: how many have a foot there, or none here."""
    angle = np.tile(np.linspace(-0.9, 0.9, 10) * float(np.arctan(SLOPE)), 4)
    beyond = np.repeat([1e-6, 1e-3, 0.02, 0.2], 10)
    random, found, lost = np.random.default_rng(17), 0, 0
    for end, outward in ((0.0, -1.0), (1.0, 1.0)):
        for side in (1.0, -1.0):
            targets = np.column_stack([RADIUS * np.sin(angle), end + side * outward * beyond, RADIUS * np.cos(angle)])
            targets = targets[:, [1, 0, 2]] if across else targets
            for starts in (None, *random.uniform(0.0, 1.0, (4, len(angle), 2))):
                projections = feet("ridge", order, targets, starts, across)[0]
                inside = (projections.found == 1) & (projections.fixed[:, across] == 1)
                found += int(np.count_nonzero(projections.found)) if side > 0.0 else 0
                lost += int(np.count_nonzero(~inside)) if side < 0.0 else 0
    return {"found": found, "lost": lost}


#: Half lengths of a body with a ridge along either of its sides, and how its upper face falls off before and behind each of them.
SIDES = {"first": (40.0, 1.0), "second": (1.0, 40.0)}
FALLS = np.array([[0.2, 0.8], [0.3, 0.5]])
#: Where feet are: behind or before a ridge, as shares of the half lengths; at 0 on it.
PLACES = np.array([[0.0, 0.3], [0.0, -0.3], [0.3, 0.0], [-0.3, 0.0], [0.0, 0.0]])


def ridges(halves: FloatArray) -> Patch:
    """Two by two flat elements that fall off from x = 0 and from y = 0, each otherwise, on a body that is deep enough."""
    patch = mesh(box((-halves[0], -halves[1], -80.0), (halves[0], halves[1], 0.0)), ("L", "L", "L"), (1, 1, 1), (2, 2, 1))
    points = patch.control_points.copy()
    top = points[:, 2] > -0.5
    falls = [np.where(points[top, a] > 0.0, FALLS[a, 1], FALLS[a, 0]) for a in (0, 1)]
    points[top, 2] = -sum(fall * np.abs(points[top, a]) for a, fall in enumerate(falls))
    return replace(patch, control_points=points)


def _faces(place: FloatArray) -> FloatArray:
    """Unit normals of the faces that meet at a place, in the order of their elements."""
    behind = [(0, 1) if place[a] == 0.0 else (int(place[a] > 0.0),) for a in (0, 1)]
    normals = np.array([[(2 * i - 1) * FALLS[0, i], (2 * j - 1) * FALLS[1, j], 1.0] for j in behind[1] for i in behind[0]])
    return normals / np.linalg.norm(normals, axis=1)[:, None]


@case(
    claim="On a line, or where lines cross, the normal is the way to a point, and the faces' mean one nearer than 1e-10 of the element.",
    grid={"longer": list(SIDES)},
    bounds={
        "mean": Bound(at_most=1e-14, reason="round-off: of unit normals, just below the distance of theory 3.14"),
        "way": Bound(at_most=1e-4, reason="round-off: of positions up to 40 over a distance of 1e-8, just above it"),
        "gap": Bound(at_most=1e-4, reason="round-off: the same, of gaps by share of the distance"),
        "apart": Bound(at_least=0.02, at_most=1.0, reason="definition: the least by which the mean differs from the way"),
    },
)
def at_no_distance(longer: str) -> dict[str, float]:
    """Largest errors of normals and gaps, over places on lines, at half and at twice the least distance that has a direction."""
    halves, errors = np.array(SIDES[longer]), {name: [0.0] for name in ("mean", "way", "gap")}
    patch, apart = ridges(halves), []
    for place in PLACES:
        normals = _faces(place)
        mean, way = (n / np.linalg.norm(n) for n in (normals.sum(axis=0), np.linspace(1.0, 3.0, len(normals)) @ normals))
        falls = np.where(place > 0.0, FALLS[:, 1], FALLS[:, 0])  # of the lower element
        least = 1e-10 * float(np.max(halves * np.sqrt(1.0 + falls**2)))
        foot = np.append(halves * place, -np.sum(falls * np.abs(halves * place)))
        for share, name, normal in ((0.5, "mean", mean), (2.0, "way", way)):
            _, gap, found = feet_on(patch, (foot + share * least * way)[None], None)
            errors[name].append(np.abs(found[0] - normal).max())
            errors["gap"].append(abs(gap[0] / (share * least) + way @ normal))
        apart.append(np.linalg.norm(mean - way))
    return {name: float(np.max(values)) for name, values in errors.items()} | {"apart": float(np.min(apart))}
