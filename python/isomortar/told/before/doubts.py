"""What is doubtful of a scene before its first load step: it runs, but most often something else was meant."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from itertools import combinations

import numpy as np

from isomortar.errors import FoldedElementError
from isomortar.geometry.patch import MAX_ORDER, FloatArray, IntArray
from isomortar.model import constants
from isomortar.model.contact_checks import SAME_WAY, something_turns
from isomortar.model.contrasts import element_lengths
from isomortar.model.entities import Body, Contact, Face, Problem
from isomortar.model.memory import memory_needed, memory_of_machine
from isomortar.model.numbering import ends_apart
from isomortar.model.rational import QUADRATURE_TOLD, quadrature_error, too_few_points
from isomortar.model.rational_faces import pressure_error, too_few_points_of
from isomortar.model.stance import FACING, Stance, stance
from isomortar.solve.feet import closest_depths
from isomortar.solve.record import State
from isomortar.told.before.edges import of_edges
from isomortar.told.before.faces import of_faces
from isomortar.told.before.left_out import of_what_is_left_out
from isomortar.told.before.meshes import of_meshes
from isomortar.told.before.motions import FLAT, approach, between, in_far_steps, nearest_approach, of_motions
from isomortar.told.before.not_held import not_held_against
from isomortar.told.before.poles import doubts_at_poles
from isomortar.told.before.sizes import of_sizes
from isomortar.told.before.turns import of_rolling, of_turns

#: An overlap of less than this share of the thinner body may be round-off of the geometry; what is more is told.
TOLD_OVERLAP = 0.02
#: Share of the memory that is there above which a scene is told to be near it; the estimate is good within a factor of two.
NEAR = 0.5
#: Faces whose sizes (square roots of their areas) differ by more were given in different units, most likely.
SIZE_RATIO = 100.0
#: Coefficients of friction above this one are of no pair of materials (dry metals and rubber: up to 1.5), and make things stick.
HIGH_FRICTION = 2.0
#: By how much forces may come out too large by locking before that is told.
LOCKING = 0.05
#: Lengths of elements along a direction further apart cost pressures at the short ones all digits but two: 1e-16 times their square.
SPANS = 1e7


def doubts(problem: Problem, state: State) -> Iterator[str]:
    """Sentences on what is doubtful.

    Parameters
    ----------
    problem : Problem
    state : State
        The reference configuration, projected.
    """
    needed, there = memory_needed(problem), memory_of_machine()
    if needed > NEAR * there:
        yield (
            f"Gauss points, tangent and factors may take {needed / 1e9:.2g} GB of memory, within a factor of two, "
            f"and there are {there / 1e9:.2g} GB"
        )
    for body in problem.deformable:
        yield from _locking(body)
        yield from _spans(body)
        yield from _seam(body)
        yield from _weights(body)
    if not problem.deformable:
        yield "all bodies are rigid: nothing deforms, and all forces are zero. Let one of them deform"
    yield from of_motions(problem)
    yield from of_turns(problem)
    yield from of_meshes(problem)
    yield from of_sizes(problem)
    yield from of_faces(problem)
    yield from of_what_is_left_out(problem)
    yield from not_held_against(problem)
    stances = [stance(problem, contact) for contact in problem.contacts]
    travel = _travel(problem) if problem.contacts else 0.0
    presses = any(c.smoothing for c in problem.contacts) or any(s.depth > constants.NO_PART * s.thickness for s in stances)
    if not any(support.moves for support in problem.supports) and not presses and not _loaded(problem):
        yield "no support moves in any stage, and nothing overlaps at the start: nothing will happen"
    for contact, found, feet in zip(problem.contacts, stances, (contact.projected for contact in state.contacts), strict=True):
        inside, before = _inside_and_before(problem, contact, state.positions, feet)
        too_deep, beside = inside if found.depth > 0.0 else 0, not np.any(feet) and not before
        yield from _of_stance(contact, found, travel, too_deep, beside)
        yield from _of_ways(problem, contact, found, beside)
        yield from () if beside else of_edges(problem, contact, feet, found.gap)
        yield from _of_contact(contact)
        yield from _pressures(problem, contact)
        yield from of_rolling(problem, contact, found.towards)
        yield from doubts_at_poles(problem, contact, travel)
    for one, other in combinations(problem.contacts, 2):
        if (one.slave, one.master) == (other.master, other.slave):
            yield (
                f"contacts {one.name!r} and {other.name!r} are the same one, both ways: every point is held twice, and how they share the "
                "pressure is left open. Remove one of them"
            )


def _locking(body: Body) -> Iterator[str]:
    """Elements that are too stiff for their Poisson's ratio."""
    order = min(direction.order for direction in body.patch.directions)
    share = _too_stiff(body, order)
    if share > LOCKING:
        size = "several times" if share > 1.0 else f"some {float(f'{100.0 * share:.1g}'):g} %"
        needed = next(other for other in range(order + 1, MAX_ORDER["L"] + 1) if _too_stiff(body, other) <= LOCKING)
        yield (
            f"body {body.name!r}: with Poisson's ratio {body.material.poisson:.15g} its elements of order {order} lock, and forces come "
            f"out {size} too large where its faces are held, more where it bends. Take order {needed} in all directions, shorter "
            "elements, or a Poisson's ratio that is lower"
        )


