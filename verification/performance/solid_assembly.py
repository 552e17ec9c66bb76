"""Assembly of the solid tangent against the speed of the machine and against the factors of the same matrix."""

from __future__ import annotations

from collections.abc import Iterator

from performance.problems import deformed, solid_system

from isomortar.harness.bench import Plot, Row, benchmark, cpu_seconds
from isomortar.harness.bench.machine import dgemm_rate

#: Seconds of a sum-factorised, symmetric assembly of the same block by order, on a core whose dgemm did `RATE` GF/s.
REFERENCE, RATE = {2: 0.073, 3: 0.33, 4: 0.9, 5: 2.2}, 83.0


@benchmark(
    question="Is the solid's tangent assembled as fast as the machine allows, and faster than it is factorised?",
    columns={
        "order": "",
        "elements": "",
        "unknowns": "",
        "forces": "s",
        "tangent": "s",
        "factor": "s",
        "dgemm": "GF/s",
        "like dgemm": "GF",
        "of the reference": "",
        "of the factors": "",
    },
    plots=(Plot("unknowns", "tangent"), Plot("unknowns", "factor")),
    limits={
        "of the reference": (1.3, "a prototype with sum factorisation took that, each relative to dgemm on its machine in its run"),
        "of the factors": (0.6, "then the factors, which no formulation spares, are most of an iteration"),
    },
)
def solid_assembly(quick: bool) -> Iterator[Row]:
    """Internal forces alone, and forces with tangent, of a deformed block of 12x12x6 elements of one order in all directions.

    The quadrature is the paper's. `like dgemm`: floating-point operations that dgemm does in the time of the tangent. `factor` gathers
    the free unknowns' entries and factorises the same tangent.
    """
    elements = (3, 3, 2) if quick else (12, 12, 6)
    for order, seconds in REFERENCE.items():
        found = solid_system(order, elements)
        equilibrium, system = found.equilibrium, found.analysed()
        positions = deformed(equilibrium)
        # Copies: the tangent of positions that are the very same is kept, not assembled.
        tangent = cpu_seconds(lambda solid=equilibrium.solid, x=positions: solid.forces_and_tangent(x.copy()))[0]  # type: ignore[misc]
        forces = cpu_seconds(lambda solid=equilibrium.solid, x=positions: solid.forces(x))[0]  # type: ignore[misc]
        factor = cpu_seconds(lambda found=found, system=system: found.factorise(system))[0]  # type: ignore[misc]
        rate = dgemm_rate()
        size: Row = {"order": order, "elements": "x".join(map(str, elements)), "unknowns": len(equilibrium.supports.free)}
        times = {"forces": forces, "tangent": tangent, "factor": factor, "dgemm": rate, "like dgemm": tangent * rate}
        yield {**size, **times, "of the reference": tangent * rate / (seconds * RATE), "of the factors": tangent / factor}
