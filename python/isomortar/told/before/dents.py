"""Constraints at points that are too far apart for a body: it comes through between them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model.contrasts import element_lengths
from isomortar.model.entities import Contact, Face, Problem
from isomortar.model.sheet import Sheet

#: What a body gives way between as many points as a face is wide, fitted to columns pressed by constraints at points (theory 9.17).
GIVES = 6.0
#: A body whose face is so many times as wide as the slave gives way no deeper than that is wide.
WIDER = 1.2
#: Share of the force from which on it is told.
TOLD = 0.01
#: Ways of enforcing contact that have constraints at fewer points than quadrature has.
AT_POINTS = ("knots", "greville", "demko")


def of_dents(problem: Problem, contact: Contact) -> Iterator[str]:
    """What is said of them before the first load step."""
    if contact.enforcement not in AT_POINTS:
        return
    slave = Sheet.of(problem, contact.slave)
    sides = (slave, *([Sheet.of(problem, contact.master)] if isinstance(contact.master, Face) else []))
    counts = [d.elements + 1 if contact.enforcement == "knots" else d.count for d in slave.directions]
    through = dents(sides, counts)
    share = float(np.sum(through) / (1.0 + np.sum(through)))
    if share > TOLD:
        size, which = float(f"{100.0 * share:.1g}"), ("slave", "master")[int(np.argmax(through))]
        yield (
            f"contact {contact.name!r}: its constraints, at {counts[0]} x {counts[1]} points of the slave, are too far apart for its "
            f"{which}, which comes through between them: forces may be some {size:g} % too small, or a few times that. Take "
            f'contacts.{contact.name}.enforcement = "mortar", or refine the slave'
        )


def dents(sides: tuple[Sheet, ...], counts: list[int]) -> FloatArray:
    """How far slave and master come through, where all of the slave is pressed, over what both give way by (theory 9.17)."""
    slave, *master = sides
    wide = np.array([lengths.sum() for lengths in element_lengths(slave.patch)[:2]])
    intervals, functions = np.array(counts) - 1.0, np.array([direction.count for direction in slave.directions]) - 1.0
    bulges = (functions - intervals > 1.0) | (intervals == 1.0)  # one function more goes to and fro
    shorter = [np.where(bulges, 1.0 - intervals / functions, 0.0)]
    shorter += [np.maximum(0.0, 1.0 - sheet.element_size * intervals / wide) for sheet in master]
    lengths = np.array([[along.sum() for along in element_lengths(sheet.patch)] for sheet in sides])
    size, sizes, deep = np.sqrt(wide.prod()), np.sqrt(lengths[:, :2].prod(axis=1)), lengths[:, 2]
    deep = np.where(sizes > WIDER * size, np.minimum(deep, size), deep)
    soft = np.array([0.0 if sheet.rigid else 1.0 / min(body.modulus for body in sheet.bodies) for sheet in sides]) * deep
    through: FloatArray = GIVES * soft / soft.sum() * wide.prod() / deep**2 * np.mean(shorter / intervals**3, axis=1)
    return through
