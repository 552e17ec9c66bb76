"""What bodies come to rest on: what they come to first, and the next constraints where they would turn about that alone (theory 6.8)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from isomortar._bindings import Control
from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.model import constants
from isomortar.model.supports import BoolArray
from isomortar.solve.contact import PairMechanics
from isomortar.solve.metric import tangent_lengths
from isomortar.solve.record import ContactState


@frozen
class RatesOfPair:
    """Control quantities of a pair, and rates of its gaps and slips by rigid motions, all of them lengths.

    Parameters
    ----------
    control : Control
    gaps, slips : ndarray, shape (n, motions) and (n, 2, motions)
        Without friction slips are nothing that contact would hold.
    """

    control: Control
    gaps: FloatArray
    slips: FloatArray

    def held(self, closed: BoolArray) -> FloatArray:
        """What constraints would hold if these were closed, shape (its rates, motions)."""
        return np.concatenate([self.gaps[closed], *np.swapaxes(self.slips[closed], 0, 1)])


@frozen
class Foothold:
    """What a pair may begin with.

    Parameters
    ----------
    near : ndarray of bool, shape (n,)
        Constraints that bear, or begin as closed.
    beyond : ndarray, shape (n,)
        How much farther others, which may begin with them, are from the master than the nearest one; infinite of those that may not.
    rates : RatesOfPair
    """

    near: BoolArray
    beyond: FloatArray
    rates: RatesOfPair


def rates(pair: PairMechanics, positions: FloatArray, start: ContactState, motions: FloatArray) -> RatesOfPair:
    """Those of a pair by motions of all control points, shape (motions, control points, 3) (theory 6.8)."""
    least = next_to_nothing(pair)
    here, own = pair.kinematics(positions, start).control, np.concatenate([pair.pair.slave.point, pair.pair.master_face])
    there = [pair.kinematics(positions + least * way, start).control if np.any(way[own]) else here for way in motions]
    area = np.where(here.weight > 0.0, here.weight, np.inf)
    gaps = np.stack([(control.gap - here.gap) / area for control in there], axis=-1) / least
    slips = np.stack([(control.slip - here.slip) / area[:, None] * tangent_lengths(here) for control in there], axis=-1) / least
    return RatesOfPair(here, gaps, slips * pair.friction.acts)


def hold_all(all_rates: Iterable[RatesOfPair]) -> bool:
    """Whether constraints with these rates, all closed, leave no motion (theory 6.9)."""
    return not len(_left([by.held(np.ones(len(by.gaps), dtype=np.bool_)) for by in all_rates]))


def foothold(
    pair: PairMechanics, positions: FloatArray, start: ContactState, near: BoolArray, begins: bool, motions: FloatArray
) -> Foothold:
    """That of a pair, by its nearest constraints and motions of all control points, shape (motions, control points, 3) (theory 6.8)."""
    bears, by = bool(np.any(start.pressure != 0.0)), rates(pair, positions, start, motions)
    heights = mean_heights(by.control)
    beyond = (heights.max() if begins else 0.0) - heights  # a contact without a foot has none to begin with
    within = np.bool_(begins) & (beyond <= constants.NEXT * np.sqrt(pair.pair.area))
    return Foothold(near & np.bool_(begins or bears), np.where(within, beyond, np.inf), by)


def rested(feet: Sequence[Foothold], works: FloatArray) -> list[BoolArray]:
    """What is near of each pair, with the next constraints that close by motions which nothing near holds (theory 6.8).

    Loads turn a body to the side on which they do work, along each of the motions; it turns to any side where they do none.
    """
    ends = np.cumsum([len(foot.near) for foot in feet])[:-1]
    beyond, gaps = np.concatenate([foot.beyond for foot in feet]), np.concatenate([foot.rates.gaps for foot in feet])
    near = np.concatenate([foot.near for foot in feet])
    while True:
        left = _left([foot.rates.held(closed) for foot, closed in zip(feet, np.split(near, ends), strict=True)])
        way = left.T @ (left @ works)
        size = np.abs(way).max()
        driven = size > constants.NO_PART * np.abs(works).max()
        closes = gaps @ way / size if driven else np.abs(gaps @ left.T).max(axis=1, initial=0.0)
        others = np.where((closes > constants.HELD) & ~near, beyond, np.inf)
        if not np.isfinite(others).any():
            return np.split(near, ends)
        near[np.argmin(others)] = True


def _left(held: Sequence[FloatArray]) -> FloatArray:
    """Orthogonal motions that change nothing of what is held, with these rates, shape (of them, motions)."""
    *_, values, ways = np.linalg.svd(np.vstack([*held, np.zeros((held[0].shape[1],) * 2)]), full_matrices=False)
    return np.asarray(ways[values <= constants.HELD])


def mean_heights(control: Control) -> FloatArray:
    """Mean gaps of constraints, shape (n,), positive where they penetrate; of those without a foot minus infinity."""
    return np.divide(control.gap, control.weight, out=np.full_like(control.gap, -np.inf), where=control.weight > 0.0)


def next_to_nothing(pair: PairMechanics) -> float:
    """A length that is next to nothing beside the slave face."""
    return constants.NO_PART * float(np.sqrt(pair.pair.area))
