"""Contact forces: the kernel integrates them in a pass of their own, and as rows of the tangent."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from small_scenes import at_few_points, bowl

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.solve.contact import Kinematics
from isomortar.solve.scales import Scales


def without_some(kinematics: Kinematics) -> Kinematics:
    """Every third quadrature point taken for one that lies beyond the master."""
    projections = kinematics.projections
    kept = np.resize(np.array([1, 1, 0], np.int32), len(projections.found))
    return replace(kinematics, projections=replace(projections, found=projections.found * kept))


@case(
    claim="Contact forces are the multipliers times the constraint rows.",
    tier="gate",
    grid={"master": ("block", "plane"), "slip_sum": ("local", "paper"), "friction": (0.0, 0.3)},
    bounds=lambda master, slip_sum, friction: {  # noqa: ARG005
        "difference": Bound(at_most=1e-13, reason="round-off: the same integrals, summed in another order"),
        "slipping": Bound(
            at_least=1.0 if friction else 0.0, at_most=25.0 if friction else 0.0, reason="definition: the sum counts only then"
        ),
    },
)
def forces_are_rows(master: str, slip_sum: str, friction: float) -> dict[str, float]:
    """Largest difference over the largest force, at the end of a run, some quadrature points left out; slipping control points there."""
    problem = at_few_points(bowl(master, friction, slip_sum=slip_sum))
    simulation = Simulation(problem)
    *_, before, last = simulation.run()
    pair = simulation.equilibrium.pairs[0]
    positions, start, end = last.state.positions, before.state.contacts[0], last.state.contacts[0]
    kinematics = without_some(pair.kinematics(positions, start))
    law = pair.law(pair.parameters(kinematics.control, Scales(np.ones(2), np.zeros(2))), end.pressure, end.traction)
    response = pair.respond(kinematics, law)
    blocks = pair.blocks(positions, kinematics, law, response)
    forces, rows = np.zeros_like(positions), np.zeros_like(positions)
    pair.add_forces(positions, kinematics, response, forces)
    point = np.repeat(np.arange(len(end.pressure)), np.diff(blocks.patterns.rows.start))
    multipliers = np.column_stack([response.pressure, response.traction])[:, : 3 if friction else 1] * (response.state > 0)[:, None]
    terms = np.einsum("bk,bki->bi", multipliers[point], blocks.rows[:, : multipliers.shape[1]])
    np.add.at(rows, blocks.patterns.rows.column, terms)
    return {
        "difference": float(np.abs(forces - rows).max() / np.abs(forces).max()),
        "slipping": float(np.sum(response.state == 2)),
    }
