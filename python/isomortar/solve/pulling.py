"""Contact that pulls: it acts where the slave's face looks away from its master, as when a body has come through it from behind."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar import _bindings
from isomortar.geometry.patch import FloatArray, IntArray, opposite
from isomortar.model.entities import Contact, RigidPlane
from isomortar.model.sheet import Sheet
from isomortar.solve.equilibrium import Balance, Equilibrium

#: Share of a contact's normal forces that may pull: beside an edge the normals of both sides can be a right angle apart.
PULLING = 0.1


class Pulling:
    """Warnings of contacts that pull; each is given once."""

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._equilibrium = equilibrium
        self._outward = [_Outward(equilibrium, contact) for contact in equilibrium.problem.contacts]
        self._told = set[str]()

    def after_step(self, balance: Balance, step: int) -> Iterator[str]:
        """Warnings that the end of a load step gives rise to."""
        for number, contact in enumerate(self._equilibrium.problem.contacts):
            if contact.name not in self._told and self._pulls(balance, number):
                self._told.add(contact.name)
                yield _sentence(contact, step)

    def _pulls(self, balance: Balance, number: int) -> bool:
        """Whether normal forces of a contact act out of its slave's body."""
        pair, outward = self._equilibrium.pairs[number].pair, self._outward[number]
        forces = np.zeros_like(balance.positions)  # without friction, whose part along the slave's own normal has any sign
        projections, response = balance.kinematics[number].projections, balance.responses[number]
        _bindings.contact_forces(pair.slave, pair.master, balance.positions, projections, response, forces)
        on_slave = -forces[outward.points]
        out = np.einsum("ij,ij->i", on_slave, outward.normals(balance.positions))
        return bool(np.maximum(out, 0.0).sum() > PULLING * np.linalg.norm(on_slave, axis=1).sum())


class _Outward:
    """Normals of a contact's slave face, out of its body, from the net of its control points, whose numbers are `points`."""

    def __init__(self, equilibrium: Equilibrium, contact: Contact) -> None:
        sheet, reference = Sheet.of(equilibrium.problem, contact.slave), equilibrium.numbering.reference
        patch, face, numbers = sheet.patch, sheet.face, sheet.points(equilibrium.numbering)
        first, second = sheet.directions
        self.points: IntArray = numbers[patch.face_points(face)]
        self._shape, self._sign = (second.count, first.count, 3), 1.0
        inward = reference[numbers[patch.face_points(opposite(face))]] - reference[self.points]
        self._sign = -1.0 if np.einsum("ij,ij->", self.normals(reference), inward) > 0.0 else 1.0

    def normals(self, positions: FloatArray) -> FloatArray:
        """Unit vectors at the control points, shape (n, 3); zero at a pole."""
        net = positions[self.points].reshape(self._shape)
        across = self._sign * np.cross(np.gradient(net, axis=1), np.gradient(net, axis=0)).reshape(-1, 3)
        length = np.linalg.norm(across, axis=1, keepdims=True)
        return np.divide(across, length, out=np.zeros_like(across), where=length > 0.0)


def _sentence(contact: Contact, step: int) -> str:
    cure = "turn its normal round, or" if isinstance(contact.master, RigidPlane) else f"name another face in contacts.{contact.name}, or"
    return (
        f"contact {contact.name!r}, load step {step}: it pulls where it should push: the slave face {contact.slave.words} "
        f"looks away from its master, as if it had come through it from behind. Look at the motions, {cure} "
        "start on the other side"
    )
