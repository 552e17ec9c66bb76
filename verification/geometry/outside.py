"""How high points are above a body, or how deep in it: beside edges, level with faces, in corners, round bodies with seams and poles."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from geometry.bodies import BODIES, Built

from isomortar.geometry.outside import Outside
from isomortar.geometry.patch import FACES, FloatArray, Patch
from isomortar.geometry.primitives import box
from isomortar.harness import Bound, case

#: Points that are looked at, and those along each direction of a face by which the exact shape stands.
SOME, FINE = 80, 24
#: Finer corners about the nearest one, in parts of the way to the next.
AROUND = np.linspace(-1.0, 1.0, 41)
#: Share of a body's size: who is nearer to its outside is neither in it nor out of it.
NEAR = 0.01
#: Area below which a face is a line or a point, by far.
NO_AREA = 1e-9
#: Sides of boxes: cubes, plates of a hundredth of their length, bars.
BOXES = {"cube": (1.0, 1.0, 1.0), "plate": (20.0, 15.0, 0.2), "bar": (0.1, 10.0, 0.1)}


def heights(patch: Patch, closed: str, points: FloatArray) -> FloatArray:
    """Of points above the faces of a body."""
    return Outside.of(patch, [face for face in FACES if face[0] not in closed]).heights(points)[0]


@case(
    claim="Points beside a box, above its faces, edges and corners, level with these, and in it are found as far from it as they are, with "
    "the sign of their side, however long it is.",
    grid={"sides": list(BOXES)},
    tier="gate",
    bounds={
        "off": Bound(at_most=1e-13, reason="round-off: of the box's length"),
        "sides": Bound(0.0, 0.0, "definition: points that are told to be on the other side"),
    },
)
def beside_boxes(sides: str) -> dict[str, float]:
    """Largest distance from the exact one over the length, and points on the wrong side."""
    lengths = np.array(BOXES[sides])
    random = np.random.default_rng(5)
    near = 0.5 + random.choice([-0.52, -0.5, -0.49, 0.0, 0.3, 0.5, 0.51, 0.9], (SOME, 3))
    points = (np.concatenate([near, random.random((SOME, 3)) * 1.4 - 0.2]) - 0.5) * lengths
    beyond = np.abs(points) - 0.5 * lengths
    exact = np.linalg.norm(np.maximum(beyond, 0.0), axis=1) + np.minimum(beyond.max(axis=1), 0.0)
    shift = np.array([3.0, -2.0, 1.0])
    found = heights(box(tuple(shift - 0.5 * lengths), tuple(shift + 0.5 * lengths)), "", points + shift)
    clear = np.abs(exact) > 1e-13 * lengths.max()
    return {
        "off": float(np.abs(np.abs(found) - np.abs(exact)).max() / lengths.max()),
        "sides": float(np.count_nonzero((found < 0.0)[clear] != (exact < 0.0)[clear])),
    }


#: Sides of a plate that leans so far that cells of its edges are long and slanting, as rows.
LEANING = np.array([[4.0, 0.0, 0.0], [2.0, 3.0, 0.0], [1.5, -1.0, 0.05]])
#: Sides of a splinter that lean together: at its two tips its faces meet so sharply that points beside it seem to be deep in it.
SPLINTER = np.array([[4.0, 0.0, 0.0], [4.0, 1.0, 0.0], [4.0, 0.4, 0.9]])


@case(
    claim="Points in a plate that leans, and round it, are on the side that planes tell, and those in it as deep as the nearest plane.",
    tier="gate",
    bounds={
        "off": Bound(at_most=1e-13, reason="round-off: of the plate's length"),
        "sides": Bound(0.0, 0.0, "definition: points that are told to be on the other side"),
    },
)
def leaning() -> dict[str, float]:
    """Largest error of a depth over the length, and points on the wrong side."""
    cube = box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    shares = np.random.default_rng(7).random((4 * SOME, 3)) * 1.6 - 0.3
    found = heights(replace(cube, control_points=cube.control_points @ LEANING), "", shares @ LEANING)
    apart = np.abs(np.linalg.det(LEANING)) / np.linalg.norm(np.cross(LEANING[[1, 2, 0]], LEANING[[2, 0, 1]]), axis=1)
    deep = np.min(np.minimum(shares, 1.0 - shares) * apart, axis=1)
    return {
        "off": float(np.abs(found + deep)[deep > 0.0].max() / np.ptp(LEANING)),
        "sides": float(np.count_nonzero((found < 0.0) != (deep > 0.0))),
    }


@case(
    claim="Of points round the tips of a splinter, all beside it, and its middle the deepest is the middle, though a dozen and more seem "
    "to be in it, and deeper.",
    tier="gate",
    bounds={
        "off": Bound(at_most=1e-13, reason="round-off: of the splinter's length"),
        "seem": Bound(at_least=13.0, reason="definition: or too few are beside it that seem to be deeper to tell"),
    },
)
def sharp() -> dict[str, float]:
    """Error of the middle's depth over the length, and points that seem to be deeper."""
    cube, random = box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), np.random.default_rng(11)
    shape = Outside.of(replace(cube, control_points=cube.control_points @ SPLINTER), FACES)
    near = random.integers(0, 2, (2 * SOME, 1)) * SPLINTER.sum(axis=0) + random.uniform(-0.5, 0.5, (2 * SOME, 3))
    shares = near @ np.linalg.inv(SPLINTER)
    points = near[np.any((shares < -NEAR) | (shares > 1.0 + NEAR), axis=1)]
    depth = 0.5 * np.linalg.det(SPLINTER) / np.linalg.norm(np.cross(SPLINTER[[1, 2, 0]], SPLINTER[[2, 0, 1]]), axis=1).max()
    found = shape.deepest(np.concatenate([points, [0.5 * SPLINTER.sum(axis=0)]]), 0.0)
    return {"off": float(abs(found - depth) / np.ptp(SPLINTER)), "seem": float(np.count_nonzero(-shape.heights(points)[0] > depth))}


