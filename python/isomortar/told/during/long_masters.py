"""Elements of a master that are too long for a contact: they cannot follow what a finer slave presses in, and are too stiff."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Contact, Face, Problem
from isomortar.model.pairs import Pair
from isomortar.model.sheet import Sheet
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.told.before.pairing import element_size
from isomortar.told.during.softness import softness

#: Share of what a master gives way by that its elements keep back, by one over the width of contact in these, and what is taken from that:
#: fitted to balls and cylinders on blocks of orders 1 to 3; and the most that it is taken for.
KEEPS, FREE, MOST = 0.2, 0.4, 0.8
#: Order from which on elements follow shorter pressures in proportion.
SMOOTH = 2.0
#: Standard deviations of its force, in length, that a contact is wide.
WIDE = 4.0
#: Share of the master's elements from which on contact is as wide as the master: nothing beside it is to be bent down.
ALL = 0.8
#: Elements of the master are too long for a finer slave: longer than its own by this factor. Where they are not both are too long.
FINER = 1.2
#: Share of the force that this adds from which on it is told.
COSTS = 0.1
#: A direction is too coarse where it keeps back this share of what the other one does.
PART = 0.5


@dataclass(frozen=True)
class LongMaster:
    """How a contact lies on elements of its master.

    Attributes
    ----------
    widths : ndarray, shape (2,)
        How wide it is along each coordinate of the master face, in elements of that.
    kept : ndarray, shape (2,)
        Share of what the master gives way by that elements keep back along each.
    softness : float
        Share of the master in what both bodies give way.
    """

    widths: FloatArray
    kept: FloatArray
    softness: float

    @property
    def costs(self) -> float:
        """Share of the force that this adds to it, by an estimate (theory 9.15)."""
        return float(1.0 / (1.0 - self.softness * min(MOST, float(np.linalg.norm(self.kept)))) - 1.0)

    @property
    def too_stiff(self) -> bool:
        """Whether it is told."""
        return self.costs > COSTS


def long_master(equilibrium: Equilibrium, pair: Pair, balance: Balance, number: int) -> LongMaster | None:
    """How a contact that bears lies on elements of its master (theory 9.15); None on planes, under slaves no finer, and beside mirrors."""
    projections, problem = balance.kinematics[number].projections, equilibrium.problem
    forces = pair.slave.area * np.maximum(pair.field(balance.responses[number].pressure), 0.0) * (projections.found > 0)
    if not isinstance(pair.contact.master, Face) or problem.images > 1 or not forces.any():
        return None
    slave_side, master_side = Sheet.of(problem, pair.contact.slave), Sheet.of(problem, pair.contact.master)
    if not element_size(master_side) > FINER * element_size(slave_side):
        return None
    directions = master_side.directions
    bounds = [direction.boundaries for direction in directions]
    places = np.stack([np.interp(projections.xi[:, k], b, np.arange(len(b))) for k, b in enumerate(bounds)], axis=1)
    mean = forces @ places / forces.sum()
    widths = WIDE * np.sqrt(forces @ np.square(places - mean) / forces.sum())
    orders = np.array([direction.order for direction in directions])
    narrow = np.divide(1.0, widths, out=np.full(2, np.inf), where=widths > 0.0)
    narrow[widths > ALL * np.array([len(b) - 1 for b in bounds])] = 0.0
    slave, master = (part[projections.found > 0].sum() for part in softness(problem, equilibrium.numbering, pair, projections))
    kept = np.minimum(MOST, KEEPS * np.minimum(1.0, SMOOTH / orders) * np.maximum(0.0, narrow - FREE))
    return LongMaster(widths, kept, master / (slave + master))


def told(problem: Problem, contact: Contact, found: LongMaster, step: int) -> str:
    """The sentence."""
    assert isinstance(contact.master, Face), "planes have no elements"
    letters, stage = Sheet.of(problem, contact.master).letters, problem.stages[problem.stage_of(step)].name
    few = [letter for letter, kept in zip(letters, found.kept, strict=True) if kept > PART * found.kept.max()]
    return (
        f"contact {contact.name!r}, load step {step}, the last of stage {stage!r}: elements of its master {contact.master.words} are too "
        f"long for it, and too stiff: it is {found.widths[0]:.2g} of them wide along {letters[0]} and {found.widths[1]:.2g} along "
        f"{letters[1]}. Forces under given motions may be too large by about {10 * round(10.0 * found.costs)} %, pressures by more. Take "
        f"twice as many elements or more along {' and '.join(few)} (bodies.{contact.master.body}.mesh.elements), or shorter ones there "
        "(mesh.grading)"
    )
