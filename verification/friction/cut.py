"""A load step whose increments are cut and grow back: what is recorded is that of the load steps that its increments would be."""

from __future__ import annotations

from unittest.mock import patch

import numpy as np
from friction.in_parts import SCENE

from isomortar.errors import ConvergenceError
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.method import Increment
from isomortar.solve.monolithic import Monolithic
from isomortar.solve.record import Observer, State, StepResult

#: A turn by 90 degrees goes in thirds, each of which is tried again after every cut one; what is longer than a fifth is refused.
LONGEST, INCREMENTS = 0.2, 6
#: Those of the scene, and others: tangents in all iterations, or there is no order to observe, and residuals that are not round-off.
SOLVER = "newton_tolerance = 1e-12\ncomplementarity_tolerance = 1e-11\n"
OTHERS = 'newton_tolerance = 5e-6\ncomplementarity_tolerance = 1e-5\nmeasures = ["forgiving", "margin", "reversal", "halving"]\n'
ADVANCE = Monolithic.advance


class Cuts(Observer):
    """Lengths of the increments after each cut."""

    def __init__(self) -> None:
        self.lengths: list[float] = []

    def cut(self, step: int, time: float, increment: float, reason: str) -> None:  # noqa: ARG002
        """Keep the length."""
        self.lengths.append(increment)


def refusing(method: Monolithic, start: State, time: float, step: int) -> Increment:
    """An increment, if it is short enough."""
    if step == 2 and time - max(method._equilibrium.time, 1.0) > LONGEST:
        raise ConvergenceError("is longer than a fifth of the load step")
    return ADVANCE(method, start, time, step)


def turned(steps: int) -> tuple[list[StepResult], list[float]]:
    """The load steps of the turn, and the lengths of increments after cuts."""
    cuts = Cuts()
    scene = SCENE.replace("STEPS", str(steps)).replace(SOLVER, OTHERS)
    return list(Simulation(Scene.from_toml(scene).problem(), cuts).run())[1:], cuts.lengths


@case(
    claim="A load step that is cut records what its increments do: forces at their end, works, counts, and Newton's order in the middle.",
    tier="gate",
    bounds={
        "forces": Bound(at_most=1e-9, reason="round-off: both take the same iterations"),
        "works": Bound(at_most=1e-9, reason="round-off: sums of six works"),
        "counts": Bound(0.0, 0.0, "definition: increments, cuts, logs, solves and points that differ"),
        "lengths": Bound(at_most=1e-12, reason="definition: half of a third, as often as there is a cut; round-off"),
        "next": Bound(at_most=1e-12, reason="definition: easy increments grow back to the longest; round-off"),
        "order": Bound(at_most=1e-6, reason="definition: the median; round-off, from which the last of three residuals is far"),
        "orders": Bound(at_least=3.0, reason="definition: or there is no median"),
        "alone": Bound(at_least=0.01, reason="definition: the order of no end, nor the mean, is that of the middle"),
    },
)
def cut() -> dict[str, float]:
    """Differences of a load step that is cut five times from six load steps; how far single orders, and the mean, are off the median."""
    parts, _ = turned(INCREMENTS)
    with patch.object(Monolithic, "advance", refusing):
        (whole,), lengths = turned(1)
    works = np.array([[c.friction_work, c.spurious_work] for step in parts for c in step.contacts]).sum(axis=0)
    own = np.array([whole.contacts[0].friction_work, whole.contacts[0].spurious_work])
    forces = np.array([reaction.force for reaction in parts[-1].reactions])
    apart = np.array([reaction.force for reaction in whole.reactions]) - forces
    orders = np.array([step.newton_order for step in parts])
    orders = orders[np.isfinite(orders)]
    middle = float(np.median(orders))
    counts = [whole.substeps - INCREMENTS, whole.cuts - len(lengths), whole.cuts - INCREMENTS + 1]
    counts += [len(whole.augmentations) - sum(len(step.augmentations) for step in parts)]
    counts += [whole.counters[name] - sum(step.counters[name] for step in parts) for name in ("solves", "factorisations", "solid points")]
    return {
        "forces": float(np.abs(apart).max() / np.abs(forces).max()),
        "works": float(np.abs(own - works).max() / np.abs(works).max()),
        "counts": float(np.abs(counts).sum()),
        "lengths": float(np.abs(np.array(lengths) - 1.0 / INCREMENTS).max()),
        "next": abs(whole.next_increment - 1.0),
        "order": abs(whole.newton_order - middle),
        "orders": float(len(orders)),
        "alone": float(np.abs([orders[0] - middle, orders[-1] - middle, orders.mean() - middle]).min()),
    }
