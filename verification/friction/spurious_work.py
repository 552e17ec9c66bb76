"""Spurious work along averaged normals: what forces without friction do around a closed loop, over a master that rests, and in a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from projection.averaged import uneven

from isomortar._bindings import Response
from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.solve.record import Reaction

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


#: A small block on a master of flat elements, pressed and then moved once round, in so many load steps a side.
SIDES, A_SIDE = ((0.13, 0.02), (0.03, 0.1), (-0.14, -0.03), (-0.02, -0.09)), 3
BLOCK = (
    *("contacts.interface.projection='averaged'", "contacts.interface.friction=0.0", "bodies.slave.mesh.elements=[2,2,1]"),
    *("bodies.master.mesh.elements=[5,5,1]", "stages.press.steps=1", "stages.press.motions.top.translate=[0,0,-0.1]"),
    *(f"stages.slide.steps={A_SIDE}", f"stages.slide.motions.top.translate=[{SIDES[0][0]},{SIDES[0][1]},0]"),
)
#: What is claimed of the loop.
BALANCED = {
    "apart": Bound(at_most=0.02, reason="discretisation: means of both ends of a load step; falls as h^2"),
    "closed": Bound(at_most=1e-6, reason="round-off: the last state is the first one, to the tolerance of Newton's method"),
    "sides": Bound(at_least=1e-5, reason="definition: a loop that takes nothing up on its way tells nothing"),
}


def loop() -> Problem:
    """The block, pressed and moved once round without friction."""
    text = Scene.load("block", BLOCK).to_toml()
    for k, (x, y) in enumerate(SIDES[1:]):
        text += f'\n[[stages]]\nname = "side{k}"\nsteps = {A_SIDE}\n[stages.motions.top]\ntranslate = [{x}, {y}, 0]\n'
    return Scene.from_toml(text).problem()


def balance(problem: Problem, reactions: Sequence[Sequence[Reaction]], spurious: Sequence[float]) -> dict[str, float]:
    """Spurious work round the loop less that of the support, over the sum of the load steps' absolute values, which is `sides`.

    Parameters
    ----------
    problem : Problem
    reactions : sequence
        Of the supports at every load step.
    spurious : sequence of float
        Of every load step.
    """
    top = [support.name for support in problem.supports].index("top")
    forces, places = (np.array([getattr(step[top], name) for step in reactions]) for name in ("force", "centre"))
    done = float(np.sum(0.5 * (forces[1:] + forces[:-1]) * np.diff(places, axis=0)))
    round_it = np.array(spurious[1:])
    size = float(np.abs(round_it).sum())
    closed = float(np.abs(forces[-1] - forces[0]).max() / np.abs(forces[0]).max())
    return {"apart": abs(float(round_it.sum()) - done) / size, "closed": closed, "sides": size}


@case(
    claim="Around a closed loop without friction supports do the work that is recorded as spurious: it is no work of the dent that a slave "
    "takes along.",
    bounds=BALANCED,
    scene="block",
)
def around_in_a_run() -> dict[str, float]:
    """Apart, change of the force, and size."""
    problem = loop()
    steps = list(Simulation(problem).run())
    return balance(problem, [step.reactions for step in steps], [step.contacts[0].spurious_work for step in steps])
