"""Friction beside supports on adjoining faces: halves and quarters of symmetric bodies against the whole ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from small_scenes import TIGHT

from isomortar.geometry.patch import FloatArray, Patch
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.harness.cases import Tier
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Body, Contact, Enforcement, Face, Material, Motion, Problem, RigidPlane, Stage, Support
from isomortar.model.settings import SolverSettings
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: Half lengths of the whole block, its height, and elements along the half lengths.
HALF, HEIGHT, ELEMENTS = (0.5, 0.4), 0.5, (3, 2)
#: Softer penalties than the default: each augmentation then takes fewer tangents.
SOFTLY = {"penalty_normal": 20.0, "penalty_tangential": 2.0, "augmentation_tolerance": 1e-11, "max_augmentations": 400}
#: The plane's first coordinate: along an edge of the block, and along none.
PLANES = {"along an edge": (1.0, 0.0, 0.0), "oblique": (0.8, 0.6, 0.0)}
#: A bowl that is pressed into a block and slides along it; C0 lines between all elements, and with them in the planes of symmetry.
CURVED = """
format = 1
[bodies.bowl]
geometry = {{ kind = "bowl", centre = [0.0, 0.0], half_width = 0.4, bottom = 0.0, rise = 0.15, top = 0.5 }}
mesh = {{ family = "L", order = {order}, elements = [4, 4, 2] }}
[bodies.base]
geometry = {{ kind = "box", lower = [-0.8, -0.6, -0.5], upper = [0.8, 0.6, -0.001] }}
mesh = {{ family = "L", order = {order}, elements = [4, 6, 2] }}
[contacts.between]
slave = "bowl.w0"
master = "base.w1"
friction = 0.3
projection = "{projection}"
[supports]
top.face = "bowl.w1"
under.face = "base.w0"
[solver]
newton_tolerance = 1e-12
complementarity_tolerance = 1e-12
[[stages]]
name = "press"
steps = 2
motions.top.translate = [0, 0, -0.06]
[[stages]]
name = "slide"
steps = 2
motions.top.translate = [0.03, 0, 0]
"""
#: Symmetry planes, by the direction across them, and the motion of the second stage.
PARTS = {"quarter": ((0, 1), (0.0, 0.0, -0.02)), "half": ((0,), (0.0, 0.1, 0.0))}
_SOLVER = {"monolithic": "Newton's method stops at 1e-12", "uzawa": "augmentations end at relative changes of 1e-11 that halve each time"}


def block(symmetric: tuple[int, ...], half: tuple[float, float] = HALF, heights: tuple[float, float] = (0.0, HEIGHT)) -> Patch:
    """A block, cut in the directions `symmetric`; the whole one has a C0 line where it is cut."""
    lower = [0.0 if k in symmetric else -half[k] for k in range(2)]
    halves = [1 if k in symmetric else 2 for k in range(2)]
    coarse = mesh(box((lower[0], lower[1], heights[0]), (*half, heights[1])), ("N",) * 3, (1, 1, 1), (halves[0], halves[1], 1))
    return mesh(coarse, ("N",) * 3, (2, 2, 2), (halves[0] * ELEMENTS[0], halves[1] * ELEMENTS[1], 2))


def solved(
    symmetric: tuple[int, ...], push: tuple[float, float, float], plane: str, method: str, enforcement: Enforcement = "mortar"
) -> list[StepResult]:
    """The block pressed on a rigid plane, then pushed."""
    still = (Motion(), Motion())
    planes = [Support(f"symmetry {'xy'[k]}", Face("block", f"{'uv'[k]}0"), still, components=(k,)) for k in symmetric]
    settings = {**TIGHT, "method": method, **(SOFTLY if method == "uzawa" else {})}
    base = Contact("base", Face("block", "w0"), RigidPlane((0, 0, 0), (0, 0, 1), PLANES[plane]), 0.2, (6, 6))
    problem = Problem(
        name="symmetric-block",
        bodies=(Body("block", block(symmetric), Material(), (4, 4, 4)),),
        contacts=(replace(base, enforcement=enforcement),),
        supports=(Support("top", Face("block", "w1"), (Motion((0.0, 0.0, -0.04)), Motion(push))), *planes),
        stages=(Stage("press", 1), Stage("push", 1)),
        settings=SolverSettings(**settings),  # type: ignore[arg-type]
    )
    return list(Simulation(problem).run())


def at_the_same_places(whole: FloatArray, part: FloatArray) -> FloatArray:
    """Numbers of the whole block's control points, by where they stand, for those of a part of it."""
    return np.array([np.argmin(np.linalg.norm(whole - point, axis=1)) for point in part])


def tier(part: str, plane: str, method: str) -> Tier:
    """The gate has half of the products: every two settings in every choice."""
    others = (part == "half", plane == "oblique", method == "uzawa")
    return "gate" if sum(others) % 2 else "nightly"


