"""Contact that is narrower than its slave can carry: one row of control points bears it, or the master is deep between those that do."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from isomortar._bindings import Projections
from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Contact, Problem
from isomortar.model.pairs import Pair
from isomortar.model.shares import percent
from isomortar.model.sheet import Sheet
from isomortar.solve.contact import PairMechanics, PutOff
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.feet import gaps
from isomortar.solve.record import ContactState
from isomortar.told.borne import Borne
from isomortar.told.during import long_masters
from isomortar.told.during.beyond_edges import beyond_edges, told
from isomortar.told.during.long_masters import long_master
from isomortar.told.during.pulling import pulls
from isomortar.told.during.softness import softness, thinness

#: Rows that bear contact below which it is told, in both directions, or in one with functions that have kinks: there forces of balls and
#: cylinders on blocks were off by up to a third. A single row of smooth functions along a line cost less than 7 %, two rows a tenth, more
#: rows less than 5 %. Rows count once at planes of symmetry, too: those of the image hardly matter down here.
ROWS = 1.3
#: The same of `dual` constraints, in both directions: there forces of balls on blocks were 13 to 130 % too large, with more rows by 16 % at
#: the most; and of constraints at all Gauss points (`kts`), as a share of those of an element: by 26 to 90 %, with more by less than 8 %.
#: Not beside planes of symmetry, whose other side has as many.
DUAL_ROWS, SHARE_OF_ELEMENT = 2.02, 0.5
#: Rows of a contact that is told up to which finer elements along that direction are advised, and share of all rows from which on they are
#: not: an element across a strip is meant.
ENOUGH, ALL = 2.5, 0.8
#: Share of the force that what is deep between control points may cost before it is told, by its estimate (theory 9.10).
COSTS = 0.1
#: Depth over what forces press in up to which it costs nothing, and what is added below the line: fitted to the same scenes.
FREE, ADDED = 0.5, 2.0
#: How far a pressure presses in a layer on what holds it, over its thickness, as a share of pressure times softness where it cannot go
#: sideways: fitted to 224 forces of balls and cylinders on layers a twentieth to one radius thick (theory 9.10).
LAYER = 0.85
#: Shares of the force that narrow contact costs: on one row of averages, and by other constraints, of which balls on blocks tell no better.
FEW, OTHERWISE = "a fifth", "50 %, at the worst by 200 %"
#: Share of the largest force of a contact below which it opens, or hardly begins: its last row is no fault of the mesh.
LIGHT = 0.1


@frozen
class Bearing:
    """What bears a contact.

    Attributes
    ----------
    rows : ndarray, shape (2,)
        How many rows of constraints do along each coordinate of the slave face (theory 9.9).
    of : tuple of int
        How many rows there are.
    least : ndarray, shape (2,)
        Rows below which there are too few along both.
    kinks : tuple of bool
        Whether functions of the face have kinks along each coordinate.
    round : tuple of bool
        Whether it is a pole, round which a coordinate goes, that bears most: a point, however many rows there are along that.
    depth : float
        Of the quadrature points, root of the mean square where there is pressure: averages of it are zero.
    costs : float
        Share of the force that this costs constraints on averages, by an estimate; below zero it costs nothing (theory 9.10).
    """

    rows: FloatArray
    of: tuple[int, int]
    least: FloatArray
    kinks: tuple[bool, bool]
    round: tuple[bool, bool]
    depth: float
    costs: float

    @property
    def too_narrow(self) -> bool:
        """Whether it is told."""
        few = (self.rows < self.least) & (self.rows < ALL * np.array(self.of))
        return bool(np.all(few | self.round) or np.any((self.rows < ROWS) & self.kinks)) or self.costs > COSTS


class Narrow:
    """Warnings of contacts that are too narrow for their slaves at the end of a stage; each is given once a contact.

    What bore when the computation begins, or goes on, counts as borne before.
    """

    def __init__(self, equilibrium: Equilibrium, states: Sequence[ContactState]) -> None:
        self._equilibrium, self._problem = equilibrium, equilibrium.problem
        self._watched = dict(enumerate(equilibrium.pairs))
        self._areas = [_areas(mechanics.pair, mechanics.pair.slave.area) for mechanics in equilibrium.pairs]
        self._largest = np.array([state.pressure @ area for state, area in zip(states, self._areas, strict=True)])
        self._borne = Borne(self._problem, states)

    def after_step(self, balance: Balance, step: int, ends: bool) -> Iterator[str]:
        """Warnings that the end of a load step gives rise to, if it `ends` a stage: all contact of round bodies is narrow at first."""
        self._borne.see(response.pressure for response in balance.responses)
        for number, mechanics in list(self._watched.items()):
            if isinstance(balance.kinematics[number], PutOff):
                continue
            pressure = balance.responses[number].pressure
            force = float(pressure @ self._areas[number])
            self._largest[number] = max(force, self._largest[number])
            bears = self._borne.more_than_nothing(number, float(np.abs(pressure).max(initial=0.0)))
            if not ends or not bears or force <= LIGHT * self._largest[number]:
                continue
            found = bearing(self._equilibrium, mechanics, balance, number)
            if found.too_narrow:
                del self._watched[number]
                yield _told(self._problem, mechanics.pair.contact, found, step)
                continue
            over = beyond_edges(self._equilibrium, mechanics.pair, balance, number)
            if over is not None and over.too_stiff:
                del self._watched[number]
                yield told(self._problem, mechanics.pair.contact, over, step)
                continue
            lies = long_master(self._equilibrium, mechanics.pair, balance, number)
            if lies is not None and lies.too_stiff and not pulls(self._equilibrium, balance, number):
                del self._watched[number]
                yield long_masters.told(self._problem, mechanics.pair.contact, lies, step)


def forces(pair: Pair, pressure: FloatArray, projections: Projections) -> FloatArray:
    """Forces of constraints, shape (n,): their pressures by the integrals of their functions over what has a foot (theory 9.9)."""
    return np.asarray(pressure * _areas(pair, pair.slave.area * (projections.found > 0)))


def _areas(pair: Pair, area: FloatArray) -> FloatArray:
    """Integrals of the constraints' functions with areas of quadrature points, shape (n,)."""
    test = pair.slave.test
    acting = np.einsum("eqa,eq->ea", test.values.reshape(*_by_element(pair), -1), area.reshape(_by_element(pair)))
    return np.bincount(test.nodes.ravel(), acting.ravel(), test.count).astype(np.float64)


