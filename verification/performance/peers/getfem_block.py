"""The block benchmark with GetFEM: large-sliding contact with friction by raytracing, an augmented Lagrangian, Newton's method.

Run by the interpreter of Debian's python3-getfem. Reads the problem (`block.description`, as JSON) on the standard input; the last line
that it prints is JSON: linear solves of every load step, forces on the top after those that converged, and why it ended early.
"""

from __future__ import annotations

import json
import sys
from typing import Any

import getfem as gf
import numpy as np

#: Regions of each mesh.
HELD, CONTACT = 1, 2
#: Newton iterations after which a load step has failed.
MOST_ITERATIONS = 60
#: Strain energy (theory 1.1) of a displacement.
ENERGY = "A1/2*sqr(log(Det(Id(3)+Grad_{u}))) + A2/2*(pow(Det(Id(3)+Grad_{u}),-2/3)*Norm_sqr(Id(3)+Grad_{u})-3)"
#: Augmentation parameter, about E over a length: it steers the iterations and leaves the solution as it is.
AUGMENTATION = 10.0
#: Distance beyond which nothing touches: less than the thickness of either body.
RELEASE = 0.3


def gauss(points: int) -> Any:
    """Integration on hexahedra with so many Gauss points a direction."""
    return gf.Integ(f"IM_GAUSS_PARALLELEPIPED(3,{2 * points - 1})")


def add_body(model: Any, problem: dict[str, Any], name: str, outward: float) -> dict[str, Any]:
    """Add a body whose contact face looks up (1) or down (-1), its support opposite; the model needs what is returned to stay alive."""
    body = problem[name]
    ticks = [np.linspace(a, b, n + 1) for a, b, n in zip(body["lower"], body["upper"], body["elements"], strict=True)]
    mesh = gf.Mesh("cartesian", *ticks)
    mesh.set_region(CONTACT, mesh.outer_faces_with_direction([0, 0, outward], 0.1))
    mesh.set_region(HELD, mesh.outer_faces_with_direction([0, 0, -outward], 0.1))
    field = gf.MeshFem(mesh, 3)
    field.set_fem(gf.Fem("FEM_QK(3,1)"))
    solid, contact = gf.MeshIm(mesh, gauss(problem["solid_points"])), gf.MeshIm(mesh, gauss(problem["contact_points"]))
    model.add_fem_variable(name, field)
    model.add_fem_data(f"{name}_before", field)
    model.add_nonlinear_term(solid, ENERGY.format(u=name))
    model.add_initialized_data(f"{name}_place", np.zeros(3))
    model.add_Dirichlet_condition_with_multipliers(solid, name, field, HELD, f"{name}_place")
    return {"mesh": mesh, "field": field, "solid": solid, "contact": contact}


def add_contact(model: Any, problem: dict[str, Any], slave: dict[str, Any], master: dict[str, Any]) -> None:
    """Add contact with friction, its multipliers on the slave face."""
    model.add_filtered_fem_variable("multiplier", slave["field"], CONTACT)
    model.add_initialized_data("r", AUGMENTATION)
    model.add_initialized_data("friction", problem["friction"])
    brick = model.add_integral_large_sliding_contact_brick_raytracing("r", RELEASE, "friction")
    model.add_slave_contact_boundary_to_large_sliding_contact_brick(brick, slave["contact"], CONTACT, "slave", "multiplier", "slave_before")
    model.add_master_contact_boundary_to_large_sliding_contact_brick(brick, master["contact"], CONTACT, "master", "master_before")


def march(model: Any, problem: dict[str, Any], top: Any) -> dict[str, Any]:
    """All load steps, as far as they converge."""
    solves: list[int] = []
    forces: list[list[float]] = []
    place = np.zeros(3)
    for stage in problem["stages"]:
        for _ in range(stage["steps"]):
            place = place + np.array(stage["translate"]) / stage["steps"]
            model.set_variable("slave_place", place)
            for name in ("slave", "master"):
                model.set_variable(f"{name}_before", model.variable(name))
            iterations, converged = model.solve("max_res", problem["tolerance"], "max_iter", MOST_ITERATIONS, "lsolver", "mumps")
            solves.append(int(iterations))
            if not converged:
                return {"solves": solves, "forces": forces, "ended": f"Newton's method did not converge in {MOST_ITERATIONS} iterations"}
            # The multiplier of a support is minus the force that it exerts.
            forces.append([-float(f) for f in gf.asm_generic(top, 0, "mult_on_slave", HELD, model)])
    return {"solves": solves, "forces": forces}


def main() -> None:
    """Read, compute, print."""
    problem = json.load(sys.stdin)
    gf.util_trace_level(0)
    model = gf.Model("real")
    model.add_initialized_data("A1", problem["bulk"])
    model.add_initialized_data("A2", problem["shear"])
    slave, master = add_body(model, problem, "slave", -1.0), add_body(model, problem, "master", 1.0)
    add_contact(model, problem, slave, master)
    found = march(model, problem, slave["solid"])
    print(json.dumps({"program": "GetFEM", "version": gf.getfem_env("version"), **found}))


if __name__ == "__main__":
    main()
