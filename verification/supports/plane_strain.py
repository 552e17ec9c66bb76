"""Slices in plane strain: supports hold both bodies across, control points of the contact face included."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

_SLICE = """
format = 1
bodies.slave.geometry = {{ kind = "box", lower = [0, 0, 0], upper = [1, {width}, 0.4] }}
bodies.slave.mesh = {{ order = [2, {order}, 2], elements = [3, {across}, 2] }}
supports.top = {{ face = "slave.w1", components = ["x", "z"] }}
supports.south = {{ face = "slave.v0", components = ["y"] }}
supports.north = {{ face = "slave.v1", components = ["y"] }}
stages = [
    {{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.04] }},
    {{ name = "push", steps = 2, motions.top.translate = [0.05, 0, 0] }},
]
solver = {{ newton_tolerance = 1e-11, complementarity_tolerance = 1e-11 }}
"""
_PLANE = 'contacts.base = { slave = "slave.w0", plane = { point = [0, 0, 0] }, friction = 0.2 }'
_BLOCK = """
contacts.base = {{ slave = "slave.w0", master = "master.w1", friction = 0.2, projection = "{projection}" }}
bodies.master.geometry = {{ kind = "box", lower = [-0.5, 0, -0.5], upper = [1.5, {width}, 0] }}
bodies.master.mesh = {{ order = [2, {order}, 2], elements = [5, {across}, 2] }}
supports.base.face = "master.w0"
supports.floor_south = {{ face = "master.v0", components = ["y"] }}
supports.floor_north = {{ face = "master.v1", components = ["y"] }}
"""
_SOFTLY = (
    *("solver.method=uzawa", "solver.penalty_normal=20", "solver.penalty_tangential=2"),
    *("solver.augmentation_tolerance=1e-10", "solver.max_augmentations=400"),
)


def solved(master: str, width: float, order: int, across: int, overrides: tuple[str, ...] = ()) -> list[StepResult]:
    """A slice pressed and pushed, with its mesh across."""
    text = (_SLICE + (_PLANE.replace("{", "{{").replace("}", "}}") if master == "plane" else _BLOCK)).format(
        width=width, order=order, across=across, projection="averaged" if master == "along averaged normals" else "closest"
    )
    return list(Simulation(Scene.from_toml(text, overrides=overrides).problem()).run())


@case(
    claim="In plane strain the force per width depends neither on the width nor on the mesh across, by either method.",
    tier="gate",
    grid={"master": ("plane", "block", "along averaged normals")},
    bounds={
        "finer": Bound(at_most=1e-9, reason="theory: fields that do not vary across are in every space; Newton's method stops at 1e-11"),
        "wider": Bound(at_most=1e-9, reason="theory: fields that do not vary across are in every space; Newton's method stops at 1e-11"),
        "uzawa": Bound(at_most=1e-8, reason="theory: both have the same limit; augmentations end at relative changes of 1e-10"),
        "across": Bound(at_most=1e-9, reason="theory: nothing moves across; Newton's method stops at 1e-11"),
        "mixed": Bound(at_least=1.0, reason="definition: points stick and slip at once in some load step"),
    },
)
def slices(master: str) -> dict[str, float]:
    """Relative change of the force per width on other slices and by Uzawa's method; largest control traction across; load steps."""
    one = solved(master, 0.3, 1, 1)
    force = np.array([result.reactions[0].force for result in one])

    def change(others: list[StepResult], scale: float = 1.0) -> float:
        return float(np.abs(np.array([result.reactions[0].force for result in others]) / scale - force).max() / np.abs(force).max())

    finer = solved(master, 0.3, 2, 2)
    return {
        "finer": change(finer),
        "wider": change(solved(master, 0.6, 2, 1), 2.0),
        "uzawa": change(solved(master, 0.3, 1, 1, _SOFTLY)),
        "across": float(np.abs(finer[-1].state.contacts[0].traction[:, 1]).max() / finer[-1].state.contacts[0].pressure.max()),
        "mixed": float(sum(0 < result.contacts[0].slip < result.contacts[0].active for result in one)),
    }
