"""The two over-refined runs of a trade: what they differ by is what they computed, and not where they recorded it."""

from __future__ import annotations

from typing import Any

import numpy as np

from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.trade.knobs import dials_of
from isomortar.trade.laboratory import Tried
from isomortar.trade.model import Yardstick
from isomortar.trade.want import wanted


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
