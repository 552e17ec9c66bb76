"""Bodies that can not be: folded ones, rigid or not, and rings that do not close, are refused by name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.patch import Patch
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene

SCENE = """
format = 1
bodies.slave = { geometry = { kind = "box", lower = [-0.2, -0.2, 0], upper = [0.2, 0.2, 0.3] }, mesh = { order = 2, elements = 2 } }
bodies.master = { geometry = { kind = "box", lower = [-1, -1, -1], upper = [1, 1, 0] }, mesh = { order = 2, elements = 2 } }
bodies.wheel = { geometry = { kind = "ring", centre = [0, 5, 0], inner = 0.2, outer = 0.4, width = 0.3 } }
contacts.interface = { slave = "slave.w0", master = "master.w1", friction = 0 }
supports = { top.face = "slave.w1", rim.face = "wheel.v0", floor.face = "master.w0" }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.01] }]
"""


def folded(patch: Patch) -> Patch:
    """The patch with its middle moved beyond its face."""
    points = patch.control_points.copy()
    middle = np.argmin(np.linalg.norm(points - points.mean(axis=0), axis=1))
    points[middle] += 3.0 * np.ptp(points, axis=0)
    return replace(patch, control_points=points)


def opened(patch: Patch, share: float) -> Patch:
    """The ring with a gap at its seam, or heavier points there."""
    points, weights, end = patch.control_points.copy(), patch.weights.copy(), patch.face_points("u1")
    points[end] += share
    weights[end] *= 1.0 if share else 1.01
    return replace(patch, control_points=points, weights=weights)


def with_body(problem: Problem, name: str, **changes: object) -> Problem:
    """The problem with a body that differs."""
    bodies = tuple(replace(body, **changes) if body.name == name else body for body in problem.bodies)  # type: ignore[arg-type]
    return replace(problem, bodies=bodies)


@case(
    claim="A body that is folded is refused by its name, a rigid one as well, and so is a ring whose ends are apart, or of other weights.",
    tier="gate",
    bounds={"silent": Bound(0.0, 0.0, "definition: those that are taken, or of which something else is said")},
)
def no_body() -> dict[str, float]:
    """How many."""
    problem = Scene.from_toml(SCENE).problem()
    master, wheel = problem.body("master"), problem.body("wheel")
    mistakes = [(with_body(problem, "master", patch=folded(master.patch), rigid=rigid), "master", "folded") for rigid in (False, True)]
    mistakes += [(with_body(problem, "wheel", patch=opened(wheel.patch, share)), "wheel", "but the first and last") for share in (0.1, 0.0)]
    silent = 0
    for mistaken, name, words in mistakes:
        try:
            Simulation(mistaken)
            silent += 1
        except InputError as error:
            silent += not (words in str(error) and name in str(error))
    Simulation(problem)
    Simulation(with_body(problem, "master", rigid=True))
    return {"silent": float(silent)}


#: A block of elements of which no two directions have as many.
_BLOCK = SCENE.replace(
    "upper = [1, 1, 0] }, mesh = { order = 2, elements = 2 }", "upper = [1, 1, 0] }, mesh = { order = 1, elements = [3, 4, 2] }"
)


@case(
    claim="Of a body one element of which is folded it is said which one, by its places along u, v, w.",
    tier="gate",
    bounds={"elsewhere": Bound(0.0, 0.0, "definition: elements at the corners of a block that are not named, or called otherwise")},
)
def which_place() -> dict[str, float]:
    """How many of eight."""
    problem = Scene.from_toml(_BLOCK).problem()
    patch, elsewhere = problem.body("master").patch, 0
    shape = np.array(patch.shape)
    for corner in np.ndindex(2, 2, 2):
        ends = np.array(corner) * (shape - 1)
        inner = ends + 1 - 2 * np.array(corner)
        points = patch.control_points.copy()
        own, other = (place @ [1, shape[0], shape[0] * shape[1]] for place in (ends, inner))
        points[own] = 1.5 * points[other] - 0.5 * points[own]
        words = ", ".join(str(k) for k in np.array(corner) * (shape - 2))
        try:
            Simulation(with_body(problem, "master", patch=replace(patch, control_points=points)))
            elsewhere += 1
        except InputError as error:
            elsewhere += f"(element {words} along u, v, w)" not in str(error)
    return {"elsewhere": float(elsewhere)}
