"""A rubber block pressed onto a rigid plane and dragged along it, from the parts of the program, top down.

`python examples/contact_from_scratch.py`. Three nested loops: load steps, augmentations of the contact multipliers (Uzawa), Newton's method
for the positions.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from isomortar._bindings import Law
from isomortar.geometry.patch import FloatArray
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.model.entities import Body, Contact, Face, Material, Motion, Problem, RigidPlane, Stage, Support
from isomortar.model.settings import SolverSettings
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.record import State
from isomortar.solve.timing import Ledger

BALANCED = 1e-9  # relative residual at which Newton's method ends
AUGMENTED = 1e-4  # relative change of the pressures at which augmentations end
PENALTIES = np.array([100.0, 10.0])  # over the block's stiffness, normal and tangential; each augmentation doubles them


def problem() -> Problem:
    """What there is: a block of quadratic NURBS, its underside the slave of a plane, its upper face held and moved."""
    block = mesh(box((0.0, 0.0, 0.0), (1.0, 1.0, 0.5)), ("N", "N", "N"), (2, 2, 2), (3, 3, 2))
    floor = RigidPlane(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0), tangent=(1.0, 0.0, 0.0))
    return Problem(
        name="from scratch",
        bodies=(Body("block", block, Material(young=10.0, poisson=0.3), quadrature=(3, 3, 3)),),
        contacts=(Contact("floor", Face("block", "w0"), floor, friction=0.4, quadrature=(4, 4)),),
        supports=(Support("top", Face("block", "w1"), (Motion((0.0, 0.0, -0.1)), Motion((0.05, 0.0, 0.0)))),),
        stages=(Stage("press", 2), Stage("drag", 2)),
        settings=SolverSettings(method="uzawa"),
    )


def forces(equilibrium: Equilibrium) -> Iterator[FloatArray]:
    """Load steps: the force that the plane exerts on the block at the end of each."""
    state = equilibrium.initial_state()
    for time in range(1, equilibrium.problem.total_steps + 1):
        state, balance = load_step(equilibrium, state, time)
        yield (balance.internal - balance.total).sum(axis=0)


def load_step(equilibrium: Equilibrium, start: State, time: float) -> tuple[State, Balance]:
    """Augmentations: balance with the multipliers held, then the multipliers that the law made of it, until they stand still."""
    prescribed, scales = equilibrium.begin(start, time)
    factors = [PENALTIES * pair.stiffness(scales) / pair.penalty_area for pair in equilibrium.pairs]
    laws = [p.law(f, c.pressure, c.traction) for p, f, c in zip(equilibrium.pairs, factors, start.contacts, strict=True)]
    positions, change = start.positions, np.inf
    while change > AUGMENTED:
        balance = newton(equilibrium, start, laws, positions, prescribed)
        pairs = list(zip(laws, balance.responses, strict=True))
        change = max(np.linalg.norm(r.pressure - law.pressure) / np.linalg.norm(r.pressure) for law, r in pairs)
        laws = [replace(law, penalties=2 * law.penalties, pressure=r.pressure, traction=r.traction) for law, r in pairs]
        positions, prescribed = balance.positions, np.zeros_like(prescribed)
    return equilibrium.state(balance), balance


def newton(equilibrium: Equilibrium, start: State, laws: Sequence[Law], positions: FloatArray, prescribed: FloatArray) -> Balance:
    """Newton's method: correct the positions until the forces at free ones vanish; the first correction moves the supports."""
    while True:
        balance = equilibrium.balance(positions, start, laws)
        residual = np.linalg.norm(balance.total.ravel()[equilibrium.supports.free])
        if residual <= BALANCED * np.linalg.norm(balance.internal) and not prescribed.any():
            return balance
        positions = balance.positions + equilibrium.correction(balance, laws, prescribed)
        prescribed = np.zeros_like(prescribed)


if __name__ == "__main__":
    for number, (x, y, z) in enumerate(forces(Equilibrium(problem(), Ledger())), start=1):
        print(f"load step {number}: the plane pushes by {z:.6f} and drags by {x:.6f} along x, {abs(y):.1e} along y")
