"""Gap between the two sides of a contact pair, point by point."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar import _bindings
from isomortar._bindings import SlaveArrays
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Contact, Problem
from isomortar.model.numbering import Numbering
from isomortar.model.pairs import Pair


def gaps(problem: Problem, contact: Contact, positions: FloatArray, points: FloatArray) -> FloatArray:
    """Gap g of points to the master by closest-point projection (theory 3.2); positive is penetration.

    Parameters
    ----------
    problem : Problem
    contact : Contact
        Pair whose master is meant.
    positions : ndarray, shape (n, 3)
        Of all control points, as in `State`.
    points : ndarray, shape (m, 3)

    Returns
    -------
    ndarray, shape (m,)
        NaN where a point has no projection on the master.

    Raises
    ------
    LostProjectionError
        The projection of a point did not settle.
    """
    count = len(points)
    slave = SlaveArrays.of_points(np.arange(count, dtype=np.int32) + np.int32(len(positions)))
    master = Pair(replace(contact, projection="closest"), problem, Numbering(problem)).master
    everywhere = np.concatenate([positions, points])
    projections = _bindings.project_points(slave, master, everywhere, np.zeros((count, 2)), np.zeros(count, dtype=np.int32))
    found = projections.found.astype(bool)
    return np.where(found, _bindings.control_quantities(slave, master, everywhere, projections).gap, np.nan)
