"""Planes of symmetry: the part of a problem on their upper side, and forces of the whole from those of the part (theory 8.5)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.halves import upper_half
from isomortar.geometry.patch import FloatArray
from isomortar.model import constants
from isomortar.model.entities import PLACES, Body, Face, Motion, Problem, RigidPlane, Support, SymmetryPlane, unit
from isomortar.model.messages import located

#: A face of a body that a plane has cut.
Cut = tuple[SymmetryPlane, Face]


def upper_part(bodies: tuple[Body, ...], planes: tuple[SymmetryPlane, ...]) -> tuple[tuple[Body, ...], tuple[Cut, ...]]:
    """The bodies on the upper side of all planes, and their faces on these.

    Raises
    ------
    InputError
        A body is not its own mirror image, or has elements across a plane.
    """
    cuts: list[Cut] = []
    for plane in planes:
        halves = [_upper_half(body, plane) for body in bodies]
        bodies = tuple(half for half, _ in halves)
        cuts += [(plane, Face(half.name, face)) for half, face in halves]
    return bodies, tuple(cuts)


def held_on_planes(problem: Problem, cuts: tuple[Cut, ...]) -> Problem:
    """The upper part of a problem, with a support for each face that a plane has cut: nothing goes through it.

    Raises
    ------
    InputError
        What it does is not symmetric: a motion, a load, a rigid plane, a face across a plane that is in use; or a support has such a name.
    """
    for plane in problem.symmetry:
        _check_motions(problem, plane)
        _check_rigid_planes(problem, plane)
        _check_loads(problem, plane)
    _check_faces(problem, cuts)
    still, deformable = tuple(Motion() for _ in problem.stages), {body.name for body in problem.deformable}
    held = [Support(plane.holding(face.body), face, still, (plane.axis,)) for plane, face in cuts if face.body in deformable]
    taken = {support.name for support in problem.supports} & {support.name for support in held}
    if taken:
        raise InputError("is what symmetry calls a support of its own; allowed: any other name", f"supports.{min(taken)}")
    return replace(problem, supports=(*problem.supports, *held))


def of_whole(problem: Problem, force: FloatArray, moment: FloatArray, centre: FloatArray) -> tuple[FloatArray, FloatArray]:
    """A force and its moment about a centre with those of all mirror images, each shape (3,) (theory 8.5)."""
    for plane in problem.symmetry:
        normal, aside = np.eye(3)[plane.axis], centre[plane.axis] - plane.place
        moment = 2.0 * (moment[plane.axis] * normal - aside * np.cross(normal, force))
        force = 2.0 * (force - force[plane.axis] * normal)
    return force, moment


def _upper_half(body: Body, plane: SymmetryPlane) -> tuple[Body, str]:
    with located(f"bodies.{body.name}"):
        if body.raised:
            raise InputError("is halved by symmetry, and its functions are of another order at a face; remove one", "mesh.contact_order")
        half, face = upper_half(body.patch, plane.axis, plane.place)
        if face[0] in (body.closed or ""):
            raise InputError(f"is closed in {face[0]}, the direction that {plane.words} halves; allowed: planes that cut another one")
    return replace(body, patch=half), face


def _check_motions(problem: Problem, plane: SymmetryPlane) -> None:
    across = "xyz"[plane.axis]
    for support in problem.supports:
        if plane.axis in support.pressed:
            raise InputError(
                f"has a component along {across}, through {plane.words}; allowed with symmetry: components along it",
                f"supports.{support.name}.force",
            )
        along_axis = np.abs(np.delete(unit(support.axis), plane.axis)).max() <= constants.NO_PART
        if support.moment is not None and not along_axis:
            raise InputError(
                f"turns out of {plane.words}; allowed with symmetry: an axis of the support along {across}",
                f"supports.{support.name}.moment",
            )
        for stage, motion in zip(problem.stages, support.motions, strict=True):
            field = f"stages.{stage.name}.motions.{support.name}"
            if motion.translate[plane.axis]:
                raise InputError(f"goes along {across}, through {plane.words}; allowed with symmetry: 0 there", f"{field}.translate")
            if motion.rotate and not along_axis:
                raise InputError(
                    f"turns out of {plane.words}; allowed with symmetry: 0, or an axis of the support along {across}", f"{field}.rotate"
                )


def _check_rigid_planes(problem: Problem, plane: SymmetryPlane) -> None:
    for contact in problem.contacts:
        if isinstance(contact.master, RigidPlane) and abs(unit(contact.master.normal)[plane.axis]) > constants.NO_PART:
            raise InputError(f"is not its own mirror image in {plane.words}; allowed: normals along it", f"contacts.{contact.name}.plane")


def _check_loads(problem: Problem, plane: SymmetryPlane) -> None:
    for load in problem.loads:
        if load.kind != "pressure" and load.value[plane.axis]:
            across = "xyz"[plane.axis]
            raise InputError(
                f"acts along {across}, through {plane.words}; allowed with symmetry: 0 there", f"loads.{load.name}.{load.kind}"
            )


def _check_faces(problem: Problem, cuts: tuple[Cut, ...]) -> None:
    """Refuse faces that are of a halved direction: of two that mirror each other one is not there any more."""
    for plane, cut in cuts:
        for field, face in _faces_in_use(problem):
            if face.body == cut.body and face.face[0] == cut.face[0]:
                raise InputError(f"is {face.words!r}, a face beside {plane.words}; allowed with symmetry: faces that it cuts", field)


def _faces_in_use(problem: Problem) -> Iterator[tuple[str, Face]]:
    """Faces of supports, loads, contacts and glue with the keys that name them."""
    for support in problem.supports:
        key = PLACES[len(support.place.meeting) - 1]
        yield from ((f"supports.{support.name}.{key}", Face(support.place.body, face)) for face in support.place.meeting)
    for load in problem.loads:
        if load.face is not None:
            yield f"loads.{load.name}.face", load.place
    for contact in problem.contacts:
        yield from ((f"contacts.{contact.name}.slave", face) for face in contact.slave.faces)
        if isinstance(contact.master, Face):
            yield from ((f"contacts.{contact.name}.master", face) for face in contact.master.faces)
    for number, joint in enumerate(problem.glue):
        yield from ((f"glue.{number}", face) for face in joint)
