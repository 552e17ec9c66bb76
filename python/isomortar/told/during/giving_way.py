"""How far the pressures of a contact alone move its bodies: beams and rings bend, and go far more than what is pressed into them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar._frozen import frozen
from isomortar.errors import KernelError
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Problem
from isomortar.model.rank import motions_left, moved
from isomortar.model.rigid import deformation
from isomortar.model.supports import Supports
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.system import LinearSystem, Source
from isomortar.solve.timing import Ledger

#: How far bodies go, over how far they are pressed in by theory, up to which nothing bends: 0.6 to 1.8 was seen of balls and cylinders on
#: blocks, strips and layers.
STILL = 2.0
#: Times what points have gone that they may go by a contact alone: others that hold a body keep it from bending as it would without them.
#: Two, as a contact's own share may be against what others have moved it by.
MORE = 2.0


@frozen
class Yields:
    """How slave and master give way to the pressures of a contact, each of shape (2,).

    Attributes
    ----------
    pressed : ndarray
        How far they are pressed in where these act, about, by theory.
    ways : ndarray
        How far they go there, as they are computed; zero of what is not known.
    """

    pressed: FloatArray
    ways: FloatArray

    @property
    def whole(self) -> float:
        """How far both go together, at the least: elements that are too long let them go less than they would."""
        return float(np.maximum(self.pressed, self.ways / STILL).sum())

    @property
    def local(self) -> float:
        """Share of that which is pressed in; 1 where nothing gives way."""
        return float(self.pressed.sum()) / self.whole if self.whole > 0.0 else 1.0

    def of_force(self, share: float) -> float:
        """Share that a force is too large by, for one by which it would be if bodies were pressed in alone (theory 9.19)."""
        return self.local * share / (1.0 + (1.0 - self.local) * share)


def giving_way(equilibrium: Equilibrium, balance: Balance, number: int) -> FloatArray:
    """How far slave and master go where the pressures of a contact act, by these alone, in their mean, shape (2,) (theory 9.19).

    Zeros where there is no telling.

    Parameters
    ----------
    equilibrium : Equilibrium
    balance : Balance
    number : int
        Of the contact.
    """
    mechanics, positions, kinematics = equilibrium.pairs[number], balance.positions, balance.kinematics[number]
    pair, state = mechanics.pair, mechanics.state(kinematics, balance.responses[number])
    forces = np.zeros_like(positions)
    mechanics.add_forces(positions, kinematics, mechanics.bearing(replace(state, traction=np.zeros_like(state.traction))), forces)
    try:
        ways = deformed_by(forces, equilibrium, positions)
    except KernelError:  # of bodies that nothing but contact keeps from buckling
        return np.zeros(2)
    whole = float(pair.slave.area @ (abs(pair.field(state.pressure)) * (kinematics.projections.found > 0)))
    works, sizes, gone = np.sum(forces * ways, axis=1), np.linalg.norm(forces, axis=1), _gone(equilibrium, positions)
    on_slave = np.isin(np.arange(len(positions)), pair.slave.point)
    return np.array([min(works[side].sum(), MORE * sizes[side] @ gone[side]) for side in (on_slave, ~on_slave)]) / whole


def _gone(equilibrium: Equilibrium, positions: FloatArray) -> FloatArray:
    """How far control points have gone, at the most, shape (control points,): of pieces that supports leave rigid motions without these."""
    numbering, gone = equilibrium.numbering, np.linalg.norm(positions - equilibrium.numbering.reference, axis=1)
    for number, piece in enumerate(numbering.pieces):
        own = numbering.piece_points(number)
        deformed = np.linalg.norm(deformation(numbering.reference[own], positions[own]), axis=1)
        free = len(motions_left(equilibrium.problem, piece, equilibrium.supports.stage)) > 0
        gone[own] = deformed if free else np.maximum(gone[own], deformed)
    return gone


def deformed_by(forces: FloatArray, equilibrium: Equilibrium, positions: FloatArray) -> FloatArray:
    """Ways of control points by forces on bodies without contact, shape (control points, 3); what supports move by forces stands still.

    Pieces that supports leave rigid motions are pushed back by forces evenly on all of their points, and these motions are not counted.

    Raises
    ------
    KernelError
        There are none, or they have no digits.
    """
    problem, numbering, solid = _held(equilibrium.problem), equilibrium.numbering, equilibrium.solid
    supports = Supports(problem, numbering, equilibrium.supports.stage)
    with equilibrium.ledger.phase("solid"):
        stiffness = solid.forces_and_tangent(positions)[1].copy()  # the solid keeps its own
    forces, rigid = forces.copy(), list[tuple[slice, FloatArray]]()
    for number, piece in enumerate(numbering.pieces):
        own, left = numbering.piece_points(number), motions_left(problem, piece, supports.stage)
        if len(left) and not piece[0].rigid:
            motions = np.column_stack([moved(piece, amounts, positions[own]).ravel() for amounts in left])
            basis = np.linalg.qr(motions)[0]
            rigid.append((own, basis))
            forces[own] = _without(basis, forces[own])
            point, component = np.divmod(_pins(basis), 3)
            stiffness[solid.diagonal[own.start + point], component, component] += np.abs(stiffness[solid.diagonal[own]]).max()
    if not len(supports.free):
        return np.zeros_like(positions)
    system = LinearSystem(len(supports.free), [Source(solid.pattern, supports.equation, supports.equation)], Ledger())
    system.factorise([stiffness])
    ways = supports.spread(system.solve(forces.ravel()[supports.free]), positions)
    for own, basis in rigid:
        ways[own] = _without(basis, ways[own])
    return ways


def _held(problem: Problem) -> Problem:
    """The problem whose supports hold what their forces move."""
    supports = (replace(s, components=tuple(sorted(s.carried)), force=(None, None, None), moment=None) for s in problem.supports)
    return replace(problem, supports=tuple(supports))


def _without(basis: FloatArray, vectors: FloatArray) -> FloatArray:
    """Vectors of some points less what of them is in a space with an orthonormal basis, shape (points, 3)."""
    flat = vectors.ravel()
    return np.asarray((flat - basis @ (basis.T @ flat)).reshape(vectors.shape))


def _pins(motions: FloatArray) -> list[int]:
    """As many unknowns as there are rigid motions, which hold these where they are held, by elimination with complete pivoting."""
    left, pins = motions.copy(), list[int]()
    for _ in range(motions.shape[1]):
        pin, motion = np.unravel_index(int(np.argmax(np.abs(left))), left.shape)
        left -= np.outer(left[:, motion] / left[pin, motion], left[pin])
        pins.append(int(pin))
    return pins
