"""Norms of forces, by pieces of glued bodies, whatever their size: none vanishes, overflows, or loses a bit."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: Two blocks that are glued, and two that are not.
SCENE = """
format = 1
glue = [["a.w1", "b.w0"]]
bodies.c.geometry = { kind = "box", lower = [5, 0, 0], upper = [6, 1, 1] }
bodies.a.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
bodies.d.geometry = { kind = "box", lower = [7, 0, 0], upper = [8, 1, 1] }
bodies.b.geometry = { kind = "box", lower = [0, 0, 1], upper = [1, 1, 2] }
supports = { a.face = "a.w0", c.face = "c.w0", d.face = "d.w0" }
stages = [{ name = "one", steps = 1 }]
"""
POWERS = (0, -1000, -600, -510, 510, 600, 1000)


@case(
    claim="The norm of forces on a piece is that of its control points, and of forces times a power of two that power times as large.",
    tier="gate",
    bounds={
        "norms": Bound(at_most=1e-15, reason="round-off: a sum of squares"),
        "scaled": Bound(at_most=1e-15, reason="round-off: no bit of a force changes with a power of two"),
    },
)
def norms() -> dict[str, float]:
    """Largest relative differences from norms by NumPy of the forces on each piece, and from those before they were scaled."""
    equilibrium = Simulation(Scene.from_toml(SCENE).problem()).equilibrium
    numbering, measures = equilibrium.numbering, equilibrium.measures
    forces = np.random.default_rng(2).uniform(-1.0, 1.0, numbering.reference.shape)
    own = [np.unique(np.concatenate([numbering.points[body.name] for body in piece])) for piece in numbering.pieces]
    exact = np.array([np.linalg.norm(forces[points]) for points in own])
    found = [np.ldexp(measures.norms(np.ldexp(forces, power)), -power) for power in POWERS]
    return {"norms": float(np.abs(found[0] / exact - 1.0).max()), "scaled": float(np.abs(np.array(found) / exact - 1.0).max())}
