"""Sides of a contact that are faces of several patches, beside the one patch that these are, with C0 lines where they meet."""

from __future__ import annotations

import functools
from dataclasses import replace
from itertools import pairwise

import numpy as np
from glue.halves import chained
from small_scenes import TIGHT
from transforms import orientations, oriented

from isomortar.geometry.patch import FloatArray, Patch
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.harness.cases import Tier
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Face, Faces, Problem
from isomortar.model.numbering import Numbering
from isomortar.model.sheet import Sheet
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: A bowl over the tiles, its lowest point beside where they meet, pressed and moved on over that.
_SCENE = """
format = 1
bodies.bowl.geometry = {{ kind = "bowl", centre = [-0.06, -0.04], half_width = {width}, bottom = 0, rise = {rise}, top = {top} }}
bodies.bowl.mesh = {{ order = [2, 2, 1], elements = [{elements}, {elements}, 1] }}
{tiles}
glue = {glue}
contacts.interface = {{ {sides}, friction = 0.2, projection = "{projection}", quadrature = {quadrature} }}
supports.top = {{ face = "bowl.w1" }}
[[stages]]
name = "press"
steps = 1
motions.top = {{ translate = [0, 0, -0.05] }}
[[stages]]
name = "move"
steps = {steps}
motions.top = {{ translate = [0.1, 0.08, 0], rotate = 5 }}
"""
_TILE = """
bodies.{name}.geometry = {{ kind = "box", lower = [{x}, {y}, -0.4], upper = [{x1}, {y1}, 0] }}
bodies.{name}.mesh = {{ family = "{family}", order = [{order}, {order}, 1], elements = [{m}, {n}, 1] }}
supports.{name} = {{ face = "{name}.w0" }}
"""
#: Bounds of tiles along x and y, with numbers of elements.
_X, _Y = ((-0.5, 1), (0.0, 1), (0.6, 1), (0.9, 0)), ((-0.5, 1), (0.0, 1), (0.5, 0))
#: The bowl as the slave, within the tiles, and as the master, wider than they are.
_BOWLS = {
    "master": {"width": 0.35, "rise": 0.05, "top": 0.4, "elements": 2},
    "slave": {"width": 1.2, "rise": 0.6, "top": 1.6, "elements": 4},
}
#: Names of tiles by row.
_ROWS = ("abe", "cdf")


def tiled(
    columns: int, rows: int, side: str = "master", family: str = "N", order: int = 2, projection: str = "closest", steps: int = 1,
    quadrature: int = 3,
) -> Problem:  # fmt: skip
    """The bowl on tiles in so many columns and rows, which are the ``master`` or the ``slave``."""
    names = [row[:columns] for row in _ROWS[:rows]]
    x, y = [*_X[:columns], _X[columns]], [*_Y[:rows], _Y[rows]]
    if rows == 1:
        y = [(-0.5, 2), (0.5, 0)]
    text = "".join(
        _TILE.format(name=names[j][i], x=x0, x1=x1, y=y0, y1=y1, m=m, n=n, family=family, order=order)
        for i, ((x0, m), (x1, _)) in enumerate(pairwise(x))
        for j, ((y0, n), (y1, _)) in enumerate(pairwise(y))
    )
    glue = [[f"{a}.u1", f"{b}.u0"] for row in names for a, b in pairwise(row)]
    glue += [[f"{a}.v1", f"{b}.v0"] for lower, upper in pairwise(names) for a, b in zip(lower, upper, strict=True)]
    faces = [f"{name}.w1" for row in names for name in row]
    other = "slave" if side == "master" else "master"
    sides = f'{side} = {faces}, {other} = "bowl.w0"'
    scene = _SCENE.format(tiles=text, glue=glue, sides=sides, projection=projection, steps=steps, quadrature=quadrature, **_BOWLS[side])
    problem = Scene.from_toml(scene).problem()
    return replace(problem, settings=replace(problem.settings, **TIGHT))  # type: ignore[arg-type]


def heavier(problem: Problem) -> Problem:
    """The problem with another factor of the weights of body "b", which changes no function."""
    bodies = (replace(b, patch=replace(b.patch, weights=2.0 * b.patch.weights)) if b.name == "b" else b for b in problem.bodies)
    return replace(problem, bodies=tuple(bodies))


