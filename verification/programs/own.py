"""The program itself as one of the programs: what it tells of load steps is what its simulation records."""

from __future__ import annotations

import numpy as np
from output.records import unlike

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.program.own import Isomortar
from isomortar.scene import Scene

#: Two blocks that are pressed onto another one and dragged, one of them along averaged normals.
SCENE = """
format = 1
bodies.lower = { geometry = { kind = "box", lower = [-1, -1, -1], upper = [2, 2, 0] }, mesh = { order = 1, elements = [3, 2, 1] } }
bodies.upper = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 0.8, 0.5] }, mesh = { order = 1, elements = [2, 1, 1] } }
contacts.between = { slave = "upper.w0", master = "lower.w1", friction = 0.2, projection = "averaged" }
bodies.other = { geometry = { kind = "box", lower = [0, 1, 0], upper = [1, 1.8, 0.5] }, mesh = { order = 1, elements = [2, 1, 1] } }
contacts.beside = { slave = "other.w0", master = "lower.w1", friction = 0.1 }
supports = { floor.face = "lower.w0", top.face = "upper.w1", hand.face = "other.w1" }
stages = [
  { name = "press", steps = 1, motions = { top.translate = [0, 0, -0.02], hand.translate = [0, 0, -0.01] } },
  { name = "drag", steps = 2, motions = { top.translate = [0.1, 0, 0], hand.translate = [0.1, 0, 0] } },
]
"""


@case(
    claim="The program tells of each load step the positions, reactions and works that its simulation records, and of all of them the "
    "solves; one that does not converge keeps what did.",
    tier="gate",
    bounds={
        "unlike": Bound(0.0, 0.0, "definition: the same computation, to the bit"),
        "works": Bound(
            at_least=1e-6, reason="definition: friction of each contact takes up work in the second stage, or it was not looked at"
        ),
        "stopped": Bound(0.0, 0.0, "definition: the ending, and the load steps before it"),
    },
)
def own() -> dict[str, float]:
    """How many numbers differ; least friction work of a contact, in all load steps; whether a run that stops is told of otherwise."""
    problem = Scene.from_toml(SCENE).problem()
    found, steps = Isomortar().run(problem), list(Simulation(problem).run())
    works = [(float(sum(c.friction_work for c in s.contacts)), float(sum(c.spurious_work for c in s.contacts))) for s in steps]
    told = [(step.step, step.positions, step.reactions, step.works) for step in found.steps]
    exact = [(step.step, step.state.positions, step.reactions, of) for step, of in zip(steps, works, strict=True)]
    solves = sum(step.counters["solves"] for step in steps)
    few = ["solver.max_cuts=0", "stages.drag.motions.top.translate=[0,0,-3]"]
    stopped = Isomortar().run(Scene.from_toml(SCENE, overrides=few).problem())
    wrong = (stopped.ending, [step.step for step in stopped.steps]) != ("not converged", [1]) or "load step 2" not in stopped.words
    return {
        "unlike": float(unlike(told, exact) + (found.solves != solves) + ((found.ending, found.words) != ("measured", ""))),
        "works": float(np.min(np.sum([[c.friction_work for c in step.contacts] for step in steps], axis=0))),
        "stopped": float(wrong),
    }
