"""How narrow a range of colours may be: what differs by less is round-off, and has one colour."""

from __future__ import annotations

from enum import Enum

from isomortar.model.entities import Problem
from isomortar.model.numbering import Numbering

#: Share of the modulus, of the size of all bodies, or of one.
ROUND_OFF = 1e-12


class Dimension(Enum):
    """What a field measures."""

    STRESS, LENGTH, RATIO = range(3)


def narrowest(problem: Problem, dimension: Dimension) -> float:
    """Of a field of bodies, or of gaps; contact stress has none, as it counts from zero where nothing bears."""
    match dimension:
        case Dimension.STRESS:
            return ROUND_OFF * max((body.material.young for body in problem.deformable), default=1.0)
        case Dimension.LENGTH:
            return ROUND_OFF * Numbering(problem).size
        case Dimension.RATIO:
            return ROUND_OFF
