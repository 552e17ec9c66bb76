"""Contact between constraints at points of the slave, where it is inside its master or apart from it and none of them sees it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from isomortar import _bindings
from isomortar._bindings import Projections, surface_functions
from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.model.enforcement import METHODS, SlaveFace
from isomortar.model.entities import Contact, Face, Problem
from isomortar.model.pairs import Pair
from isomortar.model.shares import percent
from isomortar.model.sheet import Sheet
from isomortar.solve.contact import PutOff
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.feet import gaps
from isomortar.told.before.dents import AT_POINTS, of_dents
from isomortar.told.during.long_masters import deformations, way_of_face
from isomortar.told.during.narrow import bearing, pressed_in

#: Gauss points an element, along each coordinate, where gaps are looked at: functions of order 3 are far from straight between constraints.
POINTS = 4
#: Shares of the force that a mean gap of as much as the forces press in costs, and a deviation of as much: fitted to crossed cylinders by
#: constraints at Greville's abscissae and at knots, whose forces were off by -26 to 2 %.
MEAN, DEVIATION = 0.6, 0.23
#: Share of the force from which on it is told, by its estimate.
COSTS = 0.1
#: Deviation over what forces press in above which there is no estimate: of such balls and cylinders forces were off by -48 to 61 %.
BLIND = 1.5
#: Times what forces press in that faces go, from which on bodies bend: gaps are little beside that, and forces those of the bending.
BENDS = 6.0
#: The same beside the gaps' deviation: what a ball has come in by without pressing is no bending (it goes as far as gaps deviate).
TWICE = 2.0


@frozen
class Between:
    """Gaps between constraints at points, over what forces press bodies in.

    Attributes
    ----------
    mean : float
        Their mean by the pressure; above zero inside the master.
    deviation : float
        Root of their mean square.
    gone : float
        How far the faces go there, from what of them goes least.
    """

    mean: float
    deviation: float
    gone: float

    @property
    def costs(self) -> float:
        """Share of the force that this costs, by an estimate (theory 9.22)."""
        share = max(0.0, MEAN * self.mean + DEVIATION * self.deviation)
        return share / (1.0 + share)

    @property
    def too_coarse(self) -> bool:
        """Whether it is told."""
        bends = self.gone > max(BENDS, TWICE * self.deviation)
        return not bends and (self.deviation > BLIND or self.costs > COSTS)


class BetweenPoints:
    """Warnings of contacts by constraints at points that are too far apart for what presses; each is given once.

    Of those that are too far apart for all that could press there is a warning before the run.
    """

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._equilibrium = equilibrium
        pairs = {k: p for k, p in enumerate(equilibrium.pairs) if p.pair.contact.enforcement in AT_POINTS}
        self._watched = {k: p for k, p in pairs.items() if not any(of_dents(equilibrium.problem, p.pair.contact))}

    def after_stage(self, balance: Balance, step: int) -> Iterator[str]:
        """Warnings that the end of a stage gives rise to; what too few rows bear at all is told as narrow contact."""
        for number, mechanics in list(self._watched.items()):
            if isinstance(balance.kinematics[number], PutOff) or not np.any(balance.responses[number].pressure > 0.0):
                continue
            found = between_points(self._equilibrium, balance, number)
            if found.too_coarse and not bearing(self._equilibrium, mechanics, balance, number).too_narrow:
                del self._watched[number]
                yield _sentence(self._equilibrium.problem, mechanics.pair.contact, found, step)


def between_points(equilibrium: Equilibrium, balance: Balance, number: int) -> Between:
    """Gaps of a contact by constraints at points, at Gauss points of the slave where the field of their pressures is (theory 9.22)."""
    problem, numbering, contact = equilibrium.problem, equilibrium.numbering, equilibrium.pairs[number].pair.contact
    seen = Pair(replace(contact, enforcement="mortar", projection="closest", quadrature=(POINTS, POINTS), subcells=0), problem, numbering)
    of_points = np.maximum(balance.responses[number].pressure, 0.0)
    at_control = METHODS[contact.enforcement](SlaveFace(contact, problem, numbering)).on_control_points(of_points)
    count = len(seen.slave.area)
    feet = _bindings.project_points(seen.slave, seen.master, balance.positions, np.zeros((count, 2)), np.zeros(count, np.int32))
    pressure = np.maximum(seen.field(at_control), 0.0) * (feet.found > 0)
    pressed = pressed_in(equilibrium, seen, feet, pressure)
    if not pressed > 0.0:
        return Between(0.0, 0.0, 0.0)
    share = seen.slave.area * pressure / (seen.slave.area @ pressure)
    depths: FloatArray = gaps(seen, balance.positions, feet) / pressed
    gone = _gone(equilibrium, contact, seen, feet, balance.positions, share)
    return Between(float(share @ depths), float(np.sqrt(share @ np.square(depths))), gone / pressed)


def _gone(equilibrium: Equilibrium, contact: Contact, seen: Pair, feet: Projections, positions: FloatArray, share: FloatArray) -> float:
    """How far both sides of a contact have gone where a share of its force acts at points, from what of their faces has gone least."""
    numbering, acts = equilibrium.numbering, np.flatnonzero(share)
    ways, slave = deformations(numbering, positions), SlaveFace(contact, equilibrium.problem, numbering)
    nodes = np.repeat(seen.slave.shape.nodes, seen.slave.per_element, axis=0)[acts]
    gone = way_of_face(ways, slave.point, (nodes, seen.slave.shape.values[acts][:, None]), share[acts])
    if isinstance(contact.master, Face):
        of_master = surface_functions(*Sheet.of(equilibrium.problem, contact.master).arrays(numbering), feet.xi[acts])
        gone += way_of_face(ways, seen.master_face, of_master, share[acts])
    return gone


def _sentence(problem: Problem, contact: Contact, found: Between, step: int) -> str:
    """The sentence."""
    stage, slave = problem.stages[problem.stage_of(step)].name, contact.slave
    share = percent(round(found.costs, 2))
    off = "off by a third, too small or too large" if found.deviation > BLIND else f"too small by about {share}"
    return (
        f"contact {contact.name!r}, load step {step}, the last of stage {stage!r}: its constraints, at points of its slave {slave.words}, "
        f"are too far apart for what presses, which is inside its master or apart from it between them. Forces under given motions may be "
        f'{off}, pressures by more. Take contacts.{contact.name}.enforcement = "mortar", or twice as many elements or more along '
        f"{' and '.join(Sheet.of(problem, slave).letters)} (bodies.{slave.body}.mesh.elements)"
    )
