"""A body's equations by algebraic multigrid beside its factors: where the first takes less."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from typing import Any

import numpy as np
from performance.problems import System, deformed, solid_system
from scipy import sparse

from isomortar.geometry.patch import FloatArray
from isomortar.harness.bench import Plot, Row, benchmark, cpu_seconds

#: What iterations leave of the right-hand side, and how many there are at most.
TOLERANCE, ITERATIONS = 1e-10, 300
#: Orders and elements along the sides; the third side has half as many.
MESHES = ((2, 8), (2, 12), (2, 16), (2, 24), (2, 32), (3, 8), (3, 12), (3, 16))


@benchmark(
    question="From which size on does multigrid solve a body's equations in less time than its factors take?",
    columns={
        "order": "",
        "elements": "",
        "unknowns": "",
        "set-up": "s",
        "iterations": "",
        "solve": "s",
        "left": "",
        "factor": "s",
        "by factors": "s",
        "of the factors": "",
    },
    plots=tuple(Plot("unknowns", name, "order") for name in ("solve", "factor", "of the factors")),
)
def multigrid(quick: bool) -> Iterator[Row]:
    """The tangent of a deformed block alone, of one order in all directions, without contact, solved once.

    Conjugate gradients with smoothed aggregation of PyAMG, by control points, given the six motions of a rigid body; until 1e-10 of the
    right-hand side is left. `of the factors`: set-up and one solution over a factorisation and one solution. Factors then solve for
    each column of the Schur complement on the faces at little cost; here each would take a solution more.
    """
    for order, side in ((2, 6),) if quick else MESHES:
        elements = (side, side, max(side // 2, 2))
        system = solid_system(order, elements)
        row: Row = {"order": order, "elements": "x".join(map(str, elements)), "unknowns": len(system.right)}
        try:
            library: Any = import_module("pyamg")
        except ImportError as error:
            yield {**row, "note": f"not installed ({error}); pip install pyamg"}
            continue
        iterated, factored = by_multigrid(library, system), by_factors(system)
        whole, other = iterated["set-up"] + iterated["solve"], factored["factor"] + factored["by factors"]
        yield {**row, **iterated, **factored, "of the factors": whole / other}


def by_multigrid(library: Any, system: System) -> dict[str, float]:
    """CPU seconds of set-up and solution, iterations, and what they leave."""
    blocks = sparse.bsr_matrix(system.matrix, blocksize=(3, 3))
    near_null = rigid_motions(deformed(system.equilibrium))[system.equilibrium.supports.free]

    def set_up() -> Any:
        return library.smoothed_aggregation_solver(blocks, B=near_null, strength=("symmetric", {"theta": 0.08}), max_coarse=100)

    levels = set_up()

    def solve(left: list[float]) -> None:
        levels.solve(system.right, tol=TOLERANCE, accel="cg", maxiter=ITERATIONS, residuals=left)

    left: list[float] = []
    solve(left)
    return {
        "set-up": cpu_seconds(set_up)[0],
        "solve": cpu_seconds(lambda: solve([]))[0],
        "iterations": len(left) - 1,
        "left": left[-1] / left[0],
    }


def by_factors(system: System) -> dict[str, float]:
    """CPU seconds of a factorisation and of a solution by it."""
    factors = system.analysed()
    factor = cpu_seconds(lambda: system.factorise(factors))[0]
    return {"factor": factor, "by factors": cpu_seconds(lambda: factors.solve(system.right))[0]}


def rigid_motions(points: FloatArray) -> FloatArray:
    """Three translations and three rotations of points, shape (3 points, 6)."""
    arms = points - points.mean(axis=0)
    axes = np.eye(3)
    motions = [np.broadcast_to(axis, arms.shape) for axis in axes] + [np.cross(axis, arms) for axis in axes]
    return np.stack([motion.ravel() for motion in motions], axis=1)
