"""What a trade forecasts and recommends, of runs whose results and costs are known in closed form, beside all combinations one by one."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np

from isomortar.harness import Bound, case
from isomortar.trade.knobs import Dial, Setting
from isomortar.trade.laboratory import Choice, Laboratory, Tried
from isomortar.trade.model import Model, Yardstick
from isomortar.trade.search import Recommendation, Search
from isomortar.trade.want import Want

#: Two numbers are wanted of each run; the norm of errors is that of both.
WANT = Want("two numbers", lambda run, _: np.array(run["two"]), lambda _: np.array([0.75, 0.25]))
#: Targets over what over-refined runs differ by, where these can be refined no more: nobody can tell the first.
SHARES = (2.5, 3.5, 8.0)
#: What says that.
REFUSED = "nobody could tell whether it is reached"
#: What forecasts aim at as a share of the target, and what another combination promises to cost that is run.
AIM, WORTH = 0.9, 0.9


def dials() -> tuple[Dial, ...]:
    """What refines, with cheaper and dearer settings than the scene's own, and a choice."""
    labels = {"order of block": ("2", "3", "4"), "elements of block along u": ("2", "4", "6", "8"), "load steps": ("2", "4", "8")}
    parts: tuple[Literal["order", "elements", ""], ...] = ("order", "elements", "")
    refining = [Dial(name, tuple(map(Setting, of)), 1, "", part=part) for (name, of), part in zip(labels.items(), parts, strict=True)]
    return (*refining, Dial("way", tuple(map(Setting, "abc")), 1, "", refines=False))


class Known(Laboratory):
    """Runs that are sums of what the settings of each dial do to the numbers, and products of what they cost."""

    def __init__(self, seed: int) -> None:
        super().__init__(None, dials(), Path(), None, lambda _: None)  # type: ignore[arg-type]
        random = np.random.default_rng(seed)
        self.effects, self.costs = [], []
        for dial in self._dials:
            count = len(dial.settings)
            size = 0.05 * random.random() + 0.01
            left = size * 0.4 ** np.arange(count) if dial.refines else size * random.random(count)
            self.effects.append(left[:, None] * [1.0, 0.3])  # errors of one sign: none cancels another by luck
            dearer = 1.0 + random.random() if dial.refines else random.uniform(0.5, 2.0)
            self.costs.append(dearer ** np.arange(count))

    def formula(self, choice: Choice) -> Tried:
        """The run of a choice."""
        two = np.array([1.0, 0.5]) + sum(effect[n] for effect, n in zip(self.effects, choice, strict=True))
        cost = math.prod(float(cost[n]) for cost, n in zip(self.costs, choice, strict=True))
        return Tried(choice, "", {"two": two, "cpu_seconds": cost}, "", cost, 0.0)

    def all(self) -> Iterator[Tried]:
        """The runs of all choices."""
        return map(self.formula, itertools.product(*(range(len(dial.settings)) for dial in self._dials)))

    def _measured(self, choices: Sequence[Choice], *_: Any, **__: Any) -> dict[Choice, Tried]:
        return {choice: self.formula(choice) for choice in choices}


def size(values: np.ndarray) -> float:
    """The norm of two numbers, in full."""
    return math.sqrt(0.75 * values[0] ** 2 + 0.25 * values[1] ** 2)


def off(run: Tried, truth: Tried | None) -> float:
    """How far a run is from another, over the size of that."""
    assert truth
    there = np.array(truth.numbers["two"])
    return size(np.array(run.numbers["two"]) - there) / size(there)


def over_refined(last: int) -> Choice:
    """The dearest setting of all that refines, or the last but one; else the scene's own."""
    return tuple(len(dial.settings) - last if dial.refines else dial.own for dial in dials())


@case(
    claim="Where what settings do adds up and what they cost multiplies, forecasts from single settings are exact for each of all "
    "combinations, and those that count on no luck promise no less error than there is.",
    tier="gate",
    grid={"seed": (1, 2, 3)},
    bounds={
        "error": Bound(at_most=1e-12, reason="round-off: of errors as a share of the truth"),
        "cost": Bound(at_most=1e-12, reason="round-off: of products"),
        "promised": Bound(at_most=1e-12, reason="round-off: by how much more an unhopeful forecast promises"),
    },
)
def forecasts(seed: int) -> dict[str, float]:
    """Largest differences from the runs themselves."""
    known = Known(seed)
    own = known.own
    known.run([(*own[:n], s, *own[n + 1 :]) for n, dial in enumerate(dials()) for s in range(len(dial.settings))])
    truth, rival = (known.formula(over_refined(last)) for last in (1, 2))
    yardsticks = [Yardstick(WANT, truth, rival)]
    hopeful, plain = (Model(dials(), own, known.outcomes, yardsticks, hopeful=hopeful) for hopeful in (True, False))
    worst = np.zeros(3)
    for run in known.all():
        forecast, error = hopeful.forecast(run.choice), off(run, truth)
        promised = error - plain.forecast(run.choice).error
        worst = np.maximum(worst, [abs(forecast.error - error), abs(forecast.cost / run.cost - 1.0), promised])
    return dict(zip(("error", "cost", "promised"), map(float, worst), strict=True))


