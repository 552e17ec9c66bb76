"""The bordered linear system: the stiffness with constraint rows and the linearised contact conditions around it.

    [ K + K_geo   G^T ] [ dx ]     [ forces              ]
    [ -target'    L   ] [ dl ] = - [ multiplier - target ]

Multiplier columns are scaled by e, rows of the contact conditions by w (theory 6.4), and those of the covariant
tractions by the lengths of the master's tangent vectors: all entries then have the unit of the stiffness, whatever the units and knots.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from isomortar._bindings import Law, Response
from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model import constants
from isomortar.model.supports import BoolArray
from isomortar.solve.contact import Blocks, PairMechanics, pressure_share
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.metric import median, tangent_lengths
from isomortar.solve.singular import PairConditions
from isomortar.solve.system import Source, add_product, block_product


@frozen
class Correction:
    """Newton's correction of positions, and of control pressures and tractions, shape (constraints, 3) for each pair."""

    positions: FloatArray
    multipliers: tuple[FloatArray, ...]


@frozen
class Border:
    """What one pair adds to the system: its blocks, the equations of its multipliers, and their scales."""

    pair: PairMechanics
    blocks: Blocks
    equation: IntArray
    row_scale: FloatArray  # (constraints, 3)
    column_scale: FloatArray  # (3,)
    target: Response
    pressure_share: FloatArray  # derivative of a target pressure by the multiplier: 1 where contact is sharp
    loose: BoolArray  # (constraints, 3)

    def sources(self, unknowns: IntArray) -> tuple[list[Source], list[FloatArray]]:
        """Geometric tangent, constraint columns, condition rows, and the multipliers' own block."""
        patterns = self.blocks.patterns
        columns = np.zeros((len(patterns.rows.column), 3, 3))
        kinds = 3 if self.blocks.rows.shape[1] > 2 else 1
        columns[:, :kinds] = self.column_scale[:kinds, None] * self.blocks.rows[:, :kinds]
        owner = np.repeat(np.arange(len(self.row_scale)), np.diff(patterns.wide.start))
        conditions = -self.row_scale[owner, :, None] * self.blocks.changes
        own = self.row_scale[:, :, None] * self._own_block() * self.column_scale
        sources = [
            Source(patterns.tangent, unknowns, unknowns),
            Source(patterns.rows, self.equation, unknowns, transposed=True),
            Source(patterns.wide, self.equation, unknowns),
            Source(self.pair.diagonal, self.equation, self.equation),
        ]
        return sources, [self.blocks.geometric, columns, conditions, np.ascontiguousarray(own)]

    def _own_block(self) -> FloatArray:
        """Derivative of multiplier - target by the multipliers, shape (constraints, 3, 3) (theory 4.18, 6.3)."""
        active = self.target.state > 0
        own = np.zeros((len(active), 3, 3))
        own[:, [0, 1, 2], [0, 1, 2]] = 1.0
        share = self.pressure_share[active]
        own[active, 0, 0] = 1.0 - share
        slope = self.target.traction_slope[active]  # (constraints, pressure | trial | metric, component)
        own[active, 1:, 0] = -share[:, None] * slope[:, 0]
        if not self.pair.elastic:  # else tractions are functions of slips and pressures
            own[active, 1:, 1:] -= slope[:, 1:3].transpose(0, 2, 1)
        own[:, [0, 1, 2], [0, 1, 2]] += constants.RESISTANCE * (self.loose & active[:, None])
        return own

    def trial_change(self, correction: FloatArray) -> FloatArray:
        """Change of the trial tractions with the positions, shape (constraints, 2)."""
        padded = np.zeros((len(self.blocks.trial), 3, 3))
        padded[:, :2] = self.blocks.trial
        return block_product(self.blocks.patterns.wide, padded, correction)[:, :2]


def solve_bordered(
    equilibrium: Equilibrium,
    balance: Balance,
    laws: Sequence[Law],
    targets: Sequence[Response],
    prescribed: FloatArray | None,
    keep_bodies: bool = False,
) -> tuple[Correction, list[Border | None]]:
    """Newton's correction, with given increments of the prescribed positions (theory 5.4, 6.3).

    `balance.responses` hold the current multipliers, `targets` what the contact conditions make of them. With `keep_bodies` the
    bodies' tangent stays as it was.

    Raises
    ------
    SingularSystemError
    """
    unknowns = equilibrium.supports.equation
    sources, values = equilibrium.body_tangents(balance.positions, keep_bodies)
    size = len(equilibrium.supports.free)
    borders: list[Border | None] = []
    for k, target in enumerate(targets):
        border = _border(equilibrium, k, balance, laws[k], target, size)
        borders.append(border)
        if border is None:
            continue
        more_sources, more_values = border.sources(unknowns)
        sources += more_sources
        values += more_values
        size += int(np.count_nonzero(border.equation >= 0))
    sources, values = equilibrium.seen(sources, values, balance)
    right = _right_hand_side(equilibrium, balance, targets, borders, sources, values, prescribed, size)
    multipliers = [PairConditions(b.pair, b.equation, k) for b, k in zip(borders, balance.kinematics, strict=True) if b is not None]
    solution = equilibrium.solve(sources, values, right, balance.positions, multipliers)
    correction = _correction(equilibrium, solution, balance, targets, borders)
    if prescribed is not None:
        correction.positions[...] += prescribed
    return correction, borders


