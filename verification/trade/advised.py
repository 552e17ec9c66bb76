"""What a scene could do without: which variants are offered, what they change, and what is recommended of them, of runs in closed form."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from unittest.mock import patch

import numpy as np
from told.either_way import SCENE
from trade.searched import WANT, WORTH, Known, dials, off

from isomortar.harness import Bound, case
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.trade import page
from isomortar.trade.advice import VARIANTS, CheaperSearch, cheaper_dials
from isomortar.trade.knobs import changed, dials_of
from isomortar.trade.laboratory import Choice, Tried
from isomortar.trade.search import AIM, Recommendation, Search

#: Losses that are allowed.
TARGETS = (1e-6, 0.02, 0.05, 0.2)


class Named(Known):
    """Runs that know what they are called; settings of what refines may be dearer than the scene's own, or not."""

    def __init__(self, seed: int, dearer: bool) -> None:
        super().__init__(seed)
        if not dearer:
            self._dials = tuple(replace(dial, settings=dial.settings[: dial.own + 1]) if dial.refines else dial for dial in dials())

    def formula(self, choice: Choice) -> Tried:
        """The run of a choice."""
        return replace(super().formula(choice), name=self.name(choice))


def advised(seed: int, target: float) -> tuple[Known, CheaperSearch, Recommendation]:
    """What is advised."""
    known = Named(seed, dearer=False)
    search = CheaperSearch(known, known._dials, [WANT], math.inf)
    search.screen()
    search.find_truth([target])
    return known, search, search.answer(target)


@case(
    claim="What is advised loses no more than is allowed of the scene as it is, told as it is, and is little dearer than the cheapest of "
    "all variants that lose a tenth less; where that is the scene itself nothing is, and it is said; orders are not asked for.",
    tier="gate",
    grid={"seed": (1, 2, 3)},
    bounds={
        "missed": Bound(at_most=1.0, reason="definition: loss over what is allowed"),
        "unlike": Bound(at_most=1e-12, reason="round-off: the loss that is told from the run's own"),
        "dearer": Bound(at_most=1.0 / WORTH, reason="definition: what promises to save less than a tenth is not run"),
        "wrong": Bound(0.0, 0.0, "definition: answers that are the scene itself, or none without a word of it, or by orders"),
        "found": Bound(at_least=2.0, reason="definition: or nothing is advised"),
    },
)
def what_is_advised(seed: int) -> dict[str, float]:
    """The largest of each over what is allowed, and how many answers there are."""
    missed, unlike, dearer, wrong, found = [0.0], [0.0], [0.0], 0, 0
    for target in TARGETS:
        known, search, answer = advised(seed, target)
        own = known.formula(known.own)
        cheapest = np.min([run.cost for run in known.all() if off(run, own) <= AIM * target])
        if answer.best is None:
            dearer.append(own.cost / cheapest)
            wrong += answer.why != "no variant that was tried loses so little for less"
        else:
            loss, found = off(answer.best, own), found + 1
            missed.append(loss / target)
            unlike.append(abs(answer.error - loss))
            dearer.append(answer.best.cost / cheapest)
            wrong += answer.best.choice == known.own
        wrong += len(answer.by_order) + (search.truth != search.own)
    worst = (float(np.max(values)) for values in (missed, unlike, dearer))
    return dict(zip(("missed", "unlike", "dearer", "wrong", "found"), (*worst, float(wrong), float(found)), strict=True))


_NUMBER = r"([\d.e+-]+)"
LOSES = re.compile(rf"(.*): loses {_NUMBER} % for {_NUMBER} s, {_NUMBER} times less than as it is\.")
COSTS = re.compile(rf"(.*): {_NUMBER} % ± {_NUMBER} % for {_NUMBER} s; the scene as it is: {_NUMBER} % for {_NUMBER} s(;.*)?\.")
BY_ORDER = re.compile(rf"order (\d) (?:needs {_NUMBER} s|was not found to do)")


def apart(told: tuple[str, ...], numbers: tuple[float, ...]) -> float:
    """The largest relative distance of numbers that are told from others."""
    return float(np.max([abs(float(one) / other - 1.0) for one, other in zip(told, numbers, strict=True)]))


