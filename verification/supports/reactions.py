"""What supports report where they share control points with one another and with a contact face."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from small_scenes import TIGHT

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene

_BLOCK = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 0.8, 0.6] }, mesh = { order = [2, 2, 2], elements = [2, 2, 2] } }
"""
_PLANE = 'contacts.floor = { slave = "block.w0", plane = { point = [0, 0, 0] }, friction = FRICTION }'
_DOWN = "{ translate = [0.05, 0, -0.1] }"
_TURN = "{ translate = [0.1, 0, 0.05], rotate = 10 }"
_CENTRE = "centre = [0.5, 0.4, 0.1], axis = [1, 2, 3]"
#: Supports that share edges and corners with one another and with the contact face; one face, with the same components and others; three
#: faces that meet at a corner.
SCENES = {
    "edges": f"""
        {_PLANE.replace("FRICTION", "0.0")}
        supports.top = {{ face = "block.w1", components = ["z"] }}
        supports.west = {{ face = "block.u0", components = ["x"] }}
        supports.east = {{ face = "block.u1", components = ["x"] }}
        supports.south = {{ face = "block.v0", components = ["y"] }}
        supports.north = {{ face = "block.v1", components = ["y"] }}
        stages = [{{ name = "press", steps = 2, motions.top = {_DOWN} }}]
    """,
    "one face": f"""
        {_PLANE.replace("FRICTION", "0.3")}
        supports.aside = {{ face = "block.w1", components = ["x", "y"] }}
        supports.down = {{ face = "block.w1", components = ["z"], {_CENTRE} }}
        supports.again = {{ face = "block.w1", components = ["x", "z"] }}
        stages = [{{ name = "press", steps = 2, motions = {{ aside = {_DOWN}, down = {_DOWN}, again = {_DOWN} }} }}]
    """,
    "corner": f"""
        supports.west = {{ face = "block.u0", components = ["x", "y"] }}
        supports.south = {{ face = "block.v0", components = ["x", "y"] }}
        supports.base = {{ face = "block.w0" }}
        supports.top = {{ face = "block.w1", components = ["z"], {_CENTRE} }}
        stages = [{{ name = "turn", steps = 2, motions.top = {_TURN} }}]
    """,
}
_BALANCE = "theory: the forces on all control points are in balance, those on free ones to 1e-12 of the internal forces"


def problem(scene: str) -> Problem:
    """A scene of SCENES at tight tolerances."""
    found = Scene.from_toml(_BLOCK + SCENES[scene]).problem()
    return replace(found, settings=replace(found.settings, **TIGHT))  # type: ignore[arg-type]


@case(
    claim="Supports report the forces of the components that they prescribe, each of them once: with contact they are in balance.",
    tier="gate",
    grid={"scene": tuple(SCENES)},
    bounds={
        "force": Bound(at_most=1e-11, reason=_BALANCE),
        "moment": Bound(at_most=1e-11, reason=_BALANCE),
        "stray": Bound(at_most=0.0, reason="definition: a support exerts no force along a component that it leaves free"),
        "smallest": Bound(at_least=0.01, reason="definition: what shares control points is tested only where it bears a load"),
    },
)
def balance(scene: str) -> dict[str, float]:
    """Sum of the support forces and the contact forces, and of their moments about the origin, over the largest force.

    Then the largest force along a component that is not prescribed, and the smallest force of a support over the largest.
    """
    found = problem(scene)
    result = list(Simulation(found).run())[-1]
    forces = np.array([reaction.force for reaction in result.reactions])
    moments = np.array([reaction.moment + np.cross(reaction.centre, reaction.force) for reaction in result.reactions])
    free = np.array([[component not in support.components for component in range(3)] for support in found.supports])
    sizes = np.linalg.norm(forces, axis=1)
    borne = sum((np.stack([c.force_slave + c.force_master, c.moment_slave + c.moment_master]) for c in result.contacts), np.zeros((2, 3)))
    return {
        "force": float(np.linalg.norm(forces.sum(axis=0) + borne[0]) / sizes.max()),
        "moment": float(np.linalg.norm(moments.sum(axis=0) + borne[1]) / sizes.max()),
        "stray": float(np.abs(forces[free]).max(initial=0.0)),
        "smallest": float(sizes.min() / sizes.max()),
    }
