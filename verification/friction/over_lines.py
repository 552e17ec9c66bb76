"""Sliding over C0 lines of a master of Lagrange elements, along averaged normals: every load step is reached, at the cost of any other."""

from __future__ import annotations

from typing import Final

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

AVERAGED: Final = "contacts.interface.projection='averaged'"
#: A small block over four lines of its master in three load steps: by closest points Uzawa's method cuts one.
SMALL: Final = (
    *("bodies.slave.mesh.elements=[2,2,1]", "bodies.master.mesh.elements=[5,5,1]", "stages.press.steps=1", "stages.slide.steps=3"),
    *("stages.press.motions.top.translate=[0,0,-0.1]", "stages.slide.motions.top.translate=[0.3,0.05,0]"),
)
#: Scene and order of its master, and the mean of what is recorded, load steps 20 to 50, by an independent program; with NURBS of order 2 an
#: iron is dragged with .2394, and a twist takes .1480.
LONG: Final = {"twist L1": None, "twist L2": None, "iron L1": 0.2421, "iron L2": 0.2397}
_CUT = Bound(0.0, 0.0, "definition: no load step is cut")


def ran(scene: str, *overrides: str) -> list[StepResult]:
    """The load steps of a scene along averaged normals."""
    return list(Simulation(Scene.load(scene, [AVERAGED, *overrides]).problem()).run())


@case(
    claim="A block slides over C0 lines of its master without a cut load step, and both methods find the same forces.",
    tier="nightly",
    bounds={
        "cuts": _CUT,
        "apart": Bound(at_most=1e-4, reason="discretisation: Uzawa's augmentations end at a tolerance of 0.01"),
        "slipping": Bound(at_least=1.0, reason="definition: a block that sticks tells nothing of slips over lines"),
    },
    scene="block",
)
def over_lines() -> dict[str, float]:
    """Cut load steps of both methods; largest difference of the last forces over their size; slipping control points at the end."""
    runs = [ran("block", *SMALL, f"solver.method='{method}'") for method in ("monolithic", "uzawa")]
    one, other = (steps[-1].contacts[0].force_slave for steps in runs)
    return {
        "cuts": float(sum(step.cuts for steps in runs for step in steps)),
        "apart": float(np.abs(one - other).max() / np.abs(one).max()),
        "slipping": float(runs[0][-1].contacts[0].slip),
    }


_INDEPENDENT = "reference: an independent program found 1.2706 and .3302 on the same elements; its digits"


@case(
    claim="The block of linear elements slides over the lines of its master in 15 load steps without a cut, with at most 75 tangents.",
    tier="nightly",
    bounds={
        "steps": Bound(15.0, 15.0, "definition: every load step is reached"),
        "cuts": _CUT,
        "tangents": Bound(at_most=75.0, reason="reference: an independent program took 72"),
        "normal": Bound(1.2707, 1.2705, _INDEPENDENT),
        "tangential": Bound(0.3303, 0.3301, _INDEPENDENT),
    },
    scene="block",
)
def block_over_lines() -> dict[str, float]:
    """Load steps, cuts, tangents, and the forces at the end."""
    steps = ran("block")
    force = steps[-1].contacts[0].force_slave
    return {**effort(steps), "normal": float(force[2]), "tangential": float(-force[0])} | {"tangents": tangents(steps).sum()}


def long_bounds(scene: str) -> dict[str, Bound]:
    """Load steps, cuts and tangents; and the drag of an iron."""
    mean = LONG[scene]
    drag = (
        {} if mean is None else {"drag": Bound(1.02 * mean, 0.98 * mean, "reference: that of an independent program, with cuts of its own")}
    )
    return {
        "steps": Bound(50.0, 50.0, "definition: every load step is reached"),
        "cuts": Bound(at_most=5.0, reason="reference: at most as many cuts as an independent program took"),
        "tangents": Bound(at_most=6.0, reason="reference: an independent program took 4 to 6"),
        **drag,
    }


@case(
    claim="A twist and an iron on masters of Lagrange elements come to their end, with at most 6 tangents in the median.",
    tier="nightly",
    grid={"scene": tuple(LONG)},
    bounds=long_bounds,
)
def over_lines_to_the_end(scene: str) -> dict[str, float]:
    """Load steps, cuts, tangents in the median; the mean drag of load steps 20 to 50."""
    name, kind = scene.split()
    steps = ran(name, "bodies.master.mesh.family=L", f"bodies.master.mesh.order=[{kind[1]},{kind[1]},{kind[1]}]")
    drag = float(np.mean([-step.contacts[0].force_slave[0] for step in steps[19:]]))
    return {**effort(steps), "tangents": float(np.median(tangents(steps)))} | ({"drag": drag} if LONG[scene] else {})


def effort(steps: list[StepResult]) -> dict[str, float]:
    """Load steps and cuts."""
    return {"steps": float(len(steps)), "cuts": float(sum(step.cuts for step in steps))}


def tangents(steps: list[StepResult]) -> np.ndarray:
    """Tangents of each load step."""
    return np.array([step.counters["factorisations"] for step in steps], dtype=np.float64)
