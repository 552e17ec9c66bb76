"""Friction by area: a cohesion, or a largest traction, acts on what control points stand for, and not on all that is under pressure."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar._arrays import FRICTION_LAWS
from isomortar._bindings import Projections
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Problem
from isomortar.model.pairs import Pair
from isomortar.model.shares import percent
from isomortar.model.sheet import Sheet
from isomortar.solve.contact import PairMechanics, PutOff
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.told.during.pivoting import slip_vectors, turning

#: Share of friction that may be missing before it is told: of 60 forces of caps, bowls and rings with 4 to 12 elements across a tenth and
#: more was missing of 57.
LACKS = 0.1
#: Share, of what the pressure field's friction is above that of control points, that was missing: what makes the median of 60 forces of
#: caps, bowls and rings of orders 1 to 3 that slide on planes, with 4 to 12 elements across, be told as it is; 0.06 to 1.1 of each alone.
MISSING = 1.0 / 3.0
#: Share of the slips' squares that one way, or one turn, of all has to have: what bulges as it is pressed slips to all sides, and has no
#: friction as a whole. Of what is dragged it is 0.99 and more.
AS_ONE = 0.9
#: Share of the force that a row at an end of the face has to have for contact to be along that edge: blocks that are tipped and dragged on
#: one row had half the friction with elements half as long, and blocks that lie flat have a sixth there and less, or few rows in all.
AT_EDGE = 0.7


class OnAreas:
    """Warnings of friction by area that elements are too long to tell; each is given once a contact.

    Of averages with the slave's functions alone: constraints at points have friction of their own, and of dual ones no field can be told.
    """

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._problem = equilibrium.problem
        self._watched = {k: pair for k, pair in enumerate(equilibrium.pairs) if _by_area(pair)}

    def after_stage(self, balance: Balance, step: int) -> Iterator[str]:
        """Warnings that the end of a stage gives rise to."""
        for number, mechanics in list(self._watched.items()):
            found = lacking(mechanics, balance, number)
            if found > LACKS:
                del self._watched[number]
                yield _sentence(self._problem, mechanics.pair, found, step)


def _by_area(mechanics: PairMechanics) -> bool:
    """Whether friction of a contact is no constant share of the pressure, and has a field."""
    contact = mechanics.pair.contact
    return contact.enforcement == "mortar" and mechanics.friction.law == FRICTION_LAWS["capped"]


def lacking(mechanics: PairMechanics, balance: Balance, number: int) -> float:
    """Share of the friction of a contact that its elements leave out, about; 0 where it does not slide as a whole (theory 9.28).

    Parameters
    ----------
    mechanics : PairMechanics
        Of a contact of averages with the slave's functions.
    balance : Balance
    number : int
        Of that contact.
    """
    kinematics, response, pair = balance.kinematics[number], balance.responses[number], mechanics.pair
    if isinstance(kinematics, PutOff):
        return 0.0
    bears = float(kinematics.control.weight @ mechanics.radius(response.pressure))
    found = pair.slave.area * (kinematics.projections.found > 0)
    by_points = found * mechanics.radius(np.maximum(pair.field(response.pressure), 0.0))
    if bears == 0.0 or _as_one(pair, balance.positions, kinematics.projections, by_points) < AS_ONE:
        return 0.0
    if _at_an_edge(pair, kinematics.control.weight * response.pressure):
        return 0.0
    more = MISSING * (float(by_points.sum()) / bears - 1.0)
    return more / (1.0 + more)


def _at_an_edge(pair: Pair, borne: FloatArray) -> bool:
    """Whether a row at an end of the face bears most, and others do not: its points stand for more than is in contact, not for less."""
    for axis in (0, 1):
        row = np.unique(pair.places[:, axis], return_inverse=True)[1].ravel()
        sums = np.bincount(row, borne)
        if len(sums) > 2 and max(sums[0], sums[-1]) > AT_EDGE * sums.sum():
            return True
    return False


def _as_one(pair: Pair, positions: FloatArray, projections: Projections, weights: FloatArray) -> float:
    """Share of the slips' squares in the last increment that one way of all, or one turn, has, with weights of points (theory 9.28)."""
    weights = weights * (projections.slips > 0)
    slips = slip_vectors(pair, positions, projections)
    squares = float(weights @ np.square(slips).sum(axis=1))
    if squares == 0.0:
        return 0.0
    apart = float(weights @ np.square(slips - weights @ slips / weights.sum()).sum(axis=1)) / squares
    return 1.0 - apart * (1.0 - turning(pair, positions, projections, weights))


def _sentence(problem: Problem, pair: Pair, found: float, step: int) -> str:
    """The sentence."""
    contact, slave = pair.contact, pair.contact.slave
    by_area = " and ".join(["cohesion"] * (contact.cohesion > 0.0) + ["traction_max"] * (contact.traction_max is not None))
    return (
        f"contact {contact.name!r}, load step {step}: its {by_area} counts by the area under pressure, which elements of its slave "
        f"{slave.words} are too long to tell: friction may be too small by about {percent(found)}. Take twice as many elements or more "
        f"along {' and '.join(Sheet.of(problem, slave).letters)} (bodies.{slave.body}.mesh.elements), or shorter ones there (mesh.grading)"
    )
