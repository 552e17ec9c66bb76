"""Poles of a master: feet beside and at the point into which an edge is collapsed, and targets above it without a foot of their own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from projection.closest_points import Surface
from projection.nearest import exhaustive
from shapes import dome

from isomortar import _bindings
from isomortar._bindings import Response, SlaveArrays
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case

INNER, OUTER = 0.4, 0.7
#: Latitude, counted from the pole as a share of the patch, at which feet are.
OFF = (1e-1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-14)


def face(kind: str, side: str = "v1", raised: float = 0.0, rows: int = 3) -> Surface:
    """The outer (v1) or inner face of a dome of so many rows of elements; `raised`: its pole, which is a cone's vertex then."""
    family, order = kind[0], int(kind[1:])
    patch = mesh(dome(INNER, OUTER, -0.3), (family, family, family), (order, 1, order), (rows, 1, 8))  # type: ignore[arg-type]
    points = patch.control_points.copy()
    points[patch.face_points("u1"), 2] += raised
    return Surface(replace(patch, control_points=points), side, closed="w")


def turned(surface: Surface, way: str) -> Surface:
    """The same face with its pole at the "high" or "low" end of the "first" or "second" of its directions."""
    patch, side = surface.patch, int(surface.face[1])
    end, _, direction = way.partition(" ")
    assert (surface.face[0], surface.closed) == ("v", "w"), "the second direction of the face ends at the pole"
    values = np.concatenate([patch.control_points, patch.weights[:, None]], axis=1).reshape(*patch.shape[::-1], 4).transpose(2, 1, 0, 3)
    directions = list(patch.directions)

    def turn_round(axis: int) -> None:
        nonlocal values
        values = np.flip(values, axis)
        knots = directions[axis].knots
        directions[axis] = replace(directions[axis], knots=knots[0] + knots[-1] - knots[::-1])

    if end == "low":  # two at once: the patch is no mirror image
        turn_round(0)
        turn_round(2)
    if direction == "first":
        turn_round(1)
        values, directions, side = values.transpose(2, 1, 0, 3), directions[::-1], 1 - side
    points = values.transpose(2, 1, 0, 3).reshape(-1, 4)
    closed = "u" if direction == "first" else "w"
    return Surface(Patch(tuple(directions), points[:, :3], points[:, 3]), f"v{side}", closed)  # type: ignore[arg-type]


def starts(surface: Surface, count: int, seed: int) -> FloatArray:
    """Random coordinates, and every third one at the pole."""
    low, high = surface.ends
    xi = low + np.random.default_rng(seed).uniform(0, 1, (count, 2)) * (high - low)
    xi[::3, 1] = high[1]
    return xi


@case(
    claim="Feet beside a pole are those of the exact sphere, however near it and from any start, the pole too.",
    tier="gate",
    grid={"kind": ["N2", "N3"], "side": ["v0", "v1"], "off": list(OFF)},
    bounds={
        "foot": Bound(at_most=2e-14, reason="round-off: of the surface's points; Newton's method ends below it"),
        "found": Bound(at_least=1.0, at_most=1.0, reason="definition: round the pole there is no edge"),
        "followed": Bound(at_least=1.0, at_most=1.0, reason="definition: the sphere is smooth at its pole, a foot beside it follows"),
    },
)
def beside_a_pole(kind: str, side: str, off: float) -> dict[str, float]:
    """Largest distance from the exact foot, shares found and followed; feet all round, on C0 lines too, on both sides of the face."""
    surface = face(kind, side)
    low, high = surface.ends
    random = np.random.default_rng(2)
    angle = np.concatenate([random.uniform(0.0, 2 * np.pi, 40), np.arange(8) * np.pi / 4])
    latitude = (high[1] - low[1]) * off
    radius = INNER if side == "v0" else OUTER
    normals = np.column_stack([np.sin(latitude) * np.cos(angle), np.sin(latitude) * np.sin(angle), np.full(len(angle), np.cos(latitude))])
    feet = radius * normals
    targets = feet + random.uniform(-0.25, 0.25, (len(feet), 1)) * normals
    worst, found, followed = 0.0, [], []
    for xi in (None, starts(surface, len(feet), 3), starts(surface, len(feet), 4)):
        projections = surface.project(targets, xi)
        worst = float(np.maximum(worst, np.linalg.norm(surface.points(projections.xi) - feet, axis=1).max()))
        found.append(projections.found)
        followed.append(projections.followed)
    return {"foot": worst, "found": float(np.mean(found)), "followed": float(np.mean(followed))}


