"""What is doubtful of contacts whose faces have poles, edges that are one point."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.geometry.faces import cells
from isomortar.geometry.nearest import nearest
from isomortar.geometry.patch import FloatArray
from isomortar.model.contact_checks import poles
from isomortar.model.entities import Contact, Face, Problem
from isomortar.model.sheet import Sheet


def doubts_at_poles(problem: Problem, contact: Contact, travel: float) -> Iterator[str]:
    """Poles that friction may meet, where no prescribed point goes farther than `travel`, and those of a slave that bear nothing."""
    slave = Sheet.of(problem, contact.slave)
    if isinstance(contact.master, Face) and contact.friction_law.acts:
        yield from _met_by_friction(contact.name, slave, Sheet.of(problem, contact.master), contact.master.words, travel)
    if contact.of_averages and any(slave.directions[k].family == "L" and slave.directions[k].order % 2 == 0 for k, _ in poles(slave)):
        yield (
            f"contact {contact.name!r}: the slave {contact.slave.words} has a pole, where Lagrange functions of order 2 and 4 have no "
            "area: the pole itself bears no pressure. Take another order there, or family N"
        )


def _met_by_friction(name: str, slave: Sheet, master: Sheet, words: str, travel: float) -> Iterator[str]:
    face = cells(slave.patch, slave.face)
    near = travel + float(np.sqrt(face.areas.max()))
    for across, pole in poles(master):
        ends = _ending_at(master, across, pole)
        if np.linalg.norm(face.centres - ends[nearest(face.centres, ends)], axis=1).min() <= near:
            place = ", ".join(f"{x:.4g}" for x in pole + 0.0)
            yield (
                f"contact {name!r}: the master {words} has a pole, an edge that is one point, at ({place}), and its slave may come to "
                "elements that end there: slips have no coordinates in them, and a load step that asks for them ends the run. "
                f"{_shorter(master, across) if np.linalg.norm(face.centres - pole, axis=1).min() > near else 'Have'} the pole elsewhere "
                "(another axis of a sphere), or set friction = 0, without cohesion"
            )
            return


def _shorter(master: Sheet, across: int) -> str:
    """A cure of what does not come to a pole itself."""
    return f"Take more elements there along {master.letters[across]} (bodies.{master.bodies[0].name}.mesh.elements), have"


def _ending_at(sheet: Sheet, across: int, pole: FloatArray) -> FloatArray:
    """Centres of the cells of the elements that end at a pole, where a coordinate of the sheet does, shape (n, 3)."""
    face = cells(sheet.patch, sheet.face)
    centres = np.moveaxis(face.centres.reshape(*face.shape, 3), across, 0)
    each = face.shape[across] // sheet.directions[across].elements
    ends = centres[:each].reshape(-1, 3), centres[-each:].reshape(-1, 3)
    return min(ends, key=lambda end: float(np.linalg.norm(end - pole, axis=1).min()))
