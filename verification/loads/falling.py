"""Bodies that fall by loads: what they come to first holds them, whatever else is in their way or beside it."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: A pad above a rigid die; a weight and a plate's force press it down.
_PAD = """
format = 1
[bodies.pad]
geometry = { kind = "box", lower = [0, 0, 0.03], upper = [1, 1, 0.5] }
mesh = { order = 2, elements = [2, 1, 1] }
[bodies.die]
rigid = true
geometry = { kind = "box", lower = [-1, -1, -1], upper = [2, 2, 0] }
mesh = { order = 1 }
[contacts.die]
slave = "pad.w0"
master = "die.w1"
friction = 0.2
[supports.die]
face = "die.w0"
[[stages]]
name = "fall"
steps = 2
"""
_PRESSED = {
    "plate": '[supports.top]\nface = "pad.w1"\nforce.z = -0.3\n',
    "weight": '[supports.x]\nface = "pad.u0"\ncomponents = ["x"]\n[supports.y]\nface = "pad.v0"\ncomponents = ["y"]\n'
    '[loads.own]\nbody = "pad"\nweight = [0, 0, -0.3]\n',
}
#: What else there is: a floor below the die, a wall at the side of the pad, both named first.
_BESIDE = {
    "floor": 'a = { slave = "pad.w0", plane = { point = [0, 0, -1], normal = [0, 0, 1] } }\n',
    "wall": 'a = { slave = "pad.u1", plane = { point = [1.01, 0, 0], normal = [-1, 0, 0] } }\n',
}
#: A beam above two rigid steps, one of which is a little lower.
_BEAM = """
format = 1
bodies.beam = { geometry = { kind = "box", lower = [0, 0, 0.1], upper = [2, 0.5, 0.5] }, mesh = { order = 2, elements = [6, 1, 1] } }
bodies.low = { rigid = true, geometry = { kind = "box", lower = [-0.2, -0.2, -1], upper = [0.5, 0.7, -0.01] }, mesh = { order = 1 } }
bodies.high = { rigid = true, geometry = { kind = "box", lower = [1.5, -0.2, -1], upper = [2.2, 0.7, 0] }, mesh = { order = 1 } }
contacts.FIRST = { slave = "beam.w0", master = "FIRST.w1", friction = 0 }
contacts.SECOND = { slave = "beam.w0", master = "SECOND.w1", friction = 0 }
supports.low.face = "low.w0"
supports.high.face = "high.w0"
supports.x = { face = "beam.u0", components = ["x"] }
supports.y = { face = "beam.v0", components = ["y"] }
loads.own = { body = "beam", weight = [0, 0, -0.01] }
stages = [{ name = "fall", steps = 1 }]
"""


def computed(text: str, method: str, *more: str) -> list[StepResult]:
    """All load steps of a scene by a method, with more changes."""
    return list(Simulation(Scene.from_toml(text, overrides=[f'solver.method="{method}"', *more]).problem()).run())


@case(
    claim="A body that loads bring down rests on what it comes to first: what is below that or beside it changes no digit.",
    tier="gate",
    grid={"pressed": ("plate", "weight"), "beside": ("floor", "wall"), "method": ("monolithic", "uzawa")},
    bounds={
        "apart": Bound(at_most=1e-12, reason="round-off: the same equations, with pairs that are open beside them"),
        "bears": Bound(at_least=1.0, reason="definition: the die bears from the first load step on"),
        "cuts": Bound(at_most=0.0, reason="definition: the way there is as short as without it"),
    },
)
def first_in_the_way(pressed: str, beside: str, method: str) -> dict[str, float]:
    """Largest difference of positions, relative to the pad, and cuts of load increments."""
    alone = _PAD + _PRESSED[pressed]
    both = alone.replace("[contacts.die]", f"[contacts]\n{_BESIDE[beside]}[contacts.die]")
    found = [computed(text, method, "solver.newton_tolerance=1e-13") for text in (alone, both)]
    apart = [np.abs(one.state.positions - other.state.positions).max() for one, other in zip(*found, strict=True)]
    bears = [step.contacts[-1].active for steps in found for step in steps]
    return {"apart": float(np.max(apart)), "bears": float(np.min(bears)), "cuts": float(sum(step.cuts for step in found[1]))}


@case(
    claim="A body that falls onto two steps of nearly one height rests on both, whatever is named first.",
    tier="gate",
    grid={"first": ("low", "high"), "method": ("monolithic", "uzawa")},
    bounds={
        "balance": Bound(at_most=1e-8, reason="definition: what is left of the weight, to the tolerance of balance"),
        "least": Bound(at_least=0.2, reason="theory: of a stiff beam each step bears a half"),
    },
)
def two_steps(first: str, method: str) -> dict[str, float]:
    """What is left of the weight, and the share of it that the step bears which bears less."""
    second = {"low": "high", "high": "low"}[first]
    (step,) = computed(_BEAM.replace("FIRST", first).replace("SECOND", second), method)
    weight = 0.01 * 2.0 * 0.5 * 0.4
    forces = np.array([contact.force_slave[2] for contact in step.contacts])
    return {"balance": float(abs(forces.sum() / weight - 1.0)), "least": float(forces.min() / weight)}