@case(
    claim="A pole is found at either end of either direction: feet beside it are those of the exact sphere, on a cone's vertex those of "
    "all that is in its cone of normals. Of more rows up to it than there are elements round it, too.",
    grid={"way": ["high first", "low first", "high second", "low second"], "side": ["v0", "v1"], "rows": [3, 24]},
    bounds={
        "foot": Bound(at_most=2e-14, reason="round-off: of the surface's points; Newton's method ends below it"),
        "followed": Bound(at_least=1.0, at_most=1.0, reason="definition: the sphere is smooth at its pole, a foot beside it follows"),
        "vertex": Bound(at_most=2e-16, reason="round-off: of the vertex, which is the nearest point of all in its cone of normals"),
    },
)
def at_any_end(way: str, side: str, rows: int) -> dict[str, float]:
    """Largest distance from the exact foot, share followed, and distance from the vertex of a cone; from any start and from none."""
    random = np.random.default_rng(8)
    smooth, cone = (turned(face("N2", side, raised, rows), way) for raised in (0.0, 0.1))
    radius = INNER if side == "v0" else OUTER
    angle, off = random.uniform(0.0, 2 * np.pi, 24), 10.0 ** random.uniform(-11.0, -0.5, 24)
    normals = np.column_stack([np.sin(off) * np.cos(angle), np.sin(off) * np.sin(angle), np.cos(off)])
    targets = (radius + random.uniform(-0.25, 0.25, (24, 1))) * normals
    vertex = cone.patch.control_points[cone.patch.face_points(cone.face)][:, 2].max()
    above = np.array([[0.0, 0.0, vertex + (0.1 if side == "v1" else 0.01)]])
    worst, followed, apart = 0.0, [], 0.0
    low, high = smooth.ends
    for xi in (None, low + random.uniform(0.0, 1.0, (24, 2)) * (high - low)):
        projections = smooth.project(targets, xi)
        worst = float(np.maximum(worst, np.linalg.norm(smooth.points(projections.xi) - radius * normals, axis=1).max()))
        followed.append(projections.followed)
        there = cone.points(cone.project(above, None if xi is None else xi[:1]).xi)
        apart = float(np.maximum(apart, np.linalg.norm(there - [0.0, 0.0, vertex], axis=1).max()))
    return {"foot": worst, "followed": float(np.mean(followed)), "vertex": apart}


def disc(order: int, elements: int) -> Surface:
    """The flat upper face of a plate about the z-axis, which is its pole; so many elements of any width round it."""
    line, rim = Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0])), np.linspace(0.0, 1.0, elements + 1)
    round_it = Direction("N", order, np.pad(rim, order, mode="edge"))
    angle = 2 * np.pi * (np.arange(round_it.count) % (round_it.count - 1)) / (round_it.count - 1)
    points = np.zeros((round_it.count, 2, 2, 3))
    points[:, :, 0, :2] = np.column_stack([np.cos(angle), np.sin(angle)])[:, None]
    points[:, 0, :, 2] = -0.5
    return Surface(Patch((line, line, round_it), points.reshape(-1, 3), np.ones(4 * round_it.count)), "v1", closed="w")


def spike_in_a_bowl() -> Surface:
    """The upper face of a bowl about the z-axis with a spike in its middle, whose tip is the pole."""
    profile = np.array([[1.5, 3.0], [0.5, -1.0], [0.0, 0.0]])
    along = Direction("N", 1, np.array([0.0, 0.0, 1.0, 2.0, 2.0]))
    across = Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))
    round_it = Direction("N", 2, np.pad(np.arange(13.0), 2, mode="edge"))
    angle = 2 * np.pi * (np.arange(round_it.count) % (round_it.count - 1)) / (round_it.count - 1)
    points = np.zeros((round_it.count, 2, 3, 3))
    points[..., 0], points[..., 1] = (profile[:, 0] * f(angle)[:, None, None] for f in (np.cos, np.sin))
    points[..., 2] = profile[:, 1] - np.array([0.5, 0.0])[:, None]
    return Surface(Patch((along, across, round_it), points.reshape(-1, 3), np.ones(6 * round_it.count)), "v1", closed="w")


