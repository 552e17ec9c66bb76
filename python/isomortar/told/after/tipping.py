"""Bodies that loads tip over, lift, or tip and slide: contact presses, and rubs as far as it presses, and has nothing to balance these."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import compress

import numpy as np
from scipy import sparse

from isomortar._frozen import frozen
from isomortar.errors import LostProjectionError
from isomortar.geometry.patch import FloatArray
from isomortar.model.glue import named
from isomortar.model.rank import extent
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.feet import gaps
from isomortar.solve.free_motions import FreeMotion, direction, going
from isomortar.solve.record import ContactState, State
from isomortar.solve.resting import next_to_nothing
from isomortar.told.after.limit_load import ALONG, Touch, groups_of, heights
from isomortar.told.after.load_work import borne_loads

#: Bodies that bear on less than this share of what is over the master are on its edge: soft ones are over it before rigid ones would be.
EDGE = 1.0 / 3.0
#: Directions along a face in which slips are looked at: all others are off by less than four per cent.
DIRECTIONS = 12
#: Friction in place of what contacts have where bodies tip alone: that they slide is another matter.
STICKS = 10.0
#: Of slips along so many directions the longest is longer than the slip along the nearest one by less than this.
BETWEEN = 1.0 / np.cos(np.pi / DIRECTIONS)
#: Friction so many times as large is advised where it would do.
MORE = 2.0
#: Rates of opening, beside the speed of what touches, above which a motion opens it.
ASKEW = 0.1
#: What helps where the slave goes on beyond that.
FINER = "refine the slave, whose outermost control points bear within its edge, "
#: Share of what is over the master that a motion has to open, or leave open: one that slides along it opens nothing.
OPENS = 0.25


def tipping(equilibrium: Equilibrium, state: State) -> Iterator[tuple[set[int], str]]:
    """Pieces and sentences, without a capital, on bodies that loads turn over an edge of what bears them, or lift (theory 9.12).

    Parameters
    ----------
    equilibrium : Equilibrium
        Its loads are those at the end of the increment that was begun last.
    state : State
        Where the last load increment ended that converged.
    """
    for bodies in _loaded(equilibrium, state):
        way = overturning(bodies.touches, bodies.works, bodies.sizes)
        if way is not None:
            with suppress(LostProjectionError):
                yield bodies.pieces, _said(equilibrium, state, bodies, way)


def giving_way(equilibrium: Equilibrium, state: State) -> Iterator[tuple[set[int], str]]:
    """The same on bodies that slide and tip at once, as in a corner, by the friction that contacts have (theory 9.12).

    Nothing is said where there are pressures, however large, by which contacts would bear the loads.
    """
    for bodies in _loaded(equilibrium, state):
        if overturning(bodies.touches, bodies.works, bodies.sizes, [_friction(touch) for touch in bodies.touches]) is not None:
            yield bodies.pieces, _gives_way(equilibrium, bodies)


@frozen
class _Loaded:
    """Bodies that touch each other, by the numbers of their pieces, with what they touch; motions, works on these, and their sizes."""

    pieces: set[int]
    touches: list[Touch]
    motions: list[FreeMotion]
    works: FloatArray
    sizes: FloatArray


def _loaded(equilibrium: Equilibrium, state: State) -> Iterator[_Loaded]:
    """Bodies that loads would move; a heavy one that they do not touch does not matter to the sizes of works."""
    motions, works, touches = borne_loads(equilibrium, state)
    if not touches:
        return
    pieces = np.array([motion.piece for motion in motions])
    sizes = np.sqrt(np.bincount(pieces, works**2))[pieces]
    for mine, near in groups_of(touches, pieces):
        if near and np.any(works[mine]):
            yield _Loaded(set(pieces[mine]), near, list(compress(motions, mine)), works[mine], sizes[mine])


def _friction(touch: Touch) -> float:
    """The coefficient of a contact, no less for the directions between those looked at; what a cohesion bears has no limit here."""
    contact = touch.pair.pair.contact
    return STICKS if contact.cohesion > 0.0 else BETWEEN * contact.friction


def overturning(
    touches: Sequence[Touch], works: FloatArray, sizes: FloatArray, friction: Sequence[float] | None = None
) -> FloatArray | None:
    """The motion on which loads do most work beyond what contact takes up, all of it or on a share EDGE of its area (theory 9.12).

    Its amounts add up to one: as few motions as can be. `sizes` are those of the works of the motion's body: a heavy one beside it does
    not matter. Without `friction` bodies stick, and the motion opens much of a contact. None: there is no such motion.
    """
    from scipy.optimize import linprog

    table, costs = _resistance(touches, friction or [STICKS] * len(touches))
    for crushed in (False, True):
        limits = np.append(np.zeros(table.shape[0]), 1.0)
        total = np.repeat([1.0, 0.0], [2 * len(works), len(costs)])
        bounds = [(0.0, None)] * 2 * len(works) + [(0.0, None if crushed else 0.0)] * len(costs)
        gained = np.concatenate([works, -works, -np.linalg.norm(works) * costs]) / np.abs(works).max()
        found = linprog(-gained, A_ub=sparse.vstack([table, total[None]]), b_ub=limits, bounds=bounds)
        if not found.success:
            continue
        way: FloatArray = np.diff(found.x[: 2 * len(works)].reshape(2, -1)[::-1], axis=0)[0]
        size = sizes[np.abs(way) > ALONG * np.abs(way).max()].max(initial=0.0) / np.abs(works).max()
        if -found.fun > ALONG * size > 0.0 and (friction or any(_opened(touch, way) > OPENS for touch in touches)):
            return way
    return None


def _resistance(touches: Sequence[Touch], friction: Sequence[float]) -> tuple[sparse.csr_array, FloatArray]:
    """Rows that no motion, forwards or backwards, makes positive but as far as it presses constraints, and what that costs each of them."""
    rates = [_rates(touch, coefficient) for touch, coefficient in zip(touches, friction, strict=True)]
    pressed = [np.full((len(own) // len(touch.share), 1), 1.0) for own, touch in zip(rates, touches, strict=True)]
    each = sparse.block_diag([part for part, touch in zip(pressed, touches, strict=True) for _ in touch.share])
    beside = np.concatenate([touch.beside for touch in touches])
    moves = np.concatenate([*rates, beside])
    presses = sparse.vstack([-each, sparse.csr_array((len(beside), each.shape[1]))])
    return sparse.hstack([moves, -moves, presses], format="csr"), np.concatenate([touch.share / EDGE for touch in touches])


def _rates(touch: Touch, friction: float) -> FloatArray:
    """Mean rates of closing, and with friction of slips along some directions as well, shape (n * directions, motions)."""
    if not touch.pair.friction.acts:
        return touch.closing / touch.weight[:, None]
    angles = 2.0 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    slips = np.einsum("ad,nam->ndm", [np.cos(angles), np.sin(angles)], touch.slipping)
    rates = (touch.closing[:, None] + friction * slips) / touch.weight[:, None, None]
    return np.asarray(rates).reshape(-1, rates.shape[2])


def _opened(touch: Touch, way: FloatArray) -> float:
    """Share of what is over the master that a motion opens, or that is open; none if it goes along the contact."""
    rates, beside = touch.closing @ way / touch.weight, touch.beside @ way
    goes = 0.0 if touch.pair.friction.acts else np.abs(way).max()  # without friction slips have no lengths
    speed = np.max([*np.hypot(rates, touch.lengths(way) / touch.weight), goes])
    opens, opens_more = rates < -ASKEW * speed, beside < -ASKEW * speed
    return float(1.0 - touch.share @ ~opens) if opens.any() or opens_more.any() else 0.0


def _said(equilibrium: Equilibrium, state: State, bodies: _Loaded, way: FloatArray) -> str:
    """On the bodies that go, and what opens."""
    touches, motions, works = bodies.touches, bodies.motions, bodies.works
    goes = going(equilibrium.numbering, motions, way)
    opened = [touch for touch in touches if _opened(touch, way) > OPENS]
    contacts = " and ".join(repr(touch.pair.pair.contact.name) for touch in opened)
    if goes.turns:
        how = f"turn {goes.bodies} about an axis along ({direction(goes.turn)}) through ({goes.through(equilibrium.origin)})"
        end, cure = "it tips over", "Let loads act nearer to the middle of what bears them, take a wider base, "
    else:
        how, end, cure = f"move {goes.bodies} along ({direction(goes.shift)})", "it lifts off", "Take less load that way, "
    begun = dict(zip(equilibrium.pairs, state.contacts, strict=True))
    met = " or ".join(map(repr, _met(equilibrium, state, touches, motions, way)))
    end += f" until contact {met} closes, where it may rest: bring it there by a support first if that is meant" if met else ""
    finer = goes.turns and any(_finer_bears(touch, state.positions, begun[touch.pair], motions, way, works) for touch in opened)
    return (
        f"loads {how} by then, which contact {contacts} could hold by a pull alone, or by what presses on less than a third of the area: "
        f"{end}. {cure}{FINER if finer else ''}or hold or move it by a support"
    )


def _gives_way(equilibrium: Equilibrium, bodies: _Loaded) -> str:
    """On bodies that slide, tip or both; with normality they would open what they slide on, and no direction is told."""
    pieces = [equilibrium.numbering.pieces[number] for number in sorted(bodies.pieces)]
    names = " and ".join(named(piece, piece[0].name) for piece in pieces)
    contacts = " and ".join(repr(touch.pair.pair.contact.name) for touch in bodies.touches)
    open_ = [
        pair for pair in equilibrium.pairs if bodies.pieces & set(pair.pair.pieces) and not any(t.pair is pair for t in bodies.touches)
    ]
    met = " or ".join(repr(pair.pair.contact.name) for pair in open_)
    end = f" until contact {met} closes, where it may rest: bring it there by a support first" if met else ", and is nowhere at rest"
    rubs = any(touch.pair.friction.acts for touch in bodies.touches)
    held = overturning(bodies.touches, bodies.works, bodies.sizes, [MORE * _friction(touch) for touch in bodies.touches]) is None
    friction = "with the friction that they have" if rubs else "without friction"
    more = "more friction, " if held else "" if rubs else "some friction, "
    return (
        f"no pressures of contact {contacts}, {friction}, are in balance with the loads on {names} by then: it slides, tips over, or both "
        f"at once{end}. Take {more}less load beside what presses, or hold or move it by a support"
    )


def _met(equilibrium: Equilibrium, state: State, touches: Sequence[Touch], motions: Sequence[FreeMotion], way: FloatArray) -> Iterator[str]:
    """Contacts that are open all over, and closed by the motion before a body has gone by its own size."""
    displacement = np.tensordot(way, [motion.displacement for motion in motions], 1)
    speed = float(np.linalg.norm(displacement, axis=-1).max())
    size = np.max([extent(equilibrium.numbering.pieces[motion.piece])[1] for motion, share in zip(motions, way, strict=True) if share])
    for pair, begun in zip(equilibrium.pairs, state.contacts, strict=True):
        if any(touch.pair is pair for touch in touches):
            continue
        step = next_to_nothing(pair)
        start, end = (
            heights(pair, pair.kinematics(positions, begun).control)
            for positions in (state.positions, state.positions + step * displacement / speed)
        )
        over = np.isfinite(start) & np.isfinite(end)
        closes, height = (end[over] - start[over]) / step, start[over]
        if np.any((height < 0.0) & (-height < size * closes) & (closes > ASKEW)):
            yield pair.pair.contact.name


def _finer_bears(
    touch: Touch, positions: FloatArray, begun: ContactState, motions: Sequence[FreeMotion], way: FloatArray, works: FloatArray
) -> bool:
    """Whether loads do no work on a turn about the slave's edge: constraints are averages, and the outermost bear within it."""
    pair, step = touch.pair, next_to_nothing(touch.pair)
    moved = positions + step * np.tensordot(way, [motion.displacement for motion in motions], 1)
    start, end = pair.kinematics(positions, begun).projections, pair.kinematics(moved, begun).projections
    rates = (gaps(pair.pair, moved, end) - gaps(pair.pair, positions, start)) / step
    if rates.max() <= ALONG * np.abs(rates).max():
        return False
    going_on = np.isin([motion.piece for motion in motions], [motion.piece for motion, share in zip(motions, way, strict=True) if share])
    lift = np.linalg.lstsq(touch.closing / touch.weight[:, None] * going_on, -np.ones(len(touch.weight)), rcond=ALONG)[0]
    return bool(works @ (way + rates.max() * lift) <= 0.0)
