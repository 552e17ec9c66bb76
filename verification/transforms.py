"""Changes of a problem that must leave its results: motions, units, parametrisations, order of bodies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import combinations
from typing import cast

import numpy as np

from isomortar.geometry.patch import FACES, Closed, Direction, FloatArray, Patch
from isomortar.model.entities import Body, Contact, Edge, Face, Faces, Load, Motion, Problem, Raised, RigidPlane, Support

Vector = tuple[float, float, float]


def vector(values: FloatArray) -> Vector:
    """Three floats."""
    x, y, z = (float(value) for value in values)
    return x, y, z


def with_patches(problem: Problem, change: Callable[[Patch], Patch]) -> Problem:
    """The problem with every body's patch changed."""
    return replace(problem, bodies=tuple(replace(body, patch=change(body.patch)) for body in problem.bodies))


def turned(problem: Problem, turn: FloatArray) -> Problem:
    """Geometry, rigid planes, motions and loads turned by a rotation matrix, shape (3, 3).

    Supports must hold all components by motions, or the axes be turned into axes.
    """
    return replace(
        with_patches(problem, lambda patch: replace(patch, control_points=patch.control_points @ turn.T)),
        contacts=tuple(_turned_contact(contact, turn) for contact in problem.contacts),
        supports=tuple(_turned_support(support, turn, 1.0) for support in problem.supports),
        loads=tuple(_turned_load(load, turn) for load in problem.loads),
    )


def moved(problem: Problem, by: FloatArray) -> Problem:
    """The problem somewhere else: geometry, planes and centres of supports moved by a vector, shape (3,)."""
    away = with_patches(problem, lambda patch: replace(patch, control_points=patch.control_points + by))
    return replace(
        away,
        contacts=tuple(_moved_contact(contact, by) for contact in problem.contacts),
        supports=tuple(replace(support, centre=vector(np.asarray(support.centre) + by)) for support in problem.supports),
        symmetry=tuple(replace(plane, place=plane.place + float(by[plane.axis])) for plane in problem.symmetry),
    )


def _moved_contact(contact: Contact, by: FloatArray) -> Contact:
    if not isinstance(contact.master, RigidPlane):
        return contact
    return replace(contact, master=replace(contact.master, point=vector(np.asarray(contact.master.point) + by)))


def mirrored(problem: Problem) -> Problem:
    """The mirror image in the plane x = 0, direction u reversed to keep the volume positive."""
    mirror = np.diag([-1.0, 1.0, 1.0])
    image = replace(
        with_patches(problem, lambda patch: replace(patch, control_points=patch.control_points @ mirror)),
        contacts=tuple(_turned_contact(contact, mirror) for contact in problem.contacts),
        supports=tuple(_turned_support(support, mirror, -1.0) for support in problem.supports),
        loads=tuple(_turned_load(load, mirror) for load in problem.loads),
    )
    return _oriented(image, [body.name for body in problem.bodies], (0, 1, 2), (0,))


def scaled(problem: Problem, length: float, stress: float) -> Problem:
    """Other units: all lengths times `length`, all stresses times `stress`."""
    sized = with_patches(problem, lambda patch: replace(patch, control_points=length * patch.control_points))
    bodies = tuple(replace(body, material=replace(body.material, young=stress * body.material.young)) for body in sized.bodies)
    return replace(
        sized,
        bodies=bodies,
        contacts=tuple(_scaled_contact(contact, length, stress) for contact in problem.contacts),
        supports=tuple(_scaled_support(support, length, stress) for support in problem.supports),
        loads=tuple(_scaled_load(load, length, stress) for load in problem.loads),
    )


def with_knots(problem: Problem, factor: float | tuple[float, float, float], shift: float) -> Problem:
    """All knots times `factor`, of all directions or of each, plus `shift`."""
    factors = np.broadcast_to(factor, 3)

    def changed(patch: Patch) -> Patch:
        u, v, w = (replace(d, knots=by * d.knots + shift) for d, by in zip(patch.directions, factors, strict=True))
        return replace(patch, directions=(u, v, w))

    return with_patches(problem, changed)


