"""Can a contact be meant? What cannot is refused before any work, with the key to change; what is doubtful only is a warning later."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.net import Net
from isomortar.geometry.patch import FloatArray
from isomortar.model.constants import SAME_POINT
from isomortar.model.entities import Contact, Face, Problem, RigidPlane
from isomortar.model.messages import located
from isomortar.model.sheet import Sheet
from isomortar.model.stance import Stance, stance

#: Least area of a contact face over the square of its own extent, and least extent over its body's: what is below is a line or a point.
LEAST = 1e-12
#: Faces look the same way where all normals of the slave are within 60 degrees of the master's.
SAME_WAY = 0.5
#: Least elastic slip over the extent of the slave's body: the last bits of positions then make 1e-7 of what friction bears.
LEAST_SLIP = 1e-9
#: Most that pressure times distance may be, over stiffness times size of the slave's body: beyond, smooth contact is no contact.
LARGEST_SMOOTHING = 1e-2
#: Bodies that overlap by this share of the thinner one have passed through each other.
PASSED = 0.9


def check_contacts(problem: Problem) -> None:
    """Refuse contacts that cannot be meant.

    Raises
    ------
    InputError
        Faces without an area, that look away from each other, or have passed through each other; the same contact twice; a friction
        whose numbers contradict each other; averaged normals where there are none; constraints at points, dual functions, and
        cells along knot lines, that cannot be.
    """
    for contact in problem.contacts:
        _check_sides(problem, contact)
        _check_friction(contact)
        _check_elastic_slip(problem, contact)
        _check_smoothing(problem, contact)
        _check_projection(problem, contact)
        _check_enforcement(problem, contact)
        _check_subcells(contact)
        found = stance(problem, contact)
        _check_area(problem, contact, found)
        _check_stance(problem, contact, found)
    for one, other in combinations(problem.contacts, 2):
        if (one.slave, one.master) == (other.slave, other.master):
            raise InputError(
                f"is between the same faces as contact {one.name!r}: their pressures could be shared in any way; remove one of them",
                f"contacts.{other.name}",
            )


def _check_sides(problem: Problem, contact: Contact) -> None:
    """Refuse sides of several faces that do not join to one, faces that are on both sides, and sides that are both rigid."""
    for side, place in (("slave", contact.slave), ("master", contact.master)):
        if isinstance(place, Face):
            with located(f"contacts.{contact.name}.{side}"):
                Sheet.of(problem, place)
    both = set(contact.slave.faces) & set(contact.master.faces) if isinstance(contact.master, Face) else set()
    rigid_master = isinstance(contact.master, RigidPlane) or problem.body(contact.master.body).rigid
    if rigid_master and problem.body(contact.slave.body).rigid:
        raise InputError(
            f"is {contact.slave.words}, of a rigid body, and its master is rigid too: nothing gives way; let one of the two deform",
            f"contacts.{contact.name}.slave",
        )
    if both:
        raise InputError(f"has {both.pop().words} in common with the slave; allowed: other faces", f"contacts.{contact.name}.master")


def _check_friction(contact: Contact) -> None:
    """Refuse a largest traction that leaves a part of the law without any say."""
    field = f"contacts.{contact.name}.traction_max"
    if contact.traction_max is None:
        return
    if contact.friction == 0.0:
        raise InputError(
            f"is {contact.traction_max:g}, but without friction tractions do not grow with the pressure: they are up to the cohesion, "
            f"{contact.cohesion:g}; remove it, give a coefficient of friction, or give that limit as the cohesion",
            field,
        )
    if contact.traction_max <= contact.cohesion:
        raise InputError(
            f"is {contact.traction_max:g}, and the cohesion, {contact.cohesion:g}, is not below it: friction would have no say; give a "
            "larger one, or, for tractions up to a constant, friction = 0 and that constant as the cohesion",
            field,
        )


def _check_elastic_slip(problem: Problem, contact: Contact) -> None:
    """Refuse elastic slip of what does not rub, and one that is no more than round-off of positions."""
    path, size = f"contacts.{contact.name}.elastic_slip", problem.body(contact.slave.body).size
    if contact.elastic_slip and not contact.friction_law.acts:
        raise InputError(f"is {contact.elastic_slip:g}, but the contact has no friction that could give way; remove it", path)
    if 0.0 < contact.elastic_slip < LEAST_SLIP * size:
        raise InputError(
            f"is {contact.elastic_slip:g}, next to round-off of the positions of {contact.slave.body!r}, which is {size:.3g} large; "
            f"allowed: {LEAST_SLIP * size:.3g} and more, or 0 for Coulomb's law",
            path,
        )


def _check_smoothing(problem: Problem, contact: Contact) -> None:
    """Refuse what would press bodies apart from afar, and what acts wherever there is contact, which is everywhere then."""
    if contact.smoothing and contact.cohesion:
        raise InputError(
            f"is {contact.smoothing:g}: all that is apart presses then, and a cohesion, {contact.cohesion:g} here, would act there; "
            "allowed: one of the two",
            f"contacts.{contact.name}.smoothing",
        )
    body = problem.body(contact.slave.body)
    others = [problem.body(face.body) for face in contact.master.faces] if isinstance(contact.master, Face) else []
    most = min(other.modulus for other in (body, *others)) * body.size
    if contact.smoothing > LARGEST_SMOOTHING * most:
        raise InputError(
            f"is {contact.smoothing:g}: {body.name!r} would be pressed away from afar; allowed: up to {LARGEST_SMOOTHING * most:.3g}, a "
            "hundredth of stiffness times size, or 0 for contact alone",
            f"contacts.{contact.name}.smoothing",
        )


def _check_projection(problem: Problem, contact: Contact) -> None:
    """Refuse averaged normals of a master that has none, and the paper's slip sum along them."""
    if contact.projection != "averaged":
        return
    path = f"contacts.{contact.name}.projection"
    if isinstance(contact.master, RigidPlane):
        raise InputError('is "averaged", but a rigid plane has one normal everywhere; remove it', path)
    if has_pole(Sheet.of(problem, contact.master)):
        raise InputError(
            f'is "averaged", but the master {contact.master.words} has a pole, an edge that is one point, where '
            'elements have no normal; take "closest", or a mesh without a pole',
            path,
        )
    if problem.settings.slip_sum == "paper" and contact.friction_law.acts:
        raise InputError('is "averaged", and solver.slip_sum is "paper", which counts slips on the master; take slip_sum = "local"', path)


