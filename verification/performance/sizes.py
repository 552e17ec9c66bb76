"""What a load step takes as unknowns grow, up to what the machine holds."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

from performance.memory import Mesh, in_own_process
from performance.problems import problem

from isomortar.harness.bench import Plot, Row, benchmark
from isomortar.harness.measurement import peak_memory
from isomortar.march.simulation import Simulation
from isomortar.model.memory import memory_needed, memory_of_machine

#: Elements along the sides of the block; the third side is half as long.
SIDES = (6, 8, 12, 16, 24, 32, 40, 48)
PHASES = ("solid", "projection", "contact", "factor", "solve", "other")


@dataclass(frozen=True)
class Step:
    """One load step: free unknowns, those that contact acts on, CPU seconds by phase, tangents, solves, and bytes at the peak."""

    unknowns: int
    faces: int
    seconds: dict[str, float]
    tangents: int
    solves: int
    peak: float


@benchmark(
    question="How does a load step with friction grow with its unknowns, and where does one machine end?",
    columns={
        "elements": "",
        "unknowns": "",
        "on faces": "",
        **dict.fromkeys(PHASES, "s"),
        "a step": "s",
        "tangents": "",
        "solves": "",
        "memory": "GB",
        "expected": "GB",
    },
    plots=tuple(Plot("unknowns", name) for name in ("a step", "solid", "factor", "contact", "memory")),
)
def sizes(quick: bool) -> Iterator[Row]:
    """The first load step of the press at order 2, n x n x n/2 elements, in a process of its own; CPU seconds of all its tangents.

    Meshes go up to what `isomortar check` expects the machine to hold: `expected`, beside the peak that was met. In theory the solid
    grows by the first power of the unknowns, the contact by 2/3, factors by 2, a solve and the memory by 4/3.
    """
    for side in (4, 6) if quick else SIDES:
        elements = (side, side, side // 2)
        size: Row = {"elements": "x".join(map(str, elements))}
        needed = memory_needed(problem("press", "N2", elements))
        if needed > memory_of_machine():
            yield {**size, "note": f"would take {1e-9 * needed:.0f} GB of memory, more than there is"}
            break
        found = in_own_process(first_step, ("press", "N2", elements))
        counts: Row = {"tangents": found.tangents, "solves": found.solves, "memory": 1e-9 * found.peak, "expected": 1e-9 * needed}
        times = {name: found.seconds[name] for name in PHASES}
        yield {**size, "unknowns": found.unknowns, "on faces": found.faces, **times, "a step": sum(times.values()), **counts}


def first_step(mesh: Mesh) -> Step:
    """The first load step of a scene."""
    simulation = Simulation(problem(*mesh))
    (step,) = islice(simulation.run(), 1)
    equilibrium = simulation.equilibrium
    bodies = equilibrium.systems.bodies
    assert bodies, "something was factorised"
    tangents, solves = step.counters["solid tangents"], step.counters["solves"]
    return Step(len(equilibrium.supports.free), bodies.factors.faces, dict(step.timings), tangents, solves, peak_memory())
