"""What an observer hears in the course of a load step is what its result holds, augmentation by augmentation."""

from __future__ import annotations

import pytest

from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.record import AugmentationRecord, IterationRecord, Observer

SCENE = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }
bodies.block.mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
contacts.floor = { slave = "block.w0", plane = {}, friction = 0.3 }
supports.top.face = "block.w1"
stages = [{ name = "press", steps = 1, motions.top.translate = [0.01, 0, -0.02] }]
"""


class Heard(Observer):
    """Keeps all records, with their numbers."""

    def __init__(self) -> None:
        self.augmentations: list[AugmentationRecord] = []
        self.iterations: dict[int, list[IterationRecord]] = {}

    def augmented(self, step: int, time: float, record: AugmentationRecord) -> None:
        assert (step, time) == (1, 1.0)
        self.augmentations.append(record)

    def iteration(self, step: int, time: float, augmentation: int, record: IterationRecord) -> None:
        assert (step, time) == (1, 1.0)
        self.iterations.setdefault(augmentation, []).append(record)


@pytest.mark.parametrize("method", ["uzawa", "monolithic"])
def test_records_are_heard_as_they_are_made(method: str) -> None:
    heard = Heard()
    (result,) = Simulation(Scene.from_toml(SCENE, overrides=[f"solver.method={method}"]).problem(), heard).run()
    assert len(result.augmentations) > (1 if method == "uzawa" else 0)
    assert tuple(heard.augmentations) == (result.augmentations if method == "uzawa" else ())
    for number, record in enumerate(result.augmentations, 1):
        assert tuple(heard.iterations[number]) == record.iterations
