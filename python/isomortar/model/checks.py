"""Is a problem well posed? What can be known before any work is said before any work."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import asdict, replace
from functools import cache
from itertools import combinations

import numpy as np
from pydantic import TypeAdapter, ValidationError

from isomortar._arguments import kind
from isomortar.errors import FoldedElementError, InputError
from isomortar.geometry.patch import FloatArray
from isomortar.geometry.refinement import surface_samples
from isomortar.model import constants
from isomortar.model.contact_checks import check_contacts
from isomortar.model.entities import Body, Contact, Face, Problem, RigidPlane, Support, unit
from isomortar.model.glue import check_glue, named, pieces
from isomortar.model.load_checks import check_loads
from isomortar.model.magnitudes import check_magnitudes
from isomortar.model.memory import memory_needed, memory_of_machine
from isomortar.model.messages import input_error, located
from isomortar.model.numbering import Numbering, check_closed
from isomortar.model.rank import rigid_rank
from isomortar.model.rational import QUADRATURE_TOLD, quadrature_error, too_few_points
from isomortar.model.settings import SolverSettings

#: Sizes of bodies, and forces and force densities (Young's modulus times the square of the size, and over the size) whose squares and
#: cubes are normal numbers.
SIZES, FORCES = (1e-76, 1e76), (1e-153, 1e153)
#: Share of a body's size that the last bit of its coordinates may be.
LAST_BIT = 1e-3

#: Most turns of a support in one load step. Each takes ten increments: with more a run would seem to hang.
MOST_TURNS = 10
#: Share of the forces by which the quadrature of rational functions makes them nonsense.
QUADRATURE_LOST = 0.1


def check(problem: Problem) -> None:
    """Refuse problems that cannot have a solution, or not a single one.

    Raises
    ------
    InputError
        No problem; settings of the solver that are not allowed; units that no number holds; left-handed bodies; more memory than
        there is; glue of faces that do not conform; a support that turns too often in a load step, goes or turns too far from the
        origin, goes by motion and by force at once, moves where it does not hold, or has a moment and no face to turn; a rigid body
        that supports contradict each other on, leave components to, or release; a body that nothing holds; supports that contradict
        each other; contacts and loads that cannot be meant, or are absurdly large; too few Gauss points for a body's weights.
    """
    kind("problem", problem, Problem, way=", of a scene: scene.problem()")
    _check_settings(problem.settings)
    for body in problem.bodies:
        check_units(body)
        _check_handedness(body)
        check_closed(body)
    for body in problem.deformable:
        _check_weights(body)
    _check_memory(problem)
    check_glue(problem)
    check_contacts(problem)
    check_loads(problem)
    check_magnitudes(problem)
    _check_turns(problem)
    _check_ways(problem)
    _check_carried(problem)
    _check_forces(problem)
    _check_held(problem)
    numbering = Numbering(problem)
    for one, other in combinations(problem.supports, 2):
        _check_agreement(problem, numbering, one, other)


@cache
def _allowed() -> TypeAdapter[SolverSettings]:
    return TypeAdapter(SolverSettings)


def _check_settings(settings: SolverSettings) -> None:
    """Settings made in Python are what those of a scene file may be; and go together."""
    values = asdict(settings)
    try:
        _allowed().validate_python(values)
    except ValidationError as error:
        with located("solver"):
            raise input_error(error, values) from error
    path, left = settings.path_tolerance, settings.augmentation_tolerance
    if settings.method == "uzawa" and path is not None and path < left:
        raise InputError(
            f"is {path:g}, below solver.augmentation_tolerance = {left:g}, the share of the multipliers that augmentations leave open: no "
            "increment is small enough; take that one smaller, too",
            "solver.path_tolerance",
        )
    if settings.engine == "own" and settings.compression:
        raise InputError(
            f'is {settings.compression:g}, and solver.engine is "own", whose factors are whole; remove it, or take engine = "mumps"',
            "solver.compression",
        )


def check_units(body: Body) -> None:
    """Refuse a body whose lengths, or forces that belong to them, no number holds, or of which no digits are left where it stands."""
    size, young = body.size, body.material.young
    if not SIZES[0] <= size <= SIZES[1]:
        raise InputError(
            f"body {body.name!r} is {size:.3g} long; allowed: {SIZES[0]:g} to {SIZES[1]:g}; take another unit of length",
            f"bodies.{body.name}",
        )
    for product, words in () if body.rigid else ((young * size * size, "times the square of"), (young / size, "over")):
        if not FORCES[0] <= product <= FORCES[1]:
            raise InputError(
                f"body {body.name!r}: young = {young:.3g} {words} its size, {size:.3g}, is {product:.3g}; "
                f"allowed: {FORCES[0]:g} to {FORCES[1]:g}; take other units",
                f"bodies.{body.name}.material",
            )
    farthest = float(np.abs(body.patch.control_points).max())
    if np.spacing(farthest) > LAST_BIT * size:
        raise InputError(
            f"body {body.name!r} stands {farthest:.3g} from the origin and is {size:.3g} long: its coordinates have no digits left for "
            "that; move the whole scene nearer to the origin",
            f"bodies.{body.name}",
        )


def _check_handedness(body: Body) -> None:
    """Refuse bodies that are left-handed as a whole, by the cells of their control points: their faces would look inwards."""
    grid = body.patch.control_points.reshape((*body.patch.shape, 3), order="F")
    corner = grid[:-1, :-1, :-1]
    u, v, w = grid[1:, :-1, :-1] - corner, grid[:-1, 1:, :-1] - corner, grid[:-1, :-1, 1:] - corner
    if np.einsum("ijkc,ijkc->", np.cross(u, v), w) < 0.0:
        raise InputError(
            f"body {body.name!r} is left-handed, u, v, w like the first fingers of a left hand: its volume would be negative; let its "
            "control points run the other way along one of them",
            f"bodies.{body.name}",
        )


def _check_weights(body: Body) -> None:
    """Rational functions that the Gauss points miss altogether; what they follow better is warned of."""
    with suppress(FoldedElementError):  # between the Gauss points: told by a warning, or by the run where it is at them
        error = quadrature_error(body)
        if not error <= QUADRATURE_LOST:
            raise InputError(too_few_points(body, error, QUADRATURE_TOLD), f"bodies.{body.name}.mesh.quadrature")


def _check_memory(problem: Problem) -> None:
    """The estimate is good within a factor of two: refused is what cannot fit even then."""
    needed, there = memory_needed(problem), memory_of_machine()
    if needed > 2.0 * there:
        largest = max(problem.deformable, key=lambda body: memory_needed(replace(problem, bodies=(body,))))
        raise InputError(
            f"Gauss points, tangent and factors would take about {needed / 1e9:.3g} GB of memory, and there are {there / 1e9:.3g} GB; "
            "take fewer elements, a lower order or fewer points",
            f"bodies.{largest.name}.mesh",
        )


def _check_turns(problem: Problem) -> None:
    """A support that turns too often in one load step: a mistake in the angle's unit or digits, most likely."""
    for support in problem.supports:
        for stage, motion in zip(problem.stages, support.motions, strict=True):
            turns = abs(motion.rotate) / 360.0
            if turns > MOST_TURNS * stage.steps:
                raise InputError(
                    f"turns support {support.name!r} {turns:.3g} times in {stage.steps} load steps; allowed: {MOST_TURNS} times in each. "
                    "Angles are degrees; a longer way takes more steps",
                    f"stages.{stage.name}.motions.{support.name}.rotate",
                )


