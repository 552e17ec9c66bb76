"""How much too stiff a body is that bends along elements of a high order: by how far its forces would move it, were that order higher."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from isomortar.errors import InputError, KernelError
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Body, Problem
from isomortar.model.glue import pieces, shared_directions
from isomortar.model.numbering import Numbering, same_points
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.timing import Ledger
from isomortar.told.during.acting import acting
from isomortar.told.during.carrying import at_ends, carried, loads_on
from isomortar.told.during.giving_way import deformed_by
from isomortar.told.during.raising import Finer, raised_body

#: What is taken for true along a body, the first of these that it is not too large for: rings of a single element of order 3, 120 times too
#: stiff, were 44 times so at order 4 and 1.6 at order 5, and one of order 2 that is held twice 4 times at order 5 if it was not halved.
FINER = (Finer(3, True), Finer(3, False), Finer(2, False))
#: Ways over a body's size by which its energy for small strains is found: the forces' round-off and what is not linear are both below a
#: ten thousandth of it in bodies that bend, a hundredth of their length thick.
SMALL = 1e-6
#: Entries of the stiffness of what is finer, blocks of 3 x 3, up to which it is computed: that takes about half a second, and as long for
#: each of two directions where it is told. Of a plate of 20 500 control points, 12 million, it took a minute and 4 GB.
MOST = 400_000


def locking(equilibrium: Equilibrium, balance: Balance, body: Body, along: Sequence[int]) -> float | None:
    """Share by which a body, with all that is glued to it, is too stiff along some directions for the forces that act (theory 9.23).

    None where there is no telling: bodies that are too large for it, that nothing deforms, that are folded, or that have poles.

    Parameters
    ----------
    equilibrium : Equilibrium
    balance : Balance
        Of it, with what acts on its bodies.
    body : Body
    along : sequence of int
        Numbers of the directions.
    """
    problem, stage = equilibrium.problem, equilibrium.supports.stage
    piece = next(piece for piece in pieces(problem) if body in piece)
    axes = _axes(problem, piece, body, along)
    more = next((finer for finer in FINER if sum(finer.blocks(one, axes[one.name]) for one in piece) <= MOST), None)
    if more is None:
        return None
    try:
        forces = acting(equilibrium, balance, piece)
        if forces[body.name].opposed(body.patch.shape, along):
            return 0.0
        before = [_free_of_strain(one, equilibrium.numbering, balance.positions) for one in piece]
        own = [one.name for one in piece if len(axes[one.name]) == len(along)]
        went = _went(_of(problem, before, stage), own, {name: acts.whole for name, acts in forces.items()})
        finest = _of(problem, [raised_body(one, axes[one.name], more) for one in before], stage)
        ends = {one.name: at_ends(problem, stage, piece, one) for one in piece}
        on_finest = {one.name: carried(one, forces[one.name], axes[one.name], more, ends[one.name]) for one in before}
        given = () if body.raised else piece  # what acts on a body of two orders is one, loads and all
        loads = loads_on(problem, [raised_body(one, axes[one.name], more) for one in given], finest, equilibrium.time) if given else 0.0
        would = _went(finest, own, on_finest, loads)
    except (InputError, KernelError):  # folded, or control points are one at a pole, and forces on them are others'
        return None
    return would / went - 1.0 if went > 0.0 else None


def _axes(problem: Problem, piece: Sequence[Body], body: Body, along: Sequence[int]) -> dict[str, list[int]]:
    """Directions of glued bodies that are one with some of a body's, by name."""
    alike = [places for places in shared_directions(problem) if any((body.name, "uvw"[axis]) in places for axis in along)]
    return {one.name: ["uvw".index(letter) for places in alike for name, letter in places if name == one.name] for one in piece}


def _free_of_strain(body: Body, numbering: Numbering, positions: FloatArray) -> Body:
    """A body that is free of strain where its control points are, of one order."""
    return replace(body, raised=None, patch=replace(body.patch, control_points=numbering.of_patch(body.name, positions)))


def _of(problem: Problem, bodies: Sequence[Body], stage: int) -> Equilibrium:
    """Bodies that are glued, or one alone, with what holds them still in a stage: what moves them exerts the forces that it does.

    Raises
    ------
    InputError
        One is folded, or some of its control points are one.
    """
    if any(len(np.unique(same_points(body.patch, None))) < len(body.patch.weights) for body in bodies):
        raise InputError("control points are one")
    names = {body.name for body in bodies}
    glue = tuple(joint for joint in problem.glue if all(face.body in names for face in joint))
    still = [one for one in problem.supports if one.place.body in names and one.holds(stage) and not one.moves and not one.is_plate]
    supports = tuple(replace(one, stages=None) for one in still)
    return Equilibrium(replace(problem, bodies=tuple(bodies), contacts=(), glue=glue, supports=supports, loads=()), Ledger())


def _went(of: Equilibrium, own: Sequence[str], forces: Mapping[str, FloatArray], loads: FloatArray | float = 0.0) -> float:
    """Work that forces on bodies free of strain put into some of them, which have all of the directions: what others give way is theirs."""
    total, bodies = np.zeros_like(of.numbering.reference) + loads, of.problem.bodies
    for name, on_patch in forces.items():
        of.numbering.add_of_patch(name, on_patch, total)
    ways = deformed_by(total, of, of.numbering.reference)
    if len(own) == len(bodies):
        return float(np.sum(total * ways))
    alone = [_of(of.problem, [body], of.supports.stage) for body in bodies if body.name in own]
    return sum(_energy(one, of.numbering.of_patch(one.problem.bodies[0].name, ways)) for one in alone)


def _energy(alone: Equilibrium, ways: FloatArray) -> float:
    """Twice the energy of a body whose control points have gone some ways, for small strains."""
    rest = alone.numbering.of_patch(alone.problem.bodies[0].name, alone.numbering.reference)
    small = SMALL * float(np.ptp(rest)) / max(float(np.abs(ways).max()), np.finfo(np.float64).tiny)
    forces = alone.solid.forces_and_tangent(rest + small * ways)[0]
    return float(np.sum(forces * ways)) / small
