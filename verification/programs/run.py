"""One run: a scene file computed by one of the programs, its forces and what it cost."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from isomortar.harness.cases import Bound, Shown, Words, measured, skip
from isomortar.model.entities import Problem
from isomortar.program import getfem
from isomortar.program.calculix import CalculiX
from isomortar.program.declaration import NotInstalledError, Outcome, Program
from isomortar.program.getfem import GetFEM
from isomortar.program.own import Isomortar
from isomortar.scene.scene import Scene

#: The own one first: others are compared with it.
PROGRAMS: dict[str, Program] = {program.name: program for program in (Isomortar(), GetFEM(), CalculiX())}
#: What the numbers depend on besides Python files that are imported.
FILES = (Path(getfem.__file__).with_name("getfem_job.py"),)


@measured(
    claim="The program comes to the end of the scene.",
    bounds={
        "missing": Bound(at_most=0, reason="definition: load steps that are not there were not computed"),
        "force": Shown("on the supports, shape (load steps, supports, 3)"),
        "works": Shown("of friction, and spurious, shape (load steps, 2); not a number where a program does not tell"),
        "words": Shown("of the program, where a load step does not converge"),
        "solves": Shown("linear solves of all load steps, of those that failed too"),
        "cpu_seconds": Shown("of the computation; of the whole process where the program has one of its own"),
    },
    files=FILES,
)
def computed(scene: str, program: str) -> dict[str, Any]:
    """Forces of a scene file's run by a program, as far as it came."""
    problem = Scene.load(scene).problem()
    found = outcome(PROGRAMS[program], problem)
    return {
        "missing": problem.total_steps - len(found.steps),
        "force": [[reaction.force for reaction in step.reactions] for step in found.steps],
        "works": [step.works for step in found.steps],
        "words": Words(found.words),
        "solves": found.solves,
        "cpu_seconds": found.cpu_seconds,
    }


def outcome(program: Program, problem: Problem) -> Outcome:
    """What becomes of a problem, skipped where the program is not installed.

    Raises
    ------
    OSError, RuntimeError
        That says nothing of the problem: a trouble of the machine, a crash of the program.
    """
    try:
        found = program.run(problem)
    except NotInstalledError as error:
        skip(str(error))
    if found.ending not in ("measured", "not converged"):
        raise (OSError if found.ending == "trouble" else RuntimeError)(f"{program.name}: {found.ending}: {found.words}")
    return found
