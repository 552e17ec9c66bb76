"""The over-refined runs of a trade: what they differ by is what they computed, not where they recorded it, and what the truth is off by."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.trade.knobs import Dial, Setting, dials_of
from isomortar.trade.laboratory import Choice, Laboratory, Tried
from isomortar.trade.model import Yardstick
from isomortar.trade.search import RESOLVED, Search
from isomortar.trade.want import Want, wanted


def recorded(supports: int, steps: list[int]) -> dict[str, Any]:
    """A force that bends sharply at the start of each stage, at its load steps: as friction does that begins to slip."""
    time = np.concatenate([stage + np.arange(1, count + 1) / count for stage, count in enumerate(steps)])
    height = np.tanh(40.0 * ((time - 1e-9) % 1.0))
    return {"time": time, "force": np.broadcast_to(height[:, None], (supports, len(time), 3))}


@case(
    claim="Two runs with the load steps of over-refined ones that record the same curve do not differ, however sharply it bends.",
    tier="gate",
    grid={"scene": ("iron-round", "press", "twist")},
    bounds={"apart": Bound(at_most=1e-12, reason="round-off: of times of load steps that both have")},
)
def recorded_alike(scene: str) -> dict[str, float]:
    """Relative difference, by the dearest load steps and the dearest but one."""
    loaded = Scene.load(scene)
    problem = loaded.problem()
    want = wanted("force.top.x", problem)
    dials = [dial for dial in dials_of(loaded, [want]) if dial.name.startswith("load steps of ")]
    finest, next_to = ([int(dial.settings[place].label) for dial in dials] for place in (-1, -2))
    truth, rival = (Tried((), "", recorded(len(problem.supports), steps), "", 0.0, 0.0) for steps in (finest, next_to))
    return {"apart": Yardstick(want, truth, rival).uncertainty}


class Sharp(Laboratory):
    """Runs of a number whose error is of order one in the element size, as at a sharp edge; an order is worth so many more of these."""

    def __init__(self, worth: float) -> None:
        elements = Dial("elements", tuple(map(Setting, ("12", "16", "20", "24", "30", "36"))), 0, "", part="elements")
        order = Dial("order", tuple(map(Setting, "234")), 0, "", part="order")
        super().__init__(None, (elements, order), Path(), None, lambda _: None)  # type: ignore[arg-type]
        self.dials, self._worth = (elements, order), worth

    def off(self, choice: Choice) -> float:
        """Its error; the number is one."""
        return 0.12 / int(self.dials[0].settings[choice[0]].label) / float(self._worth ** choice[1])

    def _measured(self, choices: Sequence[Choice], *_: Any, **__: Any) -> dict[Choice, Tried]:
        return {choice: Tried(choice, "", {"one": 1.0 + self.off(choice), "cpu_seconds": 1.0}, "", 1.0, 0.0) for choice in choices}


@case(
    claim="What a trade says of its truth's own error is at least the share of the real one that targets have to leave, where edges are "
    "sharp, and however many finer meshes an order more is worth.",
    tier="gate",
    grid={"worth": (1.0, 1.2, 1.25, 4 / 3, 2.0)},
    bounds={"told over real": Bound(at_least=0.99 / RESOLVED, reason="definition: targets are as many times what is told")},
)
def own_error(worth: float) -> dict[str, float]:
    """The smaller one of a loose and a tight target."""
    told = []
    for target in (0.01, 0.003):
        known = Sharp(worth)
        search = Search(known, known.dials, [Want("one", lambda run, _: np.array([run["one"]]), lambda _: np.ones(1))], math.inf)
        search.screen()
        search.find_truth([target])
        assert search.truth
        told.append(search.uncertainty / known.off(search.truth.choice))
    return {"told over real": float(np.min(told))}
