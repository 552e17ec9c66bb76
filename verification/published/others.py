"""Published benchmarks by other programs, on the same coarse elements as by our own solver: values, and what they cost."""

from __future__ import annotations

from typing import Any

from programs.run import FILES, outcome
from published.benchmark import Beside
from published.benchmarks import BENCHMARKS

from isomortar.errors import ConvergenceError
from isomortar.harness import Shown, case
from isomortar.harness.cases import Claim
from isomortar.program.calculix import CalculiX
from isomortar.program.declaration import Program
from isomortar.program.getfem import GetFEM
from isomortar.program.own import Isomortar

#: The own one first. Works are not asked for: they would cost GetFEM time. Where it cuts increments by itself, as with friction, it takes a
#: hundred iterations and more, and no run of it is like another.
PROGRAMS: dict[str, Program] = {program.name: program for program in (Isomortar(), GetFEM(works=False, iterations=300), CalculiX())}
OWN = next(iter(PROGRAMS))
#: How a benchmark is computed, by its runs that come to their end: ``nafems_punch-friction-0 L1 GetFEM``.
_RUNS = {
    f"{benchmark.name} {kind} {program}": beside
    for benchmark in BENCHMARKS
    if isinstance(beside := benchmark.beside, Beside)
    for kind in beside.kinds
    for program in PROGRAMS
    if f"{kind} {program}" not in beside.stops
}


def _claims(run: str) -> dict[str, Claim]:
    return {
        **_RUNS[run].within,
        "nodes": Shown("of all bodies"),
        "solves": Shown("linear solves of all load steps"),
        "cpu_seconds": Shown("of the computation; of the whole process where the program has one of its own"),
    }


@case(
    claim="Programs that enforce contact by other means come near what is published, on coarse elements that all of them have.",
    tier="nightly",
    grid={"run": tuple(_RUNS)},
    bounds=_claims,
    files=FILES,
)
def by_program(run: str) -> dict[str, Any]:
    """The quantities that a program's positions and reactions tell."""
    _, kind, program = run.split()
    problem = _RUNS[run].problem(kind)
    found = outcome(PROGRAMS[program], problem)
    if found.words or len(found.steps) < problem.total_steps:
        raise ConvergenceError(f"load step {len(found.steps) + 1}: {found.words}")
    numbers = {"nodes": len(found.steps[-1].positions), "solves": found.solves, "cpu_seconds": found.cpu_seconds}
    return {**_RUNS[run].numbers(problem, found.steps), **numbers}
