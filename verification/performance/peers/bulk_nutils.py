"""The benchmark `bulk` with nutils: nodal functions or splines, the system that it derives from the energy, its own choice of solver."""

from __future__ import annotations

from typing import Any

import numpy as np
import treelog
from nutils import function, mesh
from nutils.matrix import assemble_csr
from nutils.solver import System
from performance.peers.bulk_work import answer, main, multilinear, seconds


def greville(end: float, elements: int, order: int, smooth: bool) -> Any:
    """Points of a direction at which the values of a linear function are its unknowns."""
    if not smooth:
        return np.linspace(0.0, end, order * elements + 1)
    knots = np.concatenate([np.zeros(order), np.linspace(0.0, end, elements + 1), np.full(order, end)])
    return np.array([knots[i + 1 : i + order + 1].mean() for i in range(elements + order)])


def bulk(problem: dict[str, Any]) -> dict[str, Any]:
    """Assemble and solve."""
    order, smooth = problem["order"], problem["smooth"]
    sizes = list(zip(problem["upper"], problem["elements"], strict=True))
    domain, place = mesh.rectilinear([np.linspace(0.0, end, n + 1) for end, n in sizes])
    ticks = [greville(end, n, order, smooth) for end, n in sizes]
    points = np.stack(np.meshgrid(*ticks, indexing="ij"), axis=-1).reshape(-1, 3)
    direction = multilinear(problem["direction"], points)

    u = domain.field("u", btype="spline" if smooth else "std", degree=order, shape=[3])
    gradient = function.eye(3) + function.grad(u, place)
    j = np.linalg.det(gradient)
    density = problem["bulk"] / 2 * np.log(j) ** 2 + problem["shear"] / 2 * (j ** (-2 / 3) * (gradient**2).sum([0, 1]) - 3)
    system = System(domain.integral(density * function.J(place), degree=2 * problem["points"] - 1), trial="u")
    state = {"u": multilinear(problem["state"], points)}
    assembled: list[Any] = []
    assembly = seconds(lambda: assembled.append(system.assemble_jacobian_residual(state)))
    matrix, forces = assembled[-1][:2]

    free = np.repeat(points[:, 2] < problem["upper"][2] - 1e-9, 3)
    correction = np.zeros(forces.size)
    values, columns, rows = matrix.submatrix(free, free).export("csr")

    def newton() -> None:
        # The matrix is made anew each time: nutils keeps the factors of one.
        correction[free] = assemble_csr(values, rows, columns, int(free.sum())).solve(forces[free])

    solve = seconds(newton)
    vectors = {"forces": forces, "action": matrix @ direction.ravel(), "correction": correction}
    return answer(assembly, solve, direction, {name: v.reshape(-1, 3) for name, v in vectors.items()}, None if smooth else points)


if __name__ == "__main__":
    with treelog.set(treelog.FilterLog(treelog.StderrLog(), minlevel=treelog.proto.Level.error)):
        main(bulk)
