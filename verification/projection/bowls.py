"""Centres of curvature in oblique coordinates: whether a foot is the only one near does not depend on how a face is described."""

from __future__ import annotations

import numpy as np
from projection.closest_points import Surface

from isomortar.geometry.patch import Direction, Patch
from isomortar.harness import Bound, case


def bowl(shear: float, turn: float) -> Surface:
    """A bowl of curvatures 2 and 1 at its lowest point, the origin, where lines of coordinates meet at no right angle."""
    line, arc = Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0])), Direction("N", 2, np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0]))
    axes = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    along = np.array([[1.0, shear], [0.0, 1.0]])
    form = along.T @ axes.T @ np.diag([2.0, 1.0]) @ axes @ along
    place, square = np.array([-0.5, 0.0, 0.5]), np.array([0.25, -0.25, 0.25])  # Bezier points of u and of its square
    v, u = np.meshgrid(place, place, indexing="ij")
    height = 0.5 * (form[0, 0] * square[None, :] + form[1, 1] * square[:, None]) + form[0, 1] * u * v
    upper = np.concatenate([np.stack([u, v], axis=-1) @ along.T, height[..., None]], axis=-1).reshape(-1, 3)
    return Surface(Patch((arc, arc, line), np.concatenate([upper - [0.0, 0.0, 1.0], upper]), np.ones(18)), "w1")


@case(
    claim="The lowest point of a bowl is the foot of what is above it up to the centre of its larger curvature, in whatever coordinates.",
    grid={"shear": [0.0, 0.7, -1.5], "turn": [0.0, 0.4, 1.2]},
    bounds={
        "before": Bound(at_least=1.0, at_most=1.0, reason="definition: it is the only place so near"),
        "at the centre": Bound(at_most=0.0, reason="definition: along the larger curvature the distance is flat there"),
        "foot": Bound(at_most=4e-13, reason="round-off: of the place, over what is left of the distance's curvature, a thousandth"),
    },
)
def of_a_bowl(shear: float, turn: float) -> dict[str, float]:
    """Share followed before the centre of curvature and at it; largest distance of feet before it, from the lowest point."""
    face, at = bowl(shear, turn), np.full((1, 2), 0.5)
    *before, there = (face.project(np.array([[0.0, 0.0, 0.5 * share]]), at) for share in (0.5, 0.9, 0.999, 1.0))
    return {
        "before": float(np.mean([foot.followed for foot in before])),
        "at the centre": float(np.mean(there.followed)),
        "foot": float(np.max([np.linalg.norm(face.points(foot.xi)) for foot in before])),
    }
