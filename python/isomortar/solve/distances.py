"""How far the multipliers of a contact are from others: what loops over them end by (theory 5.8, 7.4)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from isomortar._bindings import Control, Law, Response
from isomortar.geometry.patch import FloatArray
from isomortar.model import constants
from isomortar.solve.contact import Kinematics, Multipliers, PairMechanics
from isomortar.solve.metric import median, traction_squares
from isomortar.solve.scales import Scales


def apart(
    pair: PairMechanics, control: Control, some: Multipliers, others: Multipliers, round_off: tuple[float, float] = (0.0, 0.0)
) -> tuple[float, float]:
    """Distance of some control pressures and tractions from others, over the norms of these; round-off is none (theory 5.8).

    Tractions count for no less than a hundredth of what friction bears, or of the pressures where that is more: where nothing pulls
    they are round-off.
    """
    (p, t), (q, s) = some, others
    size = float(q @ q)
    squares = traction_squares(control, np.stack([t - s, s])).sum(axis=1)
    noise = np.square(round_off)
    changes = np.maximum(np.array([(p - q) @ (p - q), squares[0]]) - noise, 0.0)
    cone = constants.LEAST_TRACTION * np.minimum(pair.radius(q), q)
    least = np.maximum(cone @ cone, noise[1])
    return ratio(float(changes[0]), size), ratio(float(changes[1]), float(np.maximum(squares[1], least)))


def round_off(pair: PairMechanics, positions: FloatArray, law: Law, response: Response, unbalanced: float = 0.0) -> tuple[float, float]:
    """Norms of what the last bits of positions make of pressures and tractions where gap and slip are nothing (theory 5.8).

    No iteration can remove them: where nothing pulls, friction is next to none or the bodies just touch, all is round-off. Nor are
    they known better than to `unbalanced`, what forces that are not quite in balance leave open.
    """
    last_bit = float(np.spacing(np.abs(positions[pair.pair.slave.point]).max()))
    stiffness = law.penalties.copy()
    if law.elastic:  # the largest slope of a traction by its slip
        stiffness[1] = 2.0 * float(pair.radius(response.pressure).max()) / law.elastic_slip
    normal, tangential = stiffness * last_bit * np.sqrt(np.count_nonzero(response.state))
    return max(float(normal), unbalanced), max(float(tangential), unbalanced)


def off_conditions(
    pair: PairMechanics, positions: FloatArray, kinematics: Kinematics, law: Law, response: Response, scales: Scales, unbalanced: float
) -> tuple[float, float]:
    """Relative distance of a response's pressures and tractions from what the contact conditions make of them (theory 7.4).

    Gap and slip count here with the stiffness of the whole face, traction per length, for they leave forces off by as much: small
    penalties change multipliers little, whatever the gap.
    """
    present = kinematics.control.weight[kinematics.control.weight > 0]
    if not present.size:
        return 0.0, 0.0
    whole = pair.stiffness(scales) / np.sqrt(median(present) * pair.pair.area)
    again = replace(law, penalties=np.array([whole, whole]), pressure=response.pressure, traction=response.traction)
    target = pair.respond(kinematics, again)
    return apart(
        pair,
        kinematics.control,
        (target.pressure, target.traction),
        (response.pressure, response.traction),
        round_off(pair, positions, again, response, unbalanced),
    )


def between(
    pair: PairMechanics, positions: FloatArray, kinematics: Kinematics, one: Response, other: Response, scales: Scales
) -> tuple[float, float]:
    """Relative distance of a converged response from another one, both known to round-off of gaps, slips and forces (theory 5.9)."""
    present = kinematics.control.weight[kinematics.control.weight > 0]
    if not present.size:
        return 0.0, 0.0
    law = pair.law(pair.parameters(kinematics.control, scales), other.pressure, other.traction)
    forces = constants.LEFT_OPEN * float(scales.round_off[pair.pair.pieces].max()) / median(present)
    normal, tangential = round_off(pair, positions, law, other, forces)
    return apart(pair, kinematics.control, (one.pressure, one.traction), (other.pressure, other.traction), (2.0 * normal, 2.0 * tangential))


def ratio(change: float, size: float) -> float:
    """Square root of a ratio of squares; 0 where nothing changes, infinite where there was nothing before (theory 5.8)."""
    if change == 0.0:
        return 0.0
    return float(np.sqrt(change / size)) if size > 0.0 else float("inf")


def largest(distances: Iterable[tuple[float, float]]) -> tuple[float, float]:
    """The largest of each of two, not a number where one is not; zeros of none."""
    first, second = np.max([(0.0, 0.0), *distances], axis=0)
    return float(first), float(second)
