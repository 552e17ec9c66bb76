"""A scene that is sound, and what makes its load step one that is given up."""

from __future__ import annotations

from typing import Any

from isomortar.errors import ConvergenceError
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.told.after.causes import causes

SCENE = """
format = 1
[materials]
soft = { young = SOFT, poisson = POISSON }
hard = { young = HARD, poisson = 0.3 }
[bodies.upper]
material = "hard"
geometry = { kind = "box", lower = [0, 0, 1], upper = [1, 1, TOP] }
mesh = { order = [2, 2, 1], elements = [SLAVE, SLAVE, 1] }
[bodies.lower]
material = "soft"
geometry = { kind = "box", lower = [0, 0, 0], upper = [WIDE, 1, 1] }
mesh = { order = [2, 2, 1], elements = [MASTER, MASTER, 1] }
[contacts.c]
slave = "upper.w0"
master = "lower.w1"
quadrature = POINTS
elastic_slip = SLIP
[supports]
top = { face = "upper.w1" }
floor = { face = "lower.w0" }
[solver]
method = "METHOD"
penalty_normal = PENALTY
[[stages]]
name = "press"
steps = 1
motions.top.translate = [0, 0, -0.1]
"""
SOUND: dict[str, Any] = {
    "SOFT": 10, "POISSON": 0.3, "HARD": 10, "TOP": 2, "SLAVE": 2, "MASTER": 2, "METHOD": "monolithic", "PENALTY": 100,
    "POINTS": 6, "SLIP": 0, "WIDE": 1,
}  # fmt: skip


def scene(**changes: Any) -> Simulation:
    """The scene with some of its numbers changed."""
    text = SCENE
    for name, value in (SOUND | changes).items():
        text = text.replace(name, str(value))
    return Simulation(Scene.from_toml(text).problem())


def said(simulation: Simulation, error: Exception | None = None) -> list[str]:
    """What is said of a load step that is given up by an error."""
    return list(causes(simulation.equilibrium, simulation.state, error or ConvergenceError("")))