def solve_with_kept_factors(
    equilibrium: Equilibrium, balance: Balance, targets: Sequence[Response], borders: Sequence[Border | None]
) -> Correction:
    """Correction by the factors of the last `solve_bordered`, which gave `borders`; the states must be the same."""
    size = len(equilibrium.supports.free) + sum(int(np.count_nonzero(b.equation >= 0)) for b in borders if b is not None)
    right = _right_hand_side(equilibrium, balance, targets, borders, [], [], None, size)
    return _correction(equilibrium, equilibrium.solve_again(right), balance, targets, borders)


def in_lengths(positions: FloatArray, multipliers: Sequence[FloatArray], borders: Sequence[Border | None]) -> FloatArray:
    """Positions, and multipliers of shape (constraints, 3) by pair over the scales of their columns, as one vector (theory 6.4)."""
    parts = zip(multipliers, _column_scales(borders), strict=True)
    return np.concatenate([positions.ravel(), *((of_pair / scale).ravel() for of_pair, scale in parts)])


def from_lengths(vector: FloatArray, like: Correction, borders: Sequence[Border | None]) -> Correction:
    """The correction that `in_lengths` makes a vector of, with as many control points and constraints as another one."""
    sizes = [like.positions.size, *(of_pair.size for of_pair in like.multipliers)]
    positions, *multipliers = np.split(vector, np.cumsum(sizes[:-1]))
    changes = (of_pair.reshape(-1, 3) * scale for of_pair, scale in zip(multipliers, _column_scales(borders), strict=True))
    return Correction(positions.reshape(like.positions.shape), tuple(changes))


def _column_scales(borders: Sequence[Border | None]) -> list[FloatArray]:
    """Scales of the multipliers' columns, by pair; ones where nothing is active, and multipliers are zero."""
    return [np.ones(3) if border is None else border.column_scale for border in borders]


def _correction(
    equilibrium: Equilibrium, solution: FloatArray, balance: Balance, targets: Sequence[Response], borders: Sequence[Border | None]
) -> Correction:
    """Newton's correction from the solution of the linear system."""
    positions = -equilibrium.supports.spread(solution, balance.positions)
    changes = (_multiplier_change(border, target, -solution) for border, target in zip(borders, targets, strict=True))
    return Correction(positions, tuple(changes))


def _border(equilibrium: Equilibrium, k: int, balance: Balance, law: Law, target: Response, first: int) -> Border | None:
    """Border of one pair, its equations numbered from `first`; None where nothing is active (theory 6.4)."""
    if not np.any(target.state):
        return None
    pair = equilibrium.pairs[k]
    current = balance.responses[k]
    blocks = pair.blocks(balance.positions, balance.kinematics[k], law, current)
    reached = np.diff(blocks.patterns.rows.start) > 0
    components = 3 if pair.friction.acts else 1
    equation = np.full((len(reached), 3), -1, dtype=np.int32)
    count = int(np.count_nonzero(reached)) * components
    equation[reached, :components] = first + np.arange(count, dtype=np.int32).reshape(-1, components)
    control = balance.kinematics[k].control
    lengths = np.concatenate([[1.0], tangent_lengths(control) if pair.friction.acts else np.ones(2)])
    present = control.weight > 0
    weight = np.where(present, control.weight, median(control.weight[present]))
    loose = pair.loose(balance.kinematics[k].projections.found)
    share = pressure_share(control, law, target)
    return Border(pair, blocks, equation.ravel(), weight[:, None] / lengths, float(law.penalties[0]) * lengths, target, share, loose)


def _right_hand_side(
    equilibrium: Equilibrium,
    balance: Balance,
    targets: Sequence[Response],
    borders: Sequence[Border | None],
    sources: Sequence[Source],
    values: Sequence[FloatArray],
    prescribed: FloatArray | None,
    size: int,
) -> FloatArray:
    """Forces, and distances of the multipliers from their targets, with what the prescribed increment adds to both."""
    right = np.zeros(size)
    free = equilibrium.supports.free
    right[: len(free)] = balance.unbalanced.ravel()[free]
    for border, target, now in zip(borders, targets, balance.responses, strict=True):
        if border is not None:
            apart = np.column_stack([now.pressure - target.pressure, now.traction - target.traction])
            kept = border.equation >= 0
            right[border.equation[kept]] = (border.row_scale * apart).ravel()[kept]
    if prescribed is not None and np.any(prescribed):
        for source, block in zip(sources, values, strict=True):
            if source.column_of is equilibrium.supports.unknowns and not source.transposed:
                add_product(source, block, prescribed, right)
    return right


def _multiplier_change(border: Border | None, target: Response, solution: FloatArray) -> FloatArray:
    """Corrections of p, t_1, t_2 of one pair, shape (constraints, 3)."""
    change = np.zeros((len(target.state), 3))
    if border is not None:
        kept = border.equation >= 0
        change.ravel()[kept] = solution[border.equation[kept]]
        change *= border.column_scale
    return change
