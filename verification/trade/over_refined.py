"""The over-refined runs of a trade: what they differ by is what they computed, not where they recorded it, and what the truth is off by."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.trade.knobs import KNOBS, Dial, Setting, changed, dials_of, faces_in_contact
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
    """Runs of a number that is one, and its error: of order one in element sizes, as at a sharp edge; an order is worth `worth` of these.

    Parameters
    ----------
    elements : sequence of sequence of int
        Of each direction, from the scene's own on.
    error : callable
        From elements by direction to the error.
    worth : float
    steps : sequence of int
        Numbers of load steps, likewise; the error depends on these last.
    """

    def __init__(
        self, elements: Sequence[Sequence[int]], error: Callable[..., float], worth: float = 1.0, steps: Sequence[int] = (1,)
    ) -> None:
        meshes = [Dial(f"elements {k}", tuple(map(Setting, map(str, of))), 0, "", part="elements") for k, of in enumerate(elements)]
        order = Dial("order", tuple(map(Setting, "234")), 0, "", part="order")
        of_stage = Dial("load steps", tuple(map(Setting, map(str, steps))), 0, "")
        self.dials, self._error, self._worth = (*meshes, of_stage, order), error, worth
        self._counts = (*elements, steps)
        self.fails: Callable[[Choice], bool] = lambda _: False
        super().__init__(None, self.dials, Path(), None, lambda _: None)  # type: ignore[arg-type]

    def off(self, choice: Choice) -> float:
        """Its error."""
        counts = (of[n] for of, n in zip(self._counts, choice, strict=False))
        return float(self._error(*counts) / self._worth ** choice[-1])

    def _measured(self, choices: Sequence[Choice], *_: Any, **__: Any) -> dict[Choice, Tried]:
        numbers = {choice: {"one": 1.0 + self.off(choice), "choice": choice, "cpu_seconds": 1.0} for choice in choices}
        fails = {choice: self.fails(choice) for choice in choices}
        return {c: Tried(c, "", {} if fails[c] else numbers[c], "failed" * fails[c], 1.0, 0.0) for c in choices}


def told_over_real(elements: Sequence[Sequence[int]], error: Callable[..., float], worth: float = 1.0) -> float:
    """What is said of the truth's own error over the real one, the smaller of a loose and a tight target."""
    told = []
    for target in (0.01, 0.003):
        known = Sharp(elements, error, worth)
        search = Search(known, known.dials, [Want("one", lambda run, _: np.array([run["one"]]), lambda _: np.ones(1))], math.inf)
        search.screen()
        search.find_truth([target])
        assert search.truth
        told.append(search.uncertainty / known.off(search.truth.choice))
    return float(np.min(told))


#: Least share of the real error that has to be told: targets are as many times what is told.
TOLD = Bound(at_least=0.99 / RESOLVED, reason="definition: targets are as many times what is told")
LONG, SHORT = (12, 16, 20, 24, 30, 36), (4, 5, 7, 8, 10, 12)


@case(
    claim="What a trade says of its truth's own error is at least the share of the real one that targets have to leave, where edges are "
    "sharp, and however many finer meshes an order more is worth.",
    tier="gate",
    grid={"worth": (1.0, 1.2, 1.25, 4 / 3, 2.0)},
    bounds={"told over real": TOLD},
)
def own_error(worth: float) -> dict[str, float]:
    """The smaller one of a loose and a tight target."""
    return {"told over real": told_over_real([LONG], lambda n, _: 0.12 / n, worth)}


#: Errors of two meshes: one that is no matter until the other is finer, as of a slave on a coarse master; one that has few settings.
TOGETHER: dict[str, tuple[Sequence[Sequence[int]], Callable[..., float]]] = {
    "a slave on a coarse master": ([LONG, SHORT], lambda master, slave, _: np.maximum(0.6 / master, 0.16 / slave)),
    "a slave that yields more": ([LONG, SHORT], lambda master, slave, _: np.hypot(0.6 / master, 0.16 / slave)),
    "few settings": ([LONG, (4, 8, 12)], lambda along, round_it, _: 0.2 / along + 0.2 / round_it),
}


