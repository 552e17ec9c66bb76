"""Factors of the bodies on one rank and on two, whole and compressed, beside the program's own."""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path
from statistics import median
from time import perf_counter, process_time
from typing import Any
from unittest.mock import patch

import numpy as np

from isomortar import _distributed
from isomortar._condensed import BodyFactors
from isomortar.geometry.patch import FloatArray
from isomortar.harness.bench import ASIDE, Row, benchmark
from isomortar.harness.measurement import peak_memory
from isomortar.march.simulation import Simulation
from isomortar.program.process import ONE_THREAD, output_of
from isomortar.solve.system import CheckedSystem

#: What the ranks run: each ends with a line of its own.
FIRST = "import sys; from performance.mumps import first_step; first_step(int(sys.argv[1]), *sys.argv[2:])"
OTHER = "from performance.mumps import other_rank; other_rank()"
#: So that mpirun starts more ranks than there are cores, and lets them go where there is room.
GRANTED = {"OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy": "none"}
AS_ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
MEGABYTE = 1e6


def first_step(elements: int, *settings: str) -> None:
    """Print what the first load step of the press came to, so many elements along its sides and half as many in its height."""
    from performance.problems import problem

    took: list[tuple[float, float]] = []
    left: list[float] = []
    factorise, substituted = BodyFactors.factorise, CheckedSystem.solve

    def timed(factors: BodyFactors, *given: Any, **named: Any) -> None:
        begin = perf_counter(), process_time()
        factorise(factors, *given, **named)
        took.append((perf_counter() - begin[0], process_time() - begin[1]))
        size.update(faces=factors.faces, entries=factors.factor_entries)

    def noted(system: CheckedSystem, right: FloatArray) -> FloatArray:
        left.append(system._left(system._substituted(right), right))
        return substituted(system, right)

    size: dict[str, int] = {}
    begin = perf_counter()
    simulation = Simulation(problem("press", "N2", (elements, elements, elements // 2), ["stages.press.steps=10", *settings]))
    with patch.object(BodyFactors, "factorise", timed), patch.object(CheckedSystem, "solve", noted):
        (result,) = islice(simulation.run(), 1)
    wall, cpu = (median(one) for one in zip(*took, strict=True))
    unknowns = len(simulation.equilibrium.supports.free)
    found = {"unknowns": unknowns, "factor": wall, "factor CPU": cpu, "left": max(left), "memory": peak_memory(), **size}
    force = [float(one) for one in result.reactions[0].force]
    print(json.dumps({**found, "run": perf_counter() - begin, "force": force}), flush=True)


def other_rank() -> None:
    """Factorise with the first rank, and print what that took."""
    _distributed.serve()
    print(json.dumps({"other memory": peak_memory()}), flush=True)


def run(elements: int, ranks: int, settings: Sequence[str]) -> dict[str, Any]:
    """What all ranks of a run have printed, in processes of their own."""
    folders = os.pathsep.join(filter(None, [str(Path(__file__).parents[1]), os.environ.get("PYTHONPATH")]))
    command = [sys.executable, "-c", FIRST, str(elements), *settings]
    if ranks > 1:
        command = ["mpirun", "-n", "1", *command, ":", "-n", str(ranks - 1), sys.executable, "-c", OTHER]
    said = output_of(command, environment={**ONE_THREAD, **GRANTED, **AS_ROOT, "PYTHONPATH": folders})
    found: dict[str, Any] = {}
    for line in said.splitlines():
        if line.startswith("{"):
            found |= json.loads(line)
    return found


@benchmark(
    question="What do two ranks and compressed factors cost and save?",
    columns={
        "elements": "",
        "unknowns": "",
        "on faces": "",
        "engine": "",
        "ranks": "",
        "compression": "",
        "factor": "s",
        "factor CPU": "s",
        "load step": "s",
        "entries": "million",
        "first rank": "MB",
        "another": "MB",
        "left": "",
        "force off": "",
    },
)
def mumps(quick: bool) -> Iterator[Row]:
    """The first load step of the press, NURBS of order 2, by the program's own factors, and by the engine mumps on one rank and on two.

    `factor`: wall clock of a factorisation, dense part included, the median of all; its CPU is the first rank's, where ranks that wait
    look busy. `load step`: wall clock of all of it. `entries` of the bodies' factors, on all ranks. Memory is the peak of each process.
    `left`: the most that a solution leaves of its right-hand side before it is refined. `force off`: of the support's force,
    relative to that by own factors. Both ranks are on this machine and have a core each, if nothing else is on it: what two machines
    would do it can not tell.
    """
    for elements in (6,) if quick else (12, 20):
        whole: list[float] = []
        for engine, ranks, compression in (
            ("own", 1, 0.0),
            *(("mumps", ranks, compression) for ranks in (1, 2) for compression in (0.0, 1e-9, 1e-6, 1e-3)),
        ):
            shape = f"{elements}x{elements}x{elements // 2}"
            row: Row = {"elements": shape, "engine": engine, "ranks": ranks, "compression": f"{compression:g}"}
            if engine == "mumps" and not (_distributed.is_built() and shutil.which("mpirun")):
                yield {**row, "note": "not installed; bash tools/setup.sh --mumps"}
                continue
            found = run(elements, ranks, [f"solver.engine={engine}", f"solver.compression={compression}"])
            whole = whole or found["force"]
            yield {**row, **measured(found, whole)}


def measured(found: dict[str, Any], whole: Sequence[float]) -> Row:
    """What was printed, in the units of the table."""
    off = float(np.max(np.abs(np.subtract(found["force"], whole))) / np.max(np.abs(whole)))
    return {
        "unknowns": found["unknowns"],
        "on faces": found["faces"],
        "factor": found["factor"],
        "factor CPU": found["factor CPU"],
        "load step": found["run"],
        "entries": 1e-6 * found["entries"],
        "first rank": found["memory"] / MEGABYTE,
        "another": found["other memory"] / MEGABYTE if "other memory" in found else ASIDE,
        "left": found["left"],
        "force off": off,
    }
