"""What is doubtful of contacts whose faces have poles, edges that are one point."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.geometry.faces import cells
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
    for _, pole in poles(master):
        if np.linalg.norm(face.centres - pole, axis=1).min() <= near:
            place = ", ".join(f"{x:.4g}" for x in pole + 0.0)
            yield (
                f"contact {name!r}: the master {words} has a pole, an edge that is one point, at ({place}), where "
                "its slave may come to: slips have no coordinates there, and a load step that asks for them ends the run. Have the pole "
                "elsewhere (another axis of a sphere), or set friction = 0, without cohesion"
            )
            return