def untiled(problem: Problem) -> Problem:
    """The tiles as one body, "a", with C0 lines where they meet."""
    by_name = {body.name: _even(body.patch) for body in problem.bodies}
    rows = []
    for names in ["".join(name for name in row if name in by_name) for row in _ROWS]:
        if names:
            patch = by_name[names[0]]
            for name in names[1:]:
                patch = chained(patch, by_name[name], 0)
            rows.append(patch)
    whole = rows[0] if len(rows) == 1 else chained(rows[0], rows[1], 1)
    (contact,) = problem.contacts
    master = contact.master if contact.master == Face("bowl", "w0") else Face("a", "w1")
    slave = contact.slave if contact.slave == Face("bowl", "w0") else Face("a", "w1")
    return replace(
        problem,
        bodies=tuple(replace(b, patch=whole) if b.name == "a" else b for b in problem.bodies if b.name in ("a", "bowl")),
        contacts=(replace(contact, slave=slave, master=master),),
        supports=tuple(support for support in problem.supports if support.name in ("a", "top")),
        glue=(),
    )


def _even(patch: Patch) -> Patch:
    """A box with lengths along x and y for its coordinates u and v: of several, coordinates go on at an even speed."""
    u, v, w = patch.directions
    x, y, _ = np.ptp(patch.control_points, axis=0)
    return replace(patch, directions=(replace(u, knots=x * u.knots), replace(v, knots=y * v.knots), w))


def solved(problem: Problem) -> list[StepResult]:
    """All load steps."""
    return list(Simulation(problem).run())


@functools.cache
def alike(projection: str) -> tuple[Problem, list[StepResult]]:
    """Tiles that are all named alike, and their load steps: what tiles of every orientation are compared with."""
    problem = tiled(2, 2, projection=projection)
    return problem, solved(problem)


def positions(problem: Problem, results: list[StepResult]) -> FloatArray:
    """Positions of all control points, in the order of their places in the reference, shape (load steps, n, 3)."""
    order = np.lexsort(np.round(Numbering(problem).reference, 9).T)
    return np.stack([result.state.positions[order] for result in results])


def forces(results: list[StepResult], side: str = "slave") -> FloatArray:
    """Contact forces and moments of a side, shape (load steps, 2, 3)."""
    return np.array([[getattr(result.contacts[0], f"{of}_{side}") for of in ("force", "moment")] for result in results])


def tier(tiles: str, side: str, family: str, order: int, projection: str) -> Tier:
    """The gate has a quarter of the products: any two settings in every choice, and each order with any two others but for two pairs.

    Of these, tiles and family, and side and projection, even orders have the choices that odd ones lack.
    """
    apart = (tiles == "2x2") + (family == "L"), (side == "slave") + (projection == "averaged")
    return "gate" if all((order + count) % 2 for count in apart) else "nightly"


@case(
    claim="Over tiles in a row of any lengths and numbers of elements coordinates of a side go on at the same speed.",
    grid={"side": ("master", "slave"), "family": ("N", "L"), "order": (1, 3)},
    bounds={
        "uneven": Bound(at_most=1e-14, reason="definition: on flat tiles of even elements they are lengths along the row, but for a factor")
    },
)
def at_one_speed(side: str, family: str, order: int) -> dict[str, float]:
    """Largest distance of bounds of elements along three tiles, and across, from where they are, by the whole."""
    problem = tiled(3, 1, side, family, order)
    (contact,) = problem.contacts
    found = Sheet.of(problem, getattr(contact, side)).directions
    places = ([x for x, _ in _X], [-0.5, 0.0, 0.5])
    shares = [[np.subtract(ends, ends[0]) / np.ptp(ends) for ends in (d.boundaries, place)] for d, place in zip(found, places, strict=True)]
    return {"uneven": float(np.max([np.abs(one - other).max() for one, other in shares]))}


