"""The solid's tangent, and the passes of a contact, by more than one thread."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from statistics import median
from time import perf_counter, process_time
from typing import Any
from unittest.mock import patch

from isomortar import _bindings
from isomortar.harness.bench import Row, benchmark
from isomortar.harness.bench.declaration import REPEATS
from isomortar.march.simulation import Simulation
from isomortar.program.process import output_of

#: What a process of its own runs: OpenMP asks for the number of threads once, when it is loaded.
PROGRAM = "import sys; from performance import threads; getattr(threads, sys.argv[1])(*map(int, sys.argv[2:]))"
#: What goes over the points of a contact.
PASSES = ("project_points", "control_quantities", "contact_forces", "contact_blocks")


def assemble(order: int, *elements: int) -> None:
    """Print wall-clock and CPU seconds of a tangent of the press's block, medians over repetitions."""
    from performance.problems import deformed, solid_block

    equilibrium = solid_block(order, elements)  # type: ignore[arg-type]
    positions = deformed(equilibrium)
    wall, cpu = [], []
    for _ in range(REPEATS + 1):  # the first one starts the threads
        start = perf_counter(), process_time()
        equilibrium.solid.forces_and_tangent(positions.copy())
        wall.append(perf_counter() - start[0])
        cpu.append(process_time() - start[1])
    print(median(wall[1:]), median(cpu[1:]))


def contact(order: int, *elements: int) -> None:
    """Print wall-clock and CPU seconds of all passes of the twist's contact in a load step that presses and one that twists."""
    from performance.problems import problem

    shorter = ["stages.press.steps=1", "stages.press.motions.top.translate=[0,0,-0.25]", "stages.twist.steps=1"]
    given = problem("twist", f"N{order}", elements, [*shorter, "stages.twist.motions.top.rotate=6.0"])  # type: ignore[arg-type]
    wall, cpu = [], []

    def timed(name: str) -> Any:
        function = getattr(_bindings, name)

        def run(*arguments: Any, **named: Any) -> Any:
            start = perf_counter(), process_time()
            found = function(*arguments, **named)
            wall.append(perf_counter() - start[0])
            cpu.append(process_time() - start[1])
            return found

        return patch.object(_bindings, name, run)

    with ExitStack() as stack:
        for name in PASSES:
            stack.enter_context(timed(name))
        for _ in Simulation(given).run():
            pass
    print(sum(wall), sum(cpu))


def _in_process(work: str, many: int, order: int, elements: tuple[int, int, int]) -> tuple[float, float]:
    """Wall-clock and CPU seconds of `assemble` or `contact` with some threads."""
    folders = os.pathsep.join(filter(None, [str(Path(__file__).parents[1]), os.environ.get("PYTHONPATH")]))
    command = [sys.executable, "-c", PROGRAM, work, str(order), *map(str, elements)]
    wall, cpu = output_of(command, environment={"OMP_NUM_THREADS": str(many), "PYTHONPATH": folders}).split()
    return float(wall), float(cpu)


@benchmark(
    question="How much sooner do the solid's tangent and a contact's passes come with two threads?",
    columns={"work": "", "order": "", "elements": "", "threads": "", "wall clock": "s", "CPU": "s", "sooner": "times"},
)
def threads(quick: bool) -> Iterator[Row]:
    """Wall-clock seconds by one thread and by two, in processes of their own; the bits of the result are the same.

    `assemble`: one tangent of the press's block. `contact`: feet, control quantities, forces and tangents of all iterations of two load
    steps of the twist. The one benchmark that looks at the clock on the wall: other work on the machine lengthens it.
    """
    for work, elements in {"assemble": (3, 3, 2) if quick else (12, 12, 6), "contact": (3, 3, 2) if quick else (8, 8, 3)}.items():
        for order in (2, 4):
            alone = 0.0
            for many in (1, 2):
                wall, cpu = _in_process(work, many, order, elements)
                alone = alone or wall
                size: Row = {"work": work, "order": order, "elements": "x".join(map(str, elements)), "threads": many}
                yield {**size, "wall clock": wall, "CPU": cpu, "sooner": alone / wall}
