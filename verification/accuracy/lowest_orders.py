"""The lowest order that a scene can be computed with along a face in contact: that of its exact geometry there."""

from __future__ import annotations

import json
from itertools import permutations

import numpy as np

from isomortar.accuracy.discretisations import lowest_order, sweep_of
from isomortar.harness import Bound, case
from isomortar.scene import Scene

#: A cube given by its control points, over or beside a plane.
SCENE = """
format = 1
bodies.cube.patch = {{ order = {orders}, knots = {knots}, control_points = {points} }}
contacts.c = {{ slave = "cube.{letter}0", plane = {{ point = {far}, normal = {normal} }}, friction = 0 }}
supports.back.face = "cube.{letter}1"
stages = [{{ name = "stand", steps = 1 }}]
"""


def scene(orders: tuple[int, ...], axis: int) -> Scene:
    """With the cube in one element of some orders, and contact on a face across an axis."""
    places = np.meshgrid(*(np.linspace(0.0, 1.0, order + 1) for order in orders), indexing="ij")
    points = np.column_stack([place.ravel(order="F") for place in places]).tolist()
    knots = [[0.0] * (order + 1) + [1.0] * (order + 1) for order in orders]
    normal = np.eye(3)[axis]
    given = {"orders": list(orders), "knots": knots, "points": points, "far": (-0.1 * normal).tolist(), "normal": normal.tolist()}
    return Scene.from_toml(SCENE.format(letter="uvw"[axis], **{name: json.dumps(value) for name, value in given.items()}))


@case(
    claim="The lowest order of a reference is the larger one of the geometry's along the face in contact, and at least two.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: orders that are others, of cubes of any orders, on any face")},
)
def lowest_orders() -> dict[str, float]:
    """How many."""
    wrong = 0
    for orders in (*permutations((1, 2, 3)), *permutations((1, 1, 4)), (1, 1, 1)):
        for axis in range(3):
            along = [order for k, order in enumerate(orders) if k != axis]
            given, letters = scene(orders, axis), "uvw".replace("uvw"[axis], "")
            sweep = sweep_of(given)
            wrong += lowest_order(given, "cube", letters) != np.max(along)
            wrong += (sweep.body, sweep.directions, sweep.reference) != ("cube", letters, f"N{np.max([2, *along])}")
    return {"wrong": float(wrong)}