def _check_enforcement(problem: Problem, contact: Contact) -> None:
    """Refuse points that there are not, that fall together, or are too many for multipliers of their own; dual functions likewise."""
    path, sheet, words = f"contacts.{contact.name}.enforcement", Sheet.of(problem, contact.slave), contact.slave.words
    directions = sheet.directions
    if contact.enforcement == "demko" and any(direction.family == "L" for direction in directions):
        raise InputError(
            f'is "demko", but {words} is of Lagrange elements, which have no such abscissae; take "greville": their nodes', path
        )
    if contact.enforcement in ("knots", "greville", "demko") and has_pole(sheet):
        raise InputError(
            f'is "{contact.enforcement}", but the slave {words} has a pole, an edge that is one point: constraints would fall '
            'together there; take "mortar" or "kts"',
            path,
        )
    if contact.enforcement == "dual":
        _check_dual(problem, contact, path)
    if contact.enforcement == "kts" and problem.settings.method == "monolithic":
        points = np.prod([direction.elements * count for direction, count in zip(directions, contact.quadrature, strict=True)])
        control_points = np.prod([direction.count for direction in directions])
        if points > control_points:
            raise InputError(
                f'is "kts", with {points} conditions for the {control_points} control points of {words}: as unknowns their '
                f'multipliers would repeat each other; take solver.method = "uzawa", or fewer points (contacts.{contact.name}.quadrature)',
                path,
            )


