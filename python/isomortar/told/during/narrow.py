"""Contact that is narrower than its slave can carry: one row of control points bears it, or the master is deep between those that do."""

from __future__ import annotations

import numpy as np

from isomortar._bindings import Projections
from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Contact, Problem
from isomortar.model.pairs import Pair
from isomortar.model.shares import percent
from isomortar.model.sheet import Sheet
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.feet import gaps
from isomortar.told.during.giving_way import Yields

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
#: Rows up to which there are two, and share of the force that both of two side by side have at the least where contact lies between them.
TWO, ALIKE = 2.05, 0.4
#: Share of the force that this adds for each direction in which it is so, of smooth functions and of such with kinks, and the depths over
#: what forces press in between which it does, all of it between the inner ones: read off 500 forces of balls and bowls on blocks.
BETWEEN, KINKED, DEPTHS = 0.04, 0.06, (0.05, 0.1, 0.4, 0.6)
#: Shares of the force that narrow contact costs: on one row of averages, and by other constraints, of which balls on blocks tell no better,
#: mostly and at the worst: their forces act on few points, which give way far more than what is pressed in by theory.
FEW, OTHERWISE, WORST = 0.2, "50 %, at the worst by 200 %", 2.0


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
    between : tuple of bool
        Whether it lies between two rows side by side along each coordinate, which bear it alike.
    averages : bool
        Whether constraints are on averages.
    depth : float
        Of the quadrature points, root of the mean square where there is pressure: averages of it are zero.
    yields : Yields
        How far bodies give way.
    """

    rows: FloatArray
    of: tuple[int, int]
    least: FloatArray
    kinks: tuple[bool, bool]
    round: tuple[bool, bool]
    between: tuple[bool, bool]
    averages: bool
    depth: float
    yields: Yields

    @property
    def ratio(self) -> float:
        """Depth over how far bodies are pressed in."""
        pressed = float(self.yields.pressed.sum())
        return self.depth / pressed if pressed > 0.0 else 0.0

    @property
    def costs(self) -> float:
        """Share of the force that depths between control points cost averages, by an estimate; below zero: nothing (theory 9.10)."""
        return -self.yields.of_force((FREE - self.ratio) / (self.ratio + ADDED))

    @property
    def adds(self) -> FloatArray:
        """Shares that forces are too large by as contact lies between two rows along either coordinate, shape (2,) (theory 9.27)."""
        if not self.averages:
            return np.zeros(2)
        each = np.where(self.kinks, KINKED, BETWEEN) * self.between
        return np.asarray(each * np.interp(self.ratio, DEPTHS, (0.0, 1.0, 1.0, 0.0)))

    @property
    def is_told(self) -> bool:
        """Whether it costs enough to be told."""
        few = (self.rows < self.least) & (self.rows < ALL * np.array(self.of))
        is_few = bool(np.all(few | self.round) or np.any((self.rows < ROWS) & self.kinks))
        return (is_few and self.yields.of_force(FEW if self.averages else WORST) > COSTS) or self.costs > COSTS

    @property
    def share(self) -> str:
        """About what share of the force it costs, in words."""
        if not self.averages:
            return OTHERWISE
        return percent(self.costs if self.costs > COSTS else self.yields.of_force(FEW))

    def sentence(self, problem: Problem, contact: Contact, step: int) -> str:
        """What is said of it at the end of a load step."""
        letters, what = Sheet.of(problem, contact.slave).letters, "control points" if contact.of_averages else "constraints"
        least = float(self.rows.min())
        sides = list(zip(letters, self.rows, self.of, strict=True))
        few = [letter for letter, rows, count in sides if rows <= max(ENOUGH, least) and rows < ALL * count]
        few = few or [letter for letter, is_round in zip(letters, self.round, strict=True) if not is_round]
        between = f", and between these it is about {self.depth:.2g} inside its master or apart from it" if self.costs > COSTS else ""
        stage = problem.stages[problem.stage_of(step)].name
        return (
            f"contact {contact.name!r}, load step {step}, the last of stage {stage!r}: it is too narrow for its slave "
            f"{contact.slave.words}: {self.rows[0]:.1f} of {self.of[0]} rows of {what} along {letters[0]} and {self.rows[1]:.1f} of "
            f"{self.of[1]} along {letters[1]} bear it{between}. Forces under given motions may be off by about {self.share}, pressures by "
            f"more. Take twice as many elements or more along {' and '.join(few)} (bodies.{contact.slave.body}.mesh.elements), or shorter "
            "ones there (mesh.grading)"
        )


def forces(pair: Pair, pressure: FloatArray, projections: Projections) -> FloatArray:
    """Forces of constraints, shape (n,): their pressures by the integrals of their functions over what has a foot (theory 9.9)."""
    return np.asarray(pressure * areas(pair, pair.slave.area * (projections.found > 0)))


def areas(pair: Pair, area: FloatArray) -> FloatArray:
    """Integrals of the constraints' functions with areas of quadrature points, shape (n,)."""
    test = pair.slave.test
    acting = np.einsum("eqa,eq->ea", test.values.reshape(*_by_element(pair), -1), area.reshape(_by_element(pair)))
    return np.bincount(test.nodes.ravel(), acting.ravel(), test.count).astype(np.float64)


