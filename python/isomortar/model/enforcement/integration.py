"""How contacts are integrated that do not say it: in cells where the master's knot lines cross slave elements (theory 10.10)."""

from __future__ import annotations

from dataclasses import replace
from math import ceil, log2

from isomortar.errors import LostProjectionError
from isomortar.geometry.patch import Direction
from isomortar.model.enforcement.face import SlaveFace
from isomortar.model.enforcement.subcells import Subcells
from isomortar.model.entities import Contact, Face, Problem
from isomortar.model.numbering import Numbering
from isomortar.model.sheet import Sheet


def integrated(contact: Contact, problem: Problem) -> Contact:
    """The contact with cells and their points, where lines of its master cross its elements; else as it is (theory 10.10).

    So are contacts whose constraints are at points, and those with a rigid plane.
    """
    if not contact.of_averages or not isinstance(contact.master, Face):
        return contact
    try:
        lines = Subcells(SlaveFace(contact, problem, Numbering(problem))).lines()
    except LostProjectionError:
        return contact
    if not lines:
        return contact
    first, second = Sheet.of(problem, contact.slave).directions
    order = max(direction.order for direction in Sheet.of(problem, contact.master).directions)
    return replace(contact, subcells=ceil(log2(1 + lines)), quadrature=(cell_points(first, order), cell_points(second, order)))


def cell_points(direction: Direction, master_order: int) -> int:
    """Gauss points of a cell along a direction of the slave (theory 10.10)."""
    return (direction.order + max(direction.order, master_order)) // 2 + 2
