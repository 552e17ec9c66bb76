"""Parts of a block that a force presses: of what is given and told of the whole a half has a half, and a quarter a quarter."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A block that a plate presses on a rough floor, where it bulges and slides outwards. Its functions may have a kink at each plane.
SCENE = """
format = 1
PLANES
materials.m = { young = 10, poisson = 0.4 }
bodies.block = { geometry = { kind = "box", lower = [-1, -1, 0], upper = [1, 1, 1] }, mesh = { order = 1, elements = [4, 4, 2] } }
contacts.floor = { slave = "block.w0", friction = 0.1, plane = {} }
supports.top = { face = "block.w1", components = ["x", "y"], force.z = -4 }
stages = [{ name = "press", steps = 2 }]
solver = { newton_tolerance = 1e-12, complementarity_tolerance = 1e-12 }
"""
PARTS = {"half": "symmetry = { x = 0 }", "quarter": "symmetry = { x = 0, y = 0 }"}


def pressed(planes: str) -> np.ndarray:
    """How far the plate goes down, the force that it exerts, and the work of friction, by load steps, shape (steps, 3)."""
    simulation, found = Simulation(Scene.from_toml(SCENE.replace("PLANES", planes)).problem()), []
    for result in simulation.run():
        top = float(result.state.positions[:, 2].max())
        found.append((top - 1.0, result.reactions[0].force[2], result.contacts[0].friction_work))
    return np.array(found)


@case(
    claim="A half and a quarter of a block that a force presses go down as the whole does, and tell its force and its work of friction.",
    tier="gate",
    grid={"part": tuple(PARTS)},
    bounds={
        "off": Bound(at_most=1e-8, reason="theory: the same equations by symmetry; Newton's method stops at 1e-12"),
        "work": Bound(at_least=1e-3, reason="definition: something slides"),
    },
)
def pressed_parts(part: str) -> dict[str, float]:
    """Largest error over the largest value of each."""
    found, whole = pressed(PARTS[part]), pressed("")
    return {"off": float(np.max(np.abs(found - whole).max(axis=0) / np.abs(whole).max(axis=0))), "work": float(whole[-1, 2])}
