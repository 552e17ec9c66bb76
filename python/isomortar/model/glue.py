"""Bodies that are glued: which control points of two faces are one, what that takes, and which bodies hang together."""

from __future__ import annotations

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.net import Net, misfit
from isomortar.geometry.patch import IntArray
from isomortar.model import constants
from isomortar.model.entities import Body, Face, Problem


def pieces(problem: Problem) -> tuple[tuple[Body, ...], ...]:
    """Bodies with all that is glued to them, each body once, in the order of the problem."""
    together = {body.name: {body.name} for body in problem.bodies}
    for one, other in problem.glue:
        both = together[one.body] | together[other.body]
        together |= dict.fromkeys(both, both)
    found: dict[frozenset[str], tuple[Body, ...]] = {}
    for names in (frozenset(together[body.name]) for body in problem.bodies):
        found[names] = tuple(body for body in problem.bodies if body.name in names)
    return tuple(found.values())


def names_together(problem: Problem) -> list[set[str]]:
    """Names of bodies that are glued together."""
    return [{body.name for body in piece} for piece in pieces(problem)]


def shared_directions(problem: Problem) -> tuple[tuple[tuple[str, str], ...], ...]:
    """Directions that have one mesh, as faces that are glued share it: each body and letter once, with all that it shares it with."""
    places = [(body.name, letter) for body in problem.bodies for letter in "uvw"]
    together = {place: {place} for place in places}
    for number, joint in enumerate(problem.glue):
        alike = zip(*(_along(problem.body(f.body), p) for f, p in zip(joint, shared_points(problem, number), strict=True)), strict=True)
        for one, other in alike:
            both = together[one] | together[other]
            together |= dict.fromkeys(both, both)
    return tuple(dict.fromkeys(tuple(place for place in places if place in together[start]) for start in places))


def _along(body: Body, points: IntArray) -> tuple[tuple[str, str], tuple[str, str]]:
    """The directions that the rows, and the columns, of a face's control points follow."""
    net = np.array(np.unravel_index(points, [d.count for d in reversed(body.patch.directions)]))[::-1]
    first = int(np.flatnonzero(net[:, 1] != net[:, 0])[0])
    second = next(axis for axis in range(3) if axis != first and np.ptp(net[axis]) > 0)
    return (body.name, "uvw"[first]), (body.name, "uvw"[second])


def named(piece: tuple[Body, ...], body: str) -> str:
    """A body by its name, and by what it is glued to."""
    others = [repr(other.name) for other in piece if other.name != body]
    return f"body {body!r}" + (f" (glued to {', '.join(others)})" if others else "")


def check_glue(problem: Problem) -> None:
    """Refuse joints that cannot be.

    Raises
    ------
    InputError
        A face is glued to its own body or twice, is in a contact, or joins a rigid body to one that deforms; two faces do not conform.
    """
    glued: dict[Face, Face] = {}
    for number, joint in enumerate(problem.glue):
        path, (one, other) = f"glue.{number}", joint
        if one.body == other.body:
            raise InputError(f"joins two faces of {one.body!r}; a body that meets itself is closed: bodies.{one.body}.closed", path)
        for face, mate in (joint, (other, one)):
            if face in glued:
                raise InputError(f"joins {face.words} to {mate.words}, and it is glued to {glued[face].words} already", path)
            glued[face] = mate
            if problem.body(face.body).rigid and not problem.body(mate.body).rigid:
                raise InputError(
                    f"joins {mate.words} to {face.words} of a rigid body; to have a face go with that body, put a support on it",
                    path,
                )
        shared_points(problem, number)
    for contact in problem.contacts:
        for side, place in (("slave", contact.slave), ("master", contact.master)):
            for face in place.faces if isinstance(place, Face) else ():
                if face in glued:
                    raise InputError(
                        f"is {face.words}, which is glued to {glued[face].words}: it lies inside; name an outer face",
                        f"contacts.{contact.name}.{side}",
                    )


def shared_points(problem: Problem, number: int) -> tuple[IntArray, IntArray]:
    """Control points of the two faces of a joint, by their numbers in their patches, each with the one that it is.

    Raises
    ------
    InputError
        The faces do not conform: with what differs, by how much, and where.
    """
    faces = problem.glue[number]
    bodies = [problem.body(face.body) for face in faces]
    for body in bodies:
        if body.raised:
            raise InputError(
                f"joins {body.name!r}, whose order at {body.raised.face} is another one than below; remove its mesh.contact_order",
                f"glue.{number}",
            )
    one, other = (Net.of(body.patch, face.face) for body, face in zip(bodies, faces, strict=True))
    names, near = (faces[0].body, faces[1].body), constants.SAME_POINT * max(body.size for body in bodies)
    misfits = []
    for turned in other.turned():
        found = misfit(one, turned, names, near, constants.SAME_POINT)
        if found is None:
            return one.numbers.ravel(), turned.numbers.ravel()
        misfits.append(found)
    best = max(misfits, key=lambda found: found.stage)
    if best.stage == 0:
        best = min(misfits, key=lambda found: found.size)
    raise InputError(
        f"joins {faces[0].words} to {faces[1].words}, which do not conform: {best.reason}. Glued faces share their control points: "
        "give both bodies the same mesh there, bring them together, or let them touch by a contact",
        f"glue.{number}",
    )
