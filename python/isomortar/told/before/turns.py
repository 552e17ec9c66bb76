"""What is doubtful of the turns of supports: units, axes and centres, and what is to roll."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.geometry.faces import cells
from isomortar.geometry.patch import FloatArray
from isomortar.model.constants import NO_PART
from isomortar.model.entities import Contact, Face, Problem, Support, unit
from isomortar.model.sheet import Sheet
from isomortar.told.before.motions import FLAT, piece_of

#: Angles that people give in radians, over pi, and how near to one a number of degrees has to be: 3.14 is meant as well.
RADIANS = {1 / 6: "pi/6", 1 / 4: "pi/4", 1 / 3: "pi/3", 1 / 2: "pi/2", 2 / 3: "2 pi/3", 3 / 4: "3 pi/4", 5 / 6: "5 pi/6", 1.0: "pi"}
RADIANS |= {1 / 36: "pi/36", 1 / 18: "pi/18", 1 / 12: "pi/12", 1 / 9: "pi/9", 1 / 8: "pi/8"}
RADIANS |= {3 / 2: "3 pi/2", 2.0: "2 pi", 3.0: "3 pi", 4.0: "4 pi", 6.0: "6 pi", 8.0: "8 pi", 10.0: "10 pi", 20.0: "20 pi"}
NEARLY = 1e-3
#: Share of a round body's size by which the axis of its turns may be beside its middle.
OFF_CENTRE = 0.05
#: Share of its ways, along and round, that the foot of a round body may slide before it is not taken to roll: a tyre slides by a tenth.
SLIDES = 0.5
#: Points of a side less far behind its outermost one, over its body's size, are outermost as well.
OUTERMOST = 1e-6


def of_turns(problem: Problem) -> Iterator[str]:
    """Sentences on the turns of a problem's supports, whatever they bring into contact."""
    for support in problem.supports:
        yield from _idle_turns(problem, support)
        yield from _radians(problem, support)
        yield from [*_axis_beside(problem, support)] or _off_centre(problem, support)


def of_rolling(problem: Problem, contact: Contact, towards: FloatArray) -> Iterator[str]:
    """Sentences on round bodies that turn while they go along their contact, and do not roll.

    The unit vector `towards`, shape (3,), is from slave to master.
    """
    for place, other, outwards in ((contact.slave, contact.master, towards), (contact.master, contact.slave, -towards)):
        if isinstance(place, Face) and not _moves(problem, other):
            foot = _foot(problem, place, outwards)
            for support in _round(problem, place):
                yield from _sliding(problem, contact, support, foot - support.centre, outwards)


def _sliding(problem: Problem, contact: Contact, support: Support, arm: FloatArray, normal: FloatArray) -> Iterator[str]:
    """Stages in which the foot of a round body, an `arm` away from its support's centre, slides about as far as the body goes or turns."""
    turn, least = _along(np.cross(unit(support.axis), arm), normal), OFF_CENTRE * problem.body(support.place.body).size
    for stage, motion in zip(problem.stages, support.motions, strict=True):
        way, whole = _along(np.asarray(motion.translate), normal), float(np.linalg.norm(motion.translate))
        goes, round_ = float(np.linalg.norm(way)), np.radians(motion.rotate) * turn
        slides = float(np.linalg.norm(way + round_))
        rolls_not = slides > SLIDES * max(goes, float(np.linalg.norm(round_)))
        turns = motion.rotate and not _meant(motion.rotate) and np.linalg.norm(arm) > least
        if turns and rolls_not and goes > FLAT * whole > 0.0:
            angle = -(way @ turn) / (turn @ turn) if np.linalg.norm(turn) > least else 0.0
            cure = f"turn it by {np.degrees(angle):.3g} degrees"
            if np.linalg.norm(way + angle * turn) > SLIDES * goes:
                axis = ", ".join(f"{a:g}" for a in support.axis)
                cure = f"give supports.{support.name}.axis another direction than [{axis}]"
            yield (
                f"support {support.name!r} goes along contact {contact.name!r} by {goes:.3g} in stage {stage.name!r} and turns its round "
                f"body by {motion.rotate:g} degrees: it slides by {slides:.3g}. If it is to roll, {cure}"
            )


