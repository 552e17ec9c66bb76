"""A scene before any load step: what it is made of, how its contacts stand, what it will take, and what is doubtful of it."""

from __future__ import annotations

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.patch import IntArray
from isomortar.march.simulation import Simulation
from isomortar.model import constants
from isomortar.model.contrasts import element_lengths
from isomortar.model.entities import Body, Contact, Problem, RigidPlane, Support
from isomortar.model.glue import pieces
from isomortar.model.memory import memory_needed
from isomortar.model.rank import rigid_rank
from isomortar.model.sheet import Sheet
from isomortar.model.stance import stance


@frozen
class BodyOutlook:
    """A body: moduli, none of a rigid one, size along x, y, z, elements along u, v, w with their orders and how long they are, and weights.

    `weights`: the smallest and the largest. `left_free`: how many of the six rigid motions supports leave to it and what is glued to it.
    """

    name: str
    law: str
    young: float | None
    poisson: float | None
    size: tuple[float, float, float]
    family: tuple[str, ...]
    order: tuple[int, ...]
    elements: tuple[int, ...]
    shortest: float
    longest: float
    weights: tuple[float, float]
    control_points: int
    left_free: int


@frozen
class ContactOutlook:
    """A contact: its sides, how it is found, enforced and integrated.

    `apart`: at the start, by cells of the faces; below zero where bodies overlap, and nothing where it is round-off of their size.
    """

    name: str
    slave: str
    master: str
    projection: str
    enforcement: str
    quadrature_points: int
    excluded: int
    apart: float


@frozen
class SupportOutlook:
    """A support: its face, the components that it prescribes, and how far and by what angle it goes in all stages together.

    `force`: by component; none where it has none. `moment`: about its axis. `stages`: names of those in which it holds; none: all.
    """

    name: str
    face: str
    components: str
    way: float
    degrees: float
    force: tuple[float | None, ...]
    moment: float | None
    stages: tuple[str, ...]


@frozen
class LoadOutlook:
    """A load: what kind, its face or body, and its value."""

    name: str
    kind: str
    on: str
    value: tuple[float, ...]


@frozen
class Outlook:
    """What is known of a scene before its first load step; `memory` in bytes, within a factor of two."""

    name: str
    unknowns: int
    load_steps: int
    memory: float
    bodies: tuple[BodyOutlook, ...]
    contacts: tuple[ContactOutlook, ...]
    supports: tuple[SupportOutlook, ...]
    loads: tuple[LoadOutlook, ...]
    warnings: tuple[str, ...]


def outlook(problem: Problem) -> Outlook:
    """Look at a problem without computing it.

    Raises
    ------
    InputError
        It cannot be meant, as by `Simulation`.
    """
    simulation = Simulation(problem)
    return Outlook(
        problem.name,
        len(simulation.equilibrium.supports.free),
        problem.total_steps,
        memory_needed(problem),
        tuple(_body(problem, body) for body in problem.bodies),
        tuple(
            _contact(problem, contact, state.projected) for contact, state in zip(problem.contacts, simulation.state.contacts, strict=True)
        ),
        tuple(_support(problem, support) for support in problem.given_supports),
        tuple(LoadOutlook(load.name, load.kind, load.place.words if load.face else load.body, load.value) for load in problem.loads),
        tuple(simulation.doubts()),
    )


def _body(problem: Problem, body: Body) -> BodyOutlook:
    directions, lengths = body.patch.directions, np.concatenate(element_lengths(body.patch))
    x, y, z = np.ptp(body.patch.control_points, axis=0)
    return BodyOutlook(
        body.name,
        "rigid" if body.rigid else body.material.law,
        None if body.rigid else body.material.young,
        None if body.rigid else body.material.poisson,
        (float(x), float(y), float(z)),
        tuple(direction.family for direction in directions),
        tuple(direction.order for direction in directions),
        tuple(direction.elements for direction in directions),
        float(lengths.min()),
        float(lengths.max()),
        (float(body.patch.weights.min()), float(body.patch.weights.max())),
        len(body.patch.weights),
        0 if body.rigid else 6 - rigid_rank(problem, next(piece for piece in pieces(problem) if body in piece)),
    )


def _contact(problem: Problem, contact: Contact, projected: IntArray) -> ContactOutlook:
    found = stance(problem, contact)
    master, projection = "a rigid plane", "along the plane's normal"
    if not isinstance(contact.master, RigidPlane):
        master, projection = contact.master.words, "along averaged normals" if contact.averaged else "closest points"
    apart = found.gap - found.depth
    return ContactOutlook(
        contact.name,
        contact.slave.words,
        master,
        projection,
        contact.enforcement,
        len(projected),
        int(np.count_nonzero(projected == 0)),
        apart if abs(apart) > constants.SAME_POINT * Sheet.of(problem, contact.slave).size else 0.0,
    )


def _support(problem: Problem, support: Support) -> SupportOutlook:
    ways = [np.linalg.norm(np.asarray(motion.translate)[list(support.components)]) for motion in support.motions]
    return SupportOutlook(
        support.name,
        support.place.words,
        "".join("xyz"[k] for k in support.components),
        float(np.sum(ways)),
        float(np.sum(np.abs([motion.rotate for motion in support.motions]))),
        support.force if support.pressed else (),
        support.moment,
        tuple(problem.stages[number].name for number in support.stages or ()),
    )
