"""What a trade expects over-refined runs to take, what it says that finer ones would, and the orders of which it tells the cheapest."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from trade.over_refined import LONG, Sharp

from isomortar.harness import Bound, case
from isomortar.harness.report import duration
from isomortar.trade.knobs import Dial, Setting
from isomortar.trade.laboratory import Choice, Laboratory, Tried
from isomortar.trade.search import RESOLVED, Search
from isomortar.trade.want import Want

#: One number is wanted, of which nothing is a hundredth off but what settings add to it.
WANT = Want("one", lambda run, _: np.array([run["one"]]), lambda _: np.ones(1))
#: Settings by dial, from the scene's own on: elements are on the scale of their number, which makes uneven steps of these.
LABELS = {"order": ("2", "3", "4"), "elements": ("4", "5", "8", "12"), "load steps": ("1", "2", "4", "8")}
#: How many times dearer the next setting of each is alone. One that is cheaper alone is no cheaper beside others; of one that is not tried
#: alone it is taken to be two.
RATES = {"dearer": (1.3, 1.8, 1.5), "free": (1.0, 1.0, 1.0), "cheaper": (0.7, 1.8, 1.5), "untried": (1.3, 1.8, 2.0)}


class Priced(Laboratory):
    """Runs whose costs are products of what settings cost alone, to a power where several are not the scene's own.

    Parameters
    ----------
    rates : sequence of float
        What the next setting of each dial multiplies the cost by.
    power : float
    orders : sequence of sequence of str
        Settings of further bodies' orders, which cost nothing.
    """

    def __init__(self, rates: Sequence[float], power: float, orders: Sequence[Sequence[str]] = ()) -> None:
        parts: dict[str, Any] = {"order": "order", "elements": "elements", "load steps": ""}
        made = [Dial(name, tuple(map(Setting, of)), 0, "", part=parts[name]) for name, of in LABELS.items()]
        made += [Dial(f"order {n}", tuple(map(Setting, of)), 0, "", part="order") for n, of in enumerate(orders)]
        self._rates, self._power = (*rates, *[1.0 for _ in orders]), power
        super().__init__(None, made, Path(), None, lambda _: None)  # type: ignore[arg-type]

    @property
    def dials(self) -> Sequence[Dial]:
        """What may be turned."""
        return self._dials

    def cost(self, choice: Choice) -> float:
        """Of a run, in closed form."""
        several, cost = sum(n > 0 for n in choice) > 1, 1.0
        for dial, rate, number in zip(self._dials, self._rates, choice, strict=True):
            first, second, here = (float(dial.settings[n].label) for n in (0, 1, number))
            times = math.log(here / first) / math.log(second / first) if dial.part == "elements" else number
            cost *= (max(1.0, rate) if several else rate) ** times
        return cost**self._power if several else cost

    def _measured(self, choices: Sequence[Choice], *_: Any, **__: Any) -> dict[Choice, Tried]:
        found = {choice: 1.0 + 0.01 * float(np.sum(0.25 ** np.array(choice))) for choice in choices}
        return {c: Tried(c, "", {"one": one, "cpu_seconds": self.cost(c)}, "", self.cost(c), 0.0) for c, one in found.items()}


@case(
    claim="Where costs of settings multiply, or powers of them do, a trade expects of runs that are finer than those before what they "
    "take, also where a setting costs nothing or less; of what was not tried alone each setting is expected to double it.",
    tier="gate",
    grid={"rates": tuple(RATES), "power": (1.0, 0.6)},
    bounds={
        "apart": Bound(at_most=1e-12, reason="round-off: of logarithms and powers, relative"),
        "choices": Bound(at_least=10.0, reason="definition: or hardly any are finer"),
    },
)
def costs(rates: str, power: float) -> dict[str, float]:
    """The largest relative difference, before there is a truth, where costs multiply themselves, and after two."""
    known, apart, count = Priced(RATES[rates], power), [], 0
    search = Search(known, known.dials, [WANT], math.inf)
    known.run([known.own, *(search.single(n, 1) for n in range(2 if rates == "untried" else 3))])
    every = list(itertools.product(*(range(len(dial.settings)) for dial in known.dials)))
    for before, truth in ((None, None), ((1, 1, 0), (1, 2, 1))):
        if before and truth:
            search._before, search.truth = known.run([before, truth])
        elif power != 1.0:
            continue
        for choice in every:
            if (
                sum(n > 0 for n in choice) > 1
                and choice not in known.outcomes
                and all(a >= b for a, b in zip(choice, truth or choice, strict=True))
            ):
                apart.append(abs(search._cost(choice) / known.cost(choice) - 1.0))
                count += 1
    return {"apart": float(np.max(apart)), "choices": float(count)}


#: Targets over the least one that over-refined runs tell, and by how many times finer meshes have to be for errors of order 1.5 to fall so.
BELOW = {0.9999999: 1.0, 1.0 / 8.0: 4.0}


@case(
    claim="A target that over-refined runs hardly tell takes meshes that are hardly finer, and hardly more than such runs took; one that "
    "is eight times smaller takes meshes four times finer, by errors of order 1.5, and 4^5 times as much.",
    tier="gate",
    grid={"below": tuple(BELOW)},
    bounds={
        "meshes": Bound(1.0, 1.0, "definition: whether so many times finer ones are told"),
        "time": Bound(1.0, 1.0, "definition: whether that of all over-refined runs, so many times, is told"),
    },
)
def needed(below: float) -> dict[str, float]:
    """Whether it is in the sentence."""
    known = Sharp([LONG], lambda n, _: 0.12 / n)
    search = Search(known, known.dials, [WANT], math.inf)
    search.screen()
    search.find_truth([1.0])
    why, finer = search.answer(below * RESOLVED * search.uncertainty).why, BELOW[below]
    runs = 1 + len(search.rivals)  # of a second each
    return {"meshes": float(f"about {finer:.3g} times finer" in why), "time": float(f"some {duration(runs * finer**5)} of" in why)}


@case(
    claim="The cheapest is told of each order that all bodies in contact can have, and whose runs were made; a run whose bodies have "
    "several is of none of them.",
    tier="gate",
    grid={"others": ("fewer", "untried")},
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: orders told of that not all have, and others left out"),
        "mixed": Bound(0.0, 0.0, "definition: runs of several orders that are taken for one of them, and others for none"),
    },
)
def orders(others: str) -> dict[str, float]:
    """How many of each."""
    known = Priced(RATES["dearer"], 1.0, [("2", "3") if others == "fewer" else ("2", "3", "4")])
    search = Search(known, known.dials, [WANT], math.inf)
    search.screen()
    known.run([search.single(0, 2)])  # order 4, of one body
    search.find_truth([0.5])
    answer = search.answer(0.5)
    mixed = 0
    for choice in itertools.product(range(3), (0,), (0,), range(2)):
        own = {LABELS["order"][choice[0]], LABELS["order"][choice[3]]}
        mixed += search.order(choice) != (int(*own) if len(own) == 1 else 0)
    return {"wrong": float(len({2, 3} ^ set(answer.by_order))), "mixed": float(mixed)}


@case(
    claim="Over-refined runs, whose error is none as all others are told by them, are not recommended, however cheap they were.",
    tier="gate",
    bounds={
        "recommended": Bound(0.0, 0.0, "definition: or any cheap truth would come out best"),
        "cheapest": Bound(1.0, 1.0, "definition: whether one of them was the cheapest of all runs, or nothing is tried here"),
    },
)
def own_truth() -> dict[str, float]:
    """Whether one is, and whether it could have been."""
    known = Priced((1.0, 1.0, 1.0), 1.0)
    known.cost = lambda choice: 0.5 ** sum(choice)  # type: ignore[method-assign]
    search = Search(known, known.dials, [WANT], math.inf)
    search.screen()
    search.truth, *search.rivals = known.run([(2, 3, 3), (1, 3, 3)])  # type: ignore[assignment]
    answer = search.answer(0.5)
    over_refined = [run.choice for run in (search.truth, *search.rivals) if run]
    cheapest = min(known.outcomes.values(), key=lambda run: run.cost)
    return {
        "recommended": float(answer.best is None or answer.best.choice in over_refined),
        "cheapest": float(cheapest.choice in over_refined),
    }