def _along(vector: FloatArray, normal: FloatArray) -> FloatArray:
    """What a vector has across a normal."""
    return vector - vector @ normal * normal


def _foot(problem: Problem, place: Face, outwards: FloatArray) -> FloatArray:
    """The middle of what is outermost of a side, shape (3,)."""
    sheet = Sheet.of(problem, place)
    points = cells(sheet.patch, sheet.face).centres
    heights = points @ outwards
    return points[heights > heights.max() - OUTERMOST * sheet.size].mean(axis=0)


def _round(problem: Problem, place: Face) -> list[Support]:
    """The supports of a side whose bodies, or one of them, are closed."""
    piece = piece_of(problem, place)
    names = {body.name for body in piece if any(body.closed for body in piece)}
    return [support for support in problem.supports if support.place.body in names]


def _moves(problem: Problem, place: object) -> bool:
    """Whether a support of a side goes somewhere, or is free to."""
    names = {body.name for body in piece_of(problem, place)} if isinstance(place, Face) else set()
    return any(support.moves or support.is_plate for support in problem.supports if support.place.body in names)


def _idle_turns(problem: Problem, support: Support) -> Iterator[str]:
    """Turns across which a support leaves a component free."""
    free = [axis for k, axis in enumerate("xyz") if abs(unit(support.axis)[k]) < 1.0 - NO_PART and k not in support.carried]
    for stage, motion in zip(problem.stages, support.motions, strict=True):
        if motion.rotate and free:
            yield (
                f"support {support.name!r} is to turn by {motion.rotate:g} degrees in stage {stage.name!r}, but leaves {', '.join(free)} "
                f"free, across its axis: its points do not go round. Prescribe these as well, or look at supports.{support.name}.axis"
            )


def _radians(problem: Problem, support: Support) -> Iterator[str]:
    """Angles in radians."""
    for stage, motion in zip(problem.stages, support.motions, strict=True):
        for share, words in _meant(motion.rotate):
            yield (
                f"stage {stage.name!r} turns support {support.name!r} by {motion.rotate:g} degrees, and {words} is as much: angles are in "
                f"degrees. If radians were meant, give {np.copysign(180.0 * share, motion.rotate):g}"
            )


def _meant(angle: float) -> list[tuple[float, str]]:
    """What an angle is in radians, as a share of pi and in words: the first that it is, if any."""
    return [(share, words) for share, words in RADIANS.items() if abs(abs(angle) / np.pi - share) < NEARLY * share][:1]


def _axis_beside(problem: Problem, support: Support) -> Iterator[str]:
    """A turn about an axis that is not where the body is."""
    body = problem.body(support.place.body)
    arms = body.patch.control_points - np.asarray(support.centre)
    along = arms @ unit(support.axis)
    beside = float(np.linalg.norm(arms - along[:, None] * unit(support.axis), axis=1).min())
    if support.turns and beside > body.size:
        yield (
            f"support {support.name!r} turns about an axis that is {beside:.3g} beside its body, which is {body.size:.3g} long: it goes "
            f"round on a large circle. If it is to turn where it is, give supports.{support.name}.centre (the origin by default), "
            "and axis"
        )


def _off_centre(problem: Problem, support: Support) -> Iterator[str]:
    """A round body that turns about another axis than one through its middle."""
    body = problem.body(support.place.body)
    middle = 0.5 * (body.patch.control_points.min(axis=0) + body.patch.control_points.max(axis=0))
    arm = middle - np.asarray(support.centre)
    beside = float(np.linalg.norm(arm - arm @ unit(support.axis) * unit(support.axis)))
    if body.closed and support.turns and beside > OFF_CENTRE * body.size:
        where = ", ".join(f"{x + 0.0:.3g}" for x in np.round(middle / body.size, 9) * body.size)
        yield (
            f"support {support.name!r} turns its round body about an axis {beside:.3g} beside the body's middle, [{where}]. If it is to "
            f"turn where it is, give that as supports.{support.name}.centre (the origin by default)"
        )
