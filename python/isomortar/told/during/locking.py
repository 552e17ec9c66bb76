"""How much too stiff a body is that bends along elements of a high order: by how far its forces would move it, were that order higher."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from isomortar._frozen import frozen
from isomortar.errors import InputError, KernelError
from isomortar.geometry.elevation import elevated
from isomortar.geometry.patch import Direction, FloatArray, Patch
from isomortar.geometry.refinement import homogeneous
from isomortar.geometry.splines import Spline
from isomortar.model.entities import Body, Problem
from isomortar.model.glue import pieces, shared_directions
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger
from isomortar.told.during.giving_way import deformed_by

#: Orders more along a body that are taken for what is true: rings of a single element of order 3, 120 times too stiff, were 44 times so at
#: order 4 and 1.6 at order 5.
RAISED = 3
#: Share of all forces that acts between the ends of a body from which on it is not bent by these alone: of forces there the smallest ones
#: that do the same work are only about what acts, and of pipes that widen as much as 65 times was found.
BETWEEN = 0.1
#: Ways over a body's size by which its energy for small strains is found: the forces' round-off and what is not linear are both below a
#: ten thousandth of it in bodies that bend, a hundredth of their length thick.
SMALL = 1e-6
#: Control points of bodies of the higher order up to which they are computed: a plate of 2100 took about a second and 0.3 GB, one of 20 500
#: a minute and 4, which no run should take for a sentence.
MOST = 2500


@frozen
class Locking:
    """How much too stiff a body is along a direction.

    Attributes
    ----------
    share : float
        By how much, for the forces that act.
    at_ends : bool
        Whether forces act at the ends alone.
    """

    share: float
    at_ends: bool


def locking(equilibrium: Equilibrium, positions: FloatArray, body: Body, along: int) -> Locking | None:
    """By how much a body, with all that is glued to it, is too stiff along a direction for the forces that act (theory 9.23).

    None where there is no telling: bodies that are too large for it, that are folded, or whose poles take forces of others.

    Parameters
    ----------
    equilibrium : Equilibrium
    positions : ndarray, shape (control points, 3)
    body : Body
    along : int
        Number of the direction.
    """
    problem, numbering, stage = equilibrium.problem, equilibrium.numbering, equilibrium.supports.stage
    piece = next(piece for piece in pieces(problem) if body in piece)
    shared = next(places for places in shared_directions(problem) if (body.name, "uvw"[along]) in places)
    axes = {name: "uvw".index(letter) for name, letter in shared}
    before, after, forces, raised_forces = list[Body](), list[Body](), list[FloatArray](), list[FloatArray]()
    try:
        for one in (replace(one, closed=None, raised=None) for one in piece):
            here = numbering.of_patch(one.name, positions)
            alone = _of(problem, (one,), stage)
            forces.append(alone.solid.forces_and_tangent(here - alone.origin)[0].copy())
            before.append(replace(one, patch=replace(one.patch, control_points=here)))
        as_it_is = _of(problem, tuple(before), stage)
        acts = np.where(as_it_is.supports.held, 0.0, _together(as_it_is, before, forces))
        for one, own in zip(before, forces, strict=True):
            finer, on_finer = _finer(one, axes.get(one.name), own)
            after.append(finer)
            raised_forces.append(on_finer)
        if sum(len(one.patch.weights) for one in after) > MOST:
            return None
        finest = _of(problem, tuple(after), stage)
        went = _went(as_it_is, _along_them(before, axes), acts)
        would = _went(finest, _along_them(after, axes), _together(finest, after, raised_forces))
    except (InputError, KernelError):  # folded, or control points are one at a pole, and forces on them are others'
        return None
    return Locking(would / went - 1.0, _at_ends(as_it_is, _along_them(before, axes), axes, acts)) if went > 0.0 else None


def _along_them(bodies: Sequence[Body], axes: Mapping[str, int]) -> list[Body]:
    """Those of some bodies that have one of these directions."""
    return [body for body in bodies if body.name in axes]


def _at_ends(of: Equilibrium, bodies: Sequence[Body], axes: Mapping[str, int], forces: FloatArray) -> bool:
    """Whether forces act on bodies at the ends of these directions of theirs, and on hardly anything between."""
    faces = [(one, f"{'uvw'[axes[one.name]]}{end}") for one in bodies for end in (0, 1)]
    ends = np.unique(np.concatenate([of.numbering.face_points(*face) for face in faces]))
    sizes = np.linalg.norm(forces, axis=1)
    return bool(sizes.sum() - sizes[ends].sum() < BETWEEN * sizes.sum())


def _of(problem: Problem, bodies: tuple[Body, ...], stage: int) -> Equilibrium:
    """Bodies that are glued, or one alone, with what holds them still in a stage: what moves them exerts the forces that it does.

    Raises
    ------
    InputError
        One is folded, or some of its control points are one.
    """
    names = {body.name for body in bodies}
    glue = tuple(joint for joint in problem.glue if all(face.body in names for face in joint)) if len(bodies) > 1 else ()
    still = [one for one in problem.supports if one.place.body in names and one.holds(stage) and not one.moves and not one.is_plate]
    supports = tuple(replace(one, stages=None) for one in still)
    equilibrium = Equilibrium(replace(problem, bodies=bodies, contacts=(), glue=glue, supports=supports, loads=()), Ledger())
    if any(len(np.unique(points)) < len(points) for points in equilibrium.numbering.points.values()):
        raise InputError("control points are one")
    return equilibrium


def _together(of: Equilibrium, bodies: Sequence[Body], forces: Sequence[FloatArray]) -> FloatArray:
    """Forces on bodies' patches as those on all control points."""
    total = np.zeros_like(of.numbering.reference)
    for body, own in zip(bodies, forces, strict=True):
        of.numbering.add_of_patch(body.name, own, total)
    return total


