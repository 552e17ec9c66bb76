"""Slaves that go over an edge of their master, or are about to, where a load step is given up."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model.supports import BoolArray
from isomortar.solve.contact import PairMechanics
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.feet import closest_depths

#: How an error says that a slave goes over its master's edge.
BESIDE = "beside the master"


def over_the_edge(equilibrium: Equilibrium, pair: PairMechanics, positions: FloatArray) -> Iterator[str]:
    """A slave that goes over an edge of its master, in elements of which a part only has anything below."""
    contact = pair.pair.contact
    elements = _with_a_foot(equilibrium, pair, positions)
    partly = elements.any(axis=1) & ~elements.all(axis=1)
    if partly.any() or not elements.any():
        yield (
            f"contact {contact.name!r}: the slave goes over an edge of its master; {np.count_nonzero(~elements)} of its "
            f"{elements.size} quadrature points are {BESIDE} by then, and few bear what comes. Refine the slave, use a larger master, end "
            "the motion earlier, or bring the slave onto its master from above"
        )


def at_an_edge(equilibrium: Equilibrium, pair: PairMechanics, positions: FloatArray) -> Iterator[str]:
    """A slave that is about to go over an edge, by the way that supports go in the load step."""
    contact = pair.pair.contact
    now, then = (_with_a_foot(equilibrium, pair, where) for where in (positions, _at_the_end(equilibrium, positions)))
    if now.any() and np.count_nonzero(then) < np.count_nonzero(now):
        yield (
            f"contact {contact.name!r}: the slave stands at an edge of its master, and goes over it in this load step, by which "
            f"{np.count_nonzero(~then)} of its {then.size} quadrature points come to be {BESIDE}. Refine the slave, use a larger master, "
            "or end the motion earlier"
        )


def _with_a_foot(equilibrium: Equilibrium, pair: PairMechanics, positions: FloatArray) -> BoolArray:
    """Which quadrature points have anything below, shape (elements, points of an element)."""
    contact = pair.pair.contact
    if contact.averaged:
        found = np.isfinite(closest_depths(equilibrium.problem, contact, positions))
    else:
        found = pair.initial(positions).projected > 0
    return np.asarray(found).reshape(pair.pair.slave.elements, -1)


def _at_the_end(equilibrium: Equilibrium, positions: FloatArray) -> FloatArray:
    """Positions, bodies that are glued carried on by the mean way that their supports go in the load step."""
    numbering, supports, end = equilibrium.numbering, equilibrium.supports, max(np.ceil(equilibrium.time), 1.0)
    ways, held = supports.place(end) - supports.place(end - 1.0), supports.held
    shares = np.add.reduceat(held, numbering.starts, dtype=np.float64)
    means = np.add.reduceat(ways * held, numbering.starts) / np.maximum(shares, 1.0)
    counts = np.diff(numbering.starts, append=len(positions))
    return np.asarray(positions + np.repeat(means, counts, axis=0))
