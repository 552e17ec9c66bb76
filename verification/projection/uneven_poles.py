"""A pole where the orders along it and towards it differ: what presses beside it acts on the master at its foot."""

from __future__ import annotations

import numpy as np
from projection.closest_points import Surface
from projection.poles import INNER, OUTER, turned
from shapes import dome

from isomortar import _bindings
from isomortar._bindings import Response, SlaveArrays
from isomortar.geometry.refinement import mesh
from isomortar.harness import Bound, case

#: Angles from the pole, the pole itself last; the first are in elements that do not touch it.
OFF = np.array([0.9, 0.5, 0.2, 0.1, 1e-2, 1e-4, 1e-6, 0.0])
#: Orders towards the pole and round it.
ORDERS = ("2 3", "3 2", "2 4", "4 2")


@case(
    claim="Beside a pole and on it, at either end of either direction, the force of a pressure is along the sphere's normal, and that on "
    "the master is the opposite one, at the foot: with any orders towards the pole and round it.",
    tier="gate",
    grid={"way": ["high first", "low first", "high second", "low second"], "orders": list(ORDERS)},
    bounds={
        "foot": Bound(at_most=2e-14, reason="round-off: of the surface's points; Newton's method ends below it"),
        "force": Bound(at_most=1e-13, reason="round-off: of a direction, by points of the surface over the distance from it"),
        "balance": Bound(at_most=1e-14, reason="round-off: sums over the control points of an element"),
        "moment": Bound(at_most=1e-14, reason="round-off: the same, about the sphere's centre, which the force goes through"),
    },
)
def pressed_beside(way: str, orders: str) -> dict[str, float]:
    """Largest errors over single points at growing angles from the pole, outside the sphere."""
    towards, around = map(int, orders.split())
    patch = mesh(dome(INNER, OUTER, -0.3), ("N", "N", "N"), (towards, 1, around), (3, 1, 8))
    face = turned(Surface(patch, "v1", closed="w"), way)
    angle = 0.4 + np.arange(len(OFF))
    normals = np.column_stack([np.sin(OFF) * np.cos(angle), np.sin(OFF) * np.sin(angle), np.cos(OFF)])
    own, worst = len(face.patch.weights), np.zeros(4)
    for normal in normals:
        target = (OUTER + 0.2) * normal[None]
        feet = face.project(target)
        positions = np.ascontiguousarray(np.concatenate([face.patch.control_points, target]))
        slave, forces = SlaveArrays.of_points(np.array([own], dtype=np.int32)), np.zeros_like(positions)
        one, pair = np.ones(1), np.zeros((1, 2))
        response = Response(one, pair, np.ones(1, np.int32), one, np.zeros((1, 6, 2)), pair)
        _bindings.contact_forces(slave, face.master(), positions, feet, response, forces)
        found = (
            np.linalg.norm(face.points(feet.xi)[0] - OUTER * normal),
            np.linalg.norm(forces[own] + normal),
            np.linalg.norm(forces.sum(axis=0)),
            np.linalg.norm(np.cross(positions, forces).sum(axis=0)),
        )
        worst = np.maximum(worst, found)
    return dict(zip(("foot", "force", "balance", "moment"), map(float, worst), strict=True))
