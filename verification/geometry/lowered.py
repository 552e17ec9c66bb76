"""The direction of a lower order that a direction comes from by raising its order: found where there is one, else refused."""

from __future__ import annotations

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.elevation import elevated
from isomortar.geometry.patch import Direction, Family
from isomortar.harness import Bound, case
from isomortar.model.raised import lowered

#: Directions by their order and knots.
DIRECTIONS = (
    (1, [0.0, 0.0, 0.4, 1.0, 1.0]),
    (2, [0.0, 0.0, 0.0, 0.3, 0.3, 0.8, 1.0, 1.0, 1.0]),
    (3, [0.0, 0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 1.0]),
)
#: Family, order and knots of directions, and orders that they come from by raising none of.
REFUSED: tuple[tuple[Family, int, list[float], int], ...] = (
    ("N", 2, [0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0], 1),
    ("N", 3, [0.0, 0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.0, 1.0], 1),
    ("N", 3, [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0], 4),
    ("N", 3, [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0], 0),
    ("L", 2, [0.0, 1.0, 2.0], 1),
)


@case(
    claim="Of a direction whose order was raised the one that it comes from is found, of each order on the way; else it is refused.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: directions that are others, or are found where there are none")},
)
def lowered_directions() -> dict[str, float]:
    """How many."""
    wrong = 0
    for order, knots in DIRECTIONS:
        way = [Direction("N", order, np.array(knots))]
        for _ in range(3):
            way.append(elevated(way[-1], np.zeros(way[-1].count), 0)[0])
        found = [lowered(way[-1], direction.order) for direction in way]
        wrong += sum(one.order != other.order or one.knots.tolist() != other.knots.tolist() for one, other in zip(found, way, strict=True))
    for family, order, knots, lower in REFUSED:
        try:
            lowered(Direction(family, order, np.array(knots)), lower)
            wrong += 1
        except InputError:
            pass
    return {"wrong": float(wrong)}
