"""Patches of a higher order and with more elements, and halves of patches: the same bodies, whatever their knots and weights."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
from rational_functions import shares
from scipy.interpolate import BSpline

from isomortar.errors import InputError
from isomortar.geometry.faces import cells
from isomortar.geometry.grids import CELLS
from isomortar.geometry.halves import upper_half
from isomortar.geometry.patch import FACES, Direction, FloatArray, Patch
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import cut as cut_up
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case

#: Places in each patch, and patches.
PLACES, PATCHES = 30, 24
_ROUND_OFF = "round-off: of blossoms and knots that are inserted, by the size of the body"


def line(random: np.random.Generator, span: float, symmetric: bool = False) -> Direction:
    """A direction of any order up to 3 with some inner knots of any multiplicity; symmetric: an even number of elements."""
    order, count = int(random.integers(1, 4)), int(random.integers(1, 4))
    inner = np.sort(random.choice(np.arange(1, 16), count, replace=False)) / (32 if symmetric else 16)
    repeated = np.repeat(inner, random.integers(1, order + 1, count))
    if symmetric:
        repeated = np.concatenate([repeated, np.full(random.integers(1, order + 1), 0.5), 1.0 - repeated[::-1]])
    return Direction("N", order, span * np.concatenate([np.zeros(order + 1), repeated, np.ones(order + 1)]))


def body(random: np.random.Generator, directions: tuple[Direction, Direction, Direction]) -> tuple[FloatArray, FloatArray]:
    """Control points near those of a box, shape (n, 3), and weights."""
    grid = np.stack(np.meshgrid(*(d.greville / d.knots[-1] for d in directions), indexing="ij"), axis=-1)
    return (grid + random.uniform(-0.1, 0.1, grid.shape)).reshape(-1, 3, order="F"), random.uniform(0.5, 2.0, grid.shape[:3]).ravel(
        order="F"
    )


def places(random: np.random.Generator, directions: tuple[Direction, ...]) -> FloatArray:
    """Parameters within a patch."""
    low, high = np.array([d.boundaries[[0, -1]] for d in directions]).T
    return np.asarray(low + random.random((PLACES, 3)) * (high - low))


@case(
    claim="A mesh of higher orders and more elements is the same body, as smooth as before at its own knots, at any scale of parameters.",
    tier="gate",
    grid={"span": (1e-3, 1.0, 40.0)},
    bounds={
        "shape": Bound(at_most=1e-12, reason=_ROUND_OFF),
        "knots": Bound(at_most=0.0, reason="definition: each knot once more for each order, none elsewhere but where elements are cut"),
    },
)
def raised(span: float) -> dict[str, float]:
    """Largest distance of places, and knots that differ, over random patches with an order, and more elements, of each direction's own."""
    random, worst, wrong = np.random.default_rng(41), 0.0, 0
    for _ in range(PATCHES):
        directions = (line(random, span), line(random, span), line(random, span))
        patch = Patch(directions, *body(random, directions))
        more, parts = random.permutation([0, 1, 2]), random.permutation([1, 1, 2])
        orders = tuple(int(d.order + k) for d, k in zip(directions, more, strict=True))
        finer = mesh(patch, ("N",) * 3, orders, tuple(int(d.elements * n) for d, n in zip(directions, parts, strict=True)))
        at = places(random, directions)
        ends = [shares(p.directions, p.weights, at) @ p.control_points for p in (patch, finer)]
        worst = float(np.maximum(worst, np.abs(ends[0] - ends[1]).max()))
        for d, found, k, n in zip(directions, finer.directions, more, parts, strict=True):
            distinct, counts = np.unique(d.knots, return_counts=True)
            cuts = np.setdiff1d(np.interp(np.arange(n * d.elements + 1) / n, np.arange(d.elements + 1), distinct), distinct)
            expected = np.sort(np.concatenate([np.repeat(distinct, counts + k), cuts]))
            wrong += len(expected) != len(found.knots) or bool(np.any(np.abs(expected - found.knots) > 1e-15 * span))
    return {"shape": worst, "knots": float(wrong)}


