"""What a body comes to rest on: a rough one turns about its lowest point, and then about two, to sides in closed form (theory 6.8)."""

from __future__ import annotations

import numpy as np
import pytest

from isomortar.geometry.patch import FloatArray
from isomortar.model.constants import NO_PART
from isomortar.solve.resting import Foothold, RatesOfPair, rested

#: Where the resultant of the loads acts: above the lowest point, which is the origin.
CENTRE = np.array([0.0, 0.0, 0.7])
#: Loads straight down, and to sides along and across the rows of points, and between them.
FORCES = [(0.0, 0.0), (0.1, 0.0), (-0.1, 0.0), (0.0, 0.3), (0.02, 0.05), (-0.07, 0.03)]


def some_points(random: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Points on a plane, the lowest one first, and how much farther others are; of some that may not begin, infinitely."""
    x, y = np.meshgrid(np.arange(-2, 3), np.arange(-2, 3))
    points = 0.25 * np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    points = points[np.argsort(np.linalg.norm(points, axis=1), kind="stable")]
    beyond = random.permutation(np.arange(len(points))) * 0.01 + 0.01
    beyond[random.choice(np.arange(1, len(points)), 4, replace=False)] = np.inf
    beyond[0] = 0.0
    return points, beyond


def three(points: FloatArray, beyond: FloatArray, force: FloatArray) -> list[int]:
    """The lowest point, the nearest one on the side that a body turns to about it, and that on the side it turns to about both."""
    torque = np.cross(CENTRE, force)
    least, found = NO_PART * np.abs([*force, *torque]).max(), [0]
    for pivot in (True, False):
        axis = points[found[-1]] / (np.linalg.norm(points[found[-1]]) or 1.0)
        turn = torque if pivot else (torque @ axis) * axis
        size = np.abs(turn).max()
        closing = -np.cross(turn, points)[:, 2] / (size or 1.0)
        if size <= least:  # to any side
            closing = np.linalg.norm(points if pivot else np.cross(axis, points), axis=1)
        found.append(int(np.argmin(np.where((closing > 1e-3) & (np.arange(len(points)) != 0), beyond, np.inf))))
    return sorted(found)


def foothold(points: FloatArray, beyond: FloatArray) -> Foothold:
    """That of a rough plane below points of a rigid body, whose motions are along the axes and about them."""
    motions = np.concatenate([np.tile(np.eye(3)[:, None], (1, len(points), 1)), np.cross(np.eye(3)[:, None], points)])
    rates = RatesOfPair(None, -motions[..., 2].T, np.moveaxis(motions[..., :2], 0, -1))  # type: ignore[arg-type]  nothing reads it
    return Foothold(beyond == 0.0, beyond, rates)


@pytest.mark.parametrize("size", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("aside", FORCES)
def test_a_body_turns_to_the_side_that_its_load_turns_it_to(aside: tuple[float, float], size: float) -> None:
    """In any unit of force, whatever round-off its work has, and in whatever order, and of how many contacts, its points are."""
    random = np.random.default_rng(61)
    for _ in range(12):
        points, beyond = some_points(random)
        force = size * np.array([*aside, -1.0])
        works = np.concatenate([force, np.cross(CENTRE, force)])
        works += 1e-10 * size * random.uniform(-1.0, 1.0, 6)
        order = random.permutation(len(points))
        parts = np.split(order, [random.integers(1, len(points) - 1)])
        near = rested([foothold(points[part], beyond[part]) for part in parts], works)
        assert sorted(order[np.concatenate(near)].tolist()) == three(points, beyond, force)
