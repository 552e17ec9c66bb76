"""What corrections by kept factors learn from the steps before them."""

from __future__ import annotations

from typing import Literal
from unittest.mock import patch

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.solve.record import StepResult
from isomortar.solve.secants import Secants

Method = Literal["monolithic", "uzawa"]


def pressed(method: Method) -> Problem:
    """A block that is pressed onto a plane, with friction."""
    return Scene.load("press", ["bodies.block.mesh.elements=[5,5,3]", f"solver.method={method}"]).problem()


def done(steps: list[StepResult], name: str) -> int:
    """What was done in all load steps."""
    return sum(step.counters[name] for step in steps)


@case(
    claim="Corrections by kept factors learn from the steps before, by either method, and come to the same positions with "
    "fewer solves and no more factors.",
    tier="gate",
    grid={"method": ("monolithic", "uzawa")},
    bounds={
        "solves": Bound(at_most=0.77, reason="definition: fewer"),
        "factors": Bound(at_most=1.0, reason="definition: no more"),
        "apart": Bound(at_most=1e-8, reason="theory: the same equations, to the tolerance of their residual (7.6)"),
    },
)
def learnt(method: Method) -> dict[str, float]:
    """Solves and factors with what is learnt over those without, and how far positions are apart."""
    problem = pressed(method)
    steps = list(Simulation(problem).run())
    with patch.object(Secants, "improved", lambda _, correction: correction):
        others = list(Simulation(problem).run())
    apart = np.abs(steps[-1].state.positions - others[-1].state.positions).max()
    counts = {key: done(steps, name) / done(others, name) for key, name in (("solves", "solves"), ("factors", "factorisations"))}
    return {**counts, "apart": float(apart)}
