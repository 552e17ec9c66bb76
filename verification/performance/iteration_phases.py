"""What a Newton iteration costs: by phase, and against the number of unknowns."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

from performance.problems import Phases, phases, problem

from isomortar.harness.bench import Plot, Row, benchmark

PHASES = ("solid", "projection", "contact", "factor", "solve", "other", "total")
#: Load steps of the ironing scene: it is pressed for 10, then dragged.
STEPS = 25

_MILLISECONDS = dict.fromkeys(PHASES, "ms")


def milliseconds(found: Phases) -> dict[str, float]:
    """Milliseconds per tangent, by phase and in total."""
    return {phase: 1e3 * found.seconds[phase] / found.tangents for phase in PHASES}


@benchmark(
    question="What does a Newton iteration of a contact problem cost, and which part of it?",
    columns={"kind": "", "unknowns": "", **_MILLISECONDS, "contact share": "%", "Python share": "%", "tangents": ""},
    plots=(Plot("unknowns", "total"),),
    limits={
        "contact share": (25.0, "projection, contact forces and contact tangent are to cost little beside solid and factors"),
        "Python share": (5.0, "what stands in Python is to cost nothing that one would notice"),
    },
)
def iteration_phases(quick: bool) -> Iterator[Row]:
    """The ironing scene, master of order 1 to 5 along the drag; milliseconds of CPU time per tangent.

    Iterations by kept factors count to the tangent before them. `other` is what no phase of the kernel accounts for: Python, and the
    patterns of the contact. The contact share is that of projection and contact together.
    """
    for kind in ("N2",) if quick else ("N2", "N3", "N4", "N5"):
        found = phases(problem("iron", kind, (6, 3, 2) if quick else None), 2 if quick else STEPS)
        part = {phase: 100.0 * seconds / found.seconds["total"] for phase, seconds in found.seconds.items()}
        shares = {"contact share": part["projection"] + part["contact"], "Python share": part["other"]}
        yield {"kind": kind, "unknowns": found.unknowns, **milliseconds(found), **shares, "tangents": found.tangents}


@benchmark(
    question="How does the cost of an iteration grow with unknowns and order?",
    columns={"kind": "", "elements": "", "unknowns": "", **_MILLISECONDS, "tangents": ""},
    plots=tuple(Plot("unknowns", phase, "kind") for phase in ("total", "solid", "factor", "contact")),
)
def cost_of_unknowns(quick: bool) -> Iterator[Row]:
    """The first load step of the press, orders 1 to 5 along the contact on several meshes; milliseconds of CPU time per tangent."""
    meshes = ((4, 4, 2), (6, 6, 3), (8, 8, 4), (12, 12, 6))
    for kind, mesh in product(("N1", "N2") if quick else ("N1", "N2", "N3", "N4", "N5"), meshes[:1] if quick else meshes):
        found = phases(problem("press", kind, mesh), 1)
        size: Row = {"elements": "x".join(map(str, mesh)), "unknowns": found.unknowns}
        yield {"kind": kind, **size, **milliseconds(found), "tangents": found.tangents}
