"""Contact between constraints at points of the slave, where it is inside its master or apart from it and none of them sees it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar import _bindings
from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.model.enforcement import METHODS, SlaveFace
from isomortar.model.entities import Contact, Problem
from isomortar.model.pairs import Pair
from isomortar.model.shares import percent
from isomortar.model.sheet import Sheet
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.feet import gaps
from isomortar.told.before.dents import AT_POINTS, of_dents
from isomortar.told.during.giving_way import Yields
from isomortar.told.during.softness import pressed_in

#: Gauss points an element, along each coordinate, where gaps are looked at: functions of order 3 are far from straight between constraints.
POINTS = 4
#: Shares of the force that a mean gap of as much as the forces press in costs, and a deviation of as much: fitted to crossed cylinders by
#: constraints at Greville's abscissae and at knots, whose forces were off by -26 to 2 %.
MEAN, DEVIATION = 0.6, 0.23
#: Share of the force from which on it is told, by its estimate.
COSTS = 0.1
#: Deviation over what forces press in above which there is no estimate: of such balls and cylinders forces were off by -48 to 61 %.
BLIND = 1.5
#: How far bodies go by the contact alone, over how far forces press them in, from which on they bend: gaps are little beside that. Forces
#: at few points go up to four times as far where nothing bends.
BENDS = 6.0


@frozen
class Between:
    """Gaps between constraints at points, over what forces press bodies in.

    Attributes
    ----------
    mean : float
        Their mean by the pressure; above zero inside the master.
    deviation : float
        Root of their mean square.
    yields : Yields
        How far bodies give way.
    """

    mean: float
    deviation: float
    yields: Yields

    @property
    def costs(self) -> float:
        """Share of the force that this costs, by an estimate (theory 9.22)."""
        share = max(0.0, MEAN * self.mean + DEVIATION * self.deviation)
        return share / (1.0 + share)

    @property
    def is_told(self) -> bool:
        """Whether it costs enough to be told, of what does not bend."""
        bends = self.yields.ways.sum() > BENDS * self.yields.pressed.sum()
        return not bends and (self.deviation > BLIND or self.costs > COSTS)

    def sentence(self, problem: Problem, contact: Contact, step: int) -> str:
        """What is said of it at the end of a load step."""
        stage, slave = problem.stages[problem.stage_of(step)].name, contact.slave
        share = percent(round(self.costs, 2))
        off = "off by a third, too small or too large" if self.deviation > BLIND else f"off by about {share}"
        return (
            f"contact {contact.name!r}, load step {step}, the last of stage {stage!r}: its constraints, at points of its slave "
            f"{slave.words}, are too far apart for what presses, which is inside its master or apart from it between them. Forces under "
            f'given motions may be {off}, pressures by more. Take contacts.{contact.name}.enforcement = "mortar", or twice as many '
            f"elements or more along {' and '.join(Sheet.of(problem, slave).letters)} (bodies.{slave.body}.mesh.elements)"
        )


def between_points(equilibrium: Equilibrium, balance: Balance, number: int, yields: Yields) -> Between | None:
    """Gaps of a contact by constraints at points, at Gauss points of the slave where the field of their pressures is (theory 9.22).

    None of others, and of those that are too far apart for all that could press, of which there is a warning before the run.
    """
    problem, numbering, contact = equilibrium.problem, equilibrium.numbering, equilibrium.pairs[number].pair.contact
    if contact.enforcement not in AT_POINTS or any(of_dents(problem, contact)):
        return None
    seen = Pair(replace(contact, enforcement="mortar", projection="closest", quadrature=(POINTS, POINTS), subcells=0), problem, numbering)
    of_points = np.maximum(balance.responses[number].pressure, 0.0)
    at_control = METHODS[contact.enforcement](SlaveFace(contact, problem, numbering)).on_control_points(of_points)
    count = len(seen.slave.area)
    feet = _bindings.project_points(seen.slave, seen.master, balance.positions, np.zeros((count, 2)), np.zeros(count, np.int32))
    pressure = np.maximum(seen.field(at_control), 0.0) * (feet.found > 0)
    pressed = float(pressed_in(equilibrium, seen, feet, pressure).sum())
    if not pressed > 0.0:
        return None
    share = seen.slave.area * pressure / (seen.slave.area @ pressure)
    depths: FloatArray = gaps(seen, balance.positions, feet) / pressed
    return Between(float(share @ depths), float(np.sqrt(share @ np.square(depths))), yields)
