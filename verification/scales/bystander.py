"""What touches nothing changes nothing, however stiff or soft it is and whatever it does; nor does a pair of another scale."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
from small_scenes import at_few_points, bowl
from transforms import scaled, vector

from isomortar.geometry.patch import FloatArray
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case
from isomortar.harness.cases import Tier
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Body, Face, Material, Motion, Problem, Support
from isomortar.solve.record import StepResult

METHODS = ("monolithic", "uzawa")
#: Moduli of a body that touches nothing, beside others of 10.
YOUNGS = (1e-11, 1e7, 1e13)

_TOLERANCE = "theory: the systems are separate; what is left is Newton's tolerance of 1e-12, amplified by the condition of control values"
BOUNDS = {
    "forces": Bound(at_most=1e-10, reason=_TOLERANCE),
    "pressures": Bound(at_most=1e-9, reason=_TOLERANCE),
    "tractions": Bound(at_most=1e-9, reason=_TOLERANCE),
}


def with_method(problem: Problem, method: str) -> Problem:
    """The problem solved by another method."""
    return replace(problem, settings=replace(problem.settings, method=method))  # type: ignore[arg-type]


def beside(problem: Problem, young: float, motion: Motion) -> Problem:
    """The problem with a block of another stiffness beside it, held below; its top moves in every stage."""
    patch = mesh(box((5.0, 0.0, 0.0), (6.0, 1.0, 1.0)), ("N", "N", "N"), (2, 2, 2), (2, 2, 2))
    held = Support("anvil-base", Face("anvil", "w0"), tuple(Motion() for _ in problem.stages))
    moved = Support("anvil-top", Face("anvil", "w1"), tuple(motion for _ in problem.stages))
    body = Body("anvil", patch, Material(young), (4, 4, 4))
    return replace(problem, bodies=(*problem.bodies, body), supports=(*problem.supports, held, moved))


def both(problem: Problem, length: float, stress: float) -> Problem:
    """The problem, and beside it the same once more in other units."""
    other = scaled(problem, length, stress)
    aside = np.array([10.0 * (1.0 + length), 0.0, 0.0])
    bodies = tuple(
        replace(body, name=f"other-{body.name}", patch=replace(body.patch, control_points=body.patch.control_points + aside))
        for body in other.bodies
    )
    contacts = tuple(
        replace(c, name=f"other-{c.name}", slave=_other(c.slave), master=_other(c.master))  # type: ignore[arg-type]
        for c in other.contacts
    )
    supports = tuple(
        replace(s, name=f"other-{s.name}", place=_other(s.place), centre=vector(np.array(s.centre) + aside)) for s in other.supports
    )
    return replace(problem, bodies=problem.bodies + bodies, contacts=problem.contacts + contacts, supports=problem.supports + supports)


def _other(face: Face) -> Face:
    return Face(f"other-{face.body}", face.face)


def load_steps(problem: Problem) -> list[StepResult]:
    """The problem's load steps."""
    return list(Simulation(problem).run())


@functools.cache
def alone(method: str) -> tuple[Problem, list[StepResult]]:
    """A bowl pressed on a block and turned, and its load steps: what it is compared with beside others."""
    problem = with_method(at_few_points(bowl("block")), method)
    return problem, load_steps(problem)


def measure(results: list[StepResult], pair: int, supports: slice) -> dict[str, FloatArray]:
    """Forces on some supports, pressures and traction norms of a pair; by load step."""
    return {
        "forces": np.array([[reaction.force for reaction in result.reactions[supports]] for result in results]),
        "pressures": np.array([result.state.contacts[pair].pressure for result in results]),
        "tractions": np.array([result.contacts[pair].traction_norm for result in results]),
    }


def apart(found: dict[str, FloatArray], right: dict[str, FloatArray]) -> dict[str, float]:
    """Largest difference of each quantity over its largest value."""
    return {name: float(np.abs(found[name] - value).max() / np.abs(value).max()) for name, value in right.items()}


def tier(method: str, young: float, does: str) -> Tier:
    """The gate has half of the products, every two settings in every choice, but for the longest."""
    others = (method == "uzawa", young == YOUNGS[1], does == "rests")
    return "nightly" if sum(others) % 2 or (method, does) == ("uzawa", "is crushed") else "gate"


@case(
    claim="A body that touches nothing changes no result, whether it rests, moves or is crushed, and however stiff or soft it is.",
    tier=tier,
    grid={"method": METHODS, "young": YOUNGS, "does": ("rests", "is crushed")},
    bounds=BOUNDS,
)
def stiffness(method: str, young: float, does: str) -> dict[str, float]:
    """A bowl pressed on a block and turned, with and without a third body."""
    problem, right = alone(method)
    motion = Motion() if does == "rests" else Motion((0.05, 0.0, -0.1))
    supports = slice(0, len(problem.supports))
    return apart(measure(load_steps(beside(problem, young, motion)), 0, supports), measure(right, 0, supports))


@case(
    claim="Two pairs in one scene, each with its own unit of length and of stress, have the results that each has alone.",
    tier=lambda method, stress: "gate" if method == "monolithic" else "nightly",  # noqa: ARG005
    grid={"method": METHODS, "stress": (1e-8, 1e8)},
    bounds=BOUNDS,
)
def pairs(method: str, stress: float) -> dict[str, float]:
    """The softer pair hides behind the stiffer one unless each is measured by itself."""
    length, (problem, single) = 0.1, alone(method)
    together, count = load_steps(both(problem, length, stress)), len(problem.supports)
    first = measure(together, 0, slice(0, count))
    second = measure(together, 1, slice(count, 2 * count))
    units = {"forces": stress * length**2, "pressures": stress, "tractions": stress}
    right = measure(single, 0, slice(0, count))
    own, other = apart(first, right), apart({name: value / units[name] for name, value in second.items()}, right)
    return {name: max(own[name], other[name]) for name in own}