def _by_element(pair: Pair) -> tuple[int, int]:
    return pair.slave.elements, pair.slave.per_element


def bearing(equilibrium: Equilibrium, mechanics: PairMechanics, balance: Balance, number: int) -> Bearing:
    """What bears a contact that is closed (theory 9.9, 9.10).

    Parameters
    ----------
    equilibrium : Equilibrium
    mechanics : PairMechanics
        Of the contact.
    balance : Balance
    number : int
        Of that contact.
    """
    borne = forces(mechanics.pair, balance.responses[number].pressure, balance.kinematics[number].projections)
    depth, pressed = _between(equilibrium, mechanics, balance, number)
    ratio = depth / pressed if pressed > 0.0 else 0.0
    (first, round_first), (second, round_second) = (_sums(mechanics.pair.places, borne, axis) for axis in (0, 1))
    rows = np.array([np.sum(sums) ** 2 / (sums @ sums) for sums in (first, second)])
    directions = Sheet.of(equilibrium.problem, mechanics.pair.contact.slave).directions
    u, v = (direction.order == 1 or direction.family == "L" for direction in directions)
    round_poles, counts = (round_first, round_second), (len(first), len(second))
    by_element = [count / direction.elements for count, direction in zip(counts, directions, strict=True)]
    least = _least(equilibrium.problem, mechanics.pair.contact, np.array(by_element))
    return Bearing(rows, counts, least, (u, v), round_poles, depth, (ratio - FREE) / (ratio + ADDED))


