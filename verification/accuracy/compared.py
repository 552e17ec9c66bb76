"""How runs are compared: errors of curves and fields, their roughness, grids over faces and bodies, against SciPy and exact shapes."""

from __future__ import annotations

import json
import math

import numpy as np
from scipy.interpolate import BSpline

from isomortar.accuracy.discretisations import discretisation, overrides, refined, sweep_of
from isomortar.accuracy.measures import curve_error, expected_order, reference_uncertainty, relative_error, roughness
from isomortar.accuracy.sampling import Grid, body_grid, face_grid, slave_grid, values_at
from isomortar.errors import InputError
from isomortar.geometry.primitives import box, ring, wedge
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.scene.geometry_file import patch_table

#: A body that is longest along its last direction.
LENGTHS = (1.0, 2.0, 5.0)
#: Cells of grids.
CELLS = 4000
SCENE = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
bodies.block.mesh = { order = [2, 3, 2], elements = [12, 6, 2] }
contacts.floor = { slave = "block.w0", plane = { normal = [0, 0, 1] }, friction = 0.3 }
supports.top.face = "block.w1"
stages = [{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.2] }]
"""


@case(
    claim="Errors of curves are those of the trapezoidal rule on the load times of both, roughness of polynomials is that of their second "
    "differences within stages, and changes that fall by one factor, or faster than theory lets them, add up to the reference's "
    "uncertainty.",
    tier="gate",
    bounds={
        "curve": Bound(at_most=1e-12, reason="round-off: of sums of a few numbers"),
        "field": Bound(at_most=1e-12, reason="round-off: of sums of a few numbers"),
        "roughness": Bound(at_most=1e-12, reason="round-off: of sums of a few numbers"),
        "uncertainty": Bound(at_most=1e-12, reason="round-off: of sums of a few numbers"),
    },
)
def measures() -> dict[str, float]:
    """Largest relative differences."""
    random, worst = np.random.default_rng(5), np.zeros(4)
    for _ in range(10):
        times, others = (np.sort(random.uniform(0.0, 3.0, n)) for n in (6, 9))
        values, reference = random.normal(size=(6, 3)), random.normal(size=(9, 3))
        both = np.union1d(times, others)
        both = both[(both >= np.maximum(times[0], others[0])) & (both <= np.minimum(times[-1], others[-1]))]
        ours, theirs = (np.stack([np.interp(both, t, column) for column in v.T], axis=1) for t, v in ((times, values), (others, reference)))
        exact = math.sqrt(np.trapezoid(((ours - theirs) ** 2).sum(axis=1), both) / np.trapezoid((theirs**2).sum(axis=1), both))
        weights = random.random(9)
        off = reference + random.normal(size=(9, 3))
        field = math.sqrt(np.average(((off - reference) ** 2).sum(axis=1), weights=weights))
        field /= math.sqrt(np.average((reference**2).sum(axis=1), weights=weights))
        steps, bend = np.arange(10.0), random.normal(size=2)
        heights = np.where(steps < 5, bend[0] * steps**2, 3.0 * steps + bend[1] * steps**2)
        rough = 3 * (2.0 * bend[0]) ** 2 + 3 * (2.0 * bend[1]) ** 2
        first, share = random.random(), random.uniform(0.05, 0.9)
        slowest = np.maximum(share, 0.5**2.0)  # changes of order two fall no faster, whatever two of them do
        left = sum(first * share * slowest**k for k in range(1, 2000))
        found = [
            abs(curve_error(times, values, others, reference) / exact - 1.0),
            abs(relative_error(off, reference, weights) / field - 1.0),
            abs(roughness(steps, heights, steps >= 5) / rough - 1.0),
            abs(reference_uncertainty(first, first * share, 2.0) / left - 1.0),
        ]
        worst = np.maximum(worst, found)
    return dict(zip(("curve", "field", "roughness", "uncertainty"), map(float, worst), strict=True))


def aspect(grid: Grid, lengths: tuple[float, ...]) -> float:
    """Longest over shortest edge of a cell, at its worst, where a direction of parameters is as long as said."""
    edges = np.array([length / len(places) for length, places in zip(lengths, grid.places, strict=True)])
    return float(edges.max() / edges.min())


@case(
    claim="Grids over faces and bodies have their exact area and volume, about as many cells as they are asked for, nearly square, and "
    "give fields of splines there as SciPy does.",
    tier="gate",
    bounds={
        "area": Bound(at_most=1e-12, reason="round-off: cells of a plane face are exact"),
        "volume": Bound(at_most=1e-12, reason="round-off: of sums of a few numbers"),
        "slanted": Bound(at_most=1e-12, reason="round-off: what two lines through its middle span is the area of a quadrilateral"),
        "half": Bound(at_most=1e-12, reason="round-off: cells of a plane face are exact"),
        "ring": Bound(at_most=1e-3, reason="discretisation: edges through the middles of cells, for arcs"),
        "aspect": Bound(at_most=1.5, reason="definition: whole numbers of cells an element, nearly cubes"),
        "count": Bound(1.6, 0.6, "definition: whole numbers of cells an element, about as many as asked for"),
        "field": Bound(at_most=1e-12, reason="round-off: of sums of a few numbers"),
    },
)
def grids() -> dict[str, float | list[float]]:
    """Relative errors; shapes and numbers of cells."""
    body = mesh(box((0.0, 0.0, 0.0), LENGTHS), ("N", "N", "N"), (2, 3, 1), (3, 2, 4))
    whole, face = body_grid(body, CELLS), face_grid(body, "u1", CELLS)
    bore = face_grid(ring((0.0, 0.0, 0.0), 1.0, 2.0, 0.5), "v0", CELLS)
    prism = wedge((0.0, 3.0), (1.0, 2.0), (0.0, 2.0), (0.0, 1.0))
    slanted = [face_grid(prism, "v0", CELLS).weights.sum() / 2.0, body_grid(prism, CELLS).weights.sum() / 4.0]
    halved = Scene.from_toml(SCENE, overrides=["symmetry={ y = 0.5 }"])
    exact = [2.0 * math.pi * radius * 0.5 for radius in (1.0, 2.0)]
    values = np.random.default_rng(6).normal(size=(len(body.control_points), 2))
    net = values.reshape(*body.shape, 2, order="F")
    matrices = [BSpline(d.knots, np.eye(d.count), d.order)(places) for d, places in zip(body.directions, whole.places, strict=True)]
    spline = np.einsum("ai,bj,ck,ijkx->abcx", *matrices, net).reshape(-1, 2, order="F")
    found = values_at(body.directions, body.weights, values, whole)
    return {
        "area": abs(float(face.weights.sum()) / 10.0 - 1.0),
        "volume": abs(float(whole.weights.sum()) / 10.0 - 1.0),
        "slanted": float(np.abs(np.array(slanted) - 1.0).max()),
        "half": abs(float(slave_grid(halved, halved.problem(), 0).weights.sum()) / 0.5 - 1.0),
        "ring": float(np.min([abs(bore.weights.sum() / area - 1.0) for area in exact])),
        "aspect": [aspect(whole, LENGTHS), aspect(face, LENGTHS[1:])],
        "count": [len(whole.weights) / CELLS, len(face.weights) / CELLS],
        "field": float(np.abs(found - spline).max() / np.abs(spline).max()),
    }


@case(
    claim="A scene in another kind and with another number of elements has that order and family along the swept directions, as many "
    "elements there as it is to have (of Lagrange ones so many control points), and keeps the others; its own kind gives it back.",
    tier="gate",
    grid={"kind": ("N3", "L1", "L3")},
    bounds={"wrong": Bound(0.0, 0.0, "definition: directions of another family, order or number of elements")},
)
def kinds(kind: str) -> dict[str, float]:
    """How many directions are not as they are to be; from the kind to others and back."""
    scene = Scene.from_toml(SCENE)
    wrong = 0
    for factor in (1.0, 2.0, 3.0):
        made = _made(scene, kind, factor)
        wrong += _unlike(made, kind, factor)
        for other in ("N2", "L2", kind):
            wrong += _unlike(_made(made, other, 1.0), other, factor)
    sweep = sweep_of(scene)
    twice = refined(scene, sweep, discretisation(scene, sweep, kind), 2.0)
    return {"wrong": float(wrong + (twice != discretisation(scene, sweep, kind, 2.0)))}


def _made(scene: Scene, kind: str, factor: float) -> Scene:
    """The scene in a kind with so many times its elements along its swept directions."""
    sweep = sweep_of(scene)
    return Scene.from_toml(scene.to_toml(), overrides=overrides(scene, sweep, discretisation(scene, sweep, kind, factor)))


def _unlike(scene: Scene, kind: str, factor: float) -> int:
    """Directions that are not those of a kind with so many times the elements of the first scene."""
    family, order = kind[0], int(kind[1:])
    found = [(d.family, d.order, d.elements) for d in scene.problem().body("block").patch.directions]
    share = factor / (order if family == "L" else 1)
    wanted = [(family, order, round(12 * share)), (family, order, round(6 * share))]
    return sum(one != other for one, other in zip(found[:2], wanted, strict=True)) + (found[2][2] != 2)


@case(
    claim="A body in a kind whose order its own geometry does not have is refused, and never meshed in another family without a word; of "
    "order 1 elements are Lagrange's.",
    tier="gate",
    grid={"order": (2, 3, 4)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: kinds that are taken and should not be, or refused, or of another family or order")},
)
def below_the_geometry(order: int) -> dict[str, float]:
    """How many of N1 to N4, of a block whose geometry is of an order."""
    table = patch_table(mesh(box((0, 0, 0), (1, 1, 1)), ("N", "N", "N"), (order, order, 1), (2, 1, 1)))
    lines = [f"bodies.block.patch.{key} = {json.dumps(value)}" for key, value in table.items()]
    others = [line for line in SCENE.splitlines() if not line.startswith("bodies.block")]
    scene, wrong = Scene.from_toml("\n".join([*others[:2], *lines, *others[2:]])), 0
    for kind in range(1, 5):
        try:
            found = _made(scene, f"N{kind}", 1.0).problem().body("block").patch.directions[:2]
            wrong += {(d.family, d.order) for d in found} != {("L" if kind == 1 else "N", kind)} or 1 < kind < order
        except InputError:
            wrong += not 1 < kind < order
    return {"wrong": float(wrong)}


#: A body below the block, which is in contact with it, and one beside both.
_OTHERS = """
bodies.base.geometry = { kind = "box", lower = [0, 0, -1], upper = [1, 1, 0] }
bodies.idle.geometry = { kind = "box", lower = [3, 0, 0], upper = [4, 1, 1] }
contacts.between = { slave = "block.w0", master = "base.w1" }
supports.idle.face = "idle.w0"
supports.base.face = "base.w0"
stages"""


@case(
    claim="What is swept is a body in contact, on either side; of another one, and of one that is not there, the names of these are told.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: bodies that are refused and should not be, or of which something else is told")},
)
def swept() -> dict[str, float]:
    """How many, of a block on a plane and of the same with others."""
    wrong = 0
    for text, touching in ((SCENE, ["block"]), (SCENE.replace("stages", _OTHERS.lstrip()), ["base", "block"])):
        scene = Scene.from_toml(text)
        for body in ("block", "base", "idle", "nobody"):
            try:
                wrong += sweep_of(scene, body).body != body or body not in touching
            except InputError as error:
                wrong += body in touching or f"bodies in contact here: {', '.join(touching)}" not in str(error)
    return {"wrong": float(wrong)}


#: Best orders by measure and whether the slave is refined, of orders 1 to 5: those of smooth solutions as far as free boundaries of contact
#: (slave) or the load's piecewise polynomials (master) let them.
BEST = {
    ("pressure", True): (1.0, 1.0, 1.0, 1.0, 1.0), ("displacement", True): (2.0, 2.5, 2.5, 2.5, 2.5),
    ("force", True): (2.0, 3.0, 3.0, 3.0, 3.0), ("moment", True): (2.0, 3.0, 3.0, 3.0, 3.0),
    ("pressure", False): (2.0, 3.0, 4.0, 4.0, 4.0), ("displacement", False): (2.0, 3.0, 4.0, 4.0, 4.0),
    ("force", False): (2.0, 4.0, 6.0, 6.0, 6.0), ("moment", False): (2.0, 4.0, 6.0, 6.0, 6.0),
}  # fmt: skip
#: A ring, whose geometry has four knot spans round its axis and one across.
RING = """
format = 1
bodies.ring.geometry = { kind = "ring", inner = 0.5, outer = 1, width = 1 }
bodies.ring.mesh = { order = [2, 2, 1], elements = [24, 2, 3] }
contacts.floor = { slave = "ring.v1", plane = { point = [0, 0, -2], normal = [0, 0, 1] } }
supports.bore.face = "ring.v0"
stages = [{ name = "press", steps = 1 }]
"""


@case(
    claim="Elements are as many as are asked for, to the nearest multiple of the geometry's knot spans, one at least; and the best orders "
    "are those of theory, by measure and side.",
    tier="gate",
    bounds={
        "elements": Bound(0.0, 0.0, "definition: numbers of elements that are not the nearest that the geometry can have"),
        "orders": Bound(0.0, 0.0, "theory: smoothness of the solution at free boundaries, and of the load on a master"),
    },
)
def nearest() -> dict[str, float]:
    """How many are others."""
    scene, wrong = Scene.from_toml(RING), 0
    sweep = sweep_of(scene)
    for kind, share in (("N2", 1.0), ("N3", 1.0), ("L2", 0.5), ("L3", 1.0 / 3.0)):
        for factor in np.linspace(0.03, 2.9, 23):
            multiples = [spans * np.arange(1, 100) for spans in (4, 1)]
            wanted = factor * share * np.array([24.0, 3.0])
            expected = [int(of[np.argmin(np.abs(of - number))]) for of, number in zip(multiples, wanted, strict=True)]
            u, v, w = discretisation(scene, sweep, kind, float(factor)).elements
            wrong += [u, w] != expected or v != 2
    orders = sum(expected_order(name, k, side) != best for (name, side), of in BEST.items() for k, best in enumerate(of, 1))
    return {"elements": float(wrong), "orders": float(orders)}