def grids(body: Built) -> list[FloatArray]:
    """Parameters of the corners of the cells of all outer faces of a body with an area, each shape (FINE + 1, FINE + 1, 3)."""
    line, found = np.linspace(0.0, 1.0, FINE + 1), []
    for face in FACES:
        if face[0] not in (body.closed or ""):
            axis, end = "uvw".index(face[0]), float(face[1])
            grid = np.insert(np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1), axis, end, axis=-1)
            found.append(grid[::-1] if (axis == 1) == (end == 1.0) else grid)
    return [grid for grid in found if np.abs(twice_areas(triangles(body, grid))).sum() > NO_AREA]


def places(body: Built, grid: FloatArray) -> FloatArray:
    """Where the exact shape has these parameters, in the shape of the grid."""
    return body.exact(*np.moveaxis(grid, -1, 0).reshape(3, -1))[0].reshape(grid.shape)


def twice_areas(corners: FloatArray) -> FloatArray:
    """Of triangles; those of a pole, or of a cylinder's axis, have none."""
    return np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)


def triangles(body: Built, grid: FloatArray) -> FloatArray:
    """Corners of the triangles of a grid, all seen from one side, shape (n, 3, 3)."""
    corners = places(body, grid)
    a, b, c, d = (part.reshape(-1, 3) for part in (corners[1:, 1:], corners[1:, :-1], corners[:-1, :-1], corners[:-1, 1:]))
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def distance(body: Built, point: FloatArray) -> float:
    """Of a point from the exact shape's faces: from the nearest of their corners, and the nearest of finer ones round each of those."""
    found = []
    for grid in grids(body):
        nearest = grid.reshape(-1, 3)[np.linalg.norm(places(body, grid).reshape(-1, 3) - point, axis=1).argmin()]
        fixed = [np.ptp(grid[..., axis]) == 0.0 for axis in range(3)]
        around = [np.array([nearest[k]]) if fixed[k] else np.clip(nearest[k] + AROUND / FINE, 0.0, 1.0) for k in range(3)]
        finer = np.stack(np.meshgrid(*around, indexing="ij"), axis=-1)
        found.append(np.linalg.norm(places(body, finer) - point, axis=-1).min())
    return float(np.min(found))


def turns(outside: FloatArray, point: FloatArray) -> float:
    """How often a closed surface goes round a point (van Oosterom and Strackee 1983): once, or not at all."""
    a, b, c = np.moveaxis(outside - point, 1, 0)
    x, y, z = (np.linalg.norm(of, axis=1) for of in (a, b, c))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c))
    rest = x * y * z + np.sum(a * b, axis=1) * z + np.sum(b * c, axis=1) * x + np.sum(c * a, axis=1) * y
    return float(abs(np.sum(2.0 * np.arctan2(volume, rest))) / (4.0 * np.pi))


@case(
    claim="Points in the built-in bodies and round them are on the side of their outside that the exact shape's solid angle tells, and as "
    "far from it.",
    grid={"body": list(BODIES)},
    tier=lambda body: "gate" if body in ("pipe", "cylinder", "ball", "torus", "shell", "wedge", "sector") else "nightly",
    bounds={
        "off": Bound(at_most=2e-3, reason="discretisation: flat cells of a full circle are off it by a thousandth of its size"),
        "sides": Bound(0.0, 0.0, "definition: points that are told to be on the other side"),
        "within": Bound(at_least=5.0, reason="definition: some of the points are in the body"),
    },
)
def built_in(body: str) -> dict[str, float]:
    """Largest error of a distance over the size, points on the wrong side, and those within."""
    built = BODIES[body]
    outside = np.concatenate([triangles(built, grid) for grid in grids(built)])
    corners = outside.reshape(-1, 3)
    low, size = corners.min(axis=0), np.ptp(corners, axis=0)
    points = low + (np.random.default_rng(6).random((SOME, 3)) * 1.3 - 0.15) * size
    away = np.array([distance(built, point) for point in points])
    found = heights(built.patch, built.closed or "", points)
    clear = away > NEAR * size.max()
    within = np.array([turns(outside, point) > 0.5 for point in points[clear]])
    return {
        "off": float(np.abs(np.abs(found) - away)[clear].max() / size.max()),
        "sides": float(np.count_nonzero((found[clear] < 0.0) != within)),
        "within": float(np.count_nonzero(within)),
    }