def _check_ways(problem: Problem) -> None:
    """A support that goes, or turns about a centre, so far from the origin that its body is lost in the last bits there."""
    for support in problem.supports:
        name = support.place.body
        most = LAST_BIT * problem.body(name).size
        centre = float(np.abs(support.centre).max())
        if not np.spacing(centre) <= most:
            raise InputError(
                f"is {centre:.3g} from the origin, where the coordinates of body {name!r} have no digits left; move it nearer to the body",
                f"supports.{support.name}.centre",
            )
        with np.errstate(over="ignore"):  # inf has no digits either
            ways = np.abs(np.cumsum(np.reshape([motion.translate for motion in support.motions], (-1, 3)), axis=0)).max(axis=1)
        for stage, way in zip(problem.stages, ways.tolist(), strict=True):
            if not np.spacing(way) <= most:
                raise InputError(
                    f"support {support.name!r} has gone {way:.3g} by the end of the stage, where the coordinates of body {name!r} have "
                    "no digits left; take a shorter way (units?)",
                    f"stages.{stage.name}.motions.{support.name}.translate",
                )


def _check_carried(problem: Problem) -> None:
    """A rigid body, with what is glued to it, goes as a whole with one support, or stands still."""
    carried: dict[str, str] = {}
    whole = {body.name: piece for piece in pieces(problem) for body in piece}
    for support in problem.supports:
        name = support.place.body
        if not problem.body(name).rigid:
            continue
        if support.stages is not None:
            raise InputError(
                f"are given, but body {name!r} is rigid, and goes with its support throughout; allowed: none, and motions that stop",
                f"supports.{support.name}.stages",
            )
        if name in carried:
            raise InputError(
                f"is on {named(whole[name], name)}, which is rigid and goes as a whole with support {carried[name]!r}; remove one",
                f"supports.{support.name}.face",
            )
        if len(support.carried) < 3:
            held = ", ".join("xyz"[k] for k in support.components)
            raise InputError(
                f"are {held}, but body {name!r} is rigid, and goes with its support along x, y, z; allowed: all three, by motion or force",
                f"supports.{support.name}.components",
            )
        carried |= {body.name: support.name for body in whole[name]}


