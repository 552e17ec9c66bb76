"""Feet on the line of a ridge between hollow faces: they slip only below these faces' centres of curvature."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar import _bindings
from isomortar._bindings import Projections, SlaveArrays
from isomortar._codes import Status
from isomortar.harness import Bound, case
from isomortar.model.numbering import Numbering
from isomortar.model.pairs import Pair
from isomortar.scene import Scene

#: A ridge along y, z = 2 x^2 - 0.8 |x|: distances from a point above it have no second derivative along x where its height is that.
CENTRE = (1.0 + 0.8**2) / 4.0
SCENE = """
format = 1
bodies.hills.geometry = { kind = "box", lower = [-1, -1, -1], upper = [1, 1, 0] }
bodies.hills.mesh = { family = "L", order = 2, elements = [2, 2, 1] }
bodies.block.geometry = { kind = "box", lower = [-1, -1, 1], upper = [1, 1, 2] }
contacts.top = { slave = "block.w0", master = "hills.w1", projection = "closest", friction = 0.3 }
supports = { under.face = "hills.w0", top.face = "block.w1" }
stages = [{ name = "down", steps = 1 }]
"""


def feet(points: np.ndarray, along: int, oblique: float) -> Projections:
    """Of points above the ridge, on a master whose coordinate across it is number `along`, and runs off its way by a slope."""
    problem = Scene.from_toml(SCENE).problem()
    hills = problem.body("hills")
    places = hills.patch.control_points.copy()
    top, across = hills.patch.face_points("w1"), places[:, along].copy()
    places[top, 2] = 2.0 * across[top] ** 2 - 0.8 * np.abs(across[top])
    places[:, 1 - along] += oblique * across
    bodies = (replace(hills, patch=replace(hills.patch, control_points=places)), problem.body("block"))
    problem = replace(problem, bodies=bodies)
    numbering = Numbering(problem)
    count, given = len(points), len(numbering.reference)
    slave = SlaveArrays.of_points(np.arange(given, given + count, dtype=np.int32))
    everywhere = np.concatenate([numbering.reference, points])
    master = Pair(problem.contacts[0], problem, numbering).master
    return _bindings.project_points(slave, master, everywhere, np.zeros((count, 2)), np.zeros(count, dtype=np.int32))


@case(
    claim="A foot on a C0 line is told to have no slip from the centre of curvature of the face beside it on, and not before.",
    tier="gate",
    grid={"along": (0, 1), "oblique": (0.0, 0.7)},
    bounds={
        "on the line": Bound(0.0, 0.0, "definition: feet that are not on the ridge, or not found"),
        "wrong": Bound(0.0, 0.0, "theory: feet with another doubt than none below that centre, or than that they cannot slip above it"),
    },
)
def no_slip(along: int, oblique: float) -> dict[str, float]:
    """How many of forty at heights on either side of the centre, as near as a millionth of its own."""
    heights = CENTRE * np.array([0.1, 0.7, 1.0 - 1e-6, 1.0 + 1e-6, 1.1])
    ways = np.linspace(-0.7, 0.7, 8)
    points = np.zeros((len(heights) * len(ways), 3))
    points[:, 1 - along], points[:, 2] = np.tile(ways, len(heights)), np.repeat(heights, len(ways))
    found = feet(points, along, oblique)
    expected = np.where(points[:, 2] > CENTRE, int(Status.NO_SLIP), 0)
    return {
        "on the line": float(np.count_nonzero((found.found == 0) | (found.fixed[:, along] == 0))),
        "wrong": float(np.count_nonzero(found.doubt != expected)),
    }
