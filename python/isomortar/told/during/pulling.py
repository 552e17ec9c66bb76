"""Contact that pulls: it acts where the slave's face looks away from its master, as when a body has come through it from behind."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from isomortar import _bindings
from isomortar._bindings import Response
from isomortar._codes import PointState
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Contact, RigidPlane
from isomortar.model.pairs import Pair
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.feet import point_by_point

#: Share of a contact's normal forces that may pull: beside an edge the normals of both sides can be a right angle apart.
PULLING = 0.1


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
                yield _sentence(contact, step)


def pulls(equilibrium: Equilibrium, balance: Balance, number: int) -> bool:
    """Whether normal forces of a contact act out of its slave's body.

    They are looked at point by point, the pressure there as if it pressed: what functions of both signs make of it at control points,
    and a field of theirs below zero, tell nothing of where the slave's face looks.
    """
    pair, response = equilibrium.pairs[number].pair, balance.responses[number]
    if not np.any(response.state):
        return False
    slave, everywhere = point_by_point(pair, balance.positions)
    loads = pair.slave.area * np.abs(pair.field(response.pressure))
    forces = np.zeros_like(everywhere)  # without friction, whose part along the slave's own normal has any sign
    _bindings.contact_forces(slave, pair.master, everywhere, balance.kinematics[number].projections, _pressing(loads), forces)
    on_slave = -forces[slave.point]
    out = np.einsum("ij,ij->i", on_slave, _outward(pair, balance.positions))
    return bool(np.maximum(out, 0.0).sum() > PULLING * np.linalg.norm(on_slave, axis=1).sum())


def _pressing(loads: FloatArray) -> Response:
    """What presses with some loads and rubs nowhere."""
    count = len(loads)
    states = np.full(count, PointState.STICK, dtype=np.int32)
    return Response(loads, np.zeros((count, 2)), states, np.zeros(count), np.zeros((count, 6, 2)), np.zeros((count, 2)))


def _outward(pair: Pair, positions: FloatArray) -> FloatArray:
    """Unit normals of a pair's slave at its quadrature points, out of its body, shape (points, 3); zero where it has none."""
    nodes = positions[pair.slave.point[np.repeat(pair.slave.shape.nodes, pair.slave.per_element, axis=0)]]
    first, second = np.einsum("qka,qai->kqi", pair.slave.slopes, nodes)
    across = pair.slave.outward * np.cross(first, second)
    length = np.linalg.norm(across, axis=1, keepdims=True)
    return np.divide(across, length, out=np.zeros_like(across), where=length > 0.0)


def _sentence(contact: Contact, step: int) -> str:
    cure = "turn its normal round, or" if isinstance(contact.master, RigidPlane) else f"name another face in contacts.{contact.name}, or"
    return (
        f"contact {contact.name!r}, load step {step}: it pulls where it should push: the slave face {contact.slave.words} "
        f"looks away from its master, as if it had come through it from behind. Look at the motions, {cure} "
        "start on the other side"
    )
