"""Work around closed paths of loads: what supports do is what friction takes up, and none of that comes back."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import unit
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: A bowl that is pressed onto a block, goes and turns there, and is lifted off.
_BOWL = """
format = 1
bodies.slave.geometry = { kind = "bowl", half_width = 0.3, bottom = 0, rise = 0.05, top = 0.4 }
bodies.slave.mesh = { order = [2, 2, 1], elements = [4, 4, 1] }
bodies.master.geometry = { kind = "box", lower = [-0.5, -0.5, -0.5], upper = [0.9, 0.5, 0] }
bodies.master.mesh = { order = [3, 2, 1], elements = [7, 5, 1] }
contacts.c = { slave = "slave.w0", master = "master.w1", friction = 0.4 }
supports = { top.face = "slave.w1", base.face = "master.w0" }
[[stages]]
name = "press"
steps = FEW
motions.top.translate = [0, 0, -0.08]
[[stages]]
name = "go"
steps = MANY
motions.top = { translate = [0.3, 0.1, 0], rotate = 30 }
[[stages]]
name = "lift"
steps = FEW
motions.top.translate = [0, 0, 0.12]
"""
#: A pad on a wheel that turns below it.
_WHEEL = """
format = 1
bodies.slave.geometry = { kind = "bowl", half_width = 0.15, bottom = 0, rise = 0.02, top = 0.3 }
bodies.slave.mesh = { order = [2, 2, 1], elements = [4, 2, 1] }
bodies.master.geometry = { kind = "ring", centre = [0, 0, -0.5], inner = 0.25, outer = 0.5, width = 0.5 }
bodies.master.mesh = { order = [2, 1, 1], elements = [16, 2, 2] }
contacts.c = { slave = "slave.w0", master = "master.v1", friction = 0.3 }
supports.top.face = "slave.w1"
supports.hub = { face = "master.v0", centre = [0, 0, -0.5], axis = [0, 1, 0] }
[[stages]]
name = "press"
steps = FEW
motions.top.translate = [0, 0, -0.04]
[[stages]]
name = "turn"
steps = MANY
motions.hub.rotate = 60
[[stages]]
name = "lift"
steps = FEW
motions.top.translate = [0, 0, 0.1]
"""
#: Scenes, and what else is said of them.
PATHS: dict[str, tuple[str, tuple[str, ...]]] = {
    "bowl": (_BOWL, ()),
    "averaged": (_BOWL, ('contacts.c.projection="averaged"',)),
    "dual": (_BOWL, ('contacts.c.enforcement="dual"',)),
    "cohesion": (_BOWL, ("contacts.c.cohesion=0.05",)),
    "rigid master": (_BOWL, ("bodies.master.rigid=true",)),
    "augmented": (_BOWL, ('solver.method="uzawa"', "solver.augmentation_tolerance=1e-4")),
    "wheel": (_WHEEL, ()),
    "wheel of Lagrange elements": (_WHEEL, ('bodies.master.mesh.family="L"',)),
}


def _way(step: StepResult, axes: list[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """What acts at the supports, and how far they have gone along that, shape (supports, 4): forces, and moments about their axes."""
    acts = [np.append(held.force, held.moment @ axis) for held, axis in zip(step.reactions, axes, strict=True)]
    gone = [np.append(held.displacement, np.radians(held.rotation)) for held in step.reactions]
    return np.array(acts), np.array(gone)


def works(path: str, refined: int) -> tuple[float, float, float]:
    """Of a path in so many times its load steps: work of supports, by the trapezoidal rule, of the contact, least of friction in a step."""
    text, words = PATHS[path]
    problem = Scene.from_toml(text.replace("FEW", str(2 * refined)).replace("MANY", str(6 * refined)), overrides=words).problem()
    steps = list(Simulation(problem).run())
    axes = [unit(support.axis) for support in problem.supports]
    acts, gone = (np.array(part) for part in zip(*(_way(step, axes) for step in steps), strict=True))
    acts, gone = (np.concatenate([np.zeros_like(part[:1]), part]) for part in (acts, gone))
    contacts = np.array([[(c.friction_work, c.spurious_work) for c in step.contacts] for step in steps])
    return float(np.sum(0.5 * (acts[1:] + acts[:-1]) * np.diff(gone, axis=0))), float(contacts.sum()), float(contacts[..., 0].min())


@case(
    claim="Around a path of loads that ends with bodies apart supports do the work that friction and spurious pressures are told to take "
    "up, to first order in load steps, and no load step gives work of friction back.",
    tier="gate",
    grid={"path": tuple(PATHS)},
    bounds={
        "off": Bound(
            at_most=0.06,
            reason="theory: implicit steps are of first order; what is left of that, by one refinement, with where contact ends in a step",
        ),
        "limit": Bound(at_most=0.02, reason="theory: the same, of second order"),
        "back": Bound(at_most=1e-12, reason="definition: tractions oppose slips (4.6); what sticks has round-off, over all of the work"),
    },
)
def closed_path(path: str) -> dict[str, float]:
    """By how much works differ with twice the load steps, and without end by both, over the work; what is given back."""
    (coarse, least), (fine, finer) = ((outer / inner - 1.0, back / inner) for outer, inner, back in (works(path, k) for k in (2, 4)))
    return {"off": abs(fine), "limit": abs(2.0 * fine - coarse), "back": float(np.max([-least, -finer]))}
