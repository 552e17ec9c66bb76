"""Factors of isomortar's matrices by its own solver and by others."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from performance.problems import System, last_system, problem, solid_system
from performance.solvers import SOLVERS, Solver

from isomortar.harness.bench import ASIDE, Row, benchmark, cpu_seconds


@dataclass(frozen=True)
class Times:
    """CPU seconds of the three phases, and the backward error of the solution."""

    analysis: float
    factor: float
    solve: float
    residual: float


@benchmark(
    question="Are isomortar's systems factorised as fast as the solvers allow that a person would take instead?",
    columns={
        "matrix": "",
        "program": "",
        "unknowns": "",
        "zero diagonals": "",
        "analysis": "s",
        "factor": "s",
        "solve": "s",
        "residual": "",
        "isomortar takes": "",
    },
    limits={"isomortar takes": (1.2, "isomortar's time for the factors over this program's: at most a fifth slower than the fastest")},
)
def factorisation(quick: bool) -> Iterator[Row]:
    """Systems as Newton's method has them, all taken to each program in the same process: CPU seconds to order, factorise, solve.

    Solid: the tangent of a deformed block alone, symmetric and definite; programs that know of that are told. The others carry the
    multipliers of the contact: isomortar factorises these as it does in a run, by parts or as a whole, and gathers them in that time;
    other programs are given the whole matrix. The residual is the backward error: the largest |A x - b| of a row over its
    |A| |x| + |b|. One ordering serves all load steps with the same contact, one factorisation a Newton iteration. SuperLU orders anew
    within each factorisation.
    """
    for name, made in (quick_systems() if quick else systems()).items():
        system = made()
        zeros = int(np.sum(system.matrix.diagonal() == 0.0))
        own: float | None = None
        for kind in (solver for solver in SOLVERS if solver.applies(system)):
            row = {"matrix": name, "program": kind.name, "unknowns": system.matrix.shape[0], "zero diagonals": zeros}
            try:
                times = measure(kind(system), system)
            except ImportError as error:
                yield {**row, "note": f"not installed ({error}); {kind.install}"}
                continue
            share: float | str = ASIDE if own is None else own / times.factor
            own = times.factor if own is None else own
            yield {**row, **vars(times), "isomortar takes": share}


def measure(solver: Solver, system: System) -> Times:
    """Time a solver on its system; the first factorisation, which allocates, is among the three."""
    matrix, right = system.matrix, system.right
    analysis, factor = cpu_seconds(solver.analyse)[0], cpu_seconds(solver.factorise)[0]
    solve = cpu_seconds(lambda: solver.solve(right))[0]
    x = solver.solve(right)
    sizes = abs(matrix) @ np.abs(x) + np.abs(right)
    return Times(analysis, factor, solve, float(np.max(np.abs(matrix @ x - right) / np.where(sizes > 0.0, sizes, 1.0))))


def systems() -> dict[str, Callable[[], System]]:
    """The matrices by name, each made when it is its turn."""
    tangents = {f"solid N{order} 12x12x6": lambda order=order: solid_system(order, (12, 12, 6)) for order in (2, 3, 4, 5)}
    contacts = {
        "twist N3": lambda: last_system(problem("twist", "N3"), 6),
        "iron N5": lambda: last_system(problem("iron", "N5"), 6),
        "press N2 12x12x6": lambda: last_system(problem("press", "N2", (12, 12, 6)), 2),
        "press N2 24x24x6": lambda: last_system(problem("press", "N2", (24, 24, 6)), 1),
    }
    return {**tangents, **contacts}


def quick_systems() -> dict[str, Callable[[], System]]:
    """One small matrix of either kind."""
    press = problem("press", "N2", (4, 4, 2))
    return {"solid N2 3x3x2": lambda: solid_system(2, (3, 3, 2)), "press N2 4x4x2": lambda: last_system(press, 1)}
