"""Bodies between their Gauss points: where J is least there, and load steps that would turn one inside out."""

from __future__ import annotations

from unittest.mock import patch

import numpy as np
from rational_functions import shares

from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model import constants
from isomortar.scene import Scene
from isomortar.solve.record import Observer
from isomortar.solve.secants import Secants
from isomortar.told.during.inside_out import Places

#: By name family, orders, elements and the largest weight of patches; no two directions alike.
PATCHES = {
    "flat": ("N", (1, 2, 3), (3, 2, 2), 1.0),
    "rational": ("N", (2, 3, 2), (2, 1, 3), 6.0),
    "high": ("N", (4, 2, 5), (1, 3, 2), 2.0),
    "lines": ("N", (2, 2, 3), (3, 2, 1), 3.0),
    "nodal": ("L", (2, 1, 3), (2, 3, 1), 1.0),
}
#: Share of an element that a difference goes, inwards.
STEP = 1e-3

#: A stiff bowl that is pressed into a soft box, pushed and turned, by large steps and by small ones.
SCENE = """
format = 1
materials = { m = { young = 10.0, poisson = 0.3 }, n = { young = 100.0, poisson = 0.3 } }
bodies.a.material = "n"
bodies.a.geometry = { kind = "bowl", half_width = 0.4, bottom = 0.0, rise = 0.06, top = 0.5 }
bodies.a.mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
bodies.b.material = "m"
bodies.b.geometry = { kind = "box", lower = [-0.6, -0.6, -0.4], upper = [0.65, 0.6, 0.0] }
bodies.b.mesh = { order = 2, elements = [5, 4, 2] }
contacts.c = { slave = "a.w0", master = "b.w1", friction = 0, enforcement = "dual", quadrature = 6 }
supports = { top.face = "a.w1", base.face = "b.w0" }
[[stages]]
name = "press"
steps = 1
motions.top.translate = [0, 0, -0.3]
[[stages]]
name = "turn"
steps = 1
motions.top = { translate = [0, -0.1, 0], rotate = 40 }
"""
SMALL = ("stages.press.steps=4", "stages.turn.steps=8")
#: A solid cylinder, along whose axis elements have no volume, pressed flat on its end.
CYLINDER = """
format = 1
materials.m = { young = 10.0, poisson = 0.3 }
bodies.b.geometry = { kind = "ring", inner = 0.0, outer = 1.0, width = 1.0 }
bodies.b.mesh = { order = 2, elements = [8, 2, 1] }
contacts.c = { slave = "b.w1", friction = 0, plane = { point = [0, -0.5, 0], normal = [0, 1, 0] } }
supports.top.face = "b.w0"
[[stages]]
name = "press"
steps = 4
motions.top.translate = [0, -0.6, 0]
"""


def made(name: str) -> tuple[Patch, FloatArray]:
    """A box with uneven control points and weights, and other positions of them."""
    family, orders, elements, heavy = PATCHES[name]
    patch = mesh(box((5.0, -3.0, 1.0), (6.0, -1.0, 1.5)), (family,) * 3, orders, elements)  # type: ignore[arg-type]
    if name == "lines":  # an inner line of the first direction becomes one across which functions are only continuous
        first = patch.directions[0]
        finer = Direction("N", 2, np.sort(np.append(first.knots, first.boundaries[1])))
        x, y, z = np.meshgrid(finer.greville, patch.directions[1].greville, patch.directions[2].greville, indexing="ij")
        points = np.column_stack([values.ravel(order="F") for values in (x, 2.0 * y, 0.5 * z)])
        patch = Patch((finer, *patch.directions[1:]), points, np.ones(len(points)))
    random = np.random.default_rng(7)
    weights = random.uniform(1.0, heavy, len(patch.weights))
    gap = 0.5 * np.ptp(patch.control_points, axis=0) / np.array(patch.shape)
    points = patch.control_points + 0.2 * gap * random.uniform(-1.0, 1.0, patch.control_points.shape)
    return Patch(patch.directions, points, weights), points + 1.2 * gap * random.uniform(-1.0, 1.0, points.shape)


def differences(patch: Patch, positions: FloatArray) -> FloatArray:
    """J by differences of the map of places, shape (w, v, u: elements and places of each in turn)."""
    bounds = [d.boundaries for d in patch.directions]
    inside = np.array(constants.PLACES_BETWEEN)
    lines = [(b[:-1, None] + np.diff(b)[:, None] * inside).ravel() for b in bounds]
    ways = [STEP * (np.diff(b)[:, None] * np.where(inside < 0.5, 1.0, -1.0)).ravel() for b in bounds]
    grids = [np.meshgrid(*values[::-1], indexing="ij") for values in (lines, ways)]
    places, steps = (np.column_stack([values.ravel() for values in grid[::-1]]) for grid in grids)
    volumes = []
    for points in (positions, patch.control_points):
        centred = points - points.mean(axis=0)
        slopes = []
        for k in range(3):
            on = [shares(patch.directions, patch.weights, places + n * steps * np.eye(3)[k]) @ centred for n in range(3)]
            slopes.append((-3.0 * on[0] + 4.0 * on[1] - on[2]) / (2.0 * steps[:, k, None]))
        volumes.append(np.linalg.det(np.stack(slopes, axis=1)))
    each = len(inside)
    return np.asarray(volumes[0] / volumes[1]).reshape([n for b in bounds[::-1] for n in (len(b) - 1, each)])