def _by_element(pair: Pair) -> tuple[int, int]:
    return pair.slave.elements, pair.slave.per_element


def bearing(equilibrium: Equilibrium, balance: Balance, number: int, yields: Yields) -> Bearing:
    """What bears a contact that is closed (theory 9.9, 9.10).

    Parameters
    ----------
    equilibrium : Equilibrium
    balance : Balance
    number : int
        Of the contact.
    yields : Yields
    """
    pair, kinematics = equilibrium.pairs[number].pair, balance.kinematics[number]
    borne = forces(pair, balance.responses[number].pressure, kinematics.projections)
    (first, round_first), (second, round_second) = (_sums(pair.places, borne, axis) for axis in (0, 1))
    rows = np.array([np.sum(sums) ** 2 / (sums @ sums) for sums in (first, second)])
    whole = equilibrium.problem.images == 1  # beside planes of symmetry there are others
    between = [whole and own < min(TWO, ALL * len(sums)) and _between(sums) for own, sums in zip(rows, (first, second), strict=True)]
    directions = Sheet.of(equilibrium.problem, pair.contact.slave).directions
    u, v = (direction.order == 1 or direction.family == "L" for direction in directions)
    round_poles, counts = (round_first, round_second), (len(first), len(second))
    by_element = [count / direction.elements for count, direction in zip(counts, directions, strict=True)]
    least = _least(equilibrium.problem, pair.contact, np.array(by_element))
    depth = _depth(pair, balance, number)
    averages = pair.contact.enforcement == "mortar"
    return Bearing(rows, counts, least, (u, v), round_poles, (between[0], between[1]), averages, depth, yields)


def _least(problem: Problem, contact: Contact, by_element: FloatArray) -> FloatArray:
    """Rows below which a contact is too narrow where there are so few along both coordinates; `by_element`: how many each has."""
    if contact.enforcement == "dual" and problem.images == 1:
        return np.full(2, DUAL_ROWS)
    if contact.enforcement == "kts" and problem.images == 1:
        return np.asarray(np.maximum(ROWS, SHARE_OF_ELEMENT * by_element))
    return np.full(2, ROWS)


def _between(sums: FloatArray) -> bool:
    """Whether two rows side by side bear alike (theory 9.27)."""
    pairs = np.minimum(sums[:-1], sums[1:])
    return bool(pairs.max(initial=0.0) >= ALIKE * sums.sum() > 0.0)


def _sums(places: FloatArray, borne: FloatArray, axis: int) -> tuple[FloatArray, bool]:
    """Forces by row, of constraints at the same place along a coordinate, and whether a pole that it goes round bears most (theory 9.9).

    A pole is a constraint that is alone across the coordinate: all rows have an equal part of it.
    """
    row, across = (np.unique(places[:, k], return_inverse=True)[1].ravel() for k in (axis, 1 - axis))
    at_pole = np.bincount(across)[across] == 1
    sums, of_pole = np.bincount(row, np.where(at_pole, 0.0, borne)), float(borne[at_pole].sum())
    return np.asarray(sums + of_pole / len(sums), np.float64), of_pole > 0.5 * float(borne.sum())


def _depth(pair: Pair, balance: Balance, number: int) -> float:
    """How deep quadrature points are where there is pressure (theory 9.10)."""
    projections = balance.kinematics[number].projections
    acting = pair.slave.area * abs(pair.field(balance.responses[number].pressure)) * (projections.found > 0)
    if not acting.any():
        return 0.0
    return float(np.sqrt(acting @ np.square(gaps(pair, balance.positions, projections)) / acting.sum()))