@case(
    claim="The upper half of a symmetric body is that of the whole, whichever direction is halved, and whichever way it runs.",
    tier="gate",
    grid={"family": ("N", "L"), "axis": (0, 1, 2)},
    bounds={
        "shape": Bound(at_most=1e-13, reason=_ROUND_OFF),
        "plane": Bound(at_most=0.0, reason="definition: the cut face is on the plane, all else above it"),
        "faces": Bound(at_most=0.0, reason="definition: faces that are not the one at the plane"),
    },
)
def halved(family: str, axis: int) -> dict[str, float]:
    """Largest errors over random bodies that are halved in each direction, along which a coordinate rises or falls."""
    random, worst, below, wrong = np.random.default_rng(43), 0.0, 0.0, 0
    for number in range(PATCHES):
        cut, falls, place = number % 3, number // 3 % 2 == 1, random.uniform(-2.0, 2.0)
        directions = [line(random, 2.0) for _ in range(3)]
        directions[cut] = line(random, 2.0, symmetric=True)
        if family == "L":
            directions = [Direction("L", d.order, d.boundaries) for d in directions]
        u, v, w = directions
        points, weights = body(random, (u, v, w))
        patch = _mirrored((u, v, w), points, weights, cut, axis, place, falls)
        begun = 4.0 * (number // 6)  # where knots begin is nobody's business
        u, v, w = (Direction(d.family, d.order, d.knots + begun) for d in patch.directions)
        patch = replace(patch, directions=(u, v, w))
        half, face = upper_half(patch, axis, place)
        at = places(random, half.directions)
        ends = [shares(p.directions, p.weights, at) @ p.control_points for p in (patch, half)]
        worst = float(np.maximum(worst, np.abs(ends[0] - ends[1]).max()))
        on_plane = half.control_points[half.face_points(face), axis]
        below = float(np.max([below, np.abs(on_plane - place).max(), (place - half.control_points[:, axis]).max()]))
        wrong += face != f"{'uvw'[cut]}{int(falls)}"
    return {"shape": worst, "plane": below, "faces": float(wrong)}


def _mirrored(
    directions: tuple[Direction, Direction, Direction],
    points: FloatArray,
    weights: FloatArray,
    cut: int,
    axis: int,
    place: float,
    falls: bool,
) -> Patch:
    """A body that is its own mirror image in a plane across an axis, run through from one side to the other in direction `cut`."""
    shape = tuple(d.count for d in directions)
    grid, table = points.reshape(*shape, 3, order="F"), weights.reshape(shape, order="F")
    grid[..., [axis, cut]] = grid[..., [cut, axis]]
    whole, along = 0.5 * (grid + np.flip(grid, cut)), directions[cut].greville
    rising = np.expand_dims(along - along[::-1], [k for k in range(3) if k != cut]) * table.mean(axis=cut, keepdims=True)
    whole[..., axis] = place + (-rising if falls else rising)
    return Patch(directions, whole.reshape(-1, 3, order="F"), (0.5 * (table + np.flip(table, cut))).ravel(order="F"))


@case(
    claim="A body is halved wherever it is, though round-off of its place is more than that of its size, and however small or large it is; "
    "where one point, or one weight, is off by more than round-off it is not its own mirror image.",
    tier="gate",
    grid={"size": (1e-6, 1.0, 1e6), "away": (0.0, 1e3, 1e5)},
    bounds={
        "refused": Bound(0.0, 0.0, "definition: bodies whose points are mirror images to a bit or two of where they are"),
        "taken": Bound(0.0, 0.0, "definition: bodies with a point, or a weight, that is off"),
    },
)
def halved_anywhere(size: float, away: float) -> dict[str, float]:
    """How many of the halves across each axis, of a box that is as many times its size away."""
    random, lower = np.random.default_rng(44), size * (away * np.array([1.0, -0.7, 0.4]) + [0.1, 0.2, 0.3])
    patch = mesh(box(tuple(lower), tuple(lower + size)), ("N",) * 3, (2, 2, 2), (2, 2, 2))
    far, refused, taken = float(np.abs(patch.control_points).max()), 0, 0
    for axis in range(3):
        place = float(lower[axis] + 0.5 * size)
        for off in (0.0, 1e-16, 1e-9):
            points = patch.control_points + off * far * random.choice([-1.0, 1.0], patch.control_points.shape)
            try:
                upper_half(replace(patch, control_points=points), axis, place)
                taken += off == 1e-9
            except InputError:
                refused += off != 1e-9
            try:
                upper_half(replace(patch, weights=1.0 + off * np.eye(1, len(patch.weights), 5)[0]), axis, place)
                taken += off == 1e-9
            except InputError:
                refused += off != 1e-9
    return {"refused": float(refused), "taken": float(taken)}


@case(
    claim="Graded elements get longer by the same factor all along a direction, but where a span of the geometry ends, and fill its spans.",
    tier="gate",
    grid={"grading": (0.01, 0.5, 1.0, 30.0)},
    bounds={
        "factor": Bound(at_most=1e-11, reason=_ROUND_OFF),
        "spans": Bound(at_most=1e-15, reason=_ROUND_OFF),
    },
)
def graded(grading: float) -> dict[str, float]:
    """Factors of neighbours in a span off the one whose power is the grading; ends of spans that are none of elements."""
    factors, ends = [0.0], [0.0]
    for spans, parts in ((1, 1), (1, 4), (2, 3), (3, 2), (4, 5), (5, 1)):
        lines = np.cumsum(np.append(0.0, 1.0 + np.arange(spans) ** 2))
        direction = Direction("N", 1, np.pad(lines, 1, mode="edge"))
        boundaries = cut_up(direction, spans * parts, grading)
        wanted = grading ** (1.0 / max(1, spans * parts - 1))
        lengths = np.diff(boundaries).reshape(spans, parts)
        factors += list(np.abs(lengths[:, 1:] / lengths[:, :-1] / wanted - 1.0).ravel())
        ends += list(np.abs(boundaries[::parts] - lines) / lines[-1])
    return {"factor": float(np.max(factors)), "spans": float(np.max(ends))}


@case(
    claim="Cells of a face have its area and its normal, are as many in each direction as they are to be at least, no more than it "
    "takes to end with its elements, and with nodes of Lagrange's, however few or many these are.",
    tier="gate",
    grid={"elements": (1, 5, CELLS - 1, CELLS, CELLS + 1, 3 * CELLS)},
    bounds={
        "area": Bound(at_most=1e-13, reason=_ROUND_OFF),
        "normal": Bound(at_most=1e-13, reason=_ROUND_OFF),
        "thickness": Bound(at_most=1e-13, reason=_ROUND_OFF),
        "few": Bound(0.0, 0.0, "definition: faces with fewer cells than are to be, or none that end with an element, or at a node"),
        "many": Bound(0.0, 0.0, "definition: faces with cells that could be left out, of all elements, or ways between nodes, as many"),
    },
)
def cells_of_faces(elements: int) -> dict[str, float]:
    """Largest errors over the faces of a box with so many elements along two directions; how many have too few, or too many, cells."""
    lengths = np.array([1.0, 0.5, 2.0])
    worst, few, many = np.zeros(3), 0, 0
    whole = box((0.0, 0.0, 0.0), tuple(lengths))
    patches = [mesh(whole, families, (1, 2, 1), (elements, elements, 1)) for families in (("N",) * 3, ("L",) * 3, ("N", "L", "N"))]
    for patch, face in product(patches, FACES):
        axis, found = "uvw".index(face[0]), cells(patch, face)
        out = np.where(np.arange(3) == axis, 1.0 if face[1] == "1" else -1.0, 0.0)
        area = float(np.prod(np.delete(lengths, axis)))
        errors = (found.areas.sum() / area - 1.0, found.normals - out, found.thickness / lengths[axis] - 1.0)
        worst = np.maximum(worst, [np.abs(error).max() for error in errors])
        parts = [d.elements * (d.order if d.family == "L" else 1) for d in patch.face_directions(face)]
        few += min(found.shape) < CELLS or any(n % part for n, part in zip(found.shape, parts, strict=True))
        many += any(n >= CELLS + part for n, part in zip(found.shape, parts, strict=True))
    return dict(zip(("area", "normal", "thickness"), map(float, worst), strict=True)) | {"few": float(few), "many": float(many)}


@case(
    claim="Lagrange elements beside NURBS have polynomials along their own directions: weights that vary along these alone are gone, and "
    "others count from the first along NURBS.",
    tier="gate",
    grid={"along": ("u", "v", "w")},
    bounds={
        "first": Bound(at_most=0.0, reason="definition: weights of the first functions along NURBS, at any node, are one"),
        "ratios": Bound(at_most=1e-12, reason=_ROUND_OFF),
    },
)
def mixed(along: str) -> dict[str, float]:
    """Largest differences from one, and from ratios of the weights that a random body has at the nodes."""
    random, worst, axis = np.random.default_rng(47), np.zeros(2), "uvw".index(along)
    for _ in range(PATCHES):
        directions = (line(random, 1.0), line(random, 1.0), line(random, 1.0))
        patch = Patch(directions, *body(random, directions))
        elements, orders = [d.elements for d in directions], [d.order for d in directions]
        made = mesh(patch, ["L" if k == axis else "N" for k in range(3)], [2 if k == axis else p for k, p in enumerate(orders)], elements)
        weights = np.moveaxis(made.weights.reshape(made.shape, order="F"), axis, 0)
        net = np.moveaxis(patch.weights.reshape(patch.shape, order="F"), axis, 0)
        own = directions[axis]
        there = BSpline.design_matrix(made.directions[axis].greville, own.knots, own.order) @ net.reshape(len(net), -1)
        ratios = (there / there[:, :1]).reshape(weights.shape)
        worst = np.maximum(worst, [np.abs(weights[:, 0, 0] - 1.0).max(), np.abs(weights / ratios - 1.0).max()])
    return {"first": float(worst[0]), "ratios": float(worst[1])}