def _least(problem: Problem, contact: Contact, by_element: FloatArray) -> FloatArray:
    """Rows below which a contact is too narrow where there are so few along both coordinates; `by_element`: how many each has."""
    if contact.enforcement == "dual" and problem.images == 1:
        return np.full(2, DUAL_ROWS)
    if contact.enforcement == "kts" and problem.images == 1:
        return np.asarray(np.maximum(ROWS, SHARE_OF_ELEMENT * by_element))
    return np.full(2, ROWS)


def _sums(places: FloatArray, borne: FloatArray, axis: int) -> tuple[FloatArray, bool]:
    """Forces by row, of constraints at the same place along a coordinate, and whether a pole that it goes round bears most (theory 9.9).

    A pole is a constraint that is alone across the coordinate: all rows have an equal part of it.
    """
    row, across = (np.unique(places[:, k], return_inverse=True)[1].ravel() for k in (axis, 1 - axis))
    at_pole = np.bincount(across)[across] == 1
    sums, of_pole = np.bincount(row, np.where(at_pole, 0.0, borne)), float(borne[at_pole].sum())
    return np.asarray(sums + of_pole / len(sums), np.float64), of_pole > 0.5 * float(borne.sum())


def _between(equilibrium: Equilibrium, mechanics: PairMechanics, balance: Balance, number: int) -> tuple[float, float]:
    """How deep quadrature points are where there is pressure, and how far that presses the bodies in, about (theory 9.10)."""
    pair, projections = mechanics.pair, balance.kinematics[number].projections
    pressure = abs(pair.field(balance.responses[number].pressure)) * (projections.found > 0)
    acting = pair.slave.area * pressure
    if not acting.any():
        return 0.0, 0.0
    depth = np.sqrt(acting @ np.square(gaps(pair, balance.positions, projections)) / acting.sum())
    at = (equilibrium.problem, equilibrium.numbering, pair, projections)
    spread, mean = np.sqrt(equilibrium.problem.images * (acting @ pressure)), acting @ pressure / acting.sum()
    sides = zip(softness(*at), thinness(*at, equilibrium.supports.stage), strict=True)
    pressed = sum(soft * np.minimum(spread, _of_layers(mean, thin)) for soft, thin in sides)
    return float(depth), float(acting @ pressed / acting.sum())


def _of_layers(pressure: float, thin: FloatArray) -> FloatArray:
    """How far a pressure presses in layers of one over these thicknesses, over their softness; infinity of what is none."""
    return np.divide(LAYER * pressure, thin, out=np.full_like(thin, np.inf), where=thin > 0.0)


def _told(problem: Problem, contact: Contact, found: Bearing, step: int) -> str:
    """The sentence."""
    letters, what = Sheet.of(problem, contact.slave).letters, "control points" if contact.of_averages else "constraints"
    least, deep = float(found.rows.min()), found.costs > COSTS
    sides = list(zip(letters, found.rows, found.of, strict=True))
    few = [letter for letter, rows, count in sides if rows <= max(ENOUGH, least) and rows < ALL * count]
    few = few or [letter for letter, is_round in zip(letters, found.round, strict=True) if not is_round]
    between = f", and between these it is about {found.depth:.2g} inside its master or apart from it" if deep else ""
    share = OTHERWISE if contact.enforcement != "mortar" else percent(found.costs) if deep else FEW
    stage = problem.stages[problem.stage_of(step)].name
    return (
        f"contact {contact.name!r}, load step {step}, the last of stage {stage!r}: it is too narrow for its slave {contact.slave.words}: "
        f"{found.rows[0]:.1f} of {found.of[0]} rows of {what} along {letters[0]} and {found.rows[1]:.1f} of {found.of[1]} along "
        f"{letters[1]} bear it{between}. Forces under given motions may be off by about {share}, pressures by more. Take twice as "
        f"many elements or more along {' and '.join(few)} (bodies.{contact.slave.body}.mesh.elements), or shorter ones there (mesh.grading)"
    )