def _check_forces(problem: Problem) -> None:
    """A support goes along a component by a motion, or by a force, turns by one or by a moment, and does so where it holds."""
    for support in problem.supports:
        if support.moment is not None:
            _check_moment(problem, support)
        for number, (stage, motion) in enumerate(zip(problem.stages, support.motions, strict=True)):
            if motion.moves and not support.holds(number):
                raise InputError(
                    f"moves support {support.name!r}, which does not hold in that stage (supports.{support.name}.stages); allowed: nothing",
                    f"stages.{stage.name}.motions.{support.name}",
                )
            if motion.rotate and support.moment is not None:
                raise InputError(
                    f"turns support {support.name!r}, and so does supports.{support.name}.moment; allowed: 0 there",
                    f"stages.{stage.name}.motions.{support.name}.rotate",
                )
        for stage, motion in zip(problem.stages, support.motions, strict=True):
            both = [k for k in support.pressed if motion.translate[k]]
            if both:
                words = ", ".join("xyz"[k] for k in both)
                raise InputError(
                    f"moves support {support.name!r} along {words}, where supports.{support.name}.force does; allowed: 0 there",
                    f"stages.{stage.name}.motions.{support.name}.translate",
                )


def _check_moment(problem: Problem, support: Support) -> None:
    """A plate that turns needs its components across the axis, and control points beside each other across it."""
    axis, body = unit(support.axis), problem.body(support.place.body)
    left = [k for k in range(3) if abs(axis[k]) < 1.0 and k not in support.carried]
    if left:
        raise InputError(
            f"turns the face, of which {', '.join('xyz'[k] for k in left)} go free; allowed: with all components across the axis "
            "prescribed, or moved by a force",
            f"supports.{support.name}.moment",
        )
    points = body.patch.control_points[... if body.rigid else body.patch.common_points(support.place.meeting)]
    if not np.linalg.norm(np.cross(axis, points - points.mean(axis=0)), axis=1).max() > constants.NO_PART * body.size:
        raise InputError(
            "is along the line, or through the point, that all control points of the support are on: how far they turn is not told; "
            "allowed: an axis across them",
            f"supports.{support.name}.axis",
        )


