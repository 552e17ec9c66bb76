"""What acts on bodies at the control points of their patches: loads and contact, and what supports exert."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray, IntArray
from isomortar.model.entities import Body, Face
from isomortar.model.loads import control_areas
from isomortar.model.numbering import Numbering
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.timing import Ledger

#: Share of the forces of contact, and of all others, that is left of both in a body's sections below which contact holds it all along: of
#: beams on beds and pipes on shafts up to 0.2 was, of such as bend 0.45 and more.
OPPOSED = 0.3


@frozen
class Acting:
    """Forces on the control points of a body's patch, each of shape (control points of the patch, 3).

    Of control points that are one, as those of a closed ring's two ends, all is on the first; what is glued has it on the first body.

    Attributes
    ----------
    loads, contact : ndarray
    held : ndarray
        All others: those of supports, which may act at an end alone.
    """

    loads: FloatArray
    contact: FloatArray
    held: FloatArray

    @property
    def whole(self) -> FloatArray:
        """All of them."""
        return self.loads + self.contact + self.held

    def opposed(self, shape: tuple[int, int, int], along: Sequence[int]) -> bool:
        """Whether contact holds a body, of so many control points, against all else in its sections along some directions (theory 9.24)."""
        across = tuple(axis for axis in range(3) if axis not in along)
        net, contact, others = (
            np.linalg.norm(forces.reshape((*shape, 3), order="F").sum(axis=across), axis=-1).sum()
            for forces in (self.whole, self.contact, self.loads + self.held)
        )
        return bool(contact > 0.0 and net < OPPOSED * (contact + others))


def acting(equilibrium: Equilibrium, balance: Balance, piece: Sequence[Body]) -> dict[str, Acting]:
    """What acts on bodies that are glued, or on one alone, by name; forces within them are in balance with it.

    Raises
    ------
    InputError, KernelError
        A body of two orders is folded without the lower one.
    """
    if piece[0].raised:  # such a body is alone; what keeps its lower order acts on it, too
        return {piece[0].name: _of_two_orders(equilibrium, balance, piece[0])}
    numbering = equilibrium.numbering
    loads, contact = ({body.name: np.zeros_like(balance.positions) for body in piece} for _ in range(2))
    for by_name, found in ((loads, _of_loads(equilibrium, balance)), (contact, _of_contacts(equilibrium, balance))):
        for name, forces in found:
            if name in by_name:
                by_name[name] += forces
    rest, acts = balance.internal - sum(loads.values()) - sum(contact.values()), dict[str, Acting]()
    for body in piece:
        acts[body.name] = Acting(*(_on_patch(numbering, body, forces) for forces in (loads[body.name], contact[body.name], rest)))
        rest[numbering.points[body.name]] = 0.0
    return acts


def _of_two_orders(equilibrium: Equilibrium, balance: Balance, body: Body) -> Acting:
    """The same of a body of two orders: forces within it, on a patch of the higher order alone."""
    here, whole = equilibrium.numbering.of_patch(body.name, balance.positions), replace(body, raised=None)
    alone = Equilibrium(replace(equilibrium.problem, bodies=(whole,), contacts=(), glue=(), supports=(), loads=()), Ledger())
    none = np.zeros_like(here)
    return Acting(none, none, alone.solid.forces_and_tangent(here - alone.origin)[0].copy())


def _of_loads(equilibrium: Equilibrium, balance: Balance) -> Iterator[tuple[str, FloatArray]]:
    """Forces of loads on all control points, with the names of the bodies that they act on."""
    forces = equilibrium.loads.forces(balance.positions, equilibrium.time)
    yield from zip((load.body for load in equilibrium.problem.loads), forces, strict=True)


def _of_contacts(equilibrium: Equilibrium, balance: Balance) -> Iterator[tuple[str, FloatArray]]:
    """The same of contacts."""
    problem, numbering = equilibrium.problem, equilibrium.numbering
    for mechanics, kinematics, response in zip(equilibrium.pairs, balance.kinematics, balance.responses, strict=True):
        forces, contact = np.zeros_like(balance.positions), mechanics.pair.contact
        mechanics.add_forces(balance.positions, kinematics, response, forces)
        for side in (contact.slave, contact.master):
            faces = side.faces if isinstance(side, Face) else ()
            for body in dict.fromkeys(face.body for face in faces):
                own = [numbering.face_points(problem.body(body), face.face) for face in faces if face.body == body]
                yield body, -_taken(forces, np.unique(np.concatenate(own)))


def _taken(forces: FloatArray, points: IntArray) -> FloatArray:
    """Forces on some points, which are taken from all of them."""
    found = np.zeros_like(forces)
    found[points], forces[points] = forces[points], 0.0
    return found


def _on_patch(numbering: Numbering, body: Body, forces: FloatArray) -> FloatArray:
    """Forces on all control points as those on a body's patch, each once."""
    first = np.unique(numbering.points[body.name], return_index=True)[1]
    found = np.zeros((len(body.patch.weights), 3))
    found[first] = forces[numbering.points[body.name][first]]
    return found


def covered(equilibrium: Equilibrium, balance: Balance, body: Body) -> float:
    """Share of the face of a body that contact presses on most, as of its reference area.

    Parameters
    ----------
    equilibrium : Equilibrium
    balance : Balance
    body : Body
    """
    problem, shares = equilibrium.problem, [0.0]
    for mechanics, kinematics, response in zip(equilibrium.pairs, balance.kinematics, balance.responses, strict=True):
        pair = mechanics.pair
        pressed = float(pair.slave.area[(pair.field(response.pressure) > 0.0) & (kinematics.projections.found > 0)].sum())
        for side in (pair.contact.slave, pair.contact.master):
            if isinstance(side, Face) and any(face.body == body.name for face in side.faces):
                of_faces = [control_areas(problem.body(face.body).patch, face.face).sum() for face in side.faces]
                shares.append(pressed / float(np.sum(of_faces)))
    return max(shares)
