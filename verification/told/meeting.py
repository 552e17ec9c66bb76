"""Which bodies are at or in each other: boxes turned at random, by planes between them, and bodies within others."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar.geometry.patch import FloatArray, Patch
from isomortar.geometry.primitives import box, sphere
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.model.entities import Body, Material
from isomortar.told.meeting import depth, meet

#: Pairs that are drawn; those that are nearer to touching than cells are long are not looked at.
PAIRS, CLEAR = 24, 0.04
AT_ONE_PLACE = np.zeros(3)


def turned(lengths: FloatArray, axes: FloatArray, middle: FloatArray) -> Body:
    """A box whose sides are along the rows of a rotation."""
    patch = box(tuple(-0.5 * lengths), tuple(0.5 * lengths))
    return Body("box", replace(patch, control_points=patch.control_points @ axes + middle), Material(), (2, 2, 2))


def apart(one: tuple[FloatArray, FloatArray, FloatArray], other: tuple[FloatArray, FloatArray, FloatArray]) -> float:
    """Largest distance between the shadows of two boxes on a line (Gottschalk, Lin and Manocha 1996); negative where all overlap."""
    (lengths, axes, middle), (others, of_other, centre) = one, other
    lines = np.concatenate([axes, of_other, np.cross(axes[:, None, :], of_other[None, :, :]).reshape(-1, 3)])
    lines = lines[np.linalg.norm(lines, axis=1) > 0.1]
    lines /= np.linalg.norm(lines, axis=1)[:, None]
    reach = 0.5 * (np.abs(lines @ axes.T) @ lengths + np.abs(lines @ of_other.T) @ others)
    return float(np.max(np.abs(lines @ (centre - middle)) - reach))


def drawn(random: np.random.Generator, spread: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Lengths, axes and middle of a box: flat, long or neither."""
    axes = np.linalg.qr(random.normal(size=(3, 3)))[0]
    axes[2] *= np.linalg.det(axes)
    return random.choice([0.1, 0.5, 1.0], 3), axes, spread * random.normal(size=3)


@case(
    claim="Boxes that are turned against each other are told to meet, to be in each other, and to do neither, as planes between them tell.",
    tier="gate",
    bounds={
        "meet": Bound(0.0, 0.0, "definition: pairs that are told to meet and do not, or do"),
        "in": Bound(0.0, 0.0, "definition: pairs that are told to be in each other and are not, or are"),
        "pairs": Bound(at_least=5.0, reason="definition: as many of either kind, at least"),
    },
)
def turned_boxes() -> dict[str, float]:
    """How many of some tens, and the smaller number of such as meet and such as do not."""
    random, wrong, kinds = np.random.default_rng(8), np.zeros(2), np.zeros(2)
    for _ in range(PAIRS):
        one, other = drawn(random, 0.3), drawn(random, 0.3)
        away = apart(one, other)
        if abs(away) > CLEAR:
            first, second, meets = turned(*one), turned(*other), away < 0.0
            way = random.normal(size=3)
            shifted = turned(one[0], one[1], one[2] - way)
            wrong += meet(shifted, second, way) != meets, (depth(first, second, 0.0) > 0.0) != meets
            kinds[int(meets)] += 1
    return {"meet": float(wrong[0]), "in": float(wrong[1]), "pairs": float(np.min(kinds))}


def moved(patch: Patch, way: tuple[float, float, float]) -> Body:
    """A body somewhere else."""
    return Body("moved", replace(patch, control_points=patch.control_points + way), Material(), (2, 2, 2))


