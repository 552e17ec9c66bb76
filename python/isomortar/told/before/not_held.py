"""Bodies that all of their contacts push one way, while nothing holds them against that."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.geometry.faces import cells
from isomortar.model.entities import Contact, Face, Problem
from isomortar.model.glue import names_together
from isomortar.model.sheet import Sheet


def not_held_against(problem: Problem) -> Iterator[str]:
    """Bodies that all of their contacts push one way, while no support or load holds them against that."""
    rigid = {body.name for body in problem.bodies if body.rigid}
    loaded = {load.body for load in problem.loads} | {s.place.body for s in problem.supports if s.is_plate}
    for names in names_together(problem):
        pushing = list(_pushing(problem, names))
        if pushing and not names & (rigid | loaded) and not _can_balance(problem, names, pushing):
            which = ", ".join(repr(contact.name) for contact, _ in pushing)
            yield (
                f"body {sorted(names)[0]!r}: what it touches ({which}) pushes it one way, and no support, load or other contact holds it "
                "against that: it can bear nothing there. Hold it by a support, or give it the contact that it lies on"
            )


def _pushing(problem: Problem, names: set[str]) -> Iterator[tuple[Contact, Face]]:
    """Contacts of glued bodies with others, and their sides of these."""
    for contact in problem.contacts:
        own = [side for side in (contact.slave, contact.master) if isinstance(side, Face) and side.body in names]
        if len(own) == 1:
            yield contact, own[0]


def _can_balance(problem: Problem, names: set[str], pushing: list[tuple[Contact, Face]]) -> bool:
    """Whether pressures and friction on faces may have no resultant along what supports neither hold nor are to move (theory 9.18)."""
    if any(contact.cohesion for contact, _ in pushing):
        return True
    own = [support for support in problem.supports if support.place.body in names]
    held = [k for k in range(3) for s in own if k in s.carried or any(motion.translate[k] for motion in s.motions)]
    sheets = [Sheet.of(problem, side) for _, side in pushing]
    found = [cells(sheet.patch, sheet.face) for sheet in sheets]
    normals = np.concatenate([face.normals[face.areas > 0.0] for face in found])
    way = np.where(np.isin(range(3), held), 0.0, normals.mean(axis=0))
    least = float((normals @ way).min())
    friction = max(contact.friction for contact, _ in pushing)
    return not least > friction * np.sqrt(max(0.0, float(way @ way) - least**2))