@case(
    claim="So it is where two meshes act together: one that changes nothing beside the other one as it is, and does beside a finer one; "
    "one that has few finer settings while the other has many.",
    tier="gate",
    grid={"scene": tuple(TOGETHER)},
    bounds={"told over real": TOLD},
)
def own_error_of_two(scene: str) -> dict[str, float]:
    """The smaller one of a loose and a tight target."""
    return {"told over real": told_over_real(*TOGETHER[scene])}


#: Errors of a mesh and of two more, which change nothing beside it as it is, and which of these are to be refined as it is.
BESIDE: dict[str, tuple[Callable[..., float], tuple[bool, bool]]] = {
    "the first": (lambda mesh, one, _, __: np.maximum(0.6 / mesh, 0.16 / one), (True, False)),
    "the second": (lambda mesh, _, other, __: np.maximum(0.6 / mesh, 0.16 / other), (False, True)),
    "both": (lambda mesh, one, other, _: np.maximum(0.6 / mesh, 0.08 / one + 0.08 / other), (True, True)),
    "both at once": (lambda mesh, one, other, _: np.maximum(0.6 / mesh, 0.16 / np.minimum(one, other)), (True, True)),
    "none": (lambda mesh, _, __, ___: 0.6 / mesh, (False, False)),
}
#: Runs that fail of those that look for what they change, by the settings of both.
FAILS: dict[str, tuple[Choice, ...]] = {"none": (), "before": ((0, 0),), "alone": ((0, 1), (1, 0))}