def with_weights(problem: Problem, factor: float) -> Problem:
    """All weights times `factor`."""
    return with_patches(problem, lambda patch: replace(patch, weights=factor * patch.weights))


def relabelled(problem: Problem) -> Problem:
    """Bodies in reverse order, directions u and v of every body reversed, then u, v, w called w, u, v."""
    renamed = _oriented(problem, [body.name for body in problem.bodies], (1, 2, 0), (2, 0))
    return replace(renamed, bodies=renamed.bodies[::-1])


def reversed_along(patch: Patch, axes: tuple[int, ...]) -> Patch:
    """The same body with some of its directions reversed."""
    grid = np.flip(_grid(patch), axes)
    directions = [d.reversed() if axis in axes else d for axis, d in enumerate(patch.directions)]
    return _patch((directions[0], directions[1], directions[2]), grid)


def permuted(patch: Patch, order: tuple[int, int, int] = (1, 2, 0)) -> Patch:
    """The same body, its directions of these numbers (v, w, u) taken as u, v, w."""
    first, second, third = (patch.directions[axis] for axis in order)
    return _patch((first, second, third), np.transpose(_grid(patch), (*order, 3)))


def orientations() -> tuple[tuple[tuple[int, int, int], tuple[int, ...]], ...]:
    """The 24 ways to name the directions of a body that keep its volume positive: their order, and which are reversed."""
    found: list[tuple[tuple[int, int, int], tuple[int, ...]]] = []
    for order in ((0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (1, 0, 2), (2, 1, 0)):
        odd = order in ((0, 2, 1), (1, 0, 2), (2, 1, 0))  # which turn a right hand into a left one
        found += [(order, axes) for n in range(4) if n % 2 == odd for axes in combinations(range(3), n)]
    return tuple(found)


def oriented(problem: Problem, name: str, order: tuple[int, int, int], axes: tuple[int, ...]) -> Problem:
    """The problem with the directions of a body named in another order, some of them reversed."""
    return _oriented(problem, [name], order, axes)


def _oriented(problem: Problem, names: list[str], order: tuple[int, int, int], axes: tuple[int, ...]) -> Problem:
    faces = {}
    for face in FACES:
        axis = order.index("uvw".index(face[0]))
        faces[face] = "uvw"[axis] + (face[1] if axis not in axes else "10"[int(face[1])])
    renamed = _renamed(problem, dict.fromkeys(names, faces))
    return replace(
        renamed,
        bodies=tuple(_oriented_body(body, order, axes, faces) if body.name in names else body for body in problem.bodies),
        contacts=tuple(
            replace(contact, quadrature=_along_the_face(contact.quadrature, before.slave.face, order))
            if before.slave.body in names
            else contact
            for contact, before in zip(renamed.contacts, problem.contacts, strict=True)
        ),
    )


def _oriented_body(body: Body, order: tuple[int, int, int], axes: tuple[int, ...], faces: dict[str, str]) -> Body:
    closed = sorted(faces[f"{letter}0"][0] for letter in body.closed or "")
    return replace(
        body,
        patch=reversed_along(permuted(body.patch, order), axes),
        quadrature=_in_order(body.quadrature, order),
        closed=None if body.closed is None else cast("Closed", "".join(closed)),
        raised=body.raised and Raised(faces[body.raised.face], _in_order(body.raised.orders, order)),
    )


def _in_order(values: tuple[int, int, int], order: tuple[int, int, int]) -> tuple[int, int, int]:
    first, second, third = (values[axis] for axis in order)
    return first, second, third


def _along_the_face(values: tuple[int, int], face: str, order: tuple[int, int, int]) -> tuple[int, int]:
    """What a slave face has along its two coordinates, which come in cyclic order after that across it."""
    axis = "uvw".index(face[0])
    of_body = {(axis + 1) % 3: values[0], (axis + 2) % 3: values[1]}
    across = order.index(axis)
    return of_body[order[(across + 1) % 3]], of_body[order[(across + 2) % 3]]


def _renamed(problem: Problem, names: dict[str, dict[str, str]]) -> Problem:
    """The problem with faces of some bodies called otherwise wherever they are named."""

    def named(place: Face) -> Face:
        of_body = names.get(place.body, {})
        if isinstance(place, Edge):
            place = replace(place, others=tuple(of_body.get(face, face) for face in place.others))
        return replace(place, face=of_body.get(place.face, place.face))

    def side(place: Face) -> Face:
        return _side([named(face) for face in place.faces])

    return replace(
        problem,
        contacts=tuple(
            replace(c, slave=side(c.slave), master=side(c.master) if isinstance(c.master, Face) else c.master) for c in problem.contacts
        ),
        supports=tuple(replace(support, place=named(support.place)) for support in problem.supports),
        loads=tuple(load if load.face is None else replace(load, face=named(load.place).face) for load in problem.loads),
        glue=tuple((named(one), named(other)) for one, other in problem.glue),
    )


def _side(faces: list[Face]) -> Face:
    first, *others = faces
    return Faces(first.body, first.face, tuple(others)) if others else first


def _grid(patch: Patch) -> FloatArray:
    return np.column_stack([patch.control_points, patch.weights]).reshape((*patch.shape, 4), order="F")


def _patch(directions: tuple[Direction, Direction, Direction], grid: FloatArray) -> Patch:
    values = grid.reshape((-1, 4), order="F")
    return Patch(directions, values[:, :3], values[:, 3])


def _turned_contact(contact: Contact, turn: FloatArray) -> Contact:
    if isinstance(contact.master, Face):
        return contact
    plane = contact.master
    return replace(contact, master=RigidPlane(*(vector(turn @ np.array(v)) for v in (plane.point, plane.normal, plane.tangent))))


def _turned_support(support: Support, turn: FloatArray, sense: float) -> Support:
    motions = tuple(Motion(vector(turn @ np.array(m.translate)), sense * m.rotate) for m in support.motions)
    centre, axis = (vector(turn @ np.array(v)) for v in (support.centre, support.axis))
    new = replace(support, motions=motions, centre=centre, axis=axis, moment=None if support.moment is None else sense * support.moment)
    if len(support.components) == 3:
        return new
    to = [int(np.argmax(np.abs(column))) for column in turn.T]
    assert np.abs(turn[to, range(3)]).min() == 1.0, "an axis is turned into an axis"
    force: list[float | None] = [None] * 3
    for k, size in enumerate(support.force):
        force[to[k]] = None if size is None else float(turn[to[k], k]) * size
    return replace(new, components=tuple(sorted(to[k] for k in support.components)), force=(force[0], force[1], force[2]))


def _turned_load(load: Load, turn: FloatArray) -> Load:
    return load if load.kind == "pressure" else replace(load, value=vector(turn @ np.array(load.value)))


def _scaled_load(load: Load, length: float, stress: float) -> Load:
    return replace(load, value=tuple(stress / (length if load.kind == "weight" else 1.0) * value for value in load.value))


def _scaled_contact(contact: Contact, length: float, stress: float) -> Contact:
    area = None if contact.reference_area is None else length**2 * contact.reference_area
    most = None if contact.traction_max is None else stress * contact.traction_max
    slip = length * contact.elastic_slip
    scaled = replace(
        contact,
        reference_area=area,
        cohesion=stress * contact.cohesion,
        traction_max=most,
        elastic_slip=slip,
        smoothing=stress * length * contact.smoothing,
    )
    if isinstance(contact.master, Face):
        return scaled
    return replace(scaled, master=replace(contact.master, point=vector(length * np.array(contact.master.point))))


def _scaled_support(support: Support, length: float, stress: float) -> Support:
    motions = tuple(replace(m, translate=vector(length * np.array(m.translate))) for m in support.motions)
    x, y, z = (None if size is None else stress * length**2 * size for size in support.force)
    moment = None if support.moment is None else stress * length**3 * support.moment
    return replace(support, motions=motions, centre=vector(length * np.array(support.centre)), force=(x, y, z), moment=moment)
