"""What GetFEM does with a problem: ``python3 -I getfem_job.py PROBLEM.json``, with an interpreter that finds the module getfem.

Needs nothing else but NumPy. Prints a line of JSON a load step: linear solves, whether it converged, and if so displacements of all
nodes, the forces that hold the prescribed unknowns in their place, and where they are asked for the works of contact.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import getfem as gf
import numpy as np

#: GetFEM's numbers of the faces of a product of three lines: at the end of each direction, then at its beginning.
FACES = {"u1": 0, "u0": 1, "v1": 2, "v0": 3, "w1": 4, "w0": 5}
#: Unknowns below which factors are dense: MUMPS estimates its memory by shares of the matrix, and of a small one that may be too little.
SMALL = 1000
#: Number of the region of the first load: those of contacts are lower.
FIRST_LOAD = 1000
#: Gap below which faces touch at the start, over the largest one at which they can.
TOUCH = 1e-9


def product(kind: str, parts: list[str]) -> str:
    """GetFEM's name of a tensor product of three directions."""
    u, v, w = parts
    return f"{kind}_PRODUCT({kind}_PRODUCT({u},{v}),{w})"


def gauss(points: list[int]) -> Any:
    """Integration on hexahedra with so many Gauss points by direction."""
    return gf.Integ(product("IM", [f"IM_GAUSS1D({2 * count - 1})" for count in points]))


def displacement(orders: list[int], cells: list[int], elements: Any) -> str:
    """A displacement with its own nodes, as GetFEM reads it: where it counts nodes itself, some that are close may become one."""
    kind = product("FEM", [f"FEM_PK(1,{order})" for order in orders])
    kinds = [f"CONVEX {cell} '{kind}'" for cell in cells]
    nodes = [f"{cell}: {' '.join(map(str, 3 * element))}" for cell, element in zip(cells, elements, strict=True)]
    lines = ["BEGIN MESH_FEM", "QDIM 3", *kinds, "BEGIN DOF_ENUMERATION", *nodes, "END DOF_ENUMERATION", "END MESH_FEM"]
    return "\n".join(lines)


class MeshedBody:
    """A body of the model: its mesh, its displacement, and where GetFEM's degrees of freedom stand among all nodes."""

    def __init__(self, model: Any, number: int, told: dict[str, Any], nodes: Any) -> None:
        self.variable = f"u_{number}"
        self.mesh = gf.Mesh("empty", 3)
        shape = gf.GeoTrans(product("GT", [f"GT_PK(1,{order})" for order in told["orders"]]))
        cells = [int(self.mesh.add_convex(shape, nodes[element].T)[0]) for element in told["elements"]]
        self.cells = cells
        elements = np.array(told["elements"])
        #: Number among all nodes of each of this body's.
        self.node = np.unique(elements)
        self.field = gf.MeshFem("from string", displacement(told["orders"], cells, np.searchsorted(self.node, elements)), self.mesh)
        self.solid = gf.MeshIm(self.mesh, gauss(told["gauss"]))
        model.add_fem_variable(self.variable, self.field)
        model.add_fem_data(f"{self.variable}_before", self.field)
        model.add_initialized_data(f"A1_{number}", told["bulk"])
        model.add_initialized_data(f"A2_{number}", told["shear"])
        model.add_nonlinear_term(self.solid, told["energy"])

    @property
    def unknowns(self) -> Any:
        """Number among all unknowns, 3 * node + component, of each degree of freedom."""
        return (3 * self.node[:, None] + np.arange(3)).ravel()

    def region(self, number: int, side: dict[str, Any]) -> int:
        """Make a face a region of that number."""
        cells = [self.cells[element] for element in side["elements"]]
        self.mesh.set_region(number, np.array([cells, [FACES[side["face"]]] * len(cells)]))
        return number


