"""How contact is enforced: which functionals of gap and slip are constrained, with which weights. One file a method (theory 10)."""

from __future__ import annotations

from collections.abc import Callable

from isomortar.model.enforcement import demko, dual, greville, knots, kts, mortar
from isomortar.model.enforcement.face import SlaveFace
from isomortar.model.enforcement.side import SlaveSide
from isomortar.model.entities import Contact, Enforcement, Problem
from isomortar.model.numbering import Numbering

__all__ = ["METHODS", "SlaveFace", "SlaveSide", "slave_side"]

METHODS: dict[Enforcement, Callable[[SlaveFace], SlaveSide]] = {
    "mortar": mortar.side,
    "dual": dual.side,
    "kts": kts.side,
    "knots": knots.side,
    "greville": greville.side,
    "demko": demko.side,
}


def slave_side(contact: Contact, problem: Problem, numbering: Numbering) -> SlaveSide:
    """The slave side of a contact, by its method.

    Raises
    ------
    InputError
        The method has no positive weights there.
    """
    return METHODS[contact.enforcement](SlaveFace(contact, problem, numbering))