@case(
    claim="A search that starts at a pole, or comes to one that is nearest of all beside it, goes on to what is nearer elsewhere.",
    tier="gate",
    bounds={
        "nearer": Bound(at_most=1e-12, reason="round-off: of points and distances, all of size one"),
        "of the pole": Bound(at_least=1.0, reason="definition: beside it nothing is nearer to some targets, of which it is not the foot"),
    },
)
def nearer_than_a_pole() -> dict[str, float]:
    """By how much another point of a bowl is nearer than the foot from a start at the tip of its spike; targets in the tip's cone."""
    surface = spike_in_a_bowl()
    angle = np.random.default_rng(4).uniform(0.0, 2 * np.pi, 20)
    targets = np.column_stack([1.1 * np.cos(angle), 1.1 * np.sin(angle), np.full(len(angle), 1.6)])
    start = np.column_stack([np.linspace(surface.ends[0, 0], surface.ends[1, 0], len(angle)), np.full(len(angle), surface.ends[1, 1])])
    feet = surface.project(targets, start)
    away = np.linalg.norm(surface.points(feet.xi), axis=1) > 0.1
    return {
        "nearer": float(np.maximum(0.0, exhaustive(surface, targets, feet.xi)).max()),
        "of the pole": float(np.count_nonzero(away & (feet.found > 0))),
    }


@case(
    claim="Feet beside a pole are found all round, however few elements there are round it.",
    grid={"order": [3, 4], "elements": [1, 2, 3]},
    bounds={
        "foot": Bound(at_most=2e-14, reason="round-off: of the surface's points; the face is flat, the foot is below its point"),
        "followed": Bound(at_least=1.0, at_most=1.0, reason="definition: the face is smooth at its pole, a foot beside it follows"),
    },
)
def few_elements_round(order: int, elements: int) -> dict[str, float]:
    """Largest distance from the exact foot, share followed; as near the pole as squared distances tell, from any start and from none."""
    surface, random = disc(order, elements), np.random.default_rng(9)
    radius, angle = np.repeat([1e-2, 1e-4, 1e-7], 20), random.uniform(0.0, 2 * np.pi, 60)
    feet = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(60)])
    targets = feet + random.uniform(-0.25, 0.25, (60, 1)) * np.array([0.0, 0.0, 1.0])
    found = [surface.project(targets, xi) for xi in (None, starts(surface, 60, 10))]
    return {
        "foot": float(np.max([np.linalg.norm(surface.points(one.xi) - feet, axis=1).max() for one in found])),
        "followed": float(np.mean([one.followed for one in found])),
    }


@case(
    claim="Where the pole is a vertex, targets within its cone have it for a foot, others the nearest point of the whole face.",
    tier="gate",
    grid={"kind": ["N2", "N3"], "raised": [1e-6, 1e-3, 0.1]},
    bounds={
        "pole": Bound(at_most=0.0, reason="definition: within the cone of normals nothing is nearer than the vertex"),
        "nearer": Bound(at_most=1e-9, reason="definition: no point of the master may be nearer; half the digits of a least distance"),
        "fixed": Bound(at_least=1.0, at_most=1.0, reason="definition: the vertex stays the foot of what moves within its cone"),
    },
)
def at_a_vertex(kind: str, raised: float) -> dict[str, float]:
    """Distance of feet from the vertex, for targets within its cone; how much nearer a point is to others; share fixed of the first."""
    surface = face(kind, raised=raised)
    high = surface.ends[1]
    pole = surface.points(high[None])[0]
    random = np.random.default_rng(5)
    slope = np.linalg.norm(surface.points(np.array([[0.0, high[1] - 1e-7]]))[0, :2])
    slope = (pole - surface.points(np.array([[0.0, high[1] - 1e-7]]))[0])[2] / slope
    angle, share = random.uniform(0, 2 * np.pi, 60), random.uniform(0.0, 0.9, 60)
    above = np.column_stack([share * slope * np.cos(angle), share * slope * np.sin(angle), np.ones(60)]) * random.uniform(
        0.01, 0.3, (60, 1)
    )
    within = surface.project(pole + above, starts(surface, 60, 6))
    around = pole + random.uniform(-0.2, 0.2, (60, 3))
    return {
        "pole": float(np.linalg.norm(surface.points(within.xi) - pole, axis=1).max()),
        "nearer": float(np.maximum(0.0, exhaustive(surface, around, surface.project(around).xi).max())),
        "fixed": float(np.mean(within.fixed)),
    }


