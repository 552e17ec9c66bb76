"""How far multipliers are from others, and from what the contact conditions make of them: by the equations of the documents."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.solve import distances as computed
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger

#: A pad, uneven in its elements, above a plane whose coordinates are lengths.
SCENE = """
format = 1
bodies.pad.geometry = { kind = "box", lower = [0, 0, 0], upper = [1.5, 1, 0.5] }
bodies.pad.mesh = { order = 2, elements = [2, 3, 1], grading = [3, 1, 1] }
contacts.floor = { slave = "pad.w0", plane = { point = [0, 0, 0.01] }, friction = FRICTION }
supports.top.face = "pad.w1"
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.1] }]
"""
_EXACT = "round-off: sums over some tens of control points"


def distances(
    p: np.ndarray, t: np.ndarray, q: np.ndarray, s: np.ndarray, friction: float, noise: tuple[float, float]
) -> tuple[float, float]:
    """Equation 5.8 of pressures p and tractions t from q and s."""
    floor = 1e-4 * np.sum(np.minimum(friction * q, q) ** 2)
    of_pressure = np.maximum(np.sum((p - q) ** 2) - noise[0] ** 2, 0.0) / np.sum(q**2)
    of_traction = np.maximum(np.sum((t - s) ** 2) - noise[1] ** 2, 0.0) / np.max([np.sum(s**2), floor, noise[1] ** 2])
    return float(np.sqrt(of_pressure)), float(np.sqrt(of_traction))


@case(
    claim="Two sets of pressures and tractions are as far apart as equation 5.8 says, however small tractions are, with any friction.",
    tier="gate",
    grid={"friction": (0.05, 4.0)},
    bounds={"apart": Bound(at_most=1e-12, reason=_EXACT)},
)
def apart(friction: float) -> dict[str, float]:
    """Largest relative difference of distances, over tractions of many sizes and noises."""
    equilibrium = Equilibrium(Scene.from_toml(SCENE.replace("FRICTION", str(friction))).problem(), Ledger())
    pair, state, random = equilibrium.pairs[0], equilibrium.initial_state(), np.random.default_rng(5)
    control, off = pair.kinematics(state.positions, state.contacts[0]).control, 0.0
    for size in (1.0, 1e-2, 1e-4, 0.0):
        for noise in ((0.0, 0.0), (0.3, 0.1 * size), (1e3, 1e3)):
            q, p = random.uniform(0.5, 1.0, (2, len(control.weight)))
            s, t = size * random.standard_normal((2, len(q), 2))
            found = computed.apart(pair, control, (p, t), (q, s), noise)
            wanted = distances(p, t, q, s, friction, noise)
            off = float(np.max([off, *(abs(a - b) / float(np.maximum(b, 1e-9)) for a, b in zip(found, wanted, strict=True))]))
    return {"apart": off}


@case(
    claim="Pressures are as far from the contact conditions as equation 7.4 says, with the stiffness of the whole face.",
    tier="gate",
    bounds={"off": Bound(at_most=1e-9, reason=_EXACT), "penetrates": Bound(at_least=1e-3, reason="definition: the gap is not nothing")},
)
def off_conditions() -> dict[str, float]:
    """Largest relative difference of the distance, over pressures of three sizes; the mean gap."""
    equilibrium = Equilibrium(Scene.from_toml(SCENE.replace("FRICTION", "0")).problem(), Ledger())
    pair, state = equilibrium.pairs[0], equilibrium.initial_state()
    _, scales = equilibrium.begin(state, 0.0)
    kinematics = pair.kinematics(state.positions, state.contacts[0])
    control, area = kinematics.control, 1.5
    stiffness = float(scales.stiffness[0])
    penalty, off = stiffness / np.sqrt(np.median(control.weight) * area), 0.0
    gap = control.gap / control.weight
    for size in (1e-2, 1.0, 1e2):
        pressure = size * np.linspace(0.5, 1.0, len(gap))
        law = pair.law(np.ones(2), pressure, np.zeros((len(gap), 2)))
        response = pair.respond(kinematics, law)
        found, _ = computed.off_conditions(pair, state.positions, kinematics, law, response, scales, 0.0)
        target = np.maximum(response.pressure + penalty * gap, 0.0)
        wanted = float(np.linalg.norm(target - response.pressure) / np.linalg.norm(response.pressure))
        off = float(np.maximum(off, abs(found / wanted - 1.0)))
    return {"off": off, "penetrates": float(gap.mean())}