class HeldUnknowns:
    """The prescribed unknowns of a body, by a multiplier each: minus the force that the support exerts."""

    def __init__(self, model: Any, body: MeshedBody, prescribed: Any) -> None:
        self.model, self.multiplier = model, f"held_{body.variable}"
        unknowns = body.unknowns
        own = np.flatnonzero(np.isin(unknowns, prescribed))
        #: Where they stand among all that is prescribed.
        self.places = np.searchsorted(prescribed, unknowns[own])
        if len(own):
            picks = gf.Spmat("empty", len(own), len(unknowns))
            picks.add(np.arange(len(own)), own, gf.Spmat("identity", len(own)))
            model.add_variable(self.multiplier, len(own))
            self.brick = model.add_constraint_with_multipliers(body.variable, self.multiplier, picks, np.zeros(len(own)))

    def put(self, displacements: Any) -> None:
        """Prescribe displacements."""
        if len(self.places):
            self.model.set_private_rhs(self.brick, displacements[self.places])

    def forces(self, forces: Any) -> None:
        """Write the forces that the supports exert to where they belong."""
        if len(self.places):
            forces[self.places] = -self.model.variable(self.multiplier)


class TouchingFaces:
    """Contact with friction of the model, its multipliers on the slave face: forces on the slave by reference area."""

    def __init__(self, model: Any, number: int, told: dict[str, Any], contact: dict[str, Any], bodies: list[MeshedBody]) -> None:
        slave, master = (bodies[side["body"]] for side in contact["sides"])
        # Regions of one mesh must differ: each side of each contact has a number of its own.
        sides = enumerate(zip((slave, master), contact["sides"], strict=True), 2 * number + 1)
        faces = [body.region(region, side) for region, (body, side) in sides]
        #: Kept, as the model needs them alive.
        self.rules = [gf.MeshIm(body.mesh, gauss(side["gauss"])) for body, side in zip((slave, master), contact["sides"], strict=True)]
        self.model, self.face, self.slave, self.master, self.multiplier = model, faces[0], slave, master, f"multiplier_{number}"
        friction = f"friction_{number}"
        model.add_filtered_fem_variable(self.multiplier, slave.field, faces[0])
        model.add_fem_data(f"{self.multiplier}_before", model.mesh_fem_of_variable(self.multiplier))
        model.add_initialized_data(friction, contact["friction"])
        model.add_initialized_data(f"r_{number}", told["augmentation"])
        brick = model.add_integral_large_sliding_contact_brick_raytracing(f"r_{number}", told["release"], friction)
        ends = (slave.variable, self.multiplier, f"{slave.variable}_before")
        model.add_slave_contact_boundary_to_large_sliding_contact_brick(brick, self.rules[0], faces[0], *ends)
        model.add_master_contact_boundary_to_large_sliding_contact_brick(
            brick, self.rules[1], faces[1], master.variable, f"{master.variable}_before"
        )
        self.rays = model.transformation_name_of_large_sliding_contact_brick(brick)

    def begin(self) -> None:
        """Begin a load step: multipliers of the last one are those before."""
        self.model.set_variable(f"{self.multiplier}_before", self.model.variable(self.multiplier))

    def press(self, traction: float) -> None:
        """Guess that all presses a little: what touches without any traction counts as open, and nothing else may hold a body."""
        normals = self.model.interpolation("Normal", self.slave.field, self.face)
        field = self.model.mesh_fem_of_variable(self.multiplier)
        self.model.set_variable(self.multiplier, -traction * field.reduce_vector(normals))

    def works(self) -> tuple[float, float]:
        """Friction work of a load step, and spurious work of points that press at both ends of it (theory 3.31).

        A slave point goes past the master's along its own normal, too, where that is not the master's: with rays of the end it climbs on
        the faces as they were, with those of the start on the faces as they are now. Of both together the slave's own dent makes none.
        """
        slave, master, force = self.slave.variable, self.master.variable, self.multiplier
        past = f"({slave}-{slave}_before-Interpolate({master},{self.rays})+Interpolate({master}_before,{self.rays}))"
        normal = f"Normalized(Inv(Id(3)+Grad_{slave}')*Normal)"
        climb, after, before = (f"({vector}.{normal})" for vector in (past, force, f"{force}_before"))
        pressing = f"(1-Heaviside({after}))*(1-Heaviside({before}))"
        mean = f"-0.25*({after}+{before})*{pressing}*{climb}"
        friction, spurious = self._integral(f"{after}*{climb}-{force}.{past}"), self._integral(mean)
        self._exchange()
        spurious -= self._integral(mean)
        self._exchange()
        return friction, spurious

    def _exchange(self) -> None:
        """Exchange the start and the end of the load step."""
        for name in (self.slave.variable, self.master.variable, self.multiplier):
            after, before = (self.model.variable(f"{name}{end}").copy() for end in ("", "_before"))
            self.model.set_variable(name, before)
            self.model.set_variable(f"{name}_before", after)

    def _integral(self, term: str) -> float:
        """Over the slave's face, where rays meet the master."""
        text = f"Interpolate_filter({self.rays},{term},1)"
        return float(gf.asm_generic(self.rules[0], 0, text, self.face, self.model))


