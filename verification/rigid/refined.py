"""Rigid masters on other meshes of the same shape: knots and orders that change nothing of it change no force."""

from __future__ import annotations

import functools

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A block on a rigid body, pressed and dragged with friction, by points of its own that no line of the master cuts.
SCENE = """
format = 1
bodies.block.geometry = { kind = "box", lower = [-0.4, -0.3, 0.6], upper = [0.4, 0.3, 1] }
bodies.block.mesh.elements = [6, 4, 2]
bodies.rigid = { geometry = SHAPE, mesh = MESH, rigid = true }
contacts.c = { slave = "block.w0", master = "rigid.v1", friction = 0.3, quadrature = 4, subcells = 0 }
supports.top.face = "block.w1"
solver = { newton_tolerance = 1e-12, complementarity_tolerance = 1e-11 }
[[stages]]
name = "press"
steps = 2
motions.top.translate = [0, 0, -0.06]
[[stages]]
name = "drag"
steps = 3
motions.top.translate = [0.09, 0.04, 0]
"""
SHAPES = {
    "cylinder": '{ kind = "ring", inner = 0.3, outer = 0.6, width = 1.4 }',
    "ball": '{ kind = "sphere", outer = 0.6, axis = "y" }',
    "torus": '{ kind = "torus", radius = 0.35, outer = 0.2, centre = [0, 0, 0.4] }',
}
#: The coarsest that have no friction beside a pole, and others.
MESHES = {
    "coarse": "{ order = 2, elements = [4, 1, 4] }",
    "finer": "{ order = 2, elements = [8, 1, 12] }",
    "graded": "{ order = 2, elements = [8, 1, 8], grading = [3, 1, 0.5] }",
    "higher": "{ order = [5, 2, 3], elements = [4, 1, 4] }",
}


@functools.cache
def found(shape: str, mesh: str) -> FloatArray:
    """Forces on the block and work of friction by load step, shape (steps, 4)."""
    problem = Scene.from_toml(SCENE.replace("SHAPE", SHAPES[shape]).replace("MESH", MESHES[mesh])).problem()
    return np.array([[*result.contacts[0].force_slave, result.contacts[0].friction_work] for result in Simulation(problem).run()])


@case(
    claim="Knots of a rigid master that change nothing of its shape change no force and no work of friction, nor do higher orders.",
    tier="gate",
    grid={"shape": tuple(SHAPES), "mesh": tuple(mesh for mesh in MESHES if mesh != "coarse")},
    bounds={
        "forces": Bound(at_most=1e-11, reason="round-off: points lie where they did; forces are in balance to Newton's 1e-12"),
        "work": Bound(at_most=1e-10, reason="round-off: of tractions times slips"),
    },
)
def refined(shape: str, mesh: str) -> dict[str, float]:
    """Largest change of each over its largest value."""
    coarse, fine = found(shape, "coarse"), found(shape, mesh)
    change, size = np.abs(fine - coarse), np.abs(coarse)
    return {"forces": float(change[:, :3].max() / size[:, :3].max()), "work": float(change[:, 3].max() / size[:, 3].max())}
