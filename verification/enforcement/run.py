"""One run: a scene file, its curves, its pressures and what it cost."""

from __future__ import annotations

from time import process_time
from typing import Any

from isomortar.errors import ConvergenceError
from isomortar.harness.cases import Bound, Shown, Words, measured
from isomortar.march.simulation import Simulation
from isomortar.scene.scene import Scene
from isomortar.solve.record import StepResult


@measured(
    claim="The scene comes to its end.",
    bounds={
        "missing": Bound(at_most=0, reason="definition: load steps that are not there were not computed"),
        "force": Shown("on the supports, shape (load steps, supports, 3)"),
        "moment": Shown("of these about their centres, shape (load steps, supports, 3)"),
        "pressure": Shown("smallest and largest pressure at the quadrature points or the constraints, shape (load steps, 2)"),
        "words": Shown("where a load step does not converge"),
        "solves": Shown("linear solves of all load steps"),
        "cuts": Shown("load increments that did not converge and were cut"),
        "cpu_seconds": Shown("of the computation"),
        "constraints": Shown("of the contact"),
        "control_points": Shown("of the slave's face"),
    },
)
def computed(scene: str) -> dict[str, Any]:
    """Curves of a scene file's run, as far as it came."""
    problem = Scene.load(scene).problem()
    simulation, words, steps, start = Simulation(problem), "", list[StepResult](), process_time()
    try:
        steps.extend(simulation.run())
    except ConvergenceError as error:
        words = str(error)
    slave = simulation.equilibrium.pairs[0].pair.slave
    return {
        "missing": problem.total_steps - len(steps),
        "force": [[reaction.force for reaction in step.reactions] for step in steps],
        "moment": [[reaction.moment for reaction in step.reactions] for step in steps],
        "pressure": [step.contacts[0].pressure_field for step in steps],
        "words": Words(words),
        "solves": sum(step.counters["solves"] for step in steps),
        "cuts": sum(step.cuts for step in steps),
        "cpu_seconds": process_time() - start,
        "constraints": slave.test.count,
        "control_points": len(slave.point),
    }
