"""What a trade runs no more where its budget is spent, and what it makes of runs that fail, or are not what was forecast."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
from trade.searched import WANT, Known, dials, off

from isomortar.errors import IsomortarError
from isomortar.harness import Bound, case
from isomortar.harness.measurement import Measurement
from isomortar.trade.laboratory import Choice, Laboratory, Tried
from isomortar.trade.search import TRUTH, Search

#: Targets over what over-refined runs differ by.
SHARES = (3.1, 8.0)
#: Budgets over what is spent when a search begins.
BUDGETS = (0.9, 1.1, 2.0)


class Watched(Known):
    """Runs in closed form, of which some fail, or are farther off than the sum of single settings.

    `late` counts runs that begin with more spent than `most`.
    """

    def __init__(self, seed: int) -> None:
        super().__init__(seed)
        self.most, self.late = math.inf, 0
        self.fails: Callable[[Choice], bool] = lambda _: False
        self.farther = 0.0

    def formula(self, choice: Choice) -> Tried:
        """The run of a choice; two settings or more that are cheaper are `farther` off together."""
        tried = super().formula(choice)
        if self.fails(choice):
            return replace(tried, failure="out of memory")
        cheaper = sum(dial.refines and setting < dial.own for dial, setting in zip(self._dials, choice, strict=True))
        two = np.array(tried.numbers["two"]) * (1.0 + self.farther * (cheaper > 1))
        return replace(tried, numbers=tried.numbers | {"two": two})

    def _measured(self, choices: Sequence[Choice], *_: Any, fresh: bool = False, **__: Any) -> dict[Choice, Tried]:
        self.late += bool(choices) and not fresh and self.spent > self.most
        return super()._measured(choices)


def searching(known: Watched) -> Search:
    """A search whose single settings are run."""
    search = Search(known, dials(), [WANT], math.inf)
    search.screen()
    return search


def told_by(known: Watched) -> str:
    """Why a search finds no truth; nothing, where it does."""
    try:
        searching(known).find_truth([0.0])
    except IsomortarError as error:
        return str(error)
    return ""


@case(
    claim="Where half of a budget is spent nothing more is run to find the truth, and where all of it is nothing more to find what is "
    "cheapest.",
    tier="gate",
    grid={"seed": (1, 2, 3)},
    bounds={"late": Bound(0.0, 0.0, "definition: runs that begin when there is no budget for them")},
)
def within_budget(seed: int) -> dict[str, float]:
    """Of both phases of a search, by budgets."""
    late = 0
    for share in BUDGETS:
        first, known = Watched(seed), Watched(seed)
        searching(first).find_truth([math.inf])
        search = searching(known)
        known.most, search.budget = share * first.spent, share * first.spent / TRUTH
        search.find_truth([math.inf, 0.0])
        known.most = search.budget = share * known.spent
        for target in SHARES:
            search.answer(target * search.uncertainty)
        late += known.late
    return {"late": float(late)}


@case(
    claim="A scene that fails, and first over-refined runs that do, end a search with why; where later ones fail the truth is the last one "
    "that came to its end.",
    tier="gate",
    grid={"seed": (1, 2, 3)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: of four searches those that end otherwise")},
)
def failing(seed: int) -> dict[str, float]:
    """How many."""
    own, refined, untold, later = (Watched(seed) for _ in range(4))
    own.fails = lambda choice: choice == own.own
    refined.fails = lambda choice: sum(setting > dial.own for dial, setting in zip(dials(), choice, strict=True)) > 1
    untold.effects = [effect * np.nan for effect in untold.effects]
    first = searching(Watched(seed))
    first.find_truth([math.inf])
    assert first.truth
    later.fails = lambda choice: choice not in first.laboratory.outcomes
    search = searching(later)
    search.find_truth([math.inf, 0.0])
    assert search.truth
    said = [
        "there is nothing to trade: out of memory" in told_by(own),
        "does not come to its end: out of memory" in told_by(refined),
        "there is nothing to trade: not finite: two numbers" in told_by(untold),
        search.truth.choice == first.truth.choice,
    ]
    return {"wrong": float(said.count(False))}


@case(
    claim="Where nothing is recommended it is said whether the budget was spent, or what was tried does not come so near; where runs fail "
    "what is recommended is one of the others, within its target.",
    tier="gate",
    grid={"seed": (1, 2, 3)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: of two searches in vain, and of one all of whose further runs fail, by two targets")},
)
def in_vain(seed: int) -> dict[str, float]:
    """Those that say something else, or recommend what failed, or is farther off."""
    known = Watched(seed)
    search, wrong = searching(known), 0
    search.find_truth([0.0])
    known.fails = lambda choice, runs=tuple(known.outcomes): choice not in runs  # type: ignore[misc]
    for share in SHARES:
        best = search.answer(share * search.uncertainty).best
        wrong += best is not None and not off(best, search.truth) <= share * search.uncertainty
    for budget, words in ((0.5 * known.spent, "within the budget"), (math.inf, "comes so near for less")):
        search.budget = budget
        with patch.object(search, "_pursued", return_value=None):
            wrong += words not in search.answer(SHARES[0] * search.uncertainty).why
    return {"wrong": float(wrong)}


@case(
    claim="What is recommended is within its target where settings that are cheaper together are farther off than the sum of each alone.",
    tier="gate",
    grid={"seed": (1, 2, 3)},
    bounds={
        "missed": Bound(at_most=1.0, reason="definition: error over target"),
        "found": Bound(at_least=1.0, reason="definition: or nothing is recommended"),
    },
)
def unlucky(seed: int) -> dict[str, float]:
    """The largest over the targets, and how many."""
    errors = []
    for share in (4.0, 8.0, 16.0):
        known = Watched(seed)
        known.farther = 1.0
        search = searching(known)
        search.find_truth([0.0])
        target = share * search.uncertainty
        answer = search.answer(target)
        errors += [off(answer.best, search.truth) / target] if answer.best else []
    return {"missed": float(np.array(errors).max(initial=0.0)), "found": float(len(errors))}


@case(
    claim="A run that ended and whose numbers are finite did not fail; one of which a number is not says which, but for numbers that need "
    "not be there, and one that did not end says why.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: of three runs those of which something else is said")},
)
def failures() -> dict[str, float]:
    """How many."""
    laboratory = Laboratory(None, dials(), Path(), None, lambda _: None)  # type: ignore[arg-type]
    ended = Measurement("measured", {"force": [1.0], "area": [math.nan], "pressure": [2.0]})
    asked = (
        (ended, ""),
        (replace(ended, numbers={"force": [math.inf], "pressure": [math.nan]}), "not finite: force, pressure"),
        (replace(ended, ending="timed out", message="no result after 9 s"), "no result after 9 s"),
    )
    return {"wrong": float(sum(laboratory._tried(laboratory.own, measurement).failure != words for measurement, words in asked))}
