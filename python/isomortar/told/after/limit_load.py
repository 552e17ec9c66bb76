"""How much of their loads friction can bear: rigid bodies on beds of springs, and the way on which friction resists least (theory 9.11)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from isomortar._bindings import Control
from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model.supports import BoolArray
from isomortar.solve.contact import PairMechanics
from isomortar.solve.record import ContactState, State
from isomortar.solve.resting import mean_heights, next_to_nothing

#: Rates of gaps, beside the largest one of all motions, below which a motion is along the contact: faces are flat to some digits.
ALONG = 1e-3
#: Roots of what friction resists motions by, beside the largest, below which it resists none: that of a light body is far less.
RESISTS = 1e-7
#: Share of a slave's constraints that touch from which on its moments are known: of less the place is not, before it is pressed.
FACE = 0.5
#: Iterations in which a bed of springs, and the motion that friction resists least, are found, or there are none.
ITERATIONS = 50


@frozen
class Touch:
    """Constraints of a pair that touch, by their numbers, and what motions do to them.

    `closing`: rates of their gaps, shape (n, motions); `slipping`: those of their slips, in lengths, shape (n, 2, motions); `beside`: mean
    rates of gaps of the others, which are open, shape (those, motions); `share`: parts of the area over the master, shape (n,).
    """

    pair: PairMechanics
    near: BoolArray
    weight: FloatArray
    closing: FloatArray
    slipping: FloatArray
    beside: FloatArray
    share: FloatArray

    @property
    def is_face(self) -> bool:
        """Whether most of the slave touches."""
        return bool(self.near.mean() >= FACE)

    def is_moved(self, some: BoolArray) -> bool:
        """Whether some of the motions do anything to it."""
        return bool(np.any(self.closing[:, some]) or np.any(self.slipping[..., some]))

    def by(self, some: BoolArray) -> Touch:
        """The same by some of the motions alone."""
        return replace(self, closing=self.closing[:, some], slipping=self.slipping[..., some], beside=self.beside[:, some])

    def lengths(self, way: FloatArray) -> FloatArray:
        """How far each slips."""
        return np.asarray(np.linalg.norm(self.slipping @ way, axis=1))

    def limits(self, bed: FloatArray) -> FloatArray:
        """What friction can bear at each, where a rigid motion presses them on a bed of springs."""
        pressure = np.zeros(len(self.near))
        pressure[self.near] = self.pressures(bed)
        return self.pair.radius(pressure)[self.near]

    def pressures(self, bed: FloatArray) -> FloatArray:
        """Their pressures by such a motion."""
        return np.asarray(np.maximum(self.closing @ bed, 0.0) / self.weight)


def touches_of(mechanics: Sequence[PairMechanics], state: State, displacements: Sequence[FloatArray]) -> list[Touch]:
    """What bears of all pairs, or touches, or is nearest to that, by motions given as displacements.

    Raises
    ------
    LostProjectionError
    """
    pairs = list(zip(mechanics, state.contacts, strict=True))
    found = [heights(pair, pair.kinematics(state.positions, begun).control) for pair, begun in pairs]
    nearest = min(max((float(height.max(initial=-np.inf)) for height in found), default=-np.inf), 0.0)
    touches = []
    for (pair, begun), height in zip(pairs, found, strict=True):
        bears, highest = (begun.pressure > 0.0) & np.isfinite(height), float(height.max(initial=-np.inf))
        touching = np.isfinite(height) & (height >= highest - next_to_nothing(pair)) & (highest >= nearest - next_to_nothing(pair))
        near = bears if bears.any() else touching
        if near.any():
            touches.append(_touch(pair, state.positions, begun, near, np.isfinite(height) & ~near, displacements))
    return touches


def groups_of(touches: Sequence[Touch], pieces: IntArray) -> Iterator[tuple[BoolArray, list[Touch]]]:
    """Motions, each of a piece, of those that touch each other or by others between them, and what touches there, by these motions alone.

    Loads on the rest do not matter to them, however large.
    """
    from scipy.sparse.csgraph import connected_components

    names, of_names = np.unique(pieces, return_inverse=True)
    moved = np.array([[touch.is_moved(pieces == name) for name in names] for touch in touches], dtype=np.float64)
    labels = connected_components(moved.T @ moved)[1]
    for label in np.unique(labels):
        mine = (labels == label)[of_names]
        yield mine, [touch.by(mine) for touch in touches if touch.is_moved(mine)]


def heights(pair: PairMechanics, control: Control) -> FloatArray:
    """Mean gaps; minus infinity of what has no foot, or with friction no metric to measure slips in, as at a pole."""
    measured = np.all(control.metric[:, [0, 2]] > 0.0, axis=1) if pair.friction.acts else True
    return np.where(measured, mean_heights(control), -np.inf)


def _touch(
    pair: PairMechanics,
    positions: FloatArray,
    begun: ContactState,
    near: BoolArray,
    beside: BoolArray,
    displacements: Sequence[FloatArray],
) -> Touch:
    """Of a pair at some positions; rates are differences over ways that are next to nothing."""
    at, step = pair.kinematics(positions, begun).control, next_to_nothing(pair)
    ends = [pair.kinematics(positions + step * displacement, begun).control for displacement in displacements]
    closing = np.stack([(end.gap - at.gap) / step for end in ends], axis=1)
    slips = np.stack([(end.slip[near] - at.slip[near]) / step for end in ends], axis=2)
    slipping = _in_lengths(at.metric[near] / at.square[near, None]) @ slips if pair.friction.acts else np.zeros_like(slips)
    weight = at.weight[near]
    share = weight / (weight.sum() + at.weight[beside].sum())
    return Touch(pair, near, weight, closing[near], slipping, closing[beside] / at.weight[beside, None], share)


def _in_lengths(metric: FloatArray) -> FloatArray:
    """Matrices that make lengths of slips in coordinates, shape (n, 2, 2)."""
    m11, m12, m22 = metric.T
    length = np.sqrt(m11)
    rows = np.stack([length, m12 / length, np.zeros_like(length), np.sqrt(np.maximum(m22 - m12**2 / m11, 0.0))], axis=1)
    return rows.reshape(-1, 2, 2)


def along_contact(touches: Sequence[Touch]) -> FloatArray:
    """Motions that neither close nor open what touches, shape (motions, those); all, where nothing does."""
    if not touches:
        return np.zeros((0, 0))
    _, values, motions = np.linalg.svd(np.concatenate([touch.closing / touch.weight[:, None] for touch in touches]))
    return np.asarray(motions[np.count_nonzero(values > ALONG * max(values.max(), ALONG)) :].T)


def pressed_bed(touches: Sequence[Touch], works: FloatArray, along: FloatArray) -> FloatArray | None:
    """The motion that presses bodies, as rigid ones on beds of springs, until these bear their loads; None: they do not (theory 9.11).

    Friction holds the motions along the contact, and is given no part in others.
    """
    closing = np.concatenate([touch.closing for touch in touches])
    weight = np.concatenate([touch.weight for touch in touches])
    slipping = np.concatenate([(touch.slipping / np.sqrt(touch.weight)[:, None, None]).reshape(-1, len(works)) for touch in touches])
    _, values, rows = np.linalg.svd((slipping @ along).T @ slipping)
    others = rows[np.count_nonzero(values > ALONG**2 * values.max(initial=0.0)) :].T
    bed, presses = np.zeros(len(works)), np.ones(len(weight), dtype=bool)
    for _ in range(ITERATIONS):
        stiffness = (closing[presses] / weight[presses, None]).T @ closing[presses]
        bed = others @ np.linalg.lstsq(others.T @ stiffness @ others, others.T @ works, rcond=ALONG**2)[0]
        before, presses = presses, closing @ bed > 0.0
        if np.array_equal(before, presses):
            left = others.T @ (works - stiffness @ bed)
            return bed if np.linalg.norm(left) <= ALONG * np.linalg.norm(works) else None
    return None


def least_resisted(touches: Sequence[Touch], limits: Sequence[FloatArray], along: FloatArray, works: FloatArray) -> FloatArray:
    """Of motions along the contact on which loads do unit work the one that friction resists least (theory 9.11); zero: it resists none."""
    resisted = [np.sqrt(limit)[:, None, None] * (touch.slipping @ along) for touch, limit in zip(touches, limits, strict=True)]
    slips, limit, work = np.concatenate(resisted), np.concatenate(limits), along.T @ works
    lengths, way = np.ones(len(limit)), np.zeros(len(work))
    for _ in range(ITERATIONS):
        shares = (slips / np.sqrt(lengths)[:, None, None]).reshape(-1, len(work))
        _, values, ways = np.linalg.svd(shares, full_matrices=False)
        resists = values > RESISTS * values.max(initial=0.0)
        values, ways = values[resists], ways[resists]
        found = ways.T @ (ways @ work / values**2)
        if not work @ found > 0.0 or np.linalg.norm(ways.T @ (ways @ work) - work) > ALONG * np.linalg.norm(work):
            return np.zeros(len(works))
        way = found / (work @ found)
        lengths = np.linalg.norm(slips @ way, axis=1) / np.sqrt(np.where(limit > 0.0, limit, 1.0))
        lengths = np.maximum(lengths, ALONG * lengths.max())
    return along @ way
