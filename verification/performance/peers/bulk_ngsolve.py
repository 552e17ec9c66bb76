"""The benchmark `bulk` with NGSolve: its hierarchical functions, the energy as a variation, its own choice of solver."""

from __future__ import annotations

from typing import Any

import numpy as np
from ngsolve import (
    ET,
    BilinearForm,
    CoefficientFunction,
    Det,
    Grad,
    GridFunction,
    Id,
    InnerProduct,
    IntegrationRule,
    Variation,
    VectorH1,
    dx,
    log,
    x,
    y,
    z,
)
from ngsolve.meshes import MakeStructured3DMesh
from performance.peers.bulk_work import answer, main, seconds


def bulk(problem: dict[str, Any]) -> dict[str, Any]:
    """Assemble and solve."""
    upper, (nx, ny, nz) = problem["upper"], problem["elements"]
    mesh = MakeStructured3DMesh(hexes=True, nx=nx, ny=ny, nz=nz, mapping=lambda a, b, c: (upper[0] * a, upper[1] * b, upper[2] * c))
    space = VectorH1(mesh, order=problem["order"], dirichlet="top")
    u = space.TrialFunction()
    gradient = Id(3) + Grad(u)
    j = Det(gradient)
    density = problem["bulk"] / 2 * log(j) ** 2 + problem["shear"] / 2 * (j ** (-2 / 3) * InnerProduct(gradient, gradient) - 3)
    rule = IntegrationRule(ET.HEX, 2 * problem["points"] - 1)
    form = BilinearForm(space, symmetric=True)
    form += Variation(density.Compile() * dx(intrules={ET.HEX: rule}))

    monomials = CoefficientFunction((x, y, z, x * y, y * z, z * x, x * y * z))
    fields = {}
    for name in ("state", "direction"):
        rows = [sum(c * monomials[k] for k, c in enumerate(row)) for row in problem[name]]
        fields[name] = GridFunction(space)
        fields[name].Set(CoefficientFunction(tuple(rows)))
    state, direction = fields["state"].vec, fields["direction"].vec
    forces, action, correction = (state.CreateVector() for _ in range(3))

    def assemble() -> None:
        form.Apply(state, forces)
        form.AssembleLinearization(state)

    def solve() -> None:
        correction.data = form.mat.Inverse(space.FreeDofs()) * forces

    spent = seconds(assemble), seconds(solve)
    action.data = form.mat * direction
    vectors = {"forces": forces, "action": action, "correction": correction}
    arrays = {name: v.FV().NumPy().reshape(3, -1).T for name, v in vectors.items()}
    points = np.array([v.point for v in mesh.vertices]) if problem["order"] == 1 else None
    return answer(*spent, direction.FV().NumPy().reshape(3, -1).T, arrays, points)


if __name__ == "__main__":
    main(bulk)
