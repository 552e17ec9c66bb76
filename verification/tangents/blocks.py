"""The tangent block by block: every block of every part against the extended-precision twin's derivative by its control point."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from isomortar._bindings import FaceArrays, Pattern
from isomortar._twin import ContactChange
from isomortar.geometry.patch import FloatArray
from isomortar.harness.tangents import PairTangent, solid_twin
from isomortar.harness.visits import Visit
from isomortar.solve.equilibrium import Equilibrium

BoolArray = NDArray[np.bool_]
Change = TypeVar("Change")


@dataclass(frozen=True)
class PartBlocks:
    """Blocks of one part, shape (blocks, kinds, 3): derivatives by single control points, ours and the twin's.

    `outside`: the largest derivative of the twin for which the part has no block, as a share of its largest.
    """

    part: str
    ours: FloatArray
    twin: FloatArray
    outside: float

    @property
    def errors(self) -> FloatArray:
        """Error of each block relative to its own size, shape (blocks,)."""
        size, apart = np.linalg.norm(self.twin, axis=(1, 2)), np.linalg.norm(self.ours - self.twin, axis=(1, 2))
        return np.divide(apart, size, out=np.where(apart == 0, 0.0, np.inf), where=size > 0)


def tangent_blocks(equilibrium: Equilibrium, visit: Visit) -> list[PartBlocks]:
    """All blocks at a state where control points of every pair are active.

    Parameters
    ----------
    equilibrium : Equilibrium
        Of the method "uzawa": its patterns have room for the whole tangent.
    visit : Visit

    Raises
    ------
    KernelError
        A branch switches within the step of the differences.
    """
    _, solid = equilibrium.solid.forces_and_tangent(visit.positions)
    every = range(len(visit.positions))
    changes = _by_points(visit.positions, every, lambda along: solid_twin(equilibrium, visit.positions, along))
    parts = [_part("solid", equilibrium.solid.pattern, solid, np.array(changes), np.ones(len(every), bool))]
    for pair, at in zip(equilibrium.pairs, visit.pairs, strict=True):
        parts += _pair_parts(PairTangent(pair, visit.positions, at))
    return parts


def _pair_parts(tangent: PairTangent) -> list[PartBlocks]:
    """Parts of one contact pair."""
    pair, state, blocks = tangent.pair.pair, tangent.response.state, tangent.blocks
    sides = np.union1d(pair.slave.point, pair.master.patch.point) if isinstance(pair.master, FaceArrays) else pair.slave.point
    changes = _by_points(tangent.positions, sides, tangent.twin)
    active, whole = state > 0, np.ones(len(tangent.positions), bool)

    def part(name: str, pattern: Pattern, ours: FloatArray, quantity: Callable[[ContactChange], FloatArray], rows: BoolArray) -> PartBlocks:
        twin = np.zeros((len(tangent.positions), 3, len(rows), ours.shape[1]))
        twin[sides] = [[quantity(change).reshape(len(rows), -1) for change in by_point] for by_point in changes]
        return _part(name, pattern, ours, twin, rows)

    rows, wide = blocks.patterns.rows, blocks.patterns.wide
    parts = [
        part("normal, geometric", tangent.pattern, tangent.normal, lambda change: change.normal_forces, whole),
        part("normal, gap", rows, blocks.rows[:, :1], lambda change: change.gap, active),
        part("normal, pressure", wide, blocks.changes[:, :1], lambda change: change.pressure, active),
        part("condensed", tangent.pattern, tangent.condensed, lambda change: change.forces, whole),
    ]
    if tangent.pair.friction.acts:
        parts += [
            part("tangential, geometric", tangent.pattern, tangent.tangential, lambda change: change.tangential_forces, whole),
            part("tangential, projection", rows, blocks.rows[:, 1:3], lambda change: change.coordinates, active),
            part("tangential, slip increment", rows, blocks.rows[:, 3:5], lambda change: change.slip, active),
            part("tangential, metric", rows, blocks.rows[:, 5:8], lambda change: change.metric, active),
            part("stick", wide, blocks.changes[:, 1:], lambda change: change.traction, state == 1),
            part("slip", wide, blocks.changes[:, 1:], lambda change: change.traction, state == 2),
        ]
    return parts


def _by_points(positions: FloatArray, points: Iterable[int], derivative: Callable[[FloatArray], Change]) -> list[list[Change]]:
    """Derivatives by the three coordinates of each of some control points."""
    changes = []
    for point in points:
        units = np.zeros((3, *positions.shape))
        units[:, point] = np.eye(3)
        changes.append([derivative(unit) for unit in units])
    return changes


def _part(name: str, pattern: Pattern, ours: FloatArray, twin: FloatArray, rows: BoolArray) -> PartBlocks:
    """The blocks of some rows of a pattern; `twin` has shape (control points, 3, rows, kinds)."""
    row = np.repeat(np.arange(len(rows)), np.diff(pattern.start))
    chosen = rows[row]
    row, column = row[chosen], pattern.column[chosen]
    blocks = twin[column, :, row].transpose(0, 2, 1)
    elsewhere = twin * rows[None, None, :, None]
    elsewhere[column, :, row] = 0.0
    largest = float(np.abs(blocks).max(initial=0.0))
    outside = float(np.abs(elsewhere).max(initial=0.0)) / (largest or 1.0)
    return PartBlocks(name, ours[chosen], blocks, outside)
