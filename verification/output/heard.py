"""What who watches a run hears of it while it is written to a file: all that the simulation says, in its order."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from output.records import unlike

from isomortar.driver import run
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.record import AugmentationRecord, IterationRecord, Observer, StepResult

#: A block that is pressed far, so that increments are cut, onto a floor that it is apart from, of which it is warned.
SCENE = """
format = 1
name = "block"
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = 1, elements = 1 } }
contacts.floor = { slave = "block.w0", plane.point = [0, 0, -0.1], friction = 0 }
supports.top.face = "block.w1"
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.95] }]
solver = { method = "uzawa", max_iterations = 3 }
"""


class Hearing(Observer):
    """Keeps all that it is told."""

    def __init__(self) -> None:
        self.told: list[tuple[Any, ...]] = []

    def started(self, total_steps: int, first_step: int) -> None:
        """How many load steps there are, and where the run begins."""
        self.told.append(("started", total_steps, first_step))

    def iteration(self, step: int, time: float, augmentation: int, record: IterationRecord) -> None:
        """An iteration."""
        self.told.append(("iteration", step, time, augmentation, record))

    def augmented(self, step: int, time: float, record: AugmentationRecord) -> None:
        """An augmentation."""
        self.told.append(("augmented", step, time, record))

    def cut(self, step: int, time: float, increment: float, reason: str) -> None:
        """A cut increment."""
        self.told.append(("cut", step, time, increment, reason))

    def recorded(self, result: StepResult) -> None:
        """A load step, without what the clock says of it."""
        self.told.append(("recorded", result.step, result.state, result.reactions, result.contacts, result.augmentations, result.cuts))

    def warned(self, message: str) -> None:
        """A warning."""
        self.told.append(("warned", message))


@case(
    claim="Who watches a run that is written to a file hears what the simulation says without one: starts, iterations, augmentations, "
    "cuts, load steps and warnings.",
    tier="gate",
    bounds={
        "unlike": Bound(0.0, 0.0, "definition: the same computation, to the bit"),
        "kinds": Bound(6.0, 6.0, "definition: of each kind there is one at least, or it was not looked at"),
    },
)
def heard() -> dict[str, float]:
    """How many numbers and words differ, and how many kinds there are."""
    problem = Scene.from_toml(SCENE).problem()
    alone, beside = Hearing(), Hearing()
    for _ in Simulation(problem, alone).run():
        pass
    with tempfile.TemporaryDirectory() as folder:
        run(Scene.from_toml(SCENE), Path(folder) / "run.h5", beside).close()
    return {"unlike": float(unlike(alone.told, beside.told)), "kinds": float(len({event[0] for event in alone.told}))}
