"""Spurious work along averaged normals: what constant pressures do around a closed loop, with no friction and a master that rests."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from projection.averaged import uneven

from isomortar._bindings import Response
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case

#: Load steps of the loop, and in each the places where forces are asked; how far it goes, over elements of length 0.2.
STEPS, PLACES = 24, 4
LOOP = np.array([0.12, 0.09, 0.01])


def around(share: FloatArray) -> FloatArray:
    """Where the slave is at shares of the loop, shape (shares, 3)."""
    angle = 2.0 * np.pi * share
    return LOOP * np.column_stack([np.sin(angle), 1.0 - np.cos(angle), np.sin(2.0 * angle)])


@case(
    claim="Around a closed loop over a master that rests, constant pressures along averaged normals take up just the work that is recorded "
    "as spurious.",
    grid={"order": (1, 2)},
    bounds={
        "apart": Bound(
            at_most=1e-2, reason="discretisation: feet go straight from step to step, forces between their places; falls as h^2"
        ),
        "spurious": Bound(at_least=0.02, reason="definition: a loop that takes up nothing tells nothing"),
        "friction": Bound(0.0, 0.0, reason="definition: there are no tractions"),
    },
)
def around_a_loop(order: int) -> dict[str, float]:
    """Recorded work less that of the forces, and the work, over the sum of the load steps' absolute values; largest friction work."""
    equilibrium, start = uneven(order, "inside", 3)
    pair, points = equilibrium.pairs[0], len(equilibrium.pairs[0].pair.slave.area)
    slave, n = pair.pair.slave.point, len(pair.pair.slave.point)
    pressure, none = np.random.default_rng(1).uniform(0.5, 1.5, n), np.zeros((n, 2))
    response = Response(pressure, none, np.ones(n, dtype=np.int32), np.zeros(n), np.zeros((n, 6, 2)), np.zeros((points, 2)))
    places = around(np.linspace(0.0, 1.0, STEPS * PLACES + 1))
    state, begun, forces, works = replace(pair.initial(start), pressure=pressure), start, [], []
    for k, place in enumerate(places):
        positions = start.copy()
        positions[slave] += place
        kinematics, total = pair.kinematics(positions, state), np.zeros_like(start)
        pair.add_forces(positions, kinematics, response, total)
        forces.append(total[slave].sum(axis=0))
        if k % PLACES == 0:
            works.append(pair.work(begun, state, positions, kinematics, response))
            state, begun = pair.state(kinematics, response), positions
    done = float(np.sum(0.5 * (np.array(forces)[1:] + np.array(forces)[:-1]) * np.diff(places, axis=0)))
    friction, spurious = np.array(works).T
    size = float(np.abs(spurious).sum())
    return {"apart": abs(float(spurious.sum()) - done) / size, "spurious": abs(done) / size, "friction": float(np.abs(friction).max())}
