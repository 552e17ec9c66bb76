"""What is doubtful of the ways that supports go: units, signs, and where they end."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.geometry.faces import cells
from isomortar.geometry.patch import FloatArray
from isomortar.model.constants import NO_PART
from isomortar.model.entities import Body, Contact, Face, Problem, RigidPlane, Support, unit
from isomortar.model.glue import pieces
from isomortar.model.numbering import Numbering
from isomortar.model.sheet import Sheet
from isomortar.model.supports import Supports

#: Share of what is between the supports of two sides by which they may come nearer to each other: beyond, nothing is left between them.
FLAT = 0.9
#: Share of a body's size below which ways have lost digits by round-off of positions: at 1e-13 forces of a block were off by some per cent.
SHORT = 1e-12


def of_motions(problem: Problem) -> Iterator[str]:
    """Sentences on the motions of a problem's supports, whatever they bring into contact."""
    for support in problem.supports:
        yield from _far_steps(problem, support)
        yield from _short_ways(problem, support)
        yield from _idle_motions(problem, support)
        yield from _as_absolute(problem, support)
    yield from _idle_stages(problem)
    yield from _pushed_in(problem)


def approach(problem: Problem, contact: Contact, towards: FloatArray) -> float | None:
    """By how much motions bring the sides of a contact nearer to each other at most, at an end of a stage, along a unit vector.

    `towards`, shape (3,), is from slave to master. None: something turns about another line, a side is not held along it, or there is no
    stage: nobody knows.
    """
    slave = _ways(problem, contact.slave, towards)
    master = [np.zeros(len(problem.stages))] if isinstance(contact.master, RigidPlane) else _ways(problem, contact.master, towards)
    if not (slave and master and problem.stages):
        return None
    return float(max(np.max(way - other) for way in slave for other in master))


def nearest_approach(problem: Problem, contact: Contact) -> float | None:
    """The same wherever on the master: along the normal of that of its parts to which motions lead; None: nobody knows."""
    if isinstance(contact.master, RigidPlane):
        normals = unit(contact.master.normal)[None]
    else:
        sheet = Sheet.of(problem, contact.master)
        normals = np.unique(np.round(cells(sheet.patch, sheet.face).normals, 2), axis=0)
    ways = [approach(problem, contact, -normal) for normal in normals]
    known = [way for way in ways if way is not None]
    return max(known) if len(known) == len(ways) else None


def _ways(problem: Problem, place: Face, towards: FloatArray) -> list[FloatArray]:
    """How far each support of a side's bodies has gone along a vector at the end of each stage; none: nobody knows."""
    names = {body.name for body in piece_of(problem, place)}
    supports = [support for support in problem.supports if support.place.body in names]
    tilted = any(support.turns and np.linalg.norm(np.cross(unit(support.axis), towards)) > NO_PART for support in supports)
    if tilted or any(support.is_plate for support in supports) or any(load.body in names for load in problem.loads):
        return []
    if not supports and problem.body(place.body).rigid:
        return [np.zeros(len(problem.stages))]
    held = [(support, np.isin(range(3), support.components) * towards) for support in supports]
    return [
        np.cumsum([np.asarray(motion.translate) @ along for motion in support.motions])
        for support, along in held
        if np.linalg.norm(along) > FLAT
    ]


def piece_of(problem: Problem, place: Face) -> tuple[Body, ...]:
    """The bodies of a side with what is glued to them."""
    return next(piece for piece in pieces(problem) if place.body in {body.name for body in piece})


def between(problem: Problem, contact: Contact, towards: FloatArray) -> float:
    """How thick the deformable bodies of a contact are together along a unit vector."""
    sides = [contact.slave] if isinstance(contact.master, RigidPlane) else [contact.slave, contact.master]
    bodies = {body.name: body for place in sides for body in piece_of(problem, place) if not body.rigid}
    return float(sum(np.ptp(body.patch.control_points @ towards) for body in bodies.values()))


def in_far_steps(problem: Problem, support: Support, number: int) -> bool:
    """Whether a support goes farther in a load step of a stage, by its number, than its body is long."""
    step = float(np.linalg.norm(support.motions[number].translate)) / problem.stages[number].steps
    return step > problem.body(support.place.body).size


