"""Bodies that are glued beside the one body that they are: a block cut in two, and the block with a C0 line where they meet."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
from small_scenes import TIGHT
from transforms import orientations, oriented

from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.harness import Bound, case
from isomortar.harness.cases import Tier
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Body, Face, Problem
from isomortar.model.numbering import Numbering
from isomortar.results.fields import body_points
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: One half on the other, of different heights. The sides are held across, by a support each.
_HALVES = """
format = 1
materials.soft = {{ young = 8 }}
bodies.lower = {{ geometry = {{ kind = "box", lower = [0, 0, 0], upper = [1, 0.8, 0.3] }}, mesh = {mesh} }}
bodies.upper = {{ geometry = {{ kind = "box", lower = [0, 0, 0.3], upper = [1, 0.8, 0.7] }}, mesh = {mesh} }}
glue = [["lower.w1", "upper.w0"]]
supports.lower = {{ face = "lower.v0", components = ["y"], centre = [0.5, 0, 0.3] }}
supports.upper = {{ face = "upper.v0", components = ["y"], centre = [0.5, 0, 0.3] }}
{load}
"""
#: Bent by its ends; pressed and pushed onto a plane; and an upper half that nothing bears on, carried by the lower one.
_LOADS = {
    "bent": """
        supports.foot = { face = "lower.w0" }
        supports.head = { face = "upper.w1", components = ["x", "z"] }
        stages = [{ name = "bend", steps = 1, motions.head = { translate = [0.1, 0, -0.05], rotate = 0 } }]
    """,
    "pressed": """
        contacts.floor = { slave = "lower.w0", plane = { point = [0, 0, 0], normal = [0.02, 0, 1] }, friction = 0.2 }
        supports.head = { face = "upper.w1", components = ["x", "z"] }
        stages = [{ name = "press", steps = 1, motions.head.translate = [0.03, 0, -0.05] }]
    """,
    "carried": """
        supports.foot = { face = "lower.w0", components = ["x", "z"], axis = [0, 1, 0] }
        stages = [{ name = "turn", steps = 1, motions.foot = { translate = [0.2, 0, 0.1], rotate = 20 } }]
    """,
}
_SOFTLY = ("solver.penalty_normal=20", "solver.penalty_tangential=2", "solver.augmentation_tolerance=1e-4")


def halves(load: str, family: str, order: int, method: str) -> Problem:
    """The two halves, glued, of order by order by order elements, at tight tolerances."""
    mesh = f'{{ family = "{family}", order = {order}, elements = [2, 1, 1] }}'
    changes = [f"solver.method={method}", *(_SOFTLY if method == "uzawa" else ())]
    problem = Scene.from_toml(_HALVES.format(mesh=mesh, load=_LOADS[load]), overrides=changes).problem()
    return replace(problem, settings=replace(problem.settings, **TIGHT))  # type: ignore[arg-type]


def whole(problem: Problem) -> Problem:
    """The halves as one body, "lower", with a C0 line where they are glued."""
    lower, upper = problem.body("lower"), problem.body("upper")
    body = replace(lower, patch=chained(lower.patch, upper.patch, 2))
    supports = tuple(replace(support, place=Face("lower", support.place.face)) for support in problem.supports if support.name != "upper")
    return replace(problem, bodies=(body,), supports=supports, glue=())


def chained(one: Patch, other: Patch, axis: int) -> Patch:
    """Two patches, of which one goes on along a direction where the other ends, as one patch with a C0 line there."""
    u, v, w = (followed_by(d, other.directions[k]) if k == axis else d for k, d in enumerate(one.directions))
    grids = [np.column_stack([p.control_points, p.weights]).reshape((*p.shape, 4), order="F") for p in (one, other)]
    values = np.concatenate([grids[0], np.delete(grids[1], 0, axis)], axis=axis).reshape((-1, 4), order="F")
    return Patch((u, v, w), values[:, :3], values[:, 3])


def followed_by(one: Direction, other: Direction) -> Direction:
    """One direction after another one of its order and family, with a C0 line between them."""
    moved = other.knots - other.knots[0] + one.knots[-1]
    cut = (one.knots[:-1], moved[one.order + 1 :]) if one.family == "N" else (one.knots, moved[1:])
    return replace(one, knots=np.concatenate(cut))


def solved(problem: Problem) -> StepResult:
    """The end of the load step."""
    (result,) = Simulation(problem).run()
    return result


def positions(problem: Problem, result: StepResult) -> FloatArray:
    """Control points of the block, layer by layer, those of the joint once; the upper half in its own order of directions."""
    points = body_points(problem, result.state.positions)
    layer = int(np.prod(problem.body("lower").patch.shape[:2]))
    return np.concatenate([points["lower"], points["upper"][layer:]]) if "upper" in points else points["lower"]


def forces(result: StepResult, problem: Problem) -> FloatArray:
    """Forces and moments of the supports by name, those of the two sides together, shape (supports, 2, 3)."""
    found: dict[str, FloatArray] = {}
    for support, reaction in zip(problem.supports, result.reactions, strict=True):
        name = "side" if support.name in ("lower", "upper") else support.name
        found[name] = found.get(name, np.zeros((2, 3))) + np.stack([reaction.force, reaction.moment])
    return np.stack([found[name] for name in sorted(found)])


def iterations(result: StepResult) -> int:
    """Newton iterations of the load step."""
    return sum(len(augmentation.iterations) for augmentation in result.augmentations)


def tier(load: str, family: str, order: int, method: str) -> Tier:
    """The gate has half of the products: any three settings in every choice."""
    return "gate" if (tuple(_LOADS).index(load) + (family == "L") + order + (method == "uzawa")) % 2 else "nightly"


@case(
    claim="Two bodies that are glued deform as the one body that they are, with and without contact, by both solvers.",
    tier=tier,
    grid={
        "load": ("bent", "pressed", "carried"),
        "family": ("N", "L"),
        "order": (1, 2, 3),
        "method": ("monolithic", "uzawa"),
    },
    bounds={
        "positions": Bound(at_most=1e-11, reason="theory: the same unknowns and functions; lengths are 1, and round-off is left"),
        "forces": Bound(at_most=1e-9, reason="theory: of control points that both sides' supports hold each bears its part, once"),
        "pressures": Bound(at_most=1e-9, reason="theory: the same conditions on the same unknowns"),
        "unknowns": Bound(at_most=0.0, reason="definition: shared control points are counted once"),
        "iterations": Bound(at_most=0.0, reason="theory: residuals are measured against the forces of both, as those of one body"),
    },
)
def as_one_body(load: str, family: str, order: int, method: str) -> dict[str, float]:
    """Distances of positions, forces and pressures from those of the one body; differences of unknowns and iterations."""
    cut = halves(load, family, order, method)
    block = whole(cut)
    one, other = solved(cut), solved(block)
    borne = forces(other, block)
    pressures = [np.concatenate([c.pressure for c in r.state.contacts] or [np.ones(1)]) for r in (one, other)]
    return {
        "positions": float(np.abs(positions(cut, one) - positions(block, other)).max()),
        "forces": float(np.abs(forces(one, cut) - borne).max() / max(np.abs(borne).max(), 1.0)),
        "pressures": float(np.abs(pressures[0] - pressures[1]).max() / np.abs(pressures[1]).max()),
        "unknowns": float(abs(Numbering(cut).count - Numbering(block).count)),
        "iterations": float(abs(iterations(one) - iterations(other))),
    }


@functools.cache
def alike(family: str) -> tuple[Problem, StepResult]:
    """The bent block of two halves that are named alike, and its end: what one of every orientation is compared with."""
    cut = graded(halves("bent", family, 2, "monolithic"))
    return cut, solved(cut)


@case(
    claim="A glued body may name its directions in any order and run them either way.",
    tier="gate",
    grid={"way": tuple(range(24)), "family": ("N", "L")},
    bounds={
        "positions": Bound(at_most=1e-11, reason="theory: the same unknowns and functions under other numbers"),
        "unknowns": Bound(at_most=0.0, reason="definition: shared control points are counted once"),
    },
)
def any_orientation(way: int, family: str) -> dict[str, float]:
    """Distance of the bent block's control points from those of the block with both halves named alike; difference of unknowns."""
    order, axes = orientations()[way]
    cut, one = alike(family)
    turned = oriented(cut, "upper", order, axes)
    other = solved(turned)
    points = [body_points(problem, result.state.positions)["upper"] for problem, result in ((cut, one), (turned, other))]
    back = (
        np.lexsort(np.round(cut.body("upper").patch.control_points, 9).T),
        np.lexsort(np.round(turned.body("upper").patch.control_points, 9).T),
    )
    return {
        "positions": float(np.abs(points[0][back[0]] - points[1][back[1]]).max()),
        "unknowns": float(abs(Numbering(cut).count - Numbering(turned).count)),
    }


def graded(problem: Problem) -> Problem:
    """The problem with knots that run unevenly along u and v, and with rational functions where these are NURBS: no way is like another."""

    def uneven(direction: Direction) -> Direction:
        return replace(direction, knots=direction.knots + 0.3 * direction.knots**2)

    def changed(body: Body) -> Body:
        u, v, w = body.patch.directions
        points = body.patch.control_points
        weights = 1.0 + 0.2 * points[:, 0] + 0.1 * points[:, 1] ** 2 if u.family == "N" else body.patch.weights
        return replace(body, patch=Patch((uneven(u), uneven(v), w), points, weights))

    return replace(problem, bodies=tuple(changed(body) for body in problem.bodies))