def _too_stiff(body: Body, order: int) -> float:
    """About by how much forces come out too large (theory 9.1)."""
    lengths = element_lengths(body.patch)
    long = max(float(np.median(along)) for along in lengths) / min(float(along.sum()) for along in lengths)
    held = 0.1 * long * np.sqrt(max(0.0, body.material.bulk / body.material.shear - 13 / 6))
    return float(8.0 * held**2 if order == 1 else 4.0 ** (1 - order) * held / (1.0 + held))


def _spans(body: Body) -> Iterator[str]:
    """Elements so short beside their neighbours that the last bits of positions are strains of theirs which count."""
    for axis, lengths in zip("uvw", element_lengths(body.patch), strict=True):
        if lengths.max() > SPANS * lengths.min():
            yield (
                f"body {body.name!r}: its elements along {axis} are {lengths.min():.1e} to {lengths.max():.1e} long "
                "(knot spans, or control points): pressures and stresses at the short ones are lost in round-off. Make these longer"
            )


def _weights(body: Body) -> Iterator[str]:
    """Rational functions that the Gauss points do not follow to the last per cent; what is farther off is refused."""
    try:
        error = quadrature_error(body)
        if not error <= QUADRATURE_TOLD:
            yield too_few_points(body, error, QUADRATURE_TOLD)
    except FoldedElementError as folded:
        yield f"body {body.name!r}: between its Gauss points {folded}; look at its weights and at its control points"


def _seam(body: Body) -> Iterator[str]:
    """Opposite faces that lie on each other and are not joined."""
    for axis in "uvw":
        if axis not in (body.closed or "") and ends_apart(body.patch, axis) <= constants.SAME_POINT * body.size:
            yield (
                f"body {body.name!r}: faces {axis}0 and {axis}1 lie on each other, but are not joined, and will part; "
                f'bodies.{body.name}.closed = "{axis}" joins them'
            )


def _overlaps(found: Stance) -> bool:
    return found.depth > TOLD_OVERLAP * found.thickness


def _inside_and_before(problem: Problem, contact: Contact, positions: FloatArray, feet: IntArray) -> tuple[int, int]:
    """How many slave quadrature points without a foot are inside their master, and before it, as closest points tell.

    Along averaged normals feet are found up to a depth and a distance; by closest points they are all.
    """
    if feet.all() or not contact.averaged:
        return 0, 0
    depths = closest_depths(problem, contact, positions)[feet == 0]
    return int(np.count_nonzero(depths > 0.0)), int(np.count_nonzero(depths <= 0.0))


