"""A body that contact alone holds: begun by a support that is then released."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from small_scenes import TIGHT

from isomortar.harness import Bound, Shown, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A slice of a pipe between two rigid plates, the upper one of which goes down by half the pipe's radius, from where both just touch it.
_PIPE = """
format = 1
bodies.pipe.geometry = { kind = "ring", inner = 0.7, outer = 1, width = 0.25 }
bodies.pipe.mesh = { order = [2, 2, 1], elements = [32, 2, 1] }
bodies.lower = { rigid = true, geometry = { kind = "box", lower = [-2, -1, -1.5], upper = [2, 1, -1] }, mesh.order = 1 }
bodies.upper = { rigid = true, geometry = { kind = "box", lower = [-2, -1, 1], upper = [2, 1, 1.5] }, mesh.order = 1 }
contacts.below = { slave = "pipe.v1", master = "lower.w1", friction = 0.3 }
contacts.above = { slave = "pipe.v1", master = "upper.w0", friction = 0.3 }
supports.front = { face = "pipe.w0", components = ["y"] }
supports.back = { face = "pipe.w1", components = ["y"] }
supports.hold = { face = "pipe.v0", components = ["x", "z"], stages = ["touch"] }
supports.lower.face = "lower.w0"
supports.upper.face = "upper.w1"
stages = [
    { name = "touch", steps = 1, motions.upper.translate = [0, 0, -0.01] },
    { name = "let-go", steps = 2 },
    { name = "press", steps = 7, motions.upper.translate = [0, 0, -0.49] },
]
"""


@case(
    claim="A pipe between two plates, which contact alone holds, is pressed from first touch to half its radius, and nothing else bears.",
    tier="gate",
    grid={"method": ("monolithic", "uzawa")},
    bounds={
        "balance": Bound(at_most=1e-9, reason="theory: what the plates exert is in balance; forces are to 1e-12 of the internal ones"),
        "moment": Bound(at_most=1e-9, reason="theory: as above"),
        "held": Bound(at_least=1e-2, reason="definition: what held it while it was touched bore a force, which has faded"),
        "mirror": Bound(at_most=1e-8, reason="theory: the pipe is its own mirror image, left to right"),
        "cuts": Shown("load steps are as given, where there are none"),
    },
)
def pipe(method: str) -> dict[str, float]:
    """Forces, and moments about the origin, of the plates together over the force of one, at load steps after the support's release.

    The support's force before, over that of a plate; the pipe's outline off its mirror image at the end; cuts of load steps.
    """
    found = Scene.from_toml(_PIPE, overrides=[f"solver.method={method}"]).problem()
    tight = replace(found.settings, **TIGHT, augmentation_tolerance=1e-9)  # type: ignore[arg-type]
    simulation = Simulation(replace(found, settings=tight))
    results = list(simulation.run())
    names = [support.name for support in found.supports]
    hold, lower, upper = (names.index(name) for name in ("hold", "lower", "upper"))
    balance, moment = [], []
    for result in results[2:]:
        plates = [result.reactions[k] for k in (lower, upper)]
        size = np.linalg.norm(plates[1].force)
        balance.append(np.linalg.norm(plates[0].force + plates[1].force) / size)
        moment.append(np.linalg.norm(sum(plate.moment + np.cross(plate.centre, plate.force) for plate in plates)) / size)
    points = simulation.equilibrium.numbering.points["pipe"]
    outline = results[-1].state.positions[np.unique(points)]
    apart = np.linalg.norm((outline * [-1.0, 1.0, 1.0])[:, None] - outline, axis=2).min(axis=1)
    return {
        "balance": float(max(balance)),
        "moment": float(max(moment)),
        "held": float(np.linalg.norm(results[0].reactions[hold].force) / np.linalg.norm(results[0].reactions[upper].force)),
        "mirror": float(apart.max()),
        "cuts": float(sum(result.cuts for result in results)),
    }