@case(
    claim="With friction, a half or a quarter of a symmetric body on a rigid plane is that of the whole body.",
    tier=tier,
    grid={"part": tuple(PARTS), "plane": tuple(PLANES), "method": ("monolithic", "uzawa")},
    bounds=lambda part, plane, method: {  # noqa: ARG005
        "force": Bound(at_most=1e-9, reason=f"theory: the same equations by symmetry; {_SOLVER[method]}"),
        "positions": Bound(at_most=1e-9, reason=f"theory: the same equations by symmetry; {_SOLVER[method]}"),
        "mixed": Bound(at_least=1.0, reason="definition: points stick and slip at once in some load step"),
    },
)
def part_of_whole(part: str, plane: str, method: str) -> dict[str, float]:
    """Relative error of the pressing and pushing force, largest distance of control points, and load steps with stick and slip."""
    return apart(part, plane, method)


def apart(part: str, plane: str, method: str, enforcement: Enforcement = "mortar") -> dict[str, float]:
    """Those errors, however contact is enforced."""
    symmetric, push = PARTS[part]
    parts, wholes = (solved(cut, push, plane, method, enforcement) for cut in (symmetric, ()))
    force = positions = 0.0
    for mine, all_ in zip(parts, wholes, strict=True):
        expected = all_.reactions[0].force / 2 ** len(symmetric)
        along = [k for k in range(3) if k not in symmetric]
        force = float(np.maximum(force, np.linalg.norm((mine.reactions[0].force - expected)[along]) / np.linalg.norm(expected)))
    places = at_the_same_places(block(()).control_points, block(symmetric).control_points)
    for mine, all_ in zip(parts, wholes, strict=True):
        positions = float(np.maximum(positions, np.abs(mine.state.positions - all_.state.positions[places]).max()))
    mixed = [0 < result.contacts[0].slip < result.contacts[0].active for result in parts]
    return {"force": force, "positions": positions, "mixed": float(sum(mixed))}


def pair(symmetric: tuple[int, ...]) -> list[StepResult]:
    """The block pressed on a wider one that deforms, both cut by the same planes."""
    blocks = {"upper": block(symmetric), "lower": block(symmetric, (0.9, 0.8), (-HEIGHT, 0.0))}
    planes = [Support(f"{name} {'xy'[k]}", Face(name, f"{'uv'[k]}0"), (Motion(),), components=(k,)) for k in symmetric for name in blocks]
    ends = (Support("top", Face("upper", "w1"), (Motion((0.0, 0.0, -0.04)),)), Support("floor", Face("lower", "w0"), (Motion(),)))
    problem = Problem(
        name="symmetric-blocks",
        bodies=tuple(Body(name, patch, Material(), (4, 4, 4)) for name, patch in blocks.items()),
        contacts=(Contact("base", Face("upper", "w0"), Face("lower", "w1"), 0.2, (6, 6)),),
        supports=(*ends, *planes),
        stages=(Stage("press", 2),),
        settings=SolverSettings(newton_tolerance=1e-11, complementarity_tolerance=1e-11),
    )
    return list(Simulation(problem).run())


@case(
    claim="With friction, a quarter of two symmetric bodies that deform is that of the whole ones.",
    tier="gate",
    bounds={
        "force": Bound(at_most=1e-9, reason="theory: the same equations by symmetry; Newton's method stops at 1e-11"),
        "mixed": Bound(at_least=1.0, reason="definition: points stick and slip at once in some load step"),
    },
)
def part_of_pair() -> dict[str, float]:
    """Relative error of the pressing force, and load steps with stick and slip."""
    parts, wholes = pair((0, 1)), pair(())
    apart = [4.0 * mine.reactions[0].force[2] / whole.reactions[0].force[2] - 1.0 for mine, whole in zip(parts, wholes, strict=True)]
    mixed = [0 < result.contacts[0].slip < result.contacts[0].active for result in parts]
    return {"force": float(np.abs(apart).max()), "mixed": float(sum(mixed))}


@case(
    claim="With friction, half of two symmetric curved bodies that deform is that of the whole ones, whose functions are halved with them.",
    tier=lambda projection, order: "gate" if (projection, order) in (("closest", 1), ("averaged", 2)) else "nightly",
    grid={"projection": ("closest", "averaged"), "order": (1, 2)},
    bounds={
        "forces": Bound(at_most=1e-9, reason="theory: the same equations by symmetry; Newton's method stops at 1e-12"),
        "sliding": Bound(at_least=1.0, reason="definition: points slip in some load step"),
    },
)
def half_of_curved_pair(projection: str, order: int) -> dict[str, float]:
    """Relative error of the forces of all load steps, and load steps with slip."""
    return half_of_whole(CURVED.format(projection=projection, order=[order] * 3))


