"""Elements of a master that are too long for a contact: they cannot follow what a finer slave presses in, and are too stiff."""

from __future__ import annotations

import numpy as np

from isomortar._bindings import surface_functions
from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model.entities import Contact, Face, Problem
from isomortar.model.numbering import Numbering
from isomortar.model.pairs import Pair
from isomortar.model.rigid import deformation
from isomortar.model.sheet import Sheet
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.told.during.softness import softness

#: Share of what a master gives way by that its elements keep back, by one over the width of contact in these, and what is taken from that:
#: fitted to balls and cylinders on blocks of orders 1 to 3; and the most that it is taken for.
KEEPS, FREE, MOST = 0.2, 0.4, 0.8
#: Order from which on elements follow shorter pressures in proportion.
SMOOTH = 2.0
#: Standard deviations of its force, in length, that a contact is wide.
WIDE = 4.0
#: Share of the master's elements from which on contact is as wide as the master: nothing beside it is to be bent down.
ALL = 0.8
#: Elements of the master are too long for a finer slave: longer than its own by this factor. Where they are not both are too long.
FINER = 1.2
#: Share of the force that this adds from which on it is told, and the largest that is: under rigid slaves it is a bound of little use.
COSTS, LARGEST = 0.1, 1.0
#: Times what it presses in that a master goes, up to which it does not bend (of balls and cylinders on blocks: 0.7 to 1.2).
STILL = 1.3
#: A direction is too coarse where it keeps back this share of what the other one does.
PART = 0.5


@frozen
class LongMaster:
    """How a contact lies on elements of its master.

    Attributes
    ----------
    widths : ndarray, shape (2,)
        How wide it is along each coordinate of the master face, in elements of that.
    kept : ndarray, shape (2,)
        Share of what the master gives way by that elements keep back along each.
    softness : float
        Share of the master in what both bodies give way.
    local : float
        Share of what the master goes that it is pressed in by, about: of a beam that bends it is little.
    """

    widths: FloatArray
    kept: FloatArray
    softness: float
    local: float

    @property
    def costs(self) -> float:
        """Share of the force that this adds to it at the most, about (theory 9.15)."""
        return self.local * float(1.0 / (1.0 - self.softness * min(MOST, float(np.linalg.norm(self.kept)))) - 1.0)

    @property
    def too_stiff(self) -> bool:
        """Whether it is told."""
        return self.costs > COSTS


def long_master(equilibrium: Equilibrium, pair: Pair, balance: Balance, number: int) -> LongMaster | None:
    """How a contact that bears lies on elements of its master (theory 9.15); None on planes, under slaves no finer, and beside mirrors."""
    projections, problem = balance.kinematics[number].projections, equilibrium.problem
    forces = pair.slave.area * np.maximum(pair.field(balance.responses[number].pressure), 0.0) * (projections.found > 0)
    if not isinstance(pair.contact.master, Face) or problem.images > 1 or not forces.any():
        return None
    slave_side, master_side = Sheet.of(problem, pair.contact.slave), Sheet.of(problem, pair.contact.master)
    if not master_side.element_size > FINER * slave_side.element_size:
        return None
    widths = _widths(master_side, projections.xi, forces / forces.sum())
    narrow = np.divide(1.0, widths, out=np.full(2, np.inf), where=widths > 0.0)
    narrow[widths > ALL * np.array([direction.elements for direction in master_side.directions])] = 0.0
    orders = np.array([direction.order for direction in master_side.directions])
    kept = np.minimum(MOST, KEEPS * np.minimum(1.0, SMOOTH / orders) * np.maximum(0.0, narrow - FREE))
    slave, master = (float(forces @ part) for part in softness(problem, equilibrium.numbering, pair, projections))
    pressed = master / float(forces.sum()) * float(np.sqrt(forces @ pair.field(balance.responses[number].pressure)))
    feet = np.flatnonzero(forces)
    functions = surface_functions(*master_side.arrays(equilibrium.numbering), projections.xi[feet])
    gone = _gone(_deformations(equilibrium.numbering, balance.positions), pair.master_face, functions, forces[feet])
    local = min(1.0, (STILL * pressed / gone) ** 2) if gone > 0.0 else 1.0
    return LongMaster(widths, kept, master / (slave + master), local)


def _widths(side: Sheet, places: FloatArray, shares: FloatArray) -> FloatArray:
    """How wide forces at coordinates of a face are along each, in its elements, shape (2,); `shares` of the force add up to one."""
    widths = np.empty(2)
    for axis, direction in enumerate(side.directions):
        count, bounds = direction.elements, direction.boundaries
        elements = np.interp(places[:, axis], bounds, np.arange(len(bounds)))
        if side.closed[axis]:  # from the middle of the force on, in half a turn either way
            middle = count / (2.0 * np.pi) * np.angle(shares @ np.exp(2j * np.pi * elements / count))
            elements = (elements - middle + 0.5 * count) % count
        widths[axis] = WIDE * np.sqrt(shares @ np.square(elements - shares @ elements))
    return widths


def _deformations(numbering: Numbering, positions: FloatArray) -> FloatArray:
    """How far control points have gone but for rigid motions of what hangs together, shape (control points, 3): a turn is no bending."""
    ways = np.zeros_like(positions)
    for number in range(len(numbering.pieces)):
        own = numbering.piece_points(number)
        ways[own] = deformation(numbering.reference[own], positions[own])
    return ways


def _gone(ways: FloatArray, face: IntArray, functions: tuple[IntArray, FloatArray], forces: FloatArray) -> float:
    """How far a face has gone where forces act, from what of it has gone least the same way; `ways`: those of all control points."""
    nodes, values = functions
    mean = forces @ np.einsum("qa,qac->qc", values[:, 0], ways[face[nodes]]) / forces.sum()
    return float(np.linalg.norm(ways[face] - mean, axis=1).max())


def told(problem: Problem, contact: Contact, found: LongMaster, step: int) -> str:
    """The sentence."""
    assert isinstance(contact.master, Face), "planes have no elements"
    letters, stage = Sheet.of(problem, contact.master).letters, problem.stages[problem.stage_of(step)].name
    few = [letter for letter, kept in zip(letters, found.kept, strict=True) if kept > PART * found.kept.max()]
    keys = ", ".join(f"bodies.{name}.mesh.elements" for name in dict.fromkeys(face.body for face in contact.master.faces))
    return (
        f"contact {contact.name!r}, load step {step}, the last of stage {stage!r}: elements of its master {contact.master.words} are too "
        f"long for it, and too stiff: it is {found.widths[0]:.2g} of them wide along {letters[0]} and {found.widths[1]:.2g} along "
        f"{letters[1]}. Forces under given motions may be too large by about {10 * round(10.0 * min(LARGEST, found.costs))} %, or by "
        f"little, as knots lie there, and pressures by more. Take twice as many elements or more along {' and '.join(few)} ({keys}), or "
        "shorter ones there (mesh.grading)"
    )
