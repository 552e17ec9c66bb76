"""The log of a load step: what it says of iterations and augmentations is what contacts, penalties and counts say."""

from __future__ import annotations

from typing import Literal

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model import constants
from isomortar.scene import Scene
from isomortar.solve.newton import KEPT_FACTORS
from isomortar.solve.record import AugmentationRecord, IterationRecord, Observer

#: Two pads on planes: one is dragged until some of it slips, by Coulomb's law or with elastic slip, the other one rubs without a slip.
SCENE = """
format = 1
bodies.one = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }, mesh = { order = 2, elements = [2, 2, 1] } }
bodies.two = { geometry = { kind = "box", lower = [3, 0, 0], upper = [4, 1, 0.5] }, mesh = { order = 2 } }
contacts.one = { slave = "one.w0", plane = { point = [0, 0, -0.01] }, friction = 0.3, elastic_slip = ELASTIC }
contacts.two = { slave = "two.w0", plane = { point = [0, 0, -0.01] }, friction = 0.5 }
supports = { one.face = "one.w1", two.face = "two.w1" }
[solver]
method = "METHOD"
measures = ["forgiving", "margin", "halving", "keeping"]
penalty_normal = 40
penalty_tangential = 8
penalty_growth = 3
penalty_growth_max = 5
[[stages]]
name = "press"
steps = 1
motions = { one.translate = [0, 0, -0.03], two.translate = [0, 0, -0.02] }
[[stages]]
name = "drag"
steps = 2
motions = { one.translate = [0.03, 0.02, 0], two.translate = [0, 0.002, 0] }
"""
#: Largest factor of the penalties, and that of the tangential ones.
GROWTH, MOST, SHARE = 3.0, 5.0, 8.0 / 40.0


class Told(Observer):
    """What is told of iterations and augmentations while they go on."""

    def __init__(self) -> None:
        self.iterations: list[IterationRecord] = []
        self.augmentations: list[AugmentationRecord] = []

    def iteration(self, step: int, time: float, augmentation: int, record: IterationRecord) -> None:  # noqa: ARG002
        """Keep the record."""
        self.iterations.append(record)

    def augmented(self, step: int, time: float, record: AugmentationRecord) -> None:  # noqa: ARG002
        """Keep the record."""
        self.augmentations.append(record)


@case(
    claim="The log of a load step counts iterations and augmentations from the first one, has the states that it ends with, all tangents, "
    "and the penalties that are asked for.",
    tier="gate",
    grid={"method": ("monolithic", "uzawa"), "elastic_slip": (0.0, 0.01)},
    bounds={
        "numbers": Bound(0.0, 0.0, "definition: numbers of iterations and augmentations that are not the next ones"),
        "told": Bound(0.0, 0.0, "definition: records that are told and not kept, or the other way round"),
        "states": Bound(0.0, 0.0, "definition: constraints of all contacts that are active, stick and slip, at the end and in sum"),
        "tangents": Bound(0.0, 0.0, "definition: factorisations that are counted and not logged, or the other way round"),
        "left": Bound(at_most=1.0, reason="definition: what is left at the end, over what may be"),
        "penalties": Bound(at_most=1e-12, reason="definition: by the settings, or constants.TANGENTIAL_FACTOR; round-off"),
        "slips": Bound(at_least=1.0, reason="definition: some slip and some stick, or little is tried"),
    },
)
def logged(method: Literal["monolithic", "uzawa"], elastic_slip: float) -> dict[str, float]:
    """How much the log differs from states, counts and settings; what is left over tolerances; the fewest that slip or stick."""
    problem = Scene.from_toml(SCENE.replace("METHOD", method).replace("ELASTIC", str(elastic_slip))).problem()
    told, settings = Told(), problem.settings
    steps = list(Simulation(problem, told).run())
    numbers = states = tangents = 0
    left, off, some = [0.0], [0.0], [np.inf]
    for step in steps:
        log, loops = step.augmentations, [record.iterations for record in step.augmentations]
        numbers += sum(record.augmentation != k for k, record in enumerate(log, 1))
        numbers += sum(record.iteration != k for loop in loops for k, record in enumerate(loop))
        iterations = [record for loop in loops for record in loop]
        states += sum(record.active != record.stick + record.slip for record in iterations)
        active, slip = (sum(getattr(contact, name) for contact in step.contacts) for name in ("active", "slip"))
        states += abs(iterations[-1].active - active) + abs(iterations[-1].slip - slip)
        after = [record for loop in loops for record in loop[1:]]
        tangents += abs(step.counters["factorisations"] - sum(KEPT_FACTORS not in record.notes for record in after))
        tolerance = settings.newton_tolerance if method == "uzawa" else settings.complementarity_tolerance
        left += [loop[-1].residual / tolerance for loop in loops]
        factors = [min(GROWTH**k, MOST) if method == "uzawa" else 1.0 for k in range(len(log))]
        share = SHARE if method == "uzawa" else constants.TANGENTIAL_FACTOR
        off += [abs(record.penalty_normal / log[0].penalty_normal / factor - 1.0) for record, factor in zip(log, factors, strict=True)]
        off += [abs(record.penalty_tangential / record.penalty_normal / share - 1.0) for record in log]
        some += [slip, active - slip] if step.step == 2 else []
    kept = [record for step in steps for record in step.augmentations]
    apart = [told.iterations != [record for augmentation in kept for record in augmentation.iterations]]
    apart += [told.augmentations != kept] if method == "uzawa" else []
    return {
        "numbers": float(numbers),
        "told": float(sum(apart)),
        "states": float(states),
        "tangents": float(tangents),
        "left": float(np.max(left)),
        "penalties": float(np.max(off)),
        "slips": float(np.min(some)),
    }
