"""What is said of control points that two contacts share at the edge between them: of those that bear on both, and stick to one."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import product

import numpy as np
from told.wrong.singular import CORNER

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import StepResult
from isomortar.told.during.sharing import Sharing

TOLD = re.compile(r"contacts 'floor' and 'wall', load step 1: (\d+) slave control points at the edge between them bear on both and stick")
STATES = OPEN, STICK, SLIP = 0, 1, 2
#: What a load step converges with whose contacts are then given other states.
SLIPPERY = ("contacts.floor.friction=0.0", "contacts.wall.friction=0.0")
#: States of a shared point in the one contact and in the other of which something is said.
SHARED = {(STICK, STICK), (STICK, SLIP), (SLIP, STICK)}


def with_states(equilibrium: Equilibrium, result: StepResult, floor: int, wall: int, count: int) -> StepResult:
    """The result with so many of the shared points in some states, all others of the floor sticking and those of the wall open."""
    one, other = equilibrium.pairs
    edge, mine, theirs = np.intersect1d(one.pair.slave.point, other.pair.slave.point, return_indices=True)
    assert count < len(edge)
    contacts = []
    for found, shared, state, others in zip(result.contacts, (mine, theirs), (floor, wall), (STICK, OPEN), strict=True):
        status = np.full_like(found.status, others)
        status[shared] = OPEN
        status[shared[1 : count + 1]] = state
        contacts.append(replace(found, status=status))
    return replace(result, contacts=tuple(contacts))


@case(
    claim="Two contacts are said to share forces by as many control points as are closed in both and stick in one or both, once, if there "
    "is friction in one of them.",
    tier="gate",
    grid={"floor": (0.0, 0.2), "wall": (0.0, 0.2)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: states of the shared points of which something else is said")},
)
def shared(floor: float, wall: float) -> dict[str, float]:
    """How many of nine, each said by the program twice."""
    friction = (f"contacts.floor.friction={floor}", f"contacts.wall.friction={wall}")
    equilibrium = Simulation(Scene.from_toml(CORNER, overrides=friction).problem()).equilibrium
    result, wrong = next(iter(Simulation(Scene.from_toml(CORNER, overrides=SLIPPERY).problem()).run())), 0
    for count, states in enumerate(product(STATES, STATES)):
        sharing, given = Sharing(equilibrium), with_states(equilibrium, result, *states, 1 + count % 3)
        said = [*sharing.after_step(given), *sharing.after_step(given)]
        numbers = [int(found[1]) if (found := TOLD.match(sentence)) else 0 for sentence in said]
        wrong += numbers != [1 + count % 3] * (states in SHARED and floor + wall > 0.0)
    return {"wrong": float(wrong)}
