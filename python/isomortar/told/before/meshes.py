"""What is doubtful of meshes, quadratures and settings of the solver: numbers that cost digits of the result, or do nothing."""

from __future__ import annotations

from collections.abc import Iterator
from math import comb

import numpy as np

from isomortar.geometry.patch import opposite
from isomortar.model.contrasts import element_lengths
from isomortar.model.entities import Body, Contact, Face, Problem
from isomortar.model.ratios import times
from isomortar.model.settings import SolverSettings
from isomortar.model.sheet import Sheet

#: Mean lengths of elements in two directions further apart make them slender, as when numbers of elements are in another order.
SLENDER = 20.0
#: Elements at a face in contact longer than those at the opposite face by this factor were to be the finer ones, most likely.
GRADED = 3.0
#: Bending stiffness over the right one above which a body of order 1 hardly bends.
SAID_ABOVE = 2.0
#: Share of the pressures from which on it is told that the last bits of a tall body's positions may make it; and a factor of the estimate,
#: fitted to what pressure fields of columns pressed by a tenth were off by (theory 9.6).
LOST, OF_ESTIMATE = 1e-3, 0.5
#: Shares that solvers may leave open: more shows in the second digit of forces, and is told.
LOOSE = {"newton_tolerance": 1e-4, "augmentation_tolerance": 0.01}
#: Settings that one method alone looks at.
OF_METHOD = {
    "uzawa": (
        "penalty_normal", "penalty_tangential", "penalty_growth", "penalty_growth_max",
        "augmentation_tolerance", "augmentation_norm", "max_augmentations",
    ),
    "monolithic": ("complementarity_tolerance",),
}  # fmt: skip


def of_meshes(problem: Problem) -> Iterator[str]:
    """Sentences on the discretisation of a problem, and on how far it is solved."""
    for body in problem.deformable:
        yield from _slender(body)
        yield from _few_points(body)
        yield from _hardly_bends(problem, body)
    touching = {face for contact in problem.contacts for side in (contact.slave, contact.master) for face in getattr(side, "faces", ())}
    for face in sorted(touching, key=lambda face: face.words):
        if Face(face.body, opposite(face.face)) not in touching:
            yield from _graded_away(problem.body(face.body), face)
    for contact in problem.contacts:
        yield from _one_element(problem, contact)
        yield from _few_contact_points(problem, contact)
    for face in sorted({face for contact in problem.contacts for face in contact.slave.faces}, key=lambda face: face.words):
        if not problem.body(face.body).rigid:
            yield from _tall(problem.body(face.body), face)
    yield from _loose(problem)
    yield from _without_effect(problem)


def _slender(body: Body) -> Iterator[str]:
    """Elements that are short along a direction with many of them, and long along another one."""
    lengths = [float(np.mean(along)) for along in element_lengths(body.patch)]
    shortest, longest = int(np.argmin(lengths)), int(np.argmax(lengths))
    if lengths[longest] > SLENDER * lengths[shortest] and body.patch.directions[shortest].elements > 1:
        elements = [direction.elements for direction in body.patch.directions]
        yield (
            f"body {body.name!r}: its elements are {lengths[shortest]:.2g} long along {'uvw'[shortest]} and {lengths[longest]:.2g} along "
            f"{'uvw'[longest]}, on average. bodies.{body.name}.mesh.elements, {elements}, are along u, v, w: take fewer along "
            f"{'uvw'[shortest]}, or more along {'uvw'[longest]}"
        )


def _tall(body: Body, face: Face) -> Iterator[str]:
    """A slave so tall behind its face that the last bits of its positions are pressures there (theory 9.6)."""
    axis = "uvw".index(face.face[0])
    lengths = element_lengths(body.patch)
    tall, along = float(np.sum(lengths[axis])), [k for k in range(3) if k != axis]
    wide, element = (float(min(of(lengths[k]) for k in along)) for of in (np.sum, np.median))
    orders = [body.patch.directions[k].order for k in along]
    condition = float(np.prod([comb(2 * order + 1, order) for order in orders]))
    lost = OF_ESTIMATE * np.finfo(float).eps * tall**2 / (wide * element) * condition**0.25
    if lost > LOST:
        yield (
            f"body {body.name!r} is {times(tall / wide, 1)} times as tall as {face.words}, a slave face, is wide, and of order "
            f"{max(orders)} there: round-off of its positions may be {lost:.1g} of the pressures, and more of small ones. Take a lower "
            "order, longer elements, or a body that is less tall"
        )


