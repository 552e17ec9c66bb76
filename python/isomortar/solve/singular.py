"""What a singular tangent leaves free: a body that moves, contact conditions that repeat each other, or digits that are lost."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from isomortar._frozen import frozen
from isomortar.errors import SingularSystemError
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model.entities import Face
from isomortar.model.glue import named
from isomortar.model.numbering import Numbering
from isomortar.model.supports import Supports
from isomortar.solve.contact import Kinematics, PairMechanics

#: A body moves rigidly where what is left of its motion after the closest rigid one is at most this share of it.
_RIGID = 1e-3
#: Below this share of the largest entry of a direction an equation takes no part in it.
_PART = 0.1


@frozen
class PairConditions:
    """A pair with the equations of its multipliers, shape (3 * constraints,), -1: none; and its kinematics."""

    pair: PairMechanics
    equation: IntArray
    kinematics: Kinematics


def explain(
    rcond: float, null: FloatArray, supports: Supports, positions: FloatArray, numbering: Numbering, contacts: Sequence[PairConditions]
) -> SingularSystemError:
    """The error that says what a singular tangent leaves free.

    Parameters
    ----------
    rcond : float
        Reciprocal condition of the tangent.
    null : ndarray
        A direction, by equations, that the tangent maps to next to nothing.
    supports : Supports
        Whose unknowns are those of the first equations; multipliers follow.
    positions : ndarray, shape (control points, 3)
    """
    said = f"the tangent is singular (reciprocal condition {rcond:.1e})"
    if not len(supports.free):
        return SingularSystemError(
            f"{said}: supports hold all control points, also where they put them into a master, and contact has nothing that could give "
            "way. Hold fewer components, or end the motion at the master"
        )
    if not np.isfinite(null).all():
        return SingularSystemError(f"{said}, and nothing can be said of what it leaves free")
    shares = [_of_pair(contact, null) for contact in contacts]
    moved, held = supports.spread(null, positions), supports.held.ravel()
    if shares and max(float(np.abs(share).max()) for share in shares) > np.abs(moved).max():
        largest = int(np.argmax([np.abs(share).max() for share in shares]))
        return _repeated(said, contacts[largest], np.flatnonzero(shares[largest] > _PART * shares[largest].max()), contacts, held)
    place, sentence = _rigid(moved, positions, numbering, supports)
    for contact in contacts if not sentence else ():
        active = _active(contact)
        there, total = _points_around(contact, active)
        if 2 * there < total:
            return _repeated(said, contact, active, contacts, held)
    return SingularSystemError(f"{said}: {sentence or _soft(place, numbering)}", place)


def _of_pair(contact: PairConditions, null: FloatArray) -> FloatArray:
    """Entries of a direction for the multipliers of a pair, largest by constraint, shape (constraints,)."""
    values = np.zeros(len(contact.equation))
    values[contact.equation >= 0] = null[contact.equation[contact.equation >= 0]]
    return np.abs(values).reshape(-1, 3).max(axis=1)


def _active(contact: PairConditions) -> NDArray[np.intp]:
    """Constraints that have conditions."""
    return np.flatnonzero(contact.equation.reshape(-1, 3)[:, 0] >= 0)


def _points_around(contact: PairConditions, among: NDArray[np.intp]) -> tuple[int, int]:
    """How many quadrature points around some constraints are on the master, and how many there are."""
    nodes = contact.pair.pair.slave.test.nodes
    found = contact.kinematics.projections.found.reshape(len(nodes), -1) > 0
    around = found[np.isin(nodes, among).any(axis=1)]
    return int(np.count_nonzero(around)), around.size


def _repeated(
    said: str, contact: PairConditions, among: NDArray[np.intp], contacts: Sequence[PairConditions], held: NDArray[np.bool_]
) -> SingularSystemError:
    """Contact conditions without effect: too few points on the master, or too few unknowns that they bear on."""
    pair = contact.pair.pair
    touched = np.asarray(held.reshape(-1, 3).any(axis=1))
    prescribed = int(np.count_nonzero(pair.some_carriers(touched)[among]))
    there, total = _points_around(contact, among)
    where = f"contact {contact.pair.pair.contact.name!r}: the conditions of {len(among)} constraints, the first of them {among[0]}"
    others = {other.pair.pair.contact.name: _shared(contact, among, other) for other in contacts if other is not contact}
    twice = max(others, key=lambda name: others[name], default="")
    beside = (
        f"rest on {there} of the {total} quadrature points around them; the others are beside the master. Refine the slave, use a larger "
        "master, end the motion earlier, or bring the slave onto its master from above"
    )
    if 2 * there < total:
        reason = beside
    elif 0 < prescribed < len(among):
        sticks = pair.contact.friction_law.acts and isinstance(pair.contact.master, Face)  # which may be too coarse for what sticks to it
        ways = 'refine the master, try solver.method = "uzawa", ' if sticks else ""
        reason = (
            f"repeat what supports prescribe: {prescribed} of them constrain control points that supports hold, and the others cannot make "
            f"good what is prescribed there. Keep supports off the edge of the contact face, hold fewer components, {ways}or do not move "
            "the edge into the master"
        )
    elif others.get(twice):
        reason = (
            f"repeat others: {others[twice]} of them constrain control points that contact {twice!r} constrains as well, and "
            "what sticks to one master can neither stick to another one nor press on it in the same direction. Take friction from one of "
            'the two contacts, remove one, keep their faces apart, or try solver.method = "uzawa"'
        )
    elif there < total:
        reason = beside
    else:
        reason = "repeat each other; the slave may be finer and stiffer than its master: swap the two, or refine the master"
    return SingularSystemError(f"{said}. {where}, {reason}", int(among[0]))


def _shared(contact: PairConditions, among: NDArray[np.intp], other: PairConditions) -> int:
    """How many of some constraints of a contact are on control points that active constraints of another one are on as well."""
    one, two = contact.pair.pair, other.pair.pair
    theirs = np.isin(one.slave.point, two.slave.point[two.carriers[_active(other)].nonzero()[1]])
    return int(np.count_nonzero(one.carriers[among] @ theirs.astype(np.float64)))


def _rigid(moved: FloatArray, positions: FloatArray, numbering: Numbering, supports: Supports) -> tuple[int, str]:
    """The control point that moves most, and how its body moves without forces; empty if it deforms."""
    point = int(np.argmax(np.linalg.norm(moved, axis=1)))
    piece = numbering.piece_of(point)
    own = numbering.piece_points(piece)
    arms = positions[own] - positions[own].mean(axis=0)
    size = float(np.abs(arms).max())
    turns = [np.cross(axis, arms / size) for axis in np.eye(3)]
    rigid = np.column_stack([np.tile(axis, len(arms)) for axis in np.eye(3)] + [turn.ravel() for turn in turns])
    motion = moved[own].ravel()
    amounts = np.linalg.lstsq(rigid, motion, rcond=None)[0]
    if np.linalg.norm(motion - rigid @ amounts) <= _RIGID * np.linalg.norm(motion):
        turning = np.linalg.norm(amounts[3:]) > _PART * np.linalg.norm(amounts)
        axis = amounts[3:] if turning else amounts[:3]
        along = ", ".join(f"{value:g}" for value in np.round(axis / axis[np.argmax(np.abs(axis))], 2) + 0.0)
        how = f"turn about an axis along ({along})" if turning else f"move along ({along})"
        body, held = named(numbering.pieces[piece], numbering.body_of(point)), supports.released({b.name for b in numbering.pieces[piece]})
        before = f" since support {' and '.join(map(repr, held))} was released" if held else ""
        return point, f"{body} can {how} freely{before}; hold it by a support, or bring it into contact"
    return point, ""


def _soft(point: int, numbering: Numbering) -> str:
    """A body that deforms without forces: by a field that round-off lets pass."""
    return (
        f"body {numbering.body_of(point)!r} is held, but next to nothing resists a deformation that is largest at control point {point}. "
        "Look there for elements, weights or moduli too different for double precision, and for a body that buckles"
    )
