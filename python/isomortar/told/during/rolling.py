"""Friction of contact that rolls on few elements: its control points stick in the mean of all that they reach, and what presses creeps."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from isomortar._codes import PointState
from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.model.pairs import Pair
from isomortar.model.shares import percent
from isomortar.solve.contact import PairMechanics, PutOff
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.feet import slave_points
from isomortar.told.during.extent import WIDE
from isomortar.told.during.pivoting import slip_vectors
from isomortar.told.during.softness import pressed_in

#: Widths that contact has to go along its slave before it is told: until then friction builds up by what has not rolled, too.
ROLLED = 1.0
#: Widths that it has to go in a load step for rolling to begin: a cylinder that is pressed on its own elements moves by less.
MOVES = 0.01
#: Share of what friction bears that drag was off by, over what creeps while contact rolls on by its width, in the middle of six rolling
#: cylinders with 8 to 16 elements round them and 9 to 36 load steps a quarter of a turn: 0.3 to 0.9 in the mean, 0.5 to 1 at the worst.
OFF = 0.6
#: Share of what friction bears that drag may be off by before it is told: of eight rolling cylinders below it drag was off by 0.01 to 0.25.
MOST = 0.2


@dataclass
class Roll:
    """What has come together since a contact bears, or a run goes on: widths that it has rolled, what crept, and where it was."""

    ways: float = 0.0
    creep: float = 0.0
    place: FloatArray | None = None

    @property
    def off(self) -> float:
        """Share of what friction bears that drag is off by, about (theory 9.25)."""
        return min(1.0, OFF * self.creep / self.ways) if self.ways >= ROLLED else 0.0


@frozen
class Carrying:
    """Of a load step: what friction bears at the slave's points, the middle of its force on the slave at rest, and how far that spreads."""

    bears: FloatArray
    share: FloatArray
    place: FloatArray
    spread: FloatArray

    def ways(self, before: FloatArray | None) -> float:
        """How far contact has gone along its slave, in its widths."""
        if before is None:
            return 0.0
        way = self.place - before
        length = float(np.linalg.norm(way))
        width = WIDE * float(np.sqrt(way @ self.spread @ way)) / length if length > 0.0 else 0.0
        return length / width if width > 0.0 else 0.0


class Rolling:
    """Warnings of friction that rolling makes on elements that are too long for it; each is given once a contact.

    Of averages with the slave's functions alone: constraints at points have each slip as it is, and of dual ones no field can be told.
    Where slips are elastic what presses does creep.
    """

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._equilibrium = equilibrium
        self._watched = {k: pair for k, pair in enumerate(equilibrium.pairs) if _sticks(pair)}
        self._rolls = {k: Roll() for k in self._watched}

    def after_step(self, balance: Balance, step: int) -> Iterator[str]:
        """Warnings that the end of a load step gives rise to."""
        for number, mechanics in list(self._watched.items()):
            found = None if isinstance(balance.kinematics[number], PutOff) else _pressed(self._equilibrium, mechanics, balance, number)
            if found is None:
                self._rolls[number] = Roll()
                continue
            roll = self._rolls[number]
            ways, roll.place = found.ways(roll.place), found.place
            if roll.ways > 0.0 or ways > MOVES:  # on long elements it goes on in jerks
                creep = _creep(self._equilibrium, mechanics, balance, number, found)
                roll.ways, roll.creep = roll.ways + ways, roll.creep + creep
            if roll.off > MOST:
                del self._watched[number]
                yield _sentence(mechanics.pair, roll.off, step)


def _sticks(mechanics: PairMechanics) -> bool:
    """Whether friction of a contact can be told of: of averages by the slave's functions, without elastic slips."""
    contact = mechanics.pair.contact
    return mechanics.friction.acts and contact.enforcement == "mortar" and contact.elastic_slip == 0.0


def _pressed(equilibrium: Equilibrium, mechanics: PairMechanics, balance: Balance, number: int) -> Carrying | None:
    """Of a contact with friction; None: nothing presses."""
    pair, projections = mechanics.pair, balance.kinematics[number].projections
    counts = (projections.found > 0) & (projections.slips > 0)
    bears = mechanics.radius(np.maximum(pair.field(balance.responses[number].pressure), 0.0)) * counts
    forces = pair.slave.area * bears
    if not forces.any():
        return None
    share = forces / forces.sum()
    places = slave_points(pair, equilibrium.numbering.reference)
    apart = places - share @ places
    return Carrying(bears, share, share @ places, np.einsum("q,qi,qj->ij", share, apart, apart))


def _creep(equilibrium: Equilibrium, mechanics: PairMechanics, balance: Balance, number: int, pressed: Carrying) -> float:
    """How far what sticks crept in the last increment, over how far it is pressed in by what friction bears (theory 9.25)."""
    pair, response = mechanics.pair, balance.responses[number]
    projections, test = balance.kinematics[number].projections, pair.slave.test
    gives = float(pressed_in(equilibrium, pair, projections, pressed.bears).sum())
    nodes = np.repeat(test.nodes, pair.slave.per_element, axis=0)
    sticks = np.einsum("qn,qn->q", test.values, response.state[nodes] == PointState.STICK)
    creeps = sticks[:, None] * slip_vectors(pair, balance.positions, projections)
    return float(np.sqrt(pressed.share @ np.square(creeps).sum(axis=1))) / gives if gives > 0.0 else 0.0


def _sentence(pair: Pair, off: float, step: int) -> str:
    """The sentence."""
    slave = pair.contact.slave
    return (
        f"contact {pair.contact.name!r}, load step {step}: it rolls on elements of its slave {slave.words} that are too long for its "
        f"friction, or by load steps that are: control points stick in the mean of all that they reach, and what presses creeps. Drag and "
        f"moments may be off by about {percent(off)} of what friction bears. Take twice as many elements or more along "
        f"its way (bodies.{slave.body}.mesh.elements), and twice as many load steps"
    )
