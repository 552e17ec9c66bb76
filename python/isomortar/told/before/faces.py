"""What is doubtful of faces: held twice; in contact and held, loaded, or behind another master of the same slave."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, islice

import numpy as np

from isomortar.model.constants import NO_PART
from isomortar.model.entities import Contact, Face, Problem, RigidPlane, Support, unit
from isomortar.model.sheet import Sheet


def of_faces(problem: Problem) -> Iterator[str]:
    """Sentences on what acts on a face beside what else does."""
    for contact in problem.contacts:
        yield from _held(problem, contact)
        yield from _loaded(problem, contact)
    for other in problem.contacts:
        said = (sentence for one in problem.contacts if one is not other for sentence in _behind(problem, one, other))
        yield from islice(said, 1)  # of many on one slave each is told once, and not once for each before it
    for first, second in combinations(problem.given_supports, 2):
        yield from _held_twice(first, second)


def holder(problem: Problem, place: Face | RigidPlane) -> str:
    """What prescribes all components of just that face, as words; empty: nothing."""
    if isinstance(place, RigidPlane):
        return "a rigid plane"
    if problem.body(place.body).rigid:
        return f"of the rigid body {place.body!r}"
    holders = [
        next((s.name for s in problem.supports if s.place == face and len(s.components) == 3 and s.stages is None), "")
        for face in place.faces
    ]
    return " and ".join(f"support {name!r}" for name in holders) if all(holders) else ""


def _held(problem: Problem, contact: Contact) -> Iterator[str]:
    """Sides of a contact of which a support holds all points."""
    holders = [holder(problem, place) for place in (contact.slave, contact.master)]
    if all(holders):
        yield f"contact {contact.name!r} can move nothing: its slave face is held by {holders[0]}, and its master is {holders[1]}"
        return
    for place, held in zip((contact.slave, contact.master), holders, strict=True):
        if held and isinstance(place, Face) and not problem.body(place.body).rigid:
            yield (
                f"contact {contact.name!r}: its face {place.words} is held by {held}, and nothing dents it: the body behind it feels no "
                f"contact. Hold another face; or, if it is to be rigid, bodies.{place.body}.rigid = true"
            )


def _loaded(problem: Problem, contact: Contact) -> Iterator[str]:
    """Pressures and tractions on faces in contact."""
    faces = {face for side in (contact.slave.faces, getattr(contact.master, "faces", ())) for face in side}
    for load in problem.loads:
        if load.face is not None and load.place in faces:
            yield (
                f"load {load.name!r} is on {load.place.words}, a face of contact {contact.name!r}, and acts where that is closed as well. "
                "If what presses is the other body, remove the load; or name the face that it acts on"
            )


def _behind(problem: Problem, one: Contact, other: Contact) -> Iterator[str]:
    """A master that is at, or behind, the rigid plane of another contact with the same slave: the plane is met first."""
    plane, master = one.master, other.master
    if not (isinstance(plane, RigidPlane) and set(one.slave.faces) & set(other.slave.faces)):
        return
    normal, size = unit(plane.normal), Sheet.of(problem, one.slave).size
    if isinstance(master, RigidPlane):
        points, words = np.atleast_2d(master.point), f"the plane of {other.name!r}"
        stays = bool(np.linalg.norm(unit(master.normal) - normal) < NO_PART)
    else:
        sheet, words = Sheet.of(problem, master), f"{master.words}, the master of {other.name!r},"
        points = sheet.patch.control_points[sheet.patch.face_points(sheet.face)]
        stays = not any(support.place.body == master.body and support.moves for support in problem.supports)
    if stays and ((points - plane.point) @ normal).max() <= NO_PART * size:
        yield (
            f"contacts {one.name!r} and {other.name!r} have the slave {one.slave.words} in common, and {words} is at or behind the plane "
            f"of {one.name!r}, which is met first. Remove one of them"
        )


def _held_twice(one: Support, other: Support) -> Iterator[str]:
    """Two supports on one place: a reaction is of both."""
    both = sorted({*one.components} & {*other.components})
    if both and one.place == other.place and one.stages == other.stages:
        yield (
            f"supports {one.name!r} and {other.name!r} both prescribe {', '.join('xyz'[k] for k in both)} of {one.place.words}: each is "
            "told half of the force there. Remove one of them"
        )
