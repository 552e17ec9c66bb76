"""The over-refined runs of a trade: what they differ by is what they computed, not where they recorded it, and what the truth is off by."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.trade.knobs import Dial, Setting, changed, dials_of, faces_in_contact
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


#: A quarter of a ring, glued to a box whose coordinates are others, and to a box behind both, and pressed onto a plane.
GLUED = """
format = 1
glue = [["ring.u0", "box.u1"], ["box.u0", "end.u1"]]
bodies.box = { geometry = { kind = "box", lower = [-1, -0.2, 1], upper = [0, 0.2, 2] }, mesh = { elements = [2, 1, 3], order = 1 } }
bodies.end = { geometry = { kind = "box", lower = [-2, -0.2, 1], upper = [-1, 0.2, 2] }, mesh = { elements = [1, 1, 3], order = 1 } }
[bodies.ring]
geometry = { kind = "ring", inner = 1, outer = 2, width = 0.4, angles = [0, 90] }
mesh = { elements = [2, 3, 1], order = [2, 1, 1] }
[contacts]
side = { slave = "CONTACT", plane = { point = [0, 0, 2], normal = [0, 0, -1] }, friction = 0 }
[supports]
under.face = "ring.u1"
[[stages]]
name = "press"
steps = 5
motions.under.translate = [0, 0, 0.1]
"""
#: Scenes by name: bundled ones by their own.
REFINED = {
    **{name: name for name in ("block", "iron", "iron-round", "press", "reversal", "tire", "twist")},
    "glued": GLUED.replace("CONTACT", "ring.v1"),
    "glued behind": GLUED.replace("CONTACT", "end.w1"),
}


@case(
    claim="Over-refined runs have more elements along every direction of each body, and higher orders along its faces in contact, also "
    "where bodies that are glued can not be refined one by one.",
    tier="gate",
    grid={"scene": tuple(REFINED)},
    bounds={
        "as coarse": Bound(0.0, 0.0, "definition: directions with no more elements than the scene has"),
        "as low": Bound(0.0, 0.0, "definition: directions along faces in contact with no higher order"),
    },
)
def refined_throughout(scene: str) -> dict[str, float]:
    """How many, of the dearest settings of what refines."""
    text = REFINED[scene]
    own = Scene.load(text) if text == scene else Scene.from_toml(text)
    dials = [dial for dial in dials_of(own) if dial.part]
    finest = changed(own, [dial.settings[-1] for dial in dials]).problem()
    before, after = ({b.name: b.patch.directions for b in problem.bodies} for problem in (own.problem(), finest))
    pairs = [(name, letter, one, other) for name in before for letter, one, other in zip("uvw", before[name], after[name], strict=True)]
    touching = faces_in_contact(own)
    return {
        "as coarse": float(sum(other.elements <= one.elements for _, _, one, other in pairs)),
        "as low": float(sum(other.order <= one.order for name, letter, one, other in pairs if letter in touching.get(name, ""))),
    }