@case(
    claim="The scene file of an answer has its settings, and its sentence tells the run's name, its error and cost, what the scene as it "
    "is has, what the truth is off by, and what other orders need; that of advice its loss, its cost and how many times less that is.",
    tier="gate",
    grid={"seed": (1, 2, 3)},
    bounds={
        "off": Bound(at_most=0.05, reason="definition: two digits are told"),
        "wrong": Bound(0.0, 0.0, "definition: names, orders and knobs that are others, and sentences that tell something else"),
    },
)
def sentences(seed: int) -> dict[str, float]:
    """Of an answer of either kind, and of none."""
    known, search, answer = advised(seed, 0.2)
    assert answer.best
    loss, off_by = off(answer.best, search.own), []
    found = LOSES.fullmatch(page.sentence(search, answer))
    wrong = float(found is None or found[1] != known.name(answer.best.choice))
    if found:
        off_by.append(apart(found.groups()[1:], (100.0 * loss, answer.best.cost, search.own.cost / answer.best.cost)))
    _, search, answer = advised(seed, 1e-6)
    wrong += page.sentence(search, answer) != f"Within 0.0001 %: nothing is recommended; {answer.why}."

    known = Named(seed, dearer=True)
    plain = Search(known, dials(), [WANT], math.inf)
    plain.screen()
    plain.find_truth([0.0])
    answer = plain.answer(8.0 * plain.uncertainty)
    assert answer.best
    assert plain.rival
    error, own = off(answer.best, plain.truth), off(plain.own, plain.truth)
    with TemporaryDirectory() as folder, patch.object(known, "scene", lambda choice: SimpleNamespace(to_toml=lambda: str(choice))):
        file = page._recommended(Path(folder), plain, answer)
        wrong += file is None or file.read_text(encoding="utf-8") != str(answer.best.choice)
    told = COSTS.fullmatch(page.sentence(plain, answer))
    wrong += told is None or told[1] != known.name(answer.best.choice)
    if told:
        uncertainty = off(plain.rival, plain.truth)
        off_by.append(apart(told.groups()[1:6], (100.0 * error, 100.0 * uncertainty, answer.best.cost, 100.0 * own, plain.own.cost)))
        rest = told[7] or ""
        others = {order: run for order, run in answer.by_order.items() if dials()[0].settings[answer.best.choice[0]].label != str(order)}
        orders = {int(order): float(cost) if cost else None for order, cost in BY_ORDER.findall(rest)}
        wrong += set(orders) != set(others) or any((orders[order] is None) != (run is None) for order, run in others.items())
        off_by += [apart((str(orders.get(order)),), (run.cost,)) for order, run in others.items() if run and orders.get(order)]
        wrong += f"the binding knob is {answer.binding}" not in rest if answer.binding else "knob" in rest
    return {"off": float(np.max(off_by)), "wrong": float(wrong)}


#: Changes of the blocks, and the dials that they have of what a scene may do without.
BOTH = {"below rigid", "friction of c", "order of above across", "order of below across"}
BOTH |= {"the scene beyond x = 0", "the scene beyond y = 0"}
OFFERED: tuple[tuple[tuple[str, ...], set[str]], ...] = (
    ((), BOTH),
    (("contacts.c.friction=0",), BOTH - {"friction of c"}),
    (("contacts.c.friction=0", "contacts.c.cohesion=0.01"), BOTH),
    (("bodies.below.rigid=true",), BOTH - {"below rigid", "order of below across"}),
    (("bodies.below.mesh={order=[2,2,1],elements=[4,4,1]}",), BOTH - {"order of below across"}),
    (("bodies.above.mesh={order=1,elements=[4,2,2]}",), BOTH - {"order of above across"}),
    (("symmetry={x=0}",), BOTH - {"the scene beyond x = 0"}),
    (("contacts.c={slave='below.w1',master='above.w0',friction=0.3,projection='closest'}",), BOTH - {"below rigid"} | {"above rigid"}),
    (("materials={m={young=2}}", "bodies.below.material='m'", "bodies.below.mesh={order=2,elements=[4,4,1],quadrature=3}"), BOTH),
)


#: The lower block is the slave of a block beside it as well.
BETWEEN = SCENE.replace(
    "contacts.c",
    'bodies.side.geometry = { kind = "box", lower = [-2, -1, -0.5], upper = [-1, 1, 0] }\nsupports.side.face = "side.u0"\n'
    'contacts.side = { slave = "below.u0", master = "side.u1" }\ncontacts.c',
)


def has(problem: Problem, name: str) -> bool:
    """Whether a problem has what a dial of that name promises."""
    if "rigid" in name:
        return problem.body(name.split()[0]).rigid
    if name == "friction of c":
        return not problem.contacts[0].friction_law.acts
    if "beyond" in name:
        return name[17] in {"xyz"[plane.axis] for plane in problem.symmetry}
    return [direction.order for direction in problem.body(name.split()[2]).patch.directions] == [2, 2, 1]


@case(
    claim="Variants are offered of what a scene has: rigid masters that deform and are no slaves, contacts without friction, halves by the "
    "planes in which it is symmetric, and lower orders across; each makes a scene that has it, and up to the scene's own alone.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: variants that are not offered, or for nothing, or do not make what they promise")},
)
def offered_variants() -> dict[str, float]:
    """How many, of nine scenes."""
    wrong = 0
    for changes, names in OFFERED:
        scene = Scene.from_toml(SCENE, overrides=changes)
        offered = {dial.name: dial for dial in dials_of(scene, (), VARIANTS)}
        wrong += len(names ^ offered.keys())
        wrong += sum(not has(changed(scene, [offered[name].settings[0]]).problem(), name) for name in names & offered.keys())
    wrong += {dial.name for dial in dials_of(Scene.from_toml(BETWEEN), (), VARIANTS) if "rigid" in dial.name} != {"side rigid"}
    everything = {dial.name: dial for dial in cheaper_dials(Scene.from_toml(SCENE))}
    wrong += not everything.keys() > BOTH
    wrong += sum(dial.refines and dial.own != len(dial.settings) - 1 for dial in everything.values())
    both = changed(Scene.from_toml(SCENE), [everything[name].settings[0] for name in ("below rigid", "quadrature of below")])
    return {"wrong": float(wrong + (not both.problem().body("below").rigid))}  # one takes away what the other changes
