"""Coordinates about an origin of a problem's own: far from that of the scene they have few digits left for what moves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model import constants
from isomortar.model.entities import Body, Contact, Problem, RigidPlane, Support, unit
from isomortar.model.values import Point


def origin_of(problem: Problem) -> FloatArray:
    """Where coordinates count from: the bodies' centre in components that are far away, else 0 (theory 5.10); shape (3,)."""
    ends = np.array([end(body.patch.control_points, axis=0) for body in problem.bodies for end in (np.min, np.max)])
    low, high = ends.min(axis=0), ends.max(axis=0)
    centre = low + 0.5 * (high - low)
    return np.where(np.abs(centre) > constants.NEAR_ORIGIN * (high - low).max(), centre, 0.0)


def about(problem: Problem, origin: FloatArray) -> Problem:
    """The problem with coordinates that count from a point, shape (3,); itself, where that is the origin."""
    if not np.any(origin):
        return problem
    return replace(
        problem,
        bodies=tuple(_body(body, origin) for body in problem.bodies),
        contacts=tuple(_contact(contact, origin) for contact in problem.contacts),
        supports=tuple(_support(support, origin) for support in problem.supports),
        symmetry=tuple(replace(plane, place=plane.place - float(origin[plane.axis])) for plane in problem.symmetry),
    )


def by_near_points(problem: Problem) -> Problem:
    """The problem with each rigid plane given by a point near the slave's body: far from it, coordinates of feet have few digits left.

    Itself, where they are: of another one all would be made anew that is remembered.
    """
    contacts = tuple(_by_near_point(problem, contact) for contact in problem.contacts)
    if all(near is contact for near, contact in zip(contacts, problem.contacts, strict=True)):
        return problem
    return replace(problem, contacts=contacts)


def _by_near_point(problem: Problem, contact: Contact) -> Contact:
    """The contact, with the foot of the body's centre for the point of its plane, if that is farther aside than bodies may be."""
    if not isinstance(contact.master, RigidPlane):
        return contact
    body, normal = problem.body(contact.slave.body), unit(contact.master.normal)
    low, high = body.patch.control_points.min(axis=0), body.patch.control_points.max(axis=0)
    arm = np.asarray(contact.master.point) - (low + 0.5 * (high - low))
    aside = arm - arm @ normal * normal
    if np.linalg.norm(aside) <= constants.NEAR_ORIGIN * body.size:
        return contact
    return replace(contact, master=replace(contact.master, point=_point(contact.master.point, aside)))


def _body(body: Body, origin: FloatArray) -> Body:
    return replace(body, patch=replace(body.patch, control_points=body.patch.control_points - origin))


def _contact(contact: Contact, origin: FloatArray) -> Contact:
    master = contact.master
    return replace(contact, master=replace(master, point=_point(master.point, origin))) if isinstance(master, RigidPlane) else contact


def _support(support: Support, origin: FloatArray) -> Support:
    return replace(support, centre=_point(support.centre, origin))


def _point(point: Point, origin: FloatArray) -> Point:
    x, y, z = (np.asarray(point) - origin).tolist()
    return x, y, z
