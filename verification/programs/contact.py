"""A block pressed onto another one, by isomortar and by programs that enforce contact by other means."""

from __future__ import annotations

import numpy as np
from friction.spurious_work import BALANCED, balance, loop
from programs.run import FILES, PROGRAMS
from programs.solids import reactions, run

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.scene import Scene

#: The scene `block` without its slide, with the law that all of these programs have.
PRESS = (
    'stages=[{name="press", steps=5, motions.top.translate=[0,0,-0.2]}]',
    "materials.rubber.law=neo-hookean-j",
)
OWN, *OTHERS = PROGRAMS


@case(
    claim="A block is pressed onto another one with the same force, by whatever means contact is enforced on the same elements.",
    tier="nightly",
    grid={"program": OTHERS},
    bounds={
        "force": Bound(
            at_most=3e-3,
            reason="discretisation: CalculiX' penalty lets the blocks overlap by the mean pressure, 2.7, over 1e4, 0.15 % of the way; "
            "GetFEM's multipliers hold at other points of the edge elements",
        )
    },
    files=FILES,
)
def pressed(program: str) -> dict[str, FloatArray]:
    """Force on the top after each of five load steps; differences over the largest."""
    problem = Scene.load("block", PRESS).problem()
    own, other = (reactions(run(PROGRAMS[name], problem))[0][:, 0] for name in (OWN, program))
    return {"force": np.abs(own - other).max(axis=1) / np.abs(own).max()}


@case(
    claim="Around a closed loop without friction supports do the work that GetFEM's contact is said to take up.",
    tier="nightly",
    bounds={**BALANCED, "friction": Bound(at_most=0.01, reason="definition: there is none, but for multipliers between nodes")},
    files=FILES,
)
def spurious_in_getfem() -> dict[str, float]:
    """As by `friction/around_in_a_run`; largest friction work of a load step, over the size of the spurious work."""
    problem = loop()
    steps = run(PROGRAMS["GetFEM"], problem).steps
    friction, spurious = np.array([step.works for step in steps]).T
    found = balance(problem, [step.reactions for step in steps], spurious.tolist())
    return {**found, "friction": float(np.abs(friction).max()) / found["sides"]}