@case(
    claim="A side of several patches gives what the one patch gives that they are, whichever side it is.",
    tier=tier,
    grid={
        "tiles": ("3x1", "2x2"),
        "side": ("master", "slave"),
        "family": ("N", "L"),
        "order": (1, 2, 3),
        "projection": ("closest", "averaged"),
    },
    bounds={
        "positions": Bound(at_most=1e-9, reason="theory: the same functions on the same unknowns; lengths are 1, and tolerances are left"),
        "forces": Bound(at_most=1e-8, reason="theory: the same functions on the same unknowns"),
        "pressures": Bound(at_most=1e-7, reason="theory: the same constraints, in the same order"),
        "balance": Bound(at_most=1e-11, reason="theory: forces and moments of slave and master cancel, over joints too (3.5, 3.6)"),
        "both sides": Bound(at_least=2.0, reason="definition: both sides of a joint are in contact, or nothing is tested"),
    },
)
def as_one_patch(tiles: str, side: str, family: str, order: int, projection: str) -> dict[str, float]:
    """Distances of positions, forces and pressures from those of the one patch; slave elements and feet beside a joint."""
    columns, rows = (int(count) for count in tiles.split("x"))
    several = tiled(columns, rows, side, family, order, projection)
    single = untiled(several)
    one, other = solved(heavier(several)), solved(single)
    size = np.abs(forces(other)).max()
    pressures = [np.array([result.state.contacts[0].pressure for result in results]) for results in (one, other)]
    numbering = Numbering(several)
    pressed = [name for name in ("a", "b") if _moved(one[-1].state.positions, numbering, name)]
    return {
        "positions": float(np.abs(positions(several, one) - positions(single, other)).max()),
        "forces": float(np.abs(forces(one) - forces(other)).max() / size),
        "pressures": float(np.abs(pressures[0] - pressures[1]).max() / np.abs(pressures[1]).max()),
        "balance": float(np.abs(forces(one) + forces(one, "master")).max() / size),
        "both sides": float(len(pressed)),
    }


def _moved(places: FloatArray, numbering: Numbering, name: str) -> bool:
    """Whether a body deforms by a thousandth and more."""
    points = numbering.points[name]
    return bool(np.abs(places[points] - numbering.reference[points]).max() > 1e-3)