def _of_stance(contact: Contact, found: Stance, travel: float, too_deep: int, beside: bool) -> Iterator[str]:
    """How the faces of a contact stand to each other; no prescribed point goes farther than `travel`."""
    ratio, far = np.sqrt(found.slave_area / found.master_area), found.gap > 2.0 * travel > 0.0
    if too_deep and (_overlaps(found) or beside):
        yield (
            f"contact {contact.name!r}: the bodies overlap by {found.depth:.3g} at the start (the thinner is {found.thickness:.3g} thick), "
            f"and {too_deep} of its slave quadrature points are inside their master without a foot: along averaged normals feet are found "
            "up to a tenth of the master's size deep. Nothing pushes those points out. Move one of the bodies; if a shrink fit is meant, "
            f'take contacts.{contact.name}.projection = "closest"'
        )
    elif beside and found.faces and not far:
        yield (
            f"contact {contact.name!r}: all quadrature points of the slave face {contact.slave.words} are beside its master, which is "
            f"between them, and meets none. Refine the slave there (bodies.{contact.slave.body}.mesh.elements), or exchange the two"
        )
    elif beside and not found.faces:
        yield (
            f"contact {contact.name!r}: the slave face {contact.slave.words} is wholly beside its master at the "
            "start; it meets only what motions bring before it. Check places and faces"
        )
    elif _overlaps(found):
        yield (
            f"contact {contact.name!r}: the bodies overlap by {found.depth:.3g} at the start (the thinner is {found.thickness:.3g} thick); "
            "the first load step pushes them apart. If no shrink fit is meant, move one of them"
        )
    elif far:
        yield (
            f"contact {contact.name!r} is {found.gap:.3g} apart at the start, and all supports together travel {travel:.3g}: "
            "it cannot close. Check places, motions and units"
        )
    if not 1.0 / SIZE_RATIO <= ratio <= SIZE_RATIO and isinstance(contact.master, Face):
        yield (
            f"contact {contact.name!r}: the slave face is {ratio:.3g} times as large as the master face. Are the bodies given "
            "in the same unit of length?"
        )


def _of_ways(problem: Problem, contact: Contact, found: Stance, beside: bool) -> Iterator[str]:
    """How the faces of a contact look at each other, and where motions bring them."""
    if beside:
        return
    if FACING < found.cosine <= SAME_WAY and not something_turns(problem):
        yield (
            f"contact {contact.name!r}: no part of {contact.slave.words} looks at its master, and nothing in the scene turns it. Name the "
            "face that looks at the master"
        )
        return
    way, nearest = approach(problem, contact, found.towards), nearest_approach(problem, contact)
    far = any(in_far_steps(problem, support, number) for support in problem.supports for number in range(len(problem.stages)))
    if way is None or nearest is None or far:
        return
    if nearest < 0.0 and found.depth == 0.0 and not contact.smoothing:
        yield (
            f"contact {contact.name!r}: motions take its sides away from each other, and nothing brings them back. Look at the signs of "
            "the motions"
        )
    elif found.gap > 2.0 * nearest > 0.0 and found.gap <= 2.0 * _travel(problem):
        yield (
            f"contact {contact.name!r} is {found.gap:.3g} apart at the start, and motions bring its sides nearer by {nearest:.3g}: it "
            "cannot close. Check places, motions and units"
        )
    elif way - found.gap > FLAT * between(problem, contact, found.towards) > 0.0:
        yield (
            f"contact {contact.name!r}: motions bring its sides nearer by {way:.3g}, and the bodies between them are "
            f"{between(problem, contact, found.towards):.3g} thick: they would be pressed flat. End the motions earlier; translations of "
            "stages add up"
        )


def _of_contact(contact: Contact) -> Iterator[str]:
    """What is given for a contact, wherever its faces are."""
    if contact.friction > HIGH_FRICTION and contact.traction_max is None:
        yield (
            f"contact {contact.name!r}: a coefficient of friction of {contact.friction:g} is above what materials have, and makes nearly "
            f"all stick. Was it meant in per cent, {contact.friction / 100.0:g}?"
        )


def _pressures(problem: Problem, contact: Contact) -> Iterator[str]:
    """Points of a contact that do not follow its slave's rational functions, where those of the slave's body do; else that is told."""
    with suppress(FoldedElementError):
        if contact.of_averages and all(quadrature_error(problem.body(face.body)) <= QUADRATURE_TOLD for face in contact.slave.faces):
            error = pressure_error(problem, contact)
            if error > QUADRATURE_TOLD:
                yield too_few_points_of(problem, contact, error)


def _loaded(problem: Problem) -> bool:
    """Whether a load, or the force of a support, ever is other than zero."""
    loads = [(load.factors, load.value) for load in problem.loads] + [(s.factors, (*s.force, s.moment)) for s in problem.supports]
    return any((not factors or any(factors)) and any(value) for factors, value in loads)


def _travel(problem: Problem) -> float:
    """No prescribed point goes farther than this, over all stages; what forces move may go anywhere."""
    travel = np.inf if _loaded(problem) else 0.0
    for support in problem.supports:
        arms = problem.body(support.place.body).patch.control_points - np.asarray(support.centre)
        reach = float(np.linalg.norm(arms, axis=1).max())
        travel += sum(float(np.linalg.norm(m.translate)) + abs(np.radians(m.rotate)) * reach for m in support.motions)
    return travel