@case(
    claim="Of a point whose foot is a pole's vertex the kernel says how far away that is, on which side, how coordinates have changed, the "
    "shortest way round, and that these have no length; pressures push along the line between the two, tractions do nothing. At either end "
    "of either direction.",
    tier="gate",
    grid={"way": ["high first", "low first", "high second", "low second"], "raised": [-0.1, 0.1]},
    bounds={
        "others": Bound(0.0, 0.0, "definition: all have a foot, which is the vertex, and stays it"),
        "gap": Bound(at_most=1e-15, reason="round-off: of distances of some tenths"),
        "slip": Bound(at_most=1e-15, reason="round-off: of differences of coordinates, and of a period"),
        "weight": Bound(0.0, 0.0, reason="definition: every target has an area of one, and a function of its own that is one"),
        "metric": Bound(0.0, 0.0, reason="definition: round a vertex coordinates have no length"),
        "forces": Bound(at_most=1e-14, reason="round-off: of unit vectors between points that are a hundredth apart, and of their sums"),
        "elsewhere": Bound(0.0, 0.0, reason="definition: the foot is one control point, which no other bears"),
    },
)
def said_of_a_vertex(way: str, raised: float) -> dict[str, float]:
    """Targets without that foot; largest errors of what is integrated, and of forces; those on other control points. Out of it, and in."""
    surface, random, n = turned(face("N2", "v1", raised), way), np.random.default_rng(11), 24
    own = len(surface.patch.weights)
    corners = surface.patch.control_points[surface.patch.face_points(surface.face)]
    pole = corners[np.argmin(np.linalg.norm(corners[:, :2], axis=1))]
    angle, share, length = random.uniform(0.0, 2 * np.pi, n), random.uniform(0.0, 0.1, n), random.uniform(0.01, 0.2, n)
    arm = np.column_stack([share * np.cos(angle), share * np.sin(angle), np.full(n, np.sign(raised))])
    arm *= (length / np.linalg.norm(arm, axis=1))[:, None]
    slave, master = SlaveArrays.of_points(np.arange(own, own + n, dtype=np.int32)), surface.master()
    positions = np.ascontiguousarray(np.concatenate([surface.patch.control_points, pole + arm]))
    low, high = surface.ends
    origin = low + random.uniform(0.0, 1.0, (n, 2)) * (high - low)
    feet = _bindings.project_points(slave, master, positions, origin, np.ones(n, dtype=np.int32))
    control = _bindings.control_quantities(slave, master, positions, feet)
    there = np.all(surface.points(feet.xi) == pole, axis=1) & (feet.found == 1) & (feet.followed == 1) & np.all(feet.fixed == 1, axis=1)
    round_it = 0 if way.endswith("second") else 1
    expected = feet.xi - origin
    period = (high - low)[round_it]
    expected[:, round_it] -= period * np.round(expected[:, round_it] / period)
    pressure, forces = random.uniform(0.5, 1.5, n), np.zeros_like(positions)
    state, none = 1 + np.arange(n, dtype=np.int32) % 2, np.zeros((n, 6, 2))
    response = Response(pressure, random.standard_normal((n, 2)), state, np.zeros(n), none, np.zeros((n, 2)))
    _bindings.contact_forces(slave, master, positions, feet, response, forces)
    at_pole = np.all(surface.patch.control_points == pole, axis=1)
    push = -(pressure * np.sign(raised) / length)[:, None] * arm  # forces are those of a residual, against what pushes
    return {
        "others": float(np.count_nonzero(~there)),
        "gap": float(np.abs(control.gap + np.sign(raised) * length).max()),
        "slip": float(np.abs(control.slip - expected).max()),
        "weight": float(np.abs([control.weight - 1.0, control.square - 1.0]).max()),
        "metric": float(max(np.abs(control.metric).max(), np.abs(control.point_metric).max())),
        "forces": float(max(np.abs(forces[own:] - push).max(), np.abs(forces[:own][at_pole].sum(axis=0) + push.sum(axis=0)).max() / n)),
        "elsewhere": float(np.abs(forces[:own][~at_pole]).max()),
    }


@case(
    claim="Beyond the centre of curvature a target above the pole has no foot that follows it; nearer to the face it has.",
    tier="gate",
    grid={"kind": ["N2", "N3"]},
    bounds={
        "centre": Bound(at_most=0.0, reason="definition: from the centre of the sphere all its points are as near"),
        "above": Bound(at_least=1.0, at_most=1.0, reason="definition: off the centre the pole is the nearest point"),
    },
)
def above_a_pole(kind: str) -> dict[str, float]:
    """Share of followed targets at the sphere's centre, and on the axis from there to the pole and beyond."""
    surface = face(kind, "v0")
    heights = np.array([0.001, 0.05, 0.39, 0.4, 0.41, 0.6])
    axis = np.column_stack([np.zeros((6, 2)), heights])
    found = [surface.project(axis, xi).followed for xi in (None, starts(surface, 6, 7))]
    return {"centre": float(np.mean(surface.project(np.zeros((1, 3))).followed)), "above": float(np.mean(found))}