@case(
    claim="A forecast that counts on no luck is that of one of the runs with most of its settings: what refines moves the error of that as "
    "it did alone, and what coarsens, or refines nothing, adds the size of what it changed alone.",
    tier="gate",
    grid={"seed": (1, 2, 3)},
    bounds={
        "error": Bound(at_most=1e-12, reason="round-off: from the sum by the runs in closed form, as a share of the truth"),
        "refined": Bound(at_least=1.0, reason="definition: or nothing has moved"),
        "chosen": Bound(at_least=1.0, reason="definition: or nothing that refines nothing was turned to what comes later"),
    },
)
def without_luck(seed: int) -> dict[str, float]:
    """Largest difference, and how many settings moved errors or added to them."""
    known = Known(seed)
    known.effects = [effect * [1.0, (-1.0) ** n] for n, effect in enumerate(known.effects)]  # a size of a sum is no sum of sizes
    singles = [(*known.own[:n], s, *known.own[n + 1 :]) for n, dial in enumerate(dials()) for s in range(len(dial.settings))]
    known.run(singles)
    truth, rival = (known.formula(over_refined(last)) for last in (1, 2))
    model = Model(dials(), known.own, known.outcomes, [Yardstick(WANT, truth, rival)])
    there, worst, counts = np.array(truth.numbers["two"]), 0.0, np.zeros(2)
    for run in known.all():
        turned = [[n for n, (a, b) in enumerate(zip(single, run.choice, strict=True)) if a != b] for single in singles]
        least, found = min(map(len, turned)), []
        for single, numbers in zip(singles, turned, strict=True):
            if len(numbers) > least:
                continue
            error, lost = np.array(known.formula(single).numbers["two"]) - there, 0.0
            for n in numbers:
                change = known.effects[n][run.choice[n]] - known.effects[n][single[n]]
                refines = dials()[n].refines and run.choice[n] > single[n]
                counts += [refines, not dials()[n].refines and run.choice[n] > single[n]]
                error, lost = (error + change, lost) if refines else (error, lost + size(change))
            found.append((size(error) + lost) / size(there))
        worst = np.maximum(worst, np.abs(np.array(found) - model.forecast(run.choice).error).min())
    return {"error": float(worst), "refined": float(counts[0]), "chosen": float(counts[1])}


@case(
    claim="What a search recommends has the accuracy that is asked for and is no more than a tenth dearer than the cheapest of all "
    "combinations that have it with a tenth to spare, of each order the cheapest that was run; "
    "targets that over-refined runs do not tell are refused, and no others.",
    tier="gate",
    grid={"seed": (1, 2, 3)},
    bounds={
        "missed": Bound(at_most=1.0, reason="definition: error over target"),
        "dearer": Bound(at_most=1.0 / WORTH, reason="definition: what promises to save less than a tenth is not run"),
        "dearer_by_order": Bound(at_most=1.0, reason="definition: of each order the cheapest of the runs that were made"),
        "unlike": Bound(at_most=1e-12, reason="round-off: the error that is told from the run's own"),
        "wrongly_told": Bound(0.0, 0.0, "definition: targets refused above three times what two such runs differ by, or answered below"),
    },
)
def recommended(seed: int) -> dict[str, float]:
    """The largest of each over the targets."""
    worst = np.zeros(5)
    for share in SHARES:
        known = Known(seed)
        search = Search(known, dials(), [WANT], math.inf)
        search.screen()
        search.find_truth([0.0])
        assert search.truth
        assert search.rival
        target = share * off(search.rival, search.truth)
        answer = search.answer(target)
        worst[4] += (REFUSED in answer.why) != (share < 3.0) or (answer.best is None) != (share < 3.0)
        if answer.best is not None:
            error = off(answer.best, search.truth)
            worst = np.maximum(worst, [error / target, *dearer(known, search, answer), abs(answer.error - error), 0.0])
    return dict(zip(("missed", "dearer", "dearer_by_order", "unlike", "wrongly_told"), map(float, worst), strict=True))


def dearer(known: Known, search: Search, answer: Recommendation) -> tuple[float, float]:
    """Cost over that of the cheapest that is as near to the truth: of all combinations; order by order, at its worst, of the runs made."""
    assert search.truth
    assert answer.best

    def within(runs: Iterable[Tried], share: float = 1.0) -> list[Tried]:
        return [run for run in runs if off(run, search.truth) <= share * answer.target]

    least, by_order = np.min([run.cost for run in within(known.all(), AIM)]), [1.0]
    over_refined_runs = [run.choice for run in (search.truth, *search.rivals)]
    made = [run for choice, run in known.outcomes.items() if choice not in over_refined_runs]
    for order, found in answer.by_order.items():
        alike = [run.cost for run in within(made) if dials()[0].settings[run.choice[0]].label == str(order)]
        by_order.append((found.cost if found else math.inf) / np.min(alike) if alike else 1.0 if found is None else math.inf)
    return float(answer.best.cost / least), float(np.max(by_order))