def _went(of: Equilibrium, bodies: Sequence[Body], forces: FloatArray) -> float:
    """Work that forces on bodies free of strain put into some of them: what others give way is theirs."""
    ways = deformed_by(forces, of, of.numbering.reference)
    return sum(_energy(_of(of.problem, (body,), of.supports.stage), of.numbering.of_patch(body.name, ways)) for body in bodies)


def _energy(alone: Equilibrium, ways: FloatArray) -> float:
    """Twice the energy of a body whose control points have gone some ways, for small strains."""
    rest = alone.numbering.of_patch(alone.problem.bodies[0].name, alone.numbering.reference)
    small = SMALL * float(np.ptp(rest)) / max(float(np.abs(ways).max()), np.finfo(np.float64).tiny)
    forces = alone.solid.forces_and_tangent(rest + small * ways)[0]
    return float(np.sum(forces * ways)) / small


def _finer(body: Body, along: int | None, forces: FloatArray) -> tuple[Body, FloatArray]:
    """A body of a higher order along a direction, if any, and its forces."""
    if along is None:
        return body, forces
    matrix, patch = raised(body.patch, along)
    points = tuple(count + RAISED * (axis == along) for axis, count in enumerate(body.quadrature))
    return replace(body, patch=patch, quadrature=(points[0], points[1], points[2])), _on(matrix, body.patch, patch, along, forces)


def raised(patch: Patch, along: int) -> tuple[FloatArray, Patch]:
    """What control values along a direction become if its order is higher, and the patch of that order; smoothness stays as it is."""
    direction = patch.directions[along]
    matrix: FloatArray = np.eye(direction.count)
    if direction.family == "L":
        nodes = direction.greville
        knots = np.repeat(direction.boundaries, direction.order)
        direction = Direction("N", direction.order, np.concatenate([knots[:1], knots, knots[-1:]]))
        matrix = np.asarray(np.linalg.inv(Spline([direction], matrix).evaluate(nodes[:, None])))
    for _ in range(RAISED):
        direction, matrix = elevated(direction, matrix, 0)
    grid = _along(matrix, homogeneous(patch), along)
    u, v, w = (direction if axis == along else own for axis, own in enumerate(patch.directions))
    flat = grid.reshape(-1, 4, order="F")
    return matrix, Patch((u, v, w), flat[:, :3] / flat[:, 3:], flat[:, 3])


def _along(matrix: FloatArray, grid: FloatArray, along: int) -> FloatArray:
    """A matrix times a grid of values along a direction."""
    return np.moveaxis(np.tensordot(matrix, grid, (1, along)), 0, along)


def _on(matrix: FloatArray, before: Patch, after: Patch, along: int, forces: FloatArray) -> FloatArray:
    """Forces on a raised patch that do the same work as some on the patch before in all that this can do (theory 9.23)."""
    grid = (forces / before.weights[:, None]).reshape((*before.shape, 3), order="F")
    inverse = np.asarray(np.linalg.pinv(matrix).T)
    for end in (0, -1):  # what acts on the faces there acts on no others
        inverse[:, end] = np.eye(len(matrix))[:, end]
    return np.asarray(_along(inverse, grid, along).reshape(-1, 3, order="F") * after.weights[:, None])