@case(
    claim="Of meshes that change nothing beside others as they are those that do beside finer ones are refined, and no others; where runs "
    "that look for them fail none is, or, where only those of one alone do, all of them.",
    tier="gate",
    grid={"changes": tuple(BESIDE), "fails": tuple(FAILS)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: meshes that are refined and change nothing, or change much and are not")},
)
def beside_finer(changes: str, fails: str) -> dict[str, float]:
    """How many of two."""
    error, stir = BESIDE[changes]
    known = Sharp([LONG, SHORT, SHORT], error)
    known.fails = lambda choice: choice[0] == choice[4] == 1 and choice[1:3] in FAILS[fails]
    search = Search(known, known.dials, [Want("one", lambda run, _: np.array([run["one"]]), lambda _: np.ones(1))], math.inf)
    search.screen()
    search.find_truth([0.025])
    assert search.truth
    finer = [setting > dial.own + 1 for dial, setting in zip(known.dials[1:3], search.truth.choice[1:3], strict=True)]
    known_of = {"none": stir, "before": (False, False), "alone": (any(stir),) * 2}[fails]
    return {"wrong": float(np.sum(np.array(finer) != known_of))}


@case(
    claim="Who is told that more of the processor would tell a target gets further with more: where the finest meshes that are tried do "
    "not tell it, that is said.",
    tier="gate",
    bounds={
        "budget": Bound(0.0, 0.0, "definition: targets of which a budget is said to be what is missing where none would do"),
        "meshes": Bound(0.0, 0.0, "definition: targets of which meshes are said to be what is missing where a budget would do"),
    },
)
def what_is_missing() -> dict[str, float]:
    """How many of each, without a limit and with one."""
    wrong = []
    for budget, missing in ((math.inf, "begin with finer meshes"), (12.0, "--budget")):
        known = Sharp([LONG], lambda n, _: 0.12 / n)
        search = Search(known, known.dials, [Want("one", lambda run, _: np.array([run["one"]]), lambda _: np.ones(1))], budget)
        search.screen()
        search.find_truth([1e-4])
        wrong.append(missing not in search.answer(1e-4).why)
    return dict(zip(("budget", "meshes"), map(float, wrong), strict=True))


def noise(choice: Choice) -> float:
    """A number that every run has another one of."""
    return float(np.sin(1.0 + 1e3 * np.array(choice) @ np.arange(1.0, 1.0 + len(choice))))


#: What a number is besides what is told well of the other one: off by too much, and round-off.
POOR: dict[str, Callable[[Sharp, Choice], float]] = {
    "off": lambda known, choice: 1.0 + 100.0 * known.off(choice),
    "nothing": lambda _, choice: 1e-16 * noise(choice),
}


@case(
    claim="Of several things that are wanted, a target that is refused names the one that is not told.",
    tier="gate",
    grid={"poor": tuple(POOR), "which": ("first", "second")},
    bounds={
        "told": Bound(1.0, 1.0, "definition: it is named"),
        "wrongly told": Bound(0.0, 0.0, "definition: the other one is"),
    },
)
def which_is_missing(poor: str, which: str) -> dict[str, float]:
    """Whether each is in the sentence."""
    known = Sharp([LONG], lambda n, _: 1e-3 / n)
    names = ["force.well.z", "force.poor.x"][:: 1 if which == "second" else -1]

    def want(name: str) -> Want:
        wanting = POOR[poor] if name == "force.poor.x" else lambda known, choice: 1.0 + known.off(choice)
        return Want(name, lambda run, _: np.array([wanting(known, tuple(run["choice"]))]), lambda _: np.ones(1))

    search = Search(known, known.dials, [want(name) for name in names], math.inf)
    search.screen()
    search.find_truth([0.001])
    why = search.answer(0.001).why
    return {"told": float("force.poor.x" in why), "wrongly told": float("force.well.z" in why)}


@case(
    claim="What changes nothing alone is refined where a target is not told without it: load steps that matter beside finer meshes.",
    tier="gate",
    bounds={
        "refused": Bound(0.0, 0.0, "definition: the dearest settings tell the target"),
        "told over real": TOLD,
    },
)
def settled_alone() -> dict[str, float]:
    """Whether the target is refused, and what is said of the truth's own error over the real one."""
    known = Sharp([LONG], lambda n, steps: np.maximum(0.05 * (12 / n) ** 6, 0.3 / steps), steps=(8, 16, 32, 64, 128))
    search = Search(known, known.dials, [Want("one", lambda run, _: np.array([run["one"]]), lambda _: np.ones(1))], math.inf)
    search.screen()
    search.find_truth([0.01])
    assert search.truth
    refused = RESOLVED * search.uncertainty > 0.01
    return {"refused": float(refused), "told over real": search.uncertainty / known.off(search.truth.choice)}


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


#: A block pressed and dragged, by augmentations that end early.
DRAGGED = """
format = 1
bodies.block.geometry = { kind = "bowl", half_width = 0.5, bottom = 0.0, rise = 0.2, top = 0.8 }
bodies.block.mesh = { order = [2, 2, 1], elements = [3, 3, 1] }
contacts.floor = { slave = "block.w0", plane = { normal = [0, 0, 1] }, friction = 0.3 }
supports.top = { face = "block.w1" }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.2] },
          { name = "drag", steps = 2, motions.top.translate = [0.1, 0, 0] }]
[solver]
method = "METHOD"
augmentation_tolerance = 0.1
newton_tolerance = 1e-3
complementarity_tolerance = 1e-3
"""


@case(
    claim="How far load steps are iterated is refined in over-refined runs, by either method: they have the forces of exact contact "
    "conditions.",
    tier="gate",
    grid={"method": ("monolithic", "uzawa")},
    bounds={
        "left": Bound(at_most=0.1, reason="definition: share of the scene's own error that the dearest tolerance leaves"),
        "off": Bound(at_least=1e-6, reason="definition: what the scene's own tolerance is off by, or there is nothing to refine"),
    },
)
def iterated_to_the_end(method: str) -> dict[str, float]:
    """Errors of the force along the drag."""
    own = Scene.from_toml(DRAGGED.replace("METHOD", method))
    (dial,) = dials_of(own, knobs=[knob for knob in KNOBS if knob.name == "tolerance"])
    exact = own.to_toml(), ['solver.method="monolithic"', "solver.newton_tolerance=1e-12", "solver.complementarity_tolerance=1e-12"]
    true, ours, best = (
        np.array([step.reactions[0].force for step in Simulation(scene.problem()).run()])
        for scene in (Scene.from_toml(exact[0], overrides=exact[1]), own, changed(own, [dial.settings[-1]]))
    )
    off, left = (float(np.linalg.norm(run - true) / np.linalg.norm(true)) for run in (ours, best))
    return {"left": left / off, "off": off}
