"""Interfaces that carry next to no traction: all that friction has to do there is round-off, and must not stop a run."""

from __future__ import annotations

from typing import Any

import numpy as np

from isomortar.errors import ConvergenceError
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

YOUNG, SIDE, HEIGHT = 10.0, 1.0, 2.0

#: Two halves of a column, one on the other. Without lateral strain nothing pulls at the interface, and the sums of forces are Hooke's.
_COLUMN = """
format = 1
name = "column"
materials.cork = {{ young = 10.0, poisson = 0.0 }}
solver = {{ method = "{method}", augmentation_tolerance = 1e-6, max_cuts = 0 }}

[bodies.slave]
geometry = {{ kind = "box", lower = [-0.5, -0.5, 0], upper = [0.5, 0.5, 1] }}
mesh.elements = [3, 3, 2]

[bodies.master]
geometry = {{ kind = "box", lower = [-0.5, -0.5, -1], upper = [0.5, 0.5, 0] }}
mesh.elements = [2, 2, 2]

[contacts.interface]
slave = "slave.w0"
master = "master.w1"
friction = {friction}

[supports]
top.face = "slave.w1"
base.face = "master.w0"
"""


def _force(scene: str, stages: list[dict[str, Any]]) -> dict[str, float]:
    """The force that presses at the end over Hooke's, and the load steps that were reached."""
    problem = Scene.from_toml(scene + "".join(_stage(**stage) for stage in stages)).problem()
    results: list[StepResult] = []
    try:
        results.extend(Simulation(problem).run())
    except ConvergenceError:
        return {"off": np.inf, "got there": 0.0}
    hooke = -sum(stage["by"][2] for stage in stages) / HEIGHT * YOUNG * SIDE**2
    return {"off": abs(-results[-1].reactions[0].force[2] / hooke - 1.0), "got there": 1.0}


def _stage(name: str, by: tuple[float, float, float], steps: int = 1) -> str:
    return f'\n[[stages]]\nname = "{name}"\nsteps = {steps}\nmotions.top.translate = {list(by)}\n'


BOUNDS = {
    "off": Bound(at_most=1e-4, reason="theory: Hooke's law, off by the strain of at most 1e-5; a patch test to the default quadrature"),
    "got there": Bound(at_least=1.0, reason="definition: no increment is cut"),
}


@case(
    claim="A column that is pressed together by any amount, with any friction, bears what Hooke's law says.",
    tier="gate",
    grid={"friction": (0.3, 1e-3, 1e-6, 1e-12, 1e-300), "press": (1e-5, 1e-7), "method": ("monolithic", "uzawa")},
    bounds=BOUNDS,
)
def pressed(friction: float, press: float, method: str) -> dict[str, float]:
    """No traction is due anywhere: what slips make of themselves is round-off, the more so the narrower the cone."""
    return _force(_COLUMN.format(friction=friction, method=method), [{"name": "press", "by": (0.0, 0.0, -press)}])


@case(
    claim="Augmentations of a tolerance finer than what Newton's method leaves of tractions come to their end, with narrow cones too.",
    tier="gate",
    grid={"friction": (1e-3, 1e-5, 1e-6), "press": (1e-2, 1e-3)},
    bounds=lambda friction, press: {  # noqa: ARG005
        "off": Bound(at_most=press, reason="theory: Hooke's law, off by the strain press / 2 times the law's curvature, below 2"),
        "got there": BOUNDS["got there"],
    },
)
def finely(friction: float, press: float) -> dict[str, float]:
    """Tractions are some 1e-3 of the pressures and less; 1e-8 of them is less than balance to 1e-9 tells."""
    scene = _COLUMN.format(friction=friction, method="uzawa").replace("augmentation_tolerance = 1e-6", "augmentation_tolerance = 1e-8")
    return _force(scene, [{"name": "press", "by": (0.0, 0.0, -press)}])


@case(
    claim="Bodies that part, move, and touch again with no force come through that, and bear what Hooke's law says when pressed.",
    tier="gate",
    grid={"aside": (0.0, 1e-16, 1e-9), "method": ("monolithic", "uzawa")},
    bounds=BOUNDS,
)
def touched(aside: float, method: str) -> dict[str, float]:
    """The load step that ends where the bodies touch has pressures that are nothing but round-off."""
    stages = [
        {"name": "lift", "by": (aside, 0.0, 0.1)},
        {"name": "touch", "by": (-aside, 0.0, -0.1)},
        {"name": "press", "by": (0.0, 0.0, -1e-5)},
    ]
    return _force(_COLUMN.format(friction=0.3, method=method), stages)
