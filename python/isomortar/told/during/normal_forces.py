"""Normal forces of a contact, point by point."""

from __future__ import annotations

import numpy as np

from isomortar import _bindings
from isomortar._bindings import Response
from isomortar._codes import PointState
from isomortar.geometry.patch import FloatArray
from isomortar.model.pairs import Pair
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.feet import point_by_point


def normal_forces(equilibrium: Equilibrium, balance: Balance, number: int) -> tuple[FloatArray, FloatArray]:
    """Normal forces of a contact on its slave's quadrature points and unit normals out of its body there, each shape (points, 3).

    They are looked at point by point, the pressure there as if it pressed: what functions of both signs make of it at control points,
    and a field of theirs below zero, tell nothing of where the slave's face looks.
    """
    pair, response = equilibrium.pairs[number].pair, balance.responses[number]
    outward = _outward(pair, balance.positions)
    if not np.any(response.state):
        return np.zeros_like(outward), outward
    loads = pair.slave.area * np.abs(pair.field(response.pressure)) * (balance.kinematics[number].projections.found > 0)
    if pair.contact.averaged:  # these act along the slave's own normals, of which single points have none
        return -loads[:, None] * outward, outward
    slave, everywhere = point_by_point(pair, balance.positions)
    forces = np.zeros_like(everywhere)  # without friction, whose part along the slave's own normal has any sign
    _bindings.contact_forces(slave, pair.master, everywhere, balance.kinematics[number].projections, _pressing(loads), forces)
    return -forces[slave.point], outward


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