def _graded_away(body: Body, face: Face) -> Iterator[str]:
    """Elements that are longest where contact acts, and much shorter at the opposite face, where it does not."""
    axis, end = "uvw".index(face.face[0]), int(face.face[1])
    lengths = element_lengths(body.patch)[axis]
    near, far = (lengths[0], lengths[-1])[:: -1 if end else 1]
    if not body.rigid and near == lengths.max() and near > GRADED * far:
        yield (
            f"body {body.name!r}: its elements behind {face.words}, a face in contact, are {near:.2g} long, and {far:.2g} at the opposite "
            f"face: finest where nothing touches. Take bodies.{body.name}.mesh.grading along {face.face[0]} "
            f"{'below' if end else 'above'} 1"
        )


def _few_points(body: Body) -> Iterator[str]:
    """Gauss points that do not see all ways in which an element can deform."""
    needed = [max(2, direction.order) for direction in body.patch.directions]
    if any(count < least for count, least in zip(body.quadrature, needed, strict=True)):
        yield (
            f"body {body.name!r}: {' x '.join(map(str, body.quadrature))} Gauss points an element do not see all ways in which it can "
            f"deform: what they miss costs nothing, and grows. Take bodies.{body.name}.mesh.quadrature = {needed} or more, or none"
        )


def _hardly_bends(problem: Problem, body: Body) -> Iterator[str]:
    """A thin body that is of order 1 along its sheet, whose shear strains bear what bending should."""
    stiff = stiff_sheet(problem, body)
    if stiff > SAID_ABOVE:
        lengths = element_lengths(body.patch)
        across = int(np.argmin([along.sum() for along in lengths]))
        yield (
            f"body {body.name!r} is {lengths[across].sum():.3g} thick along {'uvw'[across]}, and its elements of order 1 are so long that "
            f"it is about {times(stiff, 2)} times too stiff in bending: they shear instead (locking). Take bodies.{body.name}.mesh.order = "
            "2 or more, or elements shorter than it is thick"
        )


def stiff_sheet(problem: Problem, body: Body) -> float:
    """How many times too stiff in bending a sheet is that is of order 1 along it, in the direction that bends best; 1 of other bodies.

    An element of length h keeps its sides straight, and is sheared by kappa x where the curvature is kappa: a sheet of thickness t is
    1 + h^2 / (2 (1 + nu) t^2) times as stiff as it should be. What is held across, or glued, is no sheet.
    """
    lengths = element_lengths(body.patch)
    across = int(np.argmin([along.sum() for along in lengths]))
    letter, thickness = "uvw"[across], float(lengths[across].sum())
    held = any(problem.holds(Face(body.name, f"{letter}{end}"), k) for end in (0, 1) for k in range(len(problem.stages)))
    if held or any(face.body == body.name for joint in problem.glue for face in joint):
        return 1.0
    return min(
        1.0 + (float(lengths[k].max()) / thickness) ** 2 / (2.0 * (1.0 + body.material.poisson)) if direction.order == 1 else 1.0
        for k, direction in enumerate(body.patch.directions)
        if k != across
    )


def _one_element(problem: Problem, contact: Contact) -> Iterator[str]:
    """A slave face of one element of a low order: a mesh that was not given."""
    sheet = Sheet.of(problem, contact.slave)
    if not sheet.rigid and all(direction.elements == 1 and direction.order <= 2 for direction in sheet.directions):
        yield (
            f"contact {contact.name!r}: the slave face {contact.slave.words} is a single element, and pressure has hardly a shape. Give "
            f"bodies.{contact.slave.body}.mesh.elements"
        )


def _few_contact_points(problem: Problem, contact: Contact) -> Iterator[str]:
    """Quadrature points that do not tell the functions of a slave element apart."""
    needed = [direction.order + 1 for direction in Sheet.of(problem, contact.slave).directions]
    if contact.of_averages and any(count < least for count, least in zip(contact.quadrature, needed, strict=True)):
        yield (
            f"contact {contact.name!r}: {' x '.join(map(str, contact.quadrature))} quadrature points an element do not tell its functions "
            f"apart, and see no more of the master than that. Take contacts.{contact.name}.quadrature = {needed} or more, or none"
        )


def _loose(problem: Problem) -> Iterator[str]:
    """Tolerances of the method in use that stand for errors of the result."""
    settings = problem.settings
    for name in ("newton_tolerance", "augmentation_tolerance")[: 2 if settings.method == "uzawa" else 1]:
        value = getattr(settings, name)
        if value > LOOSE[name]:
            yield (
                f"solver.{name} = {value:g} leaves that share of forces or contact conditions open, in each load step. Take "
                f"{LOOSE[name]:g} or less, or none"
            )


def _without_effect(problem: Problem) -> Iterator[str]:
    """Settings of the method that is not in use: who varies them sees nothing change."""
    settings = problem.settings
    for method, names in OF_METHOD.items():
        for name in names if method != settings.method else ():
            value = getattr(settings, name)
            if value != getattr(SolverSettings(), name):
                yield (
                    f'solver.{name} = {value} does nothing: it is of method "{method}", and solver.method is "{settings.method}". Take it '
                    "out, or take that method"
                )
