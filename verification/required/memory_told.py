"""What memory is told of before any of it is taken: blocks of the tangent as they are, entries of factors about as many as there are."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.memory import blocks, factor_entries, memory_needed
from isomortar.scene import Scene
from isomortar.solve.system import LinearSystem

#: Family, order and elements of a block.
MESHES: dict[str, tuple[str, int, str]] = {
    "quadratic": ("N", 2, "[5,4,3]"),
    "quartic": ("N", 4, "[5,5,3]"),
    "of many": ("N", 2, "[12,10,6]"),
    "Lagrange": ("L", 3, "[3,3,2]"),
    "quartic Lagrange": ("L", 4, "[4,4,2]"),
}


@case(
    claim="Of the memory that a scene takes it is told, before the first load step, what blocks of the tangent and entries of the factors "
    "take, within a factor of two and a half.",
    tier="gate",
    grid={"mesh": tuple(MESHES)},
    bounds={
        "blocks": Bound(0.0, 0.0, "definition: pairs of control points that share an element, against the tangent's own"),
        "factors": Bound(at_most=2.5, at_least=0.4, reason="theory: nested dissection of a grid, against the entries that there are"),
        "bytes": Bound(at_most=1e-12, reason="round-off: 184 a Gauss point, 900 a block of the tangent, 16 an entry of the factors"),
    },
)
def memory_told(mesh: str) -> dict[str, float]:
    """Differences, and the share of the entries."""
    family, order, elements = MESHES[mesh]
    changes = {"family": family, "order": order, "elements": elements}
    problem = Scene.load("press", [f"bodies.block.mesh.{key}={value}" for key, value in changes.items()]).problem()
    simulation = Simulation(problem)
    equilibrium, patch = simulation.equilibrium, problem.bodies[0].patch
    system = LinearSystem(len(equilibrium.supports.free), [equilibrium.solid_source], simulation.ledger, ordering="metis")
    system.factorise([equilibrium.solid.forces_and_tangent(simulation.state.positions)[1]])
    statistics = system._rivals[0].statistics
    assert statistics is not None
    points = np.prod([d.elements * n for d, n in zip(patch.directions, problem.bodies[0].quadrature, strict=True)])
    told = 900.0 * len(equilibrium.solid.pattern.column) + 16.0 * factor_entries(patch) + 184.0 * points
    return {
        "blocks": float(abs(blocks(patch) - len(equilibrium.solid.pattern.column))),
        "factors": float(factor_entries(patch) / statistics.factor_entries),
        "bytes": float(np.abs(memory_needed(problem) / told - 1.0)),
    }
