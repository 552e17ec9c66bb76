"""What is doubtful of the edges of a master: that they bear within the slave's face, where its own could be the slave as well."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.faces import cells
from isomortar.geometry.grids import edges
from isomortar.geometry.nearest import nearest
from isomortar.geometry.patch import IntArray
from isomortar.model.entities import Contact, Face, Faces, Problem
from isomortar.model.sheet import Sheet

#: Edges bear where they are nearer to the other side than the two are anywhere and this share of its size: there faces lie on each other.
NEAR = 0.01


def of_edges(problem: Problem, contact: Contact, feet: IntArray, apart: float) -> Iterator[str]:
    """Sentences on a slave that goes on beyond edges of its master which bear on it, where neither would if each were the other.

    Parameters
    ----------
    problem : Problem
    contact : Contact
    feet : ndarray of int
        0 of slave quadrature points without a foot.
    apart : float
        Distance of the sides where they are nearest.
    """
    if feet.all() or not isinstance(contact.master, Face):
        return
    slave, master = (Sheet.of(problem, place) for place in (contact.slave, contact.master))
    twice = any((other.slave, other.master) == (contact.master, contact.slave) for other in problem.contacts)
    if master.rigid or twice or not _bear_within(master, slave, apart) or _bear_within(slave, master, apart):
        return
    joined = _joined(problem, contact)
    if joined and problem.contacts.index(joined[0]) < problem.contacts.index(contact):
        return  # with that one both are told of
    instead = _both(contact, *joined) if joined else f"Exchange the two: {contact.master.words} ends within {contact.slave.words}"
    yield (
        f"contact {contact.name!r}: the slave goes on beyond edges of its master that bear on it, and {np.count_nonzero(feet == 0)} of its "
        f"{feet.size} quadrature points are beside these. As an edge moves points come and go, and load steps may be cut, or given up. "
        f"{instead}"
    )


def _joined(problem: Problem, contact: Contact) -> tuple[Contact, Faces] | None:
    """Another contact of the slave whose master goes on from this one's, with the same friction, and both masters; None: there is none."""
    assert isinstance(contact.master, Face)
    first, *more = contact.master.faces
    for other in problem.contacts:
        alike = other is not contact and (other.slave, *_friction(other)) == (contact.slave, *_friction(contact))
        if not alike or not isinstance(other.master, Face) or set(other.master.faces) & set(contact.master.faces):
            continue
        whole = Faces(first.body, first.face, (*more, *other.master.faces))
        try:
            Sheet.of(problem, whole)
        except InputError:
            continue
        return other, whole
    return None


def _both(contact: Contact, other: Contact, whole: Faces) -> str:
    """That one contact should have the masters of two."""
    names = ", ".join(f'"{name}"' for name in whole.words.split(", "))
    return f"Give one of them both masters, which are joined, and remove contact {other.name!r}: contacts.{contact.name}.master = [{names}]"


def _friction(contact: Contact) -> tuple[float | None, ...]:
    """What friction bears."""
    return contact.friction, contact.cohesion, contact.traction_max


def _bear_within(one: Sheet, other: Sheet, apart: float) -> bool:
    """Whether an edge of one side is near the other one away from the edges of that."""
    faces, points = cells(other.patch, other.face), edges(one.patch, one.face, one.closed)
    if not len(points):
        return False
    found = nearest(points, faces.centres)
    arms, normals = points - faces.centres[found], faces.normals[found]
    heights = np.einsum("ij,ij->i", arms, normals)
    beside = np.linalg.norm(arms - heights[:, None] * normals, axis=1) > np.sqrt(2.0 * faces.areas[found])
    bears = np.abs(heights) <= apart + NEAR * np.sqrt(faces.areas.sum())
    return bool(np.any(bears & ~beside & ~faces.outermost(other.closed)[found]))
