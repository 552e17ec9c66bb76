"""Elements of a master that are too long for a contact: they cannot follow what a finer slave presses in, and are too stiff."""

from __future__ import annotations

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Contact, Face, Problem
from isomortar.model.sheet import Sheet
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.told.during.giving_way import Yields
from isomortar.told.during.pulling import pulls
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
#: Share of the force that this adds from which on it is told, and the largest that is: under rigid slaves it is a bound of little use.
COSTS, LARGEST = 0.1, 1.0
#: A direction is too coarse where it keeps back this share of what the other one does.
PART = 0.5


@frozen
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
    yields : Yields
        How far both do.
    """

    widths: FloatArray
    kept: FloatArray
    softness: float
    yields: Yields

    @property
    def costs(self) -> float:
        """Share of the force that this adds to it at the most, about (theory 9.15)."""
        kept = self.softness * min(MOST, float(np.linalg.norm(self.kept)))
        return self.yields.of_force(kept / (1.0 - kept))

    @property
    def is_told(self) -> bool:
        """Whether it costs enough to be told."""
        return self.costs > COSTS

    def sentence(self, problem: Problem, contact: Contact, step: int) -> str:
        """What is said of it at the end of a load step."""
        assert isinstance(contact.master, Face), "planes have no elements"
        letters, stage = Sheet.of(problem, contact.master).letters, problem.stages[problem.stage_of(step)].name
        few = [letter for letter, kept in zip(letters, self.kept, strict=True) if kept > PART * self.kept.max()]
        keys = ", ".join(f"bodies.{name}.mesh.elements" for name in dict.fromkeys(face.body for face in contact.master.faces))
        return (
            f"contact {contact.name!r}, load step {step}, the last of stage {stage!r}: elements of its master {contact.master.words} are "
            f"too long for it, and too stiff: it is {self.widths[0]:.2g} of them wide along {letters[0]} and {self.widths[1]:.2g} along "
            f"{letters[1]}. Forces under given motions may be too large by about {10 * round(10.0 * min(LARGEST, self.costs))} %, or by "
            f"little, as knots lie there, and pressures by more. Take twice as many elements or more along {' and '.join(few)} ({keys}), "
            "or shorter ones there (mesh.grading)"
        )


def long_master(equilibrium: Equilibrium, balance: Balance, number: int, yields: Yields) -> LongMaster | None:
    """How a contact that presses lies on elements of its master (theory 9.15).

    None on planes, under slaves no finer, beside mirrors, and of what pulls.
    """
    pair, projections, problem = equilibrium.pairs[number].pair, balance.kinematics[number].projections, equilibrium.problem
    forces = pair.slave.area * np.maximum(pair.field(balance.responses[number].pressure), 0.0) * (projections.found > 0)
    if not isinstance(pair.contact.master, Face) or problem.images > 1 or not forces.any():
        return None
    slave_side, master_side = Sheet.of(problem, pair.contact.slave), Sheet.of(problem, pair.contact.master)
    if not master_side.element_size > FINER * slave_side.element_size or pulls(equilibrium, balance, number):
        return None
    widths = _widths(master_side, projections.xi, forces / forces.sum())
    narrow = np.divide(1.0, widths, out=np.full(2, np.inf), where=widths > 0.0)
    narrow[widths > ALL * np.array([direction.elements for direction in master_side.directions])] = 0.0
    orders = np.array([direction.order for direction in master_side.directions])
    kept = np.minimum(MOST, KEEPS * np.minimum(1.0, SMOOTH / orders) * np.maximum(0.0, narrow - FREE))
    slave, master = (float(forces @ part) for part in softness(problem, equilibrium.numbering, pair, projections))
    return LongMaster(widths, kept, master / (slave + master), yields)


def _widths(side: Sheet, places: FloatArray, shares: FloatArray) -> FloatArray:
    """How wide forces at coordinates of a face are along each, in its elements, shape (2,); `shares` of the force add up to one."""
    widths = np.empty(2)
    for axis, direction in enumerate(side.directions):
        count, bounds = direction.elements, direction.boundaries
        elements = np.interp(places[:, axis], bounds, np.arange(len(bounds)))
        if side.closed[axis]:  # from the middle of the force on, in half a turn either way
            middle = count / (2.0 * np.pi) * np.angle(shares @ np.exp(2j * np.pi * elements / count))
            elements = (elements - middle + 0.5 * count) % count
        widths[axis] = WIDE * np.sqrt(shares @ np.square(elements - shares @ elements))
    return widths