def _far_steps(problem: Problem, support: Support) -> Iterator[str]:
    size = problem.body(support.place.body).size
    for number, (stage, motion) in enumerate(zip(problem.stages, support.motions, strict=True)):
        step = float(np.linalg.norm(motion.translate)) / stage.steps
        if in_far_steps(problem, support, number):
            yield (
                f"support {support.name!r} moves by {step:.3g} in each load step of stage {stage.name!r}, and its body is {size:.3g} long. "
                "Take more load steps; or are the units not the same?"
            )


def _short_ways(problem: Problem, support: Support) -> Iterator[str]:
    """A support whose ways are next to round-off of the positions."""
    size = problem.body(support.place.body).size
    way = max((float(np.linalg.norm(motion.translate)) for motion in support.motions), default=0.0)
    if 0.0 < way < SHORT * size and not support.turns:
        yield (
            f"support {support.name!r} moves by {way:.3g} in a stage at the most, and its body is {size:.3g} long: round-off of its "
            "positions takes the digits of forces. Take a longer way; or are the units not the same?"
        )


def _idle_motions(problem: Problem, support: Support) -> Iterator[str]:
    """Translations along what a support leaves free."""
    for stage, motion in zip(problem.stages, support.motions, strict=True):
        idle = [axis for k, axis in enumerate("xyz") if motion.translate[k] and k not in support.components]
        if idle:
            held = ", ".join("xyz"[k] for k in support.components)
            yield (
                f"support {support.name!r} is to move along {', '.join(idle)} in stage {stage.name!r}, but prescribes only {held}: "
                "that motion does nothing"
            )


def _idle_stages(problem: Problem) -> Iterator[str]:
    """Stages in which no support moves, begins or ends to hold, and no load changes: nothing depends on time."""
    factors = [load.factors for load in problem.loads] + [support.factors for support in problem.supports]
    for number, stage in enumerate(problem.stages[1:], start=1):
        moved = any(support.motions[number].moves for support in problem.supports)
        loaded = any(of_stage[number] != of_stage[number - 1] for of_stage in factors if of_stage)
        held = any(len({support.holds(k) for k in (number - 1, number)}) > 1 for support in problem.supports)
        if not (moved or loaded or held):
            yield (
                f"nothing moves and no load changes in stage {stage.name!r}: all its load steps ({stage.steps}) compute the same state "
                "again. Give it a motion or a load, or take it out"
            )


def _pushed_in(problem: Problem) -> Iterator[str]:
    """Slave control points that supports put behind a rigid plane: they cannot give way."""
    onto = [(contact, contact.master) for contact in problem.contacts if isinstance(contact.master, RigidPlane)]
    if not onto:
        return
    numbering = Numbering(problem)
    supports = Supports(problem, numbering)
    for contact, plane in onto:
        sheet, normal = Sheet.of(problem, contact.slave), unit(plane.normal)
        points = np.unique(sheet.points(numbering)[sheet.patch.face_points(sheet.face)])
        points = points[np.all(supports.held[points] | (np.abs(normal) < NO_PART), axis=1)]
        ends = np.cumsum([stage.steps for stage in problem.stages])[: _unchanged(problem)]
        depths = [-((supports.place(float(end))[points] - plane.point) @ normal).min(initial=np.inf) for end in ends]
        if max(depths, default=0.0) > NO_PART * sheet.size:
            stage = problem.stages[int(np.argmax(depths))].name
            yield (
                f"contact {contact.name!r}: supports put {len(points)} of its slave control points behind the plane, by "
                f"{max(depths):.3g} at the end of stage {stage!r}, and those cannot give way. Hold fewer components, or end the motion "
                "at the plane"
            )


def _unchanged(problem: Problem) -> int:
    """Number of the first stages in which the same supports hold."""
    holding = [[support.holds(k) for support in problem.supports] for k in range(len(problem.stages))]
    return next((k for k, held in enumerate(holding) if held != holding[0]), len(holding))


def _as_absolute(problem: Problem, support: Support) -> Iterator[str]:
    """Translations that say again where the support is already, while it goes on in another component."""
    ways = np.array([motion.translate for motion in support.motions])
    before = np.cumsum(ways, axis=0) - ways
    for stage, way, reached in zip(problem.stages, ways, before, strict=True):
        again = (way == reached) & (way != 0.0)
        if again.any() and np.any(way[~again]):
            axes = ", ".join("xyz"[k] for k in np.flatnonzero(again))
            yield (
                f"support {support.name!r} goes by as much along {axes} in stage {stage.name!r} as in all stages before it: translations "
                f"count from where the stage before ended. If it is to stay there along {axes}, give 0"
            )
