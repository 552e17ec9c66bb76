"""Constraints at points that are farther apart than the elements of a master: it comes through between them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.model.contrasts import element_lengths
from isomortar.model.entities import Contact, Face, Problem
from isomortar.model.sheet import Sheet

#: What a master gives way between as many points as a face is wide, fitted to columns pressed by constraints at points (theory 9.17).
GIVES = 6.0
#: Share of the force from which on it is told.
TOLD = 0.01
#: Ways of enforcing contact that have constraints at fewer points than quadrature has.
AT_POINTS = ("knots", "greville", "demko")


def of_dents(problem: Problem, contact: Contact) -> Iterator[str]:
    """What is said of them before the first load step."""
    if contact.enforcement not in AT_POINTS or not isinstance(contact.master, Face):
        return
    slave, master = Sheet.of(problem, contact.slave), Sheet.of(problem, contact.master)
    counts = [d.elements + 1 if contact.enforcement == "knots" else d.count for d in slave.directions]
    share = 0.0 if master.rigid else lost(slave, master, counts)
    if share > TOLD:
        size = float(f"{100.0 * share:.1g}")
        yield (
            f"contact {contact.name!r}: its constraints, at {counts[0]} x {counts[1]} points of the slave, are farther apart than the "
            f"elements of its master, which comes through between them: forces may be up to some {size:g} % too small. "
            f'Take contacts.{contact.name}.enforcement = "mortar", swap slave and master, or refine the slave'
        )


def lost(slave: Sheet, master: Sheet, counts: list[int]) -> float:
    """Share of the force that is lost where all of the slave is pressed, about (theory 9.17)."""
    *wide, deep = (float(lengths.sum()) for lengths in element_lengths(slave.patch))
    base = float(element_lengths(master.patch)[2].sum())
    intervals = np.array(counts) - 1.0
    finer = np.maximum(0.0, 1.0 - master.element_size * intervals / wide)
    of_slave, of_master = (depth / min(body.modulus for body in sheet.bodies) for depth, sheet in ((deep, slave), (base, master)))
    between = of_master / (of_master + (0.0 if slave.rigid else of_slave))
    dents = GIVES * between * float(np.prod(wide)) / base**2 * float(np.mean(finer / intervals**3))
    return dents / (1.0 + dents)
