"""Assembly of the solid tangent by more than one thread."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from time import perf_counter, process_time

from isomortar.harness.bench import Row, benchmark
from isomortar.harness.bench.declaration import REPEATS
from isomortar.program.process import output_of

#: What a process of its own runs: OpenMP asks for the number of threads once, when it is loaded.
PROGRAM = "import sys; from performance.threads import assemble; assemble(int(sys.argv[1]), *map(int, sys.argv[2:]))"


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


def _in_process(many: int, order: int, elements: tuple[int, int, int]) -> tuple[float, float]:
    """Wall-clock and CPU seconds of `assemble` with some threads."""
    folders = os.pathsep.join(filter(None, [str(Path(__file__).parents[1]), os.environ.get("PYTHONPATH")]))
    command = [sys.executable, "-c", PROGRAM, str(order), *map(str, elements)]
    wall, cpu = output_of(command, environment={"OMP_NUM_THREADS": str(many), "PYTHONPATH": folders}).split()
    return float(wall), float(cpu)


@benchmark(
    question="How much sooner does the solid's tangent come with two threads?",
    columns={"order": "", "elements": "", "threads": "", "wall clock": "s", "CPU": "s", "sooner": "times"},
)
def threads(quick: bool) -> Iterator[Row]:
    """Wall-clock seconds of one tangent by one thread and by two, in processes of their own; the bits of the result are the same.

    The one benchmark that looks at the clock on the wall: other work on the machine lengthens it.
    """
    elements = (3, 3, 2) if quick else (12, 12, 6)
    for order in (2, 4):
        alone = 0.0
        for many in (1, 2):
            wall, cpu = _in_process(many, order, elements)
            alone = alone or wall
            size: Row = {"order": order, "elements": "x".join(map(str, elements)), "threads": many}
            yield {**size, "wall clock": wall, "CPU": cpu, "sooner": alone / wall}