def _check_held(problem: Problem) -> None:
    """Every body needs a support, or to touch what is held, or under a load a plane, from the start, or to be glued to one that does.

    Without supports later it has to be in contact.
    """
    whole = {body.name: piece for piece in pieces(problem) for body in piece}
    held = {body.name for support in problem.given_supports if support.holds(0) for body in whole[support.place.body]}
    held |= {body.name for body in problem.bodies if body.rigid}
    loaded = {body.name for load in problem.loads for body in whole[load.body]}
    touching = [c for c in problem.contacts if _touch(problem, c)]
    on_planes = {face.body for contact in touching if isinstance(contact.master, RigidPlane) for face in contact.slave.faces}
    for _ in problem.bodies:
        for contact in touching:
            sides = [side for side in (contact.slave, contact.master) if isinstance(side, Face)]
            pair = {body.name for side in sides for face in side.faces for body in whole[face.body]}
            if pair & (loaded if isinstance(contact.master, RigidPlane) else held):
                held |= pair
    touched = [face.body for c in problem.contacts for side in (c.slave, c.master) if isinstance(side, Face) for face in side.faces]
    in_contact = {body.name for name in touched for body in whole[name]}
    for body in problem.deformable:
        if body.name not in held:
            rests = not on_planes.isdisjoint(one.name for one in whole[body.name])
            why = "and no load presses it on the plane that it touches" if rests else "and touches no held body or plane at the start"
            raise InputError(
                f"{named(whole[body.name], body.name)} is free: it has no support {why}; add a support on one of its faces"
                f"{', or a load' if rests else ''}",
                f"bodies.{body.name}",
            )
    hinged = replace(problem, supports=tuple(replace(s, moment=None) for s in problem.supports))  # on a hinge loads may hold it
    for number, stage in enumerate(problem.stages):
        for body in problem.bodies:
            if body.name not in in_contact and rigid_rank(hinged, whole[body.name], number) < 6:
                since = f" in stage {stage.name!r}" if number else ""
                raise InputError(
                    f"{named(whole[body.name], body.name)} is free to move{since}: its supports leave a rigid motion, and it is in "
                    "no contact; support more components",
                    f"bodies.{body.name}",
                )


def _touch(problem: Problem, contact: Contact) -> bool:
    """Whether two sides may touch in the reference configuration: their bounding boxes meet, or the slave comes down to the plane."""
    slave = _samples(problem, contact.slave)
    margin = 0.01 * np.ptp(slave, axis=0).max()
    if isinstance(contact.master, RigidPlane):
        return bool(((slave - contact.master.point) @ unit(contact.master.normal)).min() <= margin)
    master = _samples(problem, contact.master)
    return bool(np.all(slave.min(axis=0) - margin <= master.max(axis=0)) and np.all(master.min(axis=0) - margin <= slave.max(axis=0)))


def _samples(problem: Problem, side: Face) -> FloatArray:
    """Points on a side of a contact, shape (n, 3)."""
    return np.concatenate([surface_samples(problem.body(face.body).patch, face.face) for face in side.faces])


def _check_agreement(problem: Problem, numbering: Numbering, one: Support, other: Support) -> None:
    """Two supports may share control points only where they prescribe the same, and neither by a force."""
    first, second = (numbering.points_at(problem.body(s.place.body), s.place) for s in (one, other))
    stages = [k for k in range(len(problem.stages)) if one.holds(k) and other.holds(k)]
    shared = np.intersect1d(first, second) if stages else first[:0]
    for pressed, beside in ((one, other), (other, one)) if len(shared) else ():
        both = sorted(set(pressed.pressed) & {*beside.components, *beside.pressed})
        if both:
            raise InputError(
                f"moves {len(shared)} control points along {', '.join('xyz'[k] for k in both)} by a force, and so does support "
                f"{beside.name!r}, or prescribes it; allowed: each component by one support, or faces without a common edge",
                f"supports.{pressed.name}.force",
            )
        turned = [k for k in beside.carried if abs(unit(pressed.axis)[k]) < 1.0] if pressed.moment is not None else []
        if turned:
            raise InputError(
                f"turns {len(shared)} control points that support {beside.name!r} holds or moves along "
                f"{', '.join('xyz'[k] for k in sorted(turned))}; allowed: faces without a common edge, or other components",
                f"supports.{pressed.name}.moment",
            )
    for component in sorted(set(one.components) & set(other.components)):
        if len(shared) and not _agree(one, other, component, stages):
            x, y, z = numbering.reference[shared[0]]
            raise InputError(
                f"prescribes {'xyz'[component]} of {len(shared)} control points (the first at {x:g}, {y:g}, {z:g}) "
                f"that support {one.name!r} moves differently; allowed: the same motion, or that component in only one of the two",
                f"supports.{other.name}",
            )


def _agree(one: Support, other: Support, component: int, stages: list[int]) -> bool:
    turned = [support for support in (one, other) if support.turns and abs(unit(support.axis)[component]) < 1.0]
    if not turned:
        paths: list[FloatArray] = [np.array([s.motions[k].translate[component] for k in stages]) for s in (one, other)]
        return bool(np.array_equal(paths[0], paths[1]))
    return (one.motions, one.centre, one.axis) == (other.motions, other.centre, other.axis)