def _check_dual(problem: Problem, contact: Contact, path: str) -> None:
    """Refuse dual functions that their element's points do not tell apart, and a slip sum by products of them."""
    directions = Sheet.of(problem, contact.slave).directions
    if any(count <= direction.order for direction, count in zip(directions, contact.quadrature, strict=True)):
        least = [direction.order + 1 for direction in directions]
        raise InputError(
            f'is {list(contact.quadrature)}, too few points to tell the functions of an element apart, as enforcement = "dual" has to; '
            f"allowed: at least {least}",
            f"contacts.{contact.name}.quadrature",
        )
    if problem.settings.slip_sum == "paper" and contact.friction_law.acts:
        raise InputError(
            'is "dual", and solver.slip_sum is "paper", whose sum is one of products of functions that are nowhere negative; '
            'take slip_sum = "local"',
            path,
        )


def _check_subcells(contact: Contact) -> None:
    """Refuse cells along knot lines that there are not, or of methods that do not integrate."""
    path = f"contacts.{contact.name}.subcells"
    if contact.subcells and not isinstance(contact.master, Face):
        raise InputError(f"is {contact.subcells}, but the master is a rigid plane, which has no knot lines; allowed: 0", path)
    if contact.subcells and not contact.of_averages:
        raise InputError(
            f'is {contact.subcells}, but enforcement is "{contact.enforcement}", whose constraints are at points; '
            'allowed: 0, "mortar" or "dual"',
            path,
        )


def poles(sheet: Sheet) -> list[tuple[int, FloatArray]]:
    """Edges of a sheet's face that are one point: which of its coordinates (0, 1) ends there, and the point, shape (3,)."""
    grid = Net.of(sheet.patch, sheet.face).points
    edges = ((1, grid[0]), (1, grid[-1]), (0, grid[:, 0]), (0, grid[:, -1]))
    return [(across, edge[0]) for across, edge in edges if float(np.ptp(edge, axis=0).max()) <= SAME_POINT * sheet.size]


def has_pole(sheet: Sheet) -> bool:
    """Whether an edge of a sheet's face is one point."""
    return bool(poles(sheet))


def _check_area(problem: Problem, contact: Contact, found: Stance) -> None:
    for side, place, area in (("slave", contact.slave, found.slave_area), ("master", contact.master, found.master_area)):
        if isinstance(place, Face) and not _spreads(Sheet.of(problem, place), area):
            raise InputError(
                f"is {place.words}, a face of area {area:.3g}: its control points fall onto a line or a point; name another face",
                f"contacts.{contact.name}.{side}",
            )


def _spreads(sheet: Sheet, area: float) -> bool:
    """Whether a face is a surface. It is judged by its own extent: that of a long body makes each of its ends seem a point."""
    extent = float(np.ptp(sheet.patch.control_points[sheet.patch.face_points(sheet.face)], axis=0).max())
    return area > LEAST * extent**2 and extent > LEAST * sheet.size


def _check_stance(problem: Problem, contact: Contact, found: Stance) -> None:
    slave = contact.slave.words
    looks_away = found.cosine > SAME_WAY
    if isinstance(contact.master, RigidPlane):
        field = f"contacts.{contact.name}.plane.normal"
        turned = ", ".join(f"{-n or 0.0:g}" for n in contact.master.normal)
        cure = f"the normal points out of the plane, towards the body: turn it round, [{turned}]"
        if looks_away and found.behind:
            raise InputError(f"body {contact.slave.body!r} lies behind the plane, and {slave} looks away from it; {cure}", field)
        if found.depth > PASSED * found.thickness:
            raise InputError(f"{slave} overlaps the plane by {found.depth:.3g}, and its body is {found.thickness:.3g} thick; {cure}", field)
    elif found.depth > PASSED * found.thickness:
        raise InputError(
            f"{slave} overlaps {contact.master.body!r} by up to {found.depth:.3g}, where the thinner of the two bodies is "
            f"{found.thickness:.3g} thick: they have passed through each other; move one of them, or name the faces that meet",
            f"contacts.{contact.name}.master",
        )
    if looks_away and not something_turns(problem):
        raise InputError(
            f"{slave} looks away from its master, and nothing in the scene turns it; name the face that looks at the master",
            f"contacts.{contact.name}.slave",
        )


def something_turns(problem: Problem) -> bool:
    """Whether a support turns its face, by a motion or by a moment."""
    return any(support.turns or support.moment is not None for support in problem.supports)
