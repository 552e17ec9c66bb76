"""How deep bodies overlap before anything moves, and what the slave would have to pass through: the thinner body, where that is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar.harness import Bound, case
from isomortar.model.entities import Problem
from isomortar.model.stance import stance
from isomortar.scene import Scene

#: Two blocks, which are given other heights at their ends by moving control points.
SCENE = """
format = 1
bodies.upper = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = 1 } }
bodies.lower = { geometry = { kind = "box", lower = [0, 0, -1], upper = [1, 1, 0] }, mesh = { order = 1 } }
contacts.c = { slave = "upper.w0", master = "lower.w1" }
supports = { top.face = "upper.w1", below.face = "lower.w0" }
stages = [{ name = "press", steps = 1 }]
"""
#: Heights of the upper and lower face of both bodies at x = 0 and 1: the upper body's first.
Heights = tuple[tuple[float, float], tuple[float, float], tuple[float, float], tuple[float, float]]
#: The same with the largest depth, and the thickness of the thinner body there.
STANDING: tuple[tuple[Heights, float, float], ...] = (
    (((0, 0), (1, 1), (-1, -1), (0.1, 0.1)), 0.1, 1.0),
    (((0, 0), (1, 1), (-0.2, -0.2), (0.1, 0.1)), 0.1, 0.3),
    (((0, 0), (0.3, 0.3), (-1, -1), (0.1, 0.1)), 0.1, 0.3),
    (((0, 0), (0.3, 1.0), (-1, -1), (0.1, 0.0)), 0.1, 0.3),
    (((0, 0), (0.3, 1.0), (-1, -1), (0.0, 0.1)), 0.1, 1.0),
    (((0, 0), (1, 1), (-0.2, -0.7), (0.1, 0.0)), 0.1, 0.3),
    (((0, 0), (1, 1), (-0.2, -0.7), (0.0, 0.1)), 0.1, 0.8),
    (((0.2, 0.2), (1, 1), (-1, -1), (0, 0)), 0.0, np.nan),
)


def standing(heights: Heights) -> Problem:
    """The blocks with other heights."""
    problem = Scene.from_toml(SCENE).problem()
    bodies = []
    for body, levels in zip(problem.bodies, (heights[:2], heights[2:]), strict=True):
        points = body.patch.control_points.copy()
        for face, (first, second) in zip(("w0", "w1"), levels, strict=True):
            numbers = body.patch.face_points(face)
            points[numbers, 2] = np.where(points[numbers, 0] < 0.5, first, second)
        bodies.append(replace(body, patch=replace(body.patch, control_points=points)))
    return replace(problem, bodies=tuple(bodies))


@case(
    claim="Bodies overlap by how deep the slave is where it is deepest, and the thinner one of both is as thick as it is there.",
    tier="gate",
    bounds={
        "depth": Bound(at_most=2e-3, reason="discretisation: middles of 48 cells along x"),
        "thickness": Bound(at_most=2e-2, reason="discretisation: as above"),
    },
)
def overlapping() -> dict[str, float]:
    """Largest differences of depths and thicknesses, of eight pairs."""
    off = np.zeros(2)
    for heights, depth, thickness in STANDING:
        problem = standing(heights)
        found = stance(problem, problem.contacts[0])
        off = np.maximum(off, [abs(found.depth - depth), abs(found.thickness - thickness) if depth > 0.0 else 0.0])
    return {"depth": float(off[0]), "thickness": float(off[1])}