class PressedFace:
    """A pressure on a face, along its current normal."""

    def __init__(self, model: Any, number: int, load: dict[str, Any], bodies: list[MeshedBody]) -> None:
        body = bodies[load["body"]]
        self.model, self.size = model, f"pressure_{number}"
        model.add_initialized_data(self.size, 0.0)
        gradient = f"(Id(3)+Grad_{body.variable})"
        term = f"{self.size}*Det{gradient}*(Inv{gradient}'*Normal).Test_{body.variable}"
        # Regions of contacts come before.
        model.add_nonlinear_term(body.solid, term, body.region(FIRST_LOAD + number, load))

    def put(self, size: float) -> None:
        """Prescribe its size."""
        self.model.set_variable(self.size, size)


def main(path: str) -> None:
    """Read, compute, print."""
    told = json.loads(Path(path).read_text())
    nodes, prescribed = np.array(told["nodes"]), np.array(told["prescribed"])
    gf.util_trace_level(0)
    model = gf.Model("real")
    bodies = [MeshedBody(model, number, body, nodes) for number, body in enumerate(told["bodies"])]
    held = [HeldUnknowns(model, body, prescribed) for body in bodies]
    contacts = [TouchingFaces(model, number, told, contact, bodies) for number, contact in enumerate(told["contacts"])]
    loads = [PressedFace(model, number, load, bodies) for number, load in enumerate(told["loads"])]
    solver = "dense_lu" if model.nbdof() < SMALL else "mumps"
    for step, (wanted, sizes) in enumerate(zip(np.array(told["displacements"]), told["pressures"], strict=True)):
        for body, support in zip(bodies, held, strict=True):
            support.put(wanted)
            model.set_variable(f"{body.variable}_before", model.variable(body.variable))
        for contact in contacts:
            contact.begin()
            if step == 0 and loads:
                contact.press(TOUCH * told["augmentation"] * told["release"])
        for load, size in zip(loads, sizes, strict=True):
            load.put(size)
        solves, converged = model.solve("max_res", told["tolerance"], "max_iter", told["iterations"], "lsolver", solver)
        found = _found(model, bodies, held, nodes) if converged else {}
        if converged and told["works"]:
            found |= _works(contacts)
        print(json.dumps({"solves": int(solves), "converged": bool(converged), **found}))
        if not converged:
            break


def _found(model: Any, bodies: list[MeshedBody], held: list[HeldUnknowns], nodes: Any) -> dict[str, Any]:
    """Displacements of all nodes, and the forces of what is prescribed."""
    displacements = np.zeros(nodes.size)
    for body in bodies:
        displacements[body.unknowns] = model.variable(body.variable)
    forces = np.zeros(sum(len(support.places) for support in held))
    for support in held:
        support.forces(forces)
    return {"displacements": displacements.tolist(), "forces": forces.tolist()}


def _works(contacts: list[TouchingFaces]) -> dict[str, float]:
    """The works of all contacts."""
    friction, spurious = np.sum([contact.works() for contact in contacts], axis=0).tolist() if contacts else (0.0, 0.0)
    return {"friction": friction, "spurious": spurious}


if __name__ == "__main__":
    main(sys.argv[1])
