"""States of the active set made to order: multipliers that put the trial of every control point where it is wanted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.harness.visits import PairVisit
from isomortar.solve.contact import Kinematics, PairMechanics
from isomortar.solve.metric import traction_norms


def placed(pair: PairMechanics, positions: FloatArray, visit: PairVisit, pressure: FloatArray, length: FloatArray) -> PairVisit:
    """The visit with other multipliers: trial pressures and lengths of trial tractions are those asked for.

    A control point is open where `pressure` is zero or less, sticks where `length` is at most 1, and slips above; close to these
    values it is on an edge of the active set, off by the round-off of the control quantities.

    Parameters
    ----------
    pair : PairMechanics
    positions : ndarray, shape (control points, 3)
    visit : PairVisit
    pressure : ndarray, shape (slave control points,)
        Trial control pressures (theory 4.3), force per area.
    length : ndarray, shape (slave control points,)
        Metric norms of the trial tractions as a share of what friction bears under these pressures, of stretches as they are; directions
        stay.
    """
    kinematics = pair.kinematics(positions, visit.start)
    weight = np.where(kinematics.control.weight > 0, kinematics.control.weight, 1.0)
    law = replace(visit.law, pressure=pressure - visit.law.penalties[0] * kinematics.control.gap / weight)
    if pair.friction.acts and not law.elastic:
        trial = pair.respond(kinematics, replace(law, held=np.ones_like(law.held))).traction  # of what sticks that is the traction
        law = replace(law, traction=law.traction + _scaled(kinematics, trial, pair.radius(pressure) * length) - trial)
    if law.stretch is not None:  # by Coulomb's law its trial is the same
        plain = replace(law, penalties=law.factors, traction=law.stretch, stretch=None, held=np.ones_like(law.held))
        trial = pair.respond(kinematics, plain).traction
        law = replace(law, stretch=law.stretch + _scaled(kinematics, trial, length) - trial)
    return PairVisit(visit.start, law)


def _scaled(kinematics: Kinematics, traction: FloatArray, length: FloatArray) -> FloatArray:
    """Tractions of given metric norms; along the first coordinate where there is no direction; zero where the pressure is."""
    unit = np.where(traction_norms(kinematics.control, traction)[:, None] > 0, traction, [1.0, 0.0])
    norm = traction_norms(kinematics.control, unit)
    return np.ascontiguousarray(unit * (np.where(length > 0, length, 0.0) / np.where(norm > 0, norm, 1.0))[:, None])
