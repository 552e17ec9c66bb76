"""The benchmark `bulk` with GetFEM: the energy as a nonlinear term of a model, the free unknowns' system by MUMPS."""

from __future__ import annotations

from typing import Any

import getfem as gf
import numpy as np
from performance.peers.bulk_work import answer, main, multilinear, seconds

#: Strain energy (theory 1.1).
ENERGY = "A1/2*sqr(log(Det(Id(3)+Grad_u))) + A2/2*(pow(Det(Id(3)+Grad_u),-2/3)*Norm_sqr(Id(3)+Grad_u)-3)"


def bulk(problem: dict[str, Any]) -> dict[str, Any]:
    """Assemble and solve."""
    gf.util_trace_level(0)
    ticks = [np.linspace(0.0, end, n + 1) for end, n in zip(problem["upper"], problem["elements"], strict=True)]
    mesh = gf.Mesh("cartesian", *ticks)
    field = gf.MeshFem(mesh, 3)
    field.set_fem(gf.Fem(f"FEM_QK(3,{problem['order']})"))
    integration = gf.MeshIm(mesh, gf.Integ(f"IM_GAUSS_PARALLELEPIPED(3,{2 * problem['points'] - 1})"))
    points = field.basic_dof_nodes().T[::3]
    direction = multilinear(problem["direction"], points)

    model = gf.Model("real")
    model.add_fem_variable("u", field)
    model.set_variable("u", multilinear(problem["state"], points).ravel())
    model.add_initialized_data("A1", problem["bulk"])
    model.add_initialized_data("A2", problem["shear"])
    model.add_nonlinear_term(integration, ENERGY)
    assembly = seconds(model.assembly)
    matrix, forces = model.tangent_matrix(), -model.rhs()

    free = np.flatnonzero(np.repeat(points[:, 2] < problem["upper"][2] - 1e-9, 3))
    within = gf.Spmat("copy", matrix, free, free)
    correction = np.zeros(forces.size)
    solve = seconds(lambda: np.put(correction, free, gf.linsolve_mumps(within, forces[free])))
    vectors = {"forces": forces, "action": matrix.mult(direction.ravel()), "correction": correction}
    return answer(assembly, solve, direction, {name: v.reshape(-1, 3) for name, v in vectors.items()}, points)


if __name__ == "__main__":
    main(bulk)