@case(
    claim="The least J of a body between its Gauss points is that of its map, of all orders and weights, and in the element that is named.",
    tier="gate",
    grid={"patch": list(PATCHES)},
    bounds={
        "off": Bound(at_most=1e-4, reason="discretisation: differences over a thousandth of an element, over the largest J"),
        "other": Bound(0.0, 0.0, "definition: the element that is named is another"),
        "slabs": Bound(0.0, 0.0, "definition: looked at layer by layer it is another"),
    },
)
def least_jacobian(patch: str) -> dict[str, float]:
    """Of a box whose control points went elsewhere, so that it is folded here and there."""
    given, positions = made(patch)
    found, expected = Places(given).least(positions), differences(given, positions)
    by_element = expected.min(axis=(1, 3, 5))
    w, v, u = (int(k) for k in np.unravel_index(by_element.argmin(), by_element.shape))
    most, constants.MOST_AT_ONCE = constants.MOST_AT_ONCE, 1
    try:
        layered = Places(given).least(positions)
    finally:
        constants.MOST_AT_ONCE = most
    off = abs(found.value - expected.min()) / np.abs(expected).max()
    return {"off": float(off), "other": float(found.element != (u, v, w)), "slabs": float(layered != found)}


class Heard(Observer):
    """Counts cuts that are for bodies which fall into themselves, and warnings of these."""

    def __init__(self) -> None:
        self.cuts = self.warnings = 0

    def cut(self, step: int, time: float, increment: float, reason: str) -> None:
        """Count one of its kind."""
        del step, time, increment
        self.cuts += "its least J falls" in reason

    def warned(self, message: str) -> None:
        """Count one of its kind."""
        self.warnings += "inside out" in message or "its least J falls" in message


def run(text: str, *overrides: str) -> tuple[FloatArray, float, Heard]:
    """The last force of the first support, the least J of body b, and what was heard."""
    heard = Heard()
    simulation = Simulation(Scene.from_toml(text, overrides=list(overrides)).problem(), heard)
    *_, last = simulation.run()
    soft = simulation.equilibrium.problem.body("b")
    positions = simulation.equilibrium.numbering.of_patch("b", simulation.state.positions)
    return last.reactions[0].force, Places(soft.patch).least(positions).value, heard


@case(
    claim="A load step that would turn a body inside out between its Gauss points is cut, and comes to what small ones come to.",
    tier="gate",
    bounds={
        "J": Bound(at_least=0.3, reason="definition: -0.035 where the body is turned inside out; small load steps leave 0.42"),
        "force": Bound(at_most=1e-6, reason="theory: without friction the path does not matter; a relative difference"),
        "cuts": Bound(at_least=1.0, reason="definition: or nothing is tried"),
        "heard": Bound(0.0, 0.0, "definition: warnings, and cuts of small load steps"),
    },
)
def falls() -> dict[str, float]:
    """By large steps, with corrections that learn nothing and lead into it, and by small ones."""
    expected, _, small = run(SCENE, *SMALL)
    with patch.object(constants, "KEPT_SHARE", 0.2), patch.object(Secants, "improved", lambda _, correction: correction):
        force, jacobian, heard = run(SCENE)
    off = np.linalg.norm(force - expected) / np.linalg.norm(expected)
    return {"J": jacobian, "force": float(off), "cuts": heard.cuts, "heard": heard.warnings + small.warnings + small.cuts}


@case(
    claim="Along an axis where elements have no volume there is no J to look at: a solid cylinder's is that of what is done to it, and "
    "pressed hard it is not told to be inside out.",
    tier="gate",
    bounds={
        "off": Bound(at_most=1e-12, reason="round-off: of a cylinder that is squeezed evenly, over its J"),
        "J": Bound(at_least=0.05, at_most=constants.LOOKED_BETWEEN, reason="definition: pressed so hard that it is looked at"),
        "heard": Bound(0.0, 0.0, "definition: warnings of an honest cylinder"),
    },
)
def on_an_axis() -> dict[str, float]:
    """Squeezed along its axis to shares of its length; and pressed."""
    patch = Scene.from_toml(CYLINDER).problem().body("b").patch
    places, squeezed = Places(patch), np.array([1.0, 0.5, 0.2])
    found = [places.least(patch.control_points * [1.0, share, 1.0]).value for share in squeezed]
    _, jacobian, heard = run(CYLINDER)
    return {"off": float(np.abs(np.array(found) / squeezed - 1.0).max()), "J": jacobian, "heard": float(heard.warnings)}


#: A column of Hooke's law that is pressed to a fifth of its height at once.
HOOKE = """
format = 1
materials.m = { young = 10.0, poisson = 0.0, law = "linear-elastic" }
bodies.b.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
supports = { top.face = "b.w1", base.face = "b.w0" }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.8] }]
"""


@case(
    claim="Of a body of Hooke's law, whatever its volume, no load step is cut and nothing is said of its J.",
    tier="gate",
    bounds={
        "J": Bound(at_most=1e-12, reason="definition: a fifth of its height; how far off"),
        "force": Bound(at_most=1e-12, reason="theory: Young's modulus times strain and area; a relative difference"),
        "heard": Bound(0.0, 0.0, "definition: cuts and warnings"),
    },
)
def of_small_strains() -> dict[str, float]:
    """Of a column that comes to where the J of another law would have fallen."""
    force, jacobian, heard = run(HOOKE)
    return {"J": abs(jacobian - 0.2), "force": float(abs(force[2] / -8.0 - 1.0)), "heard": float(heard.cuts + heard.warnings)}