@case(
    claim="With constraints at points too, those between elements and in the plane of symmetry among them.",
    tier="nightly",
    grid={"enforcement": ("greville", "knots"), "order": (1, 2)},
    bounds={
        "forces": Bound(at_most=1e-9, reason="theory: the same equations by symmetry; Newton's method stops at 1e-12"),
        "sliding": Bound(at_least=1.0, reason="definition: points slip in some load step"),
    },
)
def half_of_pair_at_points(enforcement: str, order: int) -> dict[str, float]:
    """The same along averaged normals: at closest points of kinked masters such constraints come and go, and few runs end."""
    text = CURVED.format(projection="averaged", order=[order, order, 2])
    return half_of_whole(text, [f"contacts.between.enforcement={enforcement}"])


@case(
    claim="Half of two symmetric bodies is that of the whole by the default projection too, where the master's only kink is in the plane.",
    tier=lambda family: "gate" if family == "N" else "nightly",
    grid={"family": ("N", "L")},
    bounds={
        "forces": Bound(at_most=1e-9, reason="theory: the same equations by symmetry; Newton's method stops at 1e-12"),
        "sliding": Bound(at_least=1.0, reason="definition: points slip in some load step"),
    },
)
def half_of_only_kink(family: str) -> dict[str, float]:
    """The same of a master with two elements across the plane, linear splines or quadratic Lagrange ones."""
    text = CURVED.replace('projection = "{projection}"\n', "").format(order=[1 if family == "N" else 2] * 3)
    return half_of_whole(text, [f"bodies.base.mesh.family={[family] * 3}", "bodies.base.mesh.elements=[1, 2, 1]"])


#: The base of `CURVED`, with u and v the other way round: planes of symmetry are at the ends of its coordinates.
_BACKWARDS = """{ order = [1, 1, 1], knots = [[0, 0, 1, 1], [0, 0, 1, 1], [0, 0, 1, 1]], control_points = [
    [0.8, 0.6, -0.5], [-0.8, 0.6, -0.5], [0.8, -0.6, -0.5], [-0.8, -0.6, -0.5],
    [0.8, 0.6, -0.001], [-0.8, 0.6, -0.001], [0.8, -0.6, -0.001], [-0.8, -0.6, -0.001]] }"""


@case(
    claim="Half of two symmetric bodies is that of the whole along averaged normals, at whichever end of its master the plane is.",
    tier="gate",
    grid={"plane": ("at the start", "at the end")},
    bounds={
        "forces": Bound(at_most=1e-9, reason="theory: the same equations by symmetry; Newton's method stops at 1e-12"),
        "works": Bound(at_most=1e-9, reason="theory: as above, of friction, and of pressures along averaged normals, which is far less"),
        "sliding": Bound(at_least=1.0, reason="definition: points slip in some load step"),
    },
)
def half_at_an_end(plane: str) -> dict[str, float]:
    """The same of a master that has one element from the plane to its edge, and the relative error of the works of contact."""
    text = CURVED.format(projection="averaged", order=[1] * 3).replace("elements = [4, 6, 2]", "elements = [4, 2, 2]")
    box = 'geometry = { kind = "box", lower = [-0.8, -0.6, -0.5], upper = [0.8, 0.6, -0.001] }'
    assert box in text, "the base is a box"
    halves, wholes = both(text.replace(box, f"patch = {_BACKWARDS}") if plane == "at the end" else text)
    half, whole = (np.array([result.contacts[0].work for result in results]) for results in (halves, wholes))
    return off(halves, wholes) | {"works": float((np.abs(half - whole).max(axis=0) / np.abs(whole).max(axis=0)).max())}


def half_of_whole(text: str, overrides: Sequence[str] = ()) -> dict[str, float]:
    """Half of a scene against the whole: relative error of the forces of all load steps, and load steps with slip."""
    return off(*both(text, overrides))


def both(text: str, overrides: Sequence[str] = ()) -> tuple[list[StepResult], list[StepResult]]:
    """Load steps of half of a scene, and of the whole."""
    half, whole = (Scene.from_toml(text, overrides=[*overrides, *cut]).problem() for cut in (["symmetry={y=0.0}"], []))
    return list(Simulation(half).run()), list(Simulation(whole).run())


def off(halves: Sequence[StepResult], wholes: Sequence[StepResult]) -> dict[str, float]:
    """Relative error of forces, and load steps with slip."""
    half, whole = (np.array([result.reactions[0].force for result in results]) for results in (halves, wholes))
    sliding = [result.contacts[0].slip > 0 for result in halves]
    return {"forces": float(np.abs(half - whole).max() / np.abs(whole).max()), "sliding": float(sum(sliding))}