@case(
    claim="A body within another one meets it, whichever is named first, and one beside it that its box reaches into does not, nor one "
    "level with it; what touches it does.",
    tier="gate",
    bounds={"others": Bound(0.0, 0.0, "definition: pairs, in either order, of which something else is told")},
)
def within_and_beside() -> dict[str, float]:
    """How many of five, in both orders."""
    cube, ball = box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), sphere((0.0, 0.0, 0.0), 0.0, 0.5, (-90.0, 90.0), (0.0, 360.0), "z")
    small = box((0.0, 0.0, 0.0), (0.1, 0.1, 0.1))
    pairs = [
        (moved(small, (0.45, 0.45, 0.45)), True),
        (moved(small, (1.0, 0.45, 0.45)), True),
        (moved(small, (1.002, 0.45, 0.9)), False),
        (moved(ball, (1.32, 1.32, 1.32)), False),
        (moved(ball, (1.25, 1.25, 1.25)), True),
    ]
    whole, still = moved(cube, (0.0, 0.0, 0.0)), AT_ONE_PLACE
    return {"others": float(sum((meet(one, whole, still) != meets) + (meet(whole, one, still) != meets) for one, meets in pairs))}


def twisted(degrees: float) -> Body:
    """A bar that is twisted about z, whose sharpest edges are then below a right angle, and its cells no planes."""
    patch = mesh(box((-0.5, -0.5, 0.0), (0.5, 0.5, 1.0)), ("N", "N", "N"), (2, 2, 2), (3, 3, 4))
    x, y, z = patch.control_points.T
    angle = np.radians(degrees) * z
    points = np.column_stack([x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle), z])
    return Body("bar", replace(patch, control_points=points), Material(), (2, 2, 2))


@case(
    claim="Cubes beside a twisted bar, clear of all that its edges come round, are not in it, however sharp these are; cubes at its axis "
    "are.",
    tier="gate",
    grid={"degrees": (60.0, 110.0)},
    bounds={
        "in it": Bound(0.0, 0.0, "definition: cubes that are told to be, and are not"),
        "not in it": Bound(0.0, 0.0, "definition: cubes that are not told to be, and are"),
    },
)
def beside_a_twisted_bar(degrees: float) -> dict[str, float]:
    """How many of ten, and of three."""
    bar, cube = twisted(degrees), box((-0.05, -0.05, -0.05), (0.05, 0.05, 0.05))
    angles = np.radians(np.arange(10) * 36.0 + 5.0)
    beside = [(0.5 * np.sqrt(2.0) + 0.08) * np.array([np.cos(a), np.sin(a), 0.0]) + [0.0, 0.0, 0.06] for a in angles]
    at_axis = [np.array([0.1, 0.0, z]) for z in (0.1, 0.5, 0.97)]
    deep = [[depth(bar, moved(cube, tuple(place)), 0.0) for place in places] for places in (beside, at_axis)]
    return {"in it": float(np.count_nonzero(deep[0])), "not in it": float(len(at_axis) - np.count_nonzero(deep[1]))}


#: A cube that leans so far both ways that its corners are needles, and points in it and round it, each looked at by itself.
NEEDLES, ROUND = 3.0, 60


@case(
    claim="Points in a cube that leans until its corners are needles are in it, and those round it are not; the deepest of all of them is "
    "as deep as planes tell.",
    tier="gate",
    bounds={
        "others": Bound(0.0, 0.0, "definition: points of which something else is told"),
        "off": Bound(at_most=1e-12, reason="round-off: of the depth, over the size"),
    },
)
def by_needles() -> dict[str, float]:
    """How many of some tens, and by how much the deepest is off."""
    lean = np.array([[1.0, 0.0, 0.0], [NEEDLES, 1.0, 0.0], [NEEDLES, 0.0, 1.0]])
    cube = box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    body = Body("cube", replace(cube, control_points=cube.control_points @ lean), Material(), (2, 2, 2))
    shares = np.random.default_rng(9).random((ROUND, 3)) * 1.6 - 0.3
    apart = 1.0 / np.linalg.norm(np.cross(lean[[1, 2, 0]], lean[[2, 0, 1]]), axis=1)
    deep = np.min(np.minimum(shares, 1.0 - shares) * apart, axis=1)
    found = np.array([body.outside.deepest(point[None], 0.0) for point in shares @ lean])
    return {
        "others": float(np.count_nonzero((found > 0.0) != (deep > 0.0))),
        "off": abs(body.outside.deepest(shares @ lean, 0.0) - float(deep.max())) / float(np.ptp(lean)),
    }
