"""Contact that pulls: it acts where the slave's face looks away from its master, as when a body has come through it from behind."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar.model.entities import Contact, RigidPlane
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.told.during.normal_forces import normal_forces

#: Share of a contact's normal forces that may pull: beside an edge the normals of both sides can be a right angle apart.
PULLING = 0.1
#: Share of all normal forces, and of all normals, by which they go against each other as a whole where a face has rolled over its edge: of
#: one that goes all round a ring nothing is left of their sums.
ROLLED = 0.1


class Pulling:
    """Warnings of contacts that pull; each is given once."""

    def __init__(self, equilibrium: Equilibrium) -> None:
        self._equilibrium = equilibrium
        self._told = set[str]()

    def after_step(self, balance: Balance, step: int) -> Iterator[str]:
        """Warnings that the end of a load step gives rise to."""
        for number, contact in enumerate(self._equilibrium.problem.contacts):
            if contact.name not in self._told and pulls(self._equilibrium, balance, number):
                self._told.add(contact.name)
                on_slave, outward = normal_forces(self._equilibrium, balance, number)
                whole = np.linalg.norm(on_slave, axis=1).sum() * len(outward)
                yield _sentence(contact, step, bool(on_slave.sum(axis=0) @ outward.sum(axis=0) < -ROLLED * whole))


def pulls(equilibrium: Equilibrium, balance: Balance, number: int) -> bool:
    """Whether normal forces of a contact act out of its slave's body."""
    on_slave, outward = normal_forces(equilibrium, balance, number)
    out = np.einsum("ij,ij->i", on_slave, outward)
    return bool(np.maximum(out, 0.0).sum() > PULLING * np.linalg.norm(on_slave, axis=1).sum())


def _sentence(contact: Contact, step: int, rolled: bool) -> str:
    """On a slave that came from behind, or whose face still looks to its master as a whole, and has `rolled` over its edge."""
    pulls = f"contact {contact.name!r}, load step {step}: it pulls where it should push: the slave face {contact.slave.words}"
    if rolled:
        return (
            f"{pulls} has rolled over an edge of its own, and looks away from its master there: what meets that is the face beside it. "
            "Give that face a contact, too, take less friction, or end the motion earlier"
        )
    cure = "turn its normal round, or" if isinstance(contact.master, RigidPlane) else f"name another face in contacts.{contact.name}, or"
    return (
        f"{pulls} looks away from its master, as if it had come through it from behind. Look at the motions, {cure} start on the other side"
    )
