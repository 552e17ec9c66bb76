"""How narrow a range of colours may be: what differs by less is round-off, and has one colour."""

from __future__ import annotations

from isomortar.model.entities import Problem
from isomortar.model.numbering import Numbering

#: Share of the modulus, of the size of all bodies, or of one.
ROUND_OFF = 1e-12


def narrowest(problem: Problem, field: str) -> float:
    """Of a field of bodies or of a slave face, by its name in pictures or pages."""
    if field in ("stress", "von Mises stress"):
        return ROUND_OFF * max((body.material.young for body in problem.deformable), default=1.0)
    return ROUND_OFF * (Numbering(problem).size if field in ("gap", "displacement") else 1.0)
