"""What is doubtful of numbers with a unit beside others with the same one: moduli, loads, what friction bears."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model.contact_checks import LEAST
from isomortar.model.entities import Body, Contact, Load, Problem, Support
from isomortar.model.loads import control_areas
from isomortar.model.ratios import times
from isomortar.model.sheet import Sheet

#: Young's moduli further apart were given in two units, most likely: steel is 2e5 times as stiff as soft rubber.
STIFFER = 3e5
#: What acts on a face by a larger share of Young's modulus flattens what it acts on, or tears it.
BORNE = 0.5
#: Elastic slip above this share of a body leaves friction no say before the body has gone that far.
ELASTIC = 0.1
#: Friction that bears a smaller share of Young's modulus is as good as none.
FAINT = 1e-7
#: The acceleration of gravity in m/s² and in mm/s², and how near to one a weight has to be: 9.8 is meant as well.
GRAVITY, NEARLY = (9.81, 9810.0), 2e-3


def of_sizes(problem: Problem) -> Iterator[str]:
    """Sentences on moduli, loads and friction of a problem."""
    yield from _moduli(problem)
    for body in problem.deformable:
        yield from _auxetic(body)
    for contact in problem.contacts:
        yield from _cohesion(problem, contact)
        yield from _faint(problem, contact)
        yield from _elastic_slip(problem, contact)
    for load in problem.loads:
        yield from _no_load(load)
        yield from [*_acceleration(load)] or _large_load(problem, load)
    for support in problem.supports:
        yield from _large_force(problem, support)


def _moduli(problem: Problem) -> Iterator[str]:
    bodies = sorted(problem.deformable, key=lambda body: body.material.young)
    ratio = bodies[-1].material.young / bodies[0].material.young if bodies else 1.0
    if ratio > STIFFER:
        yield (
            f"body {bodies[-1].name!r} is {times(ratio)} times as stiff as body {bodies[0].name!r}. Are their Young's moduli given in the "
            f"same unit? If it is to be rigid beside that one, bodies.{bodies[-1].name}.rigid = true"
        )


def _auxetic(body: Body) -> Iterator[str]:
    if body.material.poisson < 0.0:
        yield (
            f"body {body.name!r}: with Poisson's ratio {body.material.poisson:g} it grows thicker as it is pulled, which few materials do. "
            "Is the sign meant?"
        )


def _young(problem: Problem, contact: Contact) -> float:
    """Young's modulus of the softer side."""
    sides = [contact.slave.faces, getattr(contact.master, "faces", ())]
    bodies = [problem.body(face.body) for faces in sides for face in faces]
    return min(body.material.young for body in bodies if not body.rigid)


def _cohesion(problem: Problem, contact: Contact) -> Iterator[str]:
    young = _young(problem, contact)
    if contact.cohesion > young:
        yield (
            f"contact {contact.name!r}: a cohesion of {contact.cohesion:g} makes all stick, where Young's modulus is {young:g}. Is it "
            "given in the same unit?"
        )


def _faint(problem: Problem, contact: Contact) -> Iterator[str]:
    """Tractions that are given and make no difference."""
    young = _young(problem, contact)
    for name, most in (("cohesion", contact.cohesion), ("traction_max", contact.traction_max or 0.0)):
        if 0.0 < most < FAINT * young:
            yield (
                f"contact {contact.name!r}: {name} = {most:g} is as good as no traction, where Young's modulus is {young:g}. Is it given "
                "in the same unit?"
            )


def _elastic_slip(problem: Problem, contact: Contact) -> Iterator[str]:
    size = Sheet.of(problem, contact.slave).size
    if contact.elastic_slip > ELASTIC * size:
        yield (
            f"contact {contact.name!r}: with an elastic slip of {contact.elastic_slip:g} nothing slides before it has gone that far, and "
            f"the slave is {size:.3g} large. It is a length: take a hundredth of what slides, or less"
        )


def _no_load(load: Load) -> Iterator[str]:
    if not any(load.value) or (load.factors and not any(load.factors)):
        yield f"load {load.name!r} is zero in all stages: it does nothing. Give it a size, or a factor in a stage's loads"


def _acceleration(load: Load) -> Iterator[str]:
    """An acceleration in the place of a weight."""
    size = _norm(load.value)
    if load.kind == "weight" and any(abs(size / gravity - 1.0) < NEARLY for gravity in GRAVITY):
        yield (
            f"load {load.name!r} is {size:g} large, as the acceleration of gravity is. A weight is force per volume: give density times "
            "that"
        )


def _large_load(problem: Problem, load: Load) -> Iterator[str]:
    body = problem.body(load.body)
    length = body.size if load.kind == "weight" else 1.0
    size = length * _norm(load.value) * _largest(load.factors)
    if size > BORNE * body.material.young:
        words = f"times the size of its body, {body.size:.3g}, " if load.kind == "weight" else ""
        yield (
            f"load {load.name!r} {words}comes to {size:.3g} force per area, and Young's modulus is {body.material.young:g}: hardly "
            "anything bears that. Are both given in the same units?"
        )


def _large_force(problem: Problem, support: Support) -> Iterator[str]:
    body = problem.body(support.place.body)
    if body.rigid:
        return
    force = np.array([support.force[k] for k in support.pressed])
    area = float(control_areas(body.patch, support.place.face).sum()) if support.pressed else 1.0
    if not area > LEAST * body.size**2:  # a line or a point
        return
    size = float(np.linalg.norm(force)) * _largest(support.factors) / area / problem.images
    if size > BORNE * body.material.young:
        yield (
            f"support {support.name!r} presses by {size:.3g} force per area of its face, and Young's modulus is {body.material.young:g}: "
            "hardly anything bears that. Are both given in the same units?"
        )


def _norm(values: tuple[float, ...] | FloatArray) -> float:
    return float(np.linalg.norm(values))


def _largest(factors: tuple[float, ...]) -> float:
    return float(np.max(np.abs(factors))) if factors else 1.0