def tier_of_way(way: int, turned: str) -> Tier:
    """The gate has half of the ways once: each order of the directions is that of the first tile, and of the last one.

    `any_orientation` has all of them, of two halves.
    """
    order, flips = divmod(way, 4)
    of_the_first = (order + flips // 2) % 2 == 0
    return "gate" if (turned == "first") == of_the_first and (order + flips) % 2 == 0 else "nightly"


@case(
    claim="Faces of a side may lie in any order, and their bodies may name and run their directions in any way.",
    tier=tier_of_way,
    grid={"way": tuple(range(24)), "turned": ("first", "last")},
    bounds={
        "positions": Bound(at_most=1e-9, reason="theory: the same functions on the same unknowns; lengths are 1, and tolerances are left"),
        "forces": Bound(at_most=1e-8, reason="theory: the same functions on the same unknowns"),
    },
)
def any_orientation_of_tiles(way: int, turned: str) -> dict[str, float]:
    """Distances of positions and forces from those of tiles that are all named alike.

    The first one gives the side its coordinates. Closest points on C0 lines take their slips from the side with the lower coordinates,
    on one patch as on several: with these the first one stays as it is.
    """
    tile, projection = {"first": ("a", "averaged"), "last": ("d", "closest")}[turned]
    right, expected = alike(projection)
    other = oriented(right, tile, *orientations()[way])
    (contact,) = other.contacts
    assert isinstance(contact.master, Face)
    if way % 2:
        first, *others = contact.master.faces if turned == "last" else contact.master.faces[::-1]
        other = replace(other, contacts=(replace(contact, master=Faces(first.body, first.face, tuple(others[::-1]))),))
    found = solved(other)
    return {
        "positions": float(np.abs(positions(right, expected) - positions(other, found)).max()),
        "forces": float(np.abs(forces(expected) - forces(found)).max() / np.abs(forces(expected)).max()),
    }


@case(
    claim="Below each control point of a side of tiles lies the one opposite it in its body, whichever way that runs its directions.",
    tier="gate",
    grid={"turned": ("a", "d")},
    bounds={
        "away": Bound(at_most=0.0, reason="definition: a turned body has the same control points"),
        "thickness": Bound(at_least=0.4, at_most=0.4, reason="definition: that of the tiles"),
    },
)
def bodies_of_tiles(turned: str) -> dict[str, float]:
    """Largest distance from what is below tiles that are all named alike, over all ways of one of them."""
    right = tiled(2, 2)
    expected = through(right)
    found = [through(oriented(right, turned, *way)) for way in orientations()]
    return {
        "away": float(np.max([np.abs(pairs - expected).max() for pairs in found])),
        "thickness": float(np.abs(expected[:, 0] - expected[:, 1]).max()),
    }


def through(problem: Problem) -> FloatArray:
    """Control points of the master's side and those opposite, in the order of their places on the side, shape (n, 2, 3)."""
    (contact,) = problem.contacts
    assert isinstance(contact.master, Face)
    sheet = Sheet.of(problem, contact.master)
    layers = sheet.patch.control_points.reshape(2, -1, 3)
    own = int(sheet.face[1])
    order = np.lexsort(np.round(layers[own], 9).T)
    return np.stack([layers[own][order], layers[1 - own][order]], axis=1)


@case(
    claim="A slave goes over the joint of two patches as over the C0 line of one: in the same iterations, without a cut.",
    tier=lambda family, order, projection: "gate" if ((family == "L") + (projection == "averaged") + order) % 2 else "nightly",
    grid={"family": ("N", "L"), "order": (1, 2, 3), "projection": ("closest", "averaged")},
    bounds={
        "cuts": Bound(at_most=0.0, reason="definition: no load step is cut"),
        "iterations": Bound(at_most=0.0, reason="theory: the same functions on the same unknowns"),
        "across": Bound(at_least=10.0, reason="definition: feet go over the joint, or nothing is tested"),
    },
)
def over_a_joint(family: str, order: int, projection: str) -> dict[str, float]:
    """Cuts; difference of iterations; feet that lie on the other patch at the end."""
    several = tiled(2, 1, "master", family, order, projection, 2, 5)
    one, other = solved(several), solved(untiled(several))
    states = [result.state.contacts[0] for result in (one[0], one[-1])]
    joint = np.unique(several.body("a").patch.directions[0].knots)[-1]
    sides = [state.projection[:, 0] > joint for state in states]
    both = (states[0].projected > 0) & (states[1].projected > 0)
    return {
        "cuts": float(sum(result.cuts for result in one)),
        "iterations": float(abs(_iterations(one) - _iterations(other))),
        "across": float(np.count_nonzero(both & (sides[0] != sides[1]))),
    }


def _iterations(results: list[StepResult]) -> int:
    return sum(len(augmentation.iterations) for result in results for augmentation in result.augmentations)


@case(
    claim="Beside a patch that is smooth where the tiles meet, a side of several patches is within the error of the mesh.",
    tier="nightly",
    grid={"order": (2, 3), "projection": ("closest", "averaged")},
    bounds={
        "share": Bound(at_most=1.0, reason="theory: functions of the smooth patch are among those of the tiles; meshes are as fine"),
        "error": Bound(at_least=1e-4, reason="definition: a mesh without an error tells nothing"),
    },
)
def beside_a_smooth_patch(order: int, projection: str) -> dict[str, float]:
    """Distance of forces from those on one smooth patch, over what refining that changes; what it changes, of the largest force."""
    several = tiled(2, 1, "master", "N", order, projection)
    single = untiled(several)
    points = single.body("a").patch.control_points
    found = [forces(solved(several))]
    for parts in (1, 3):
        patch = mesh(box(points.min(axis=0), points.max(axis=0)), ("N", "N", "N"), (order, order, 1), (2 * parts, 2 * parts, 1))
        smooth = replace(single, bodies=tuple(replace(b, patch=patch) if b.name == "a" else b for b in single.bodies))
        found.append(forces(solved(smooth)))
    error = np.linalg.norm(found[1] - found[2])
    return {"share": float(np.linalg.norm(found[0] - found[1]) / error), "error": float(error / np.abs(found[2]).max())}
