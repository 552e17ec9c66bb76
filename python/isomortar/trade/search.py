"""The search of a trade: truth, screening of single settings, and the cheapest combination for a target, verified by runs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from functools import cached_property

import numpy as np

from isomortar._frozen import frozen
from isomortar.errors import IsomortarError
from isomortar.harness.report import duration, percent
from isomortar.trade.knobs import Dial
from isomortar.trade.laboratory import Choice, Laboratory, Tried
from isomortar.trade.model import Model, Yardstick
from isomortar.trade.want import Want

#: Where over-refined runs differ by this share of what is wanted, it is round-off or nothing they have in common.
NOTHING = 0.5
#: A target is told from the truth's own error where it is this many times as large.
RESOLVED = 3.0
#: Forecasts aim at this share of the target; what is measured may take all of it.
AIM = 0.9
#: Another combination is tried where it should cost less than this share of the best one so far.
WORTH = 0.9
#: What changes the result by less than this share of the error that the truth has, or may have for a target, is not what that comes from.
SETTLED = 1.0 / 10.0
#: Combinations that are tried for one target.
TRIES = 12
#: Share of the budget that over-refined runs may take where something is told that the rest can look for: half, as a search for what is
#: cheapest took about as much as the truth that it needs.
TRUTH = 0.5
#: Unknowns and their cost with element size: what an answer without enough truth estimates the need by.
RATE, COST = 1.5, 5.0


@frozen
class Recommendation:
    """What came of a target.

    Parameters
    ----------
    target : float
    best : Tried or None
        The cheapest run within the target, run afresh.
    error : float
        Its error: the largest of those wanted.
    why : str
        Why there is none; empty where there is.
    binding : str
        The dial whose next dearer setting would lower the error most.
    by_order : dict of int to Tried or None
        The cheapest run within the target by order of all bodies.
    cut : bool
        Whether the budget ended the search: something cheaper may do.
    """

    target: float
    best: Tried | None
    error: float
    why: str = ""
    binding: str = ""
    by_order: Mapping[int, Tried | None] = field(default_factory=dict)
    cut: bool = False


class Search:
    """The cheapest settings of a scene for what is wanted.

    Parameters
    ----------
    laboratory : Laboratory
    dials : sequence of Dial
    wants : sequence of Want
    budget : float
        CPU seconds that all runs may take; a run that has begun is ended.
    """

    def __init__(self, laboratory: Laboratory, dials: Sequence[Dial], wants: Sequence[Want], budget: float) -> None:
        self.laboratory, self.dials, self.wants, self.budget = laboratory, dials, wants, budget
        self.truth: Tried | None = None
        self.rivals: tuple[Tried, ...] = ()  # other over-refined runs: how far they are from the truth is its own error
        self._before: Tried | None = None  # the truth before this one
        self._finest = False  # whether the truth has the dearest settings that there are
        self._failure = ""  # why over-refined runs finer than the truth did not come to their end
        self._cut = False  # whether the last search of a target was ended by the budget
        self._level, self._share = 1, TRUTH  # of the next over-refined runs, and what of the budget they may take
        self._stirring: set[int] = set()  # dials that may change what is wanted beside finer settings of others alone

    @cached_property
    def own(self) -> Tried:
        """The scene as it is.

        Raises
        ------
        IsomortarError
            It does not come to its end, does not tell what is wanted, or has nothing of it.
        """
        (own,) = self.laboratory.run([self.laboratory.own])
        untold = [] if own.failure else [w.text for w in self.wants if not np.isfinite(w.values(own.numbers, own.numbers)).all()]
        failure = f"not finite: {', '.join(untold)}" if untold else own.failure
        if failure:
            raise IsomortarError(f"the scene as it is does not come to its end, so that there is nothing to trade: {failure}")
        nothing = [w.text for w in self.wants if w.is_nothing(own.numbers)]
        if nothing:
            raise IsomortarError(
                f"of {', '.join(nothing)} the scene as it is has nothing but round-off, as by symmetry or on a mesh that is too coarse for "
                "it, and errors are no share of that: want something else, or refine the scene"
            )
        return own

    @property
    def yardsticks(self) -> list[Yardstick]:
        """How far from the truth, by what is wanted."""
        assert self.truth
        return [Yardstick(want, self.truth, *self.rivals) for want in self.wants]

    @property
    def rival(self) -> Tried | None:
        """The over-refined run that is farthest from the truth."""
        return max(self.rivals, key=self.error, default=None)

    @property
    def model(self) -> Model:
        """Forecasts from all runs so far."""
        return self._forecasts(hopeful=False)

    @property
    def uncertainty(self) -> float:
        """The truth's own error: the largest of what is wanted."""
        return max(yardstick.uncertainty for yardstick in self.yardsticks)

    def error(self, outcome: Tried) -> float:
        """Distance from the truth: the largest of what is wanted; infinite where the run failed, or does not tell it."""
        return max(yardstick.error(outcome) for yardstick in self.yardsticks)

    def screen(self) -> None:
        """Run every dial one setting cheaper and one dearer, and every choice.

        Raises
        ------
        IsomortarError
            The budget is not even enough for that.
        """
        singles = []
        for number, dial in enumerate(self.dials):
            near = (dial.own - 1, dial.own + 1) if dial.refines else range(len(dial.settings))
            singles += [self.single(number, setting) for setting in near if 0 <= setting < len(dial.settings)]
        runs = len({*singles} - {self.own.choice})
        needed = self.own.cost * runs
        if needed > self.budget:
            raise IsomortarError(
                f"the scene as it is takes {duration(self.own.cost)} of the processor, so that to turn every knob alone, "
                f"{runs} runs, takes about {duration(needed)}, and the budget is {duration(self.budget)}: give more "
                "(--budget, in minutes), or begin with a coarser scene"
            )
        self.laboratory.run([self.own.choice, *singles])

    def find_truth(self, targets: Sequence[float], share: float = TRUTH) -> None:
        """Over-refined runs of other orders and other meshes, refined from the largest target to the smallest until they tell it.

        One differs in both, which may hide an error of either behind that of the other: one more differs from the truth in its mesh alone.
        They are as good as a target asks: what for 5 % spends nothing on load steps that change a thousandth may be enough for 1 % as well.
        Meshes that change nothing either are looked at once more beside the finer ones.
        Ends where all is told, a share of the budget is spent, or two levels tell next to nothing; goes on from there where it is given
        more.

        Raises
        ------
        IsomortarError
            Such a run does not come to its end, or all are one: nothing can be refined.
        """
        self._share, last = share, max(len(dial.settings) for dial in self.dials)
        for target in sorted(targets, reverse=True):
            while self.truth is None or self._stirs(target) or not self._told(target):
                if self._level > last or self._hopeless or not self._refine(self._level, target):
                    return
                self._level += 1

    def answers(self, targets: Sequence[float]) -> list[Recommendation]:
        """The cheapest settings for some targets.

        What is told by half of the budget is looked for first; where that leaves targets that are not told, the truth has the rest of it.
        """
        self.find_truth(targets)
        untold = [target for target in targets if not self._told(target)]
        if untold:
            for target in targets:
                if target not in untold:
                    self._search(target)
            self.find_truth(untold, 1.0)
        return [self.answer(target) for target in targets]

    def answer(self, target: float) -> Recommendation:
        """The cheapest settings for a target, as a whole and by order."""
        if not self._told(target):
            return Recommendation(target, None, math.nan, self._needed(target))
        best, by_order = self._search(target)
        if best is None:
            why = "no combination was found within the budget" if self._over else "no combination that was tried comes so near for less"
            return Recommendation(target, None, math.nan, why, "", by_order)
        afresh = self.laboratory.run_afresh(best.choice)
        return Recommendation(target, afresh, self.error(afresh), "", self._binding(afresh.choice), by_order, self._cut)

    def _search(self, target: float) -> tuple[Tried | None, dict[int, Tried | None]]:
        """The cheapest run within a target that is told, as a whole and by order."""
        self._cut, orders = False, dict(self._orders())
        for kept in orders.values():
            self._pursued(target, kept, hopeful=False)
        self._pursued(target, {}, hopeful=False)
        best = self._pursued(target, {}, hopeful=True)
        return best, {order: self._cheapest(target, kept) for order, kept in orders.items()}

    def order(self, choice: Choice) -> int:
        """The order that all bodies in contact have; 0 where they differ."""
        orders = {int(d.settings[s].label) for d, s in zip(self.dials, choice, strict=True) if d.part == "order"}
        return orders.pop() if len(orders) == 1 else 0

    def single(self, number: int, setting: int) -> Choice:
        """The scene's own settings but for one."""
        return tuple(setting if n == number else s for n, s in enumerate(self.laboratory.own))

    @property
    def _over(self) -> bool:
        return self.laboratory.spent > self.budget

    def _told(self, target: float) -> bool:
        """Whether the truth is known well enough for a target."""
        return RESOLVED * self.uncertainty <= target

    @property
    def _hopeless(self) -> bool:
        """Whether over-refined runs of two levels, one after the other, differ by half of what is wanted: a third one tells nothing."""
        return self._before is not None and not self.uncertainty < NOTHING

    def _refine(self, level: int, target: float) -> bool:
        """Run over-refined runs of a level; whether they tell the truth better than those before."""
        settled = self._settled(target)
        if self.truth and self._refined(settled, 1, level, 1) == self.truth.choice:
            self._stirring |= settled  # what does nothing alone may do something beside finer settings
            settled = set()
        finest = self._refined(settled, 1, level, 1)
        coarser = self._coarser(self._refined(settled, 2, level, 2), 1), self._coarser(finest, 2)
        others = [other for other in dict.fromkeys(coarser) if other != finest]
        choices = (finest, *others)
        self._finest = self.truth is not None and finest == self.truth.choice
        if self._finest or (self.truth and self.laboratory.spent + sum(map(self._cost, choices)) > self._share * self.budget):
            return False
        if not others:
            raise IsomortarError("nothing of the scene can be refined further, so that two runs cannot tell what the truth is")
        truth, *rivals = self.laboratory.run(choices)
        failed = [outcome for outcome in (truth, *rivals) if outcome.failure]
        if failed and self.truth:
            self._failure = failed[0].failure
            return False
        if failed:
            raise IsomortarError(f"an over-refined run, which tells the truth, does not come to its end: {failed[0].failure}")
        self._before, self.truth, self.rivals, self._failure = self.truth, truth, tuple(rivals), ""
        return True

    def _refined(self, settled: set[int], orders: int, meshes: int, last: int) -> Choice:
        """Orders and meshes so many settings dearer than the scene's own; of all else that refines the dearest setting, or the last but.

        What is settled is not refined on: its mesh by one setting, all else by one or not at all.
        """

        def setting(number: int, dial: Dial) -> int:
            if dial.part == "order":
                return dial.own + orders
            if dial.part == "elements":
                return dial.own + (min(meshes, 1) if number in settled else meshes)
            if not dial.refines:
                return dial.own
            return dial.own + 2 - last if number in settled else max(dial.own, len(dial.settings) - last)

        return tuple(min(len(d.settings) - 1, setting(number, d)) for number, d in enumerate(self.dials))

    def _coarser(self, choice: Choice, by: int) -> Choice:
        """With meshes that are so many settings coarser along each direction, but none coarser than the scene's own."""
        return tuple(max(d.own, s - by) if d.part == "elements" else s for d, s in zip(self.dials, choice, strict=True))

    def _stirs(self, target: float) -> bool:
        """Whether meshes that are settled beside the scene's own ones are not beside finer ones: a slave on a finer master, say."""
        assert self.truth
        if self.laboratory.spent > self._share * self.budget:
            return False
        beside, settled = self._coarser(self.truth.choice, 2), self._settled(target)
        meshes = {number for number in settled if self.dials[number].part == "elements"}
        stirring = meshes if self._moved(beside, meshes) > self._limit(target) else set()
        if len(stirring) > 1:
            stirring = {number for number in meshes if self._moved(beside, {number}) > self._limit(target)} or meshes
        self._stirring |= stirring
        return bool(stirring)

    def _moved(self, choice: Choice, meshes: set[int]) -> float:
        """By how much a setting more of some meshes changes what is wanted; nothing where such a run fails."""
        finer = tuple(setting + (number in meshes) for number, setting in enumerate(choice))
        before, after = self.laboratory.run([choice, finer])
        return max(y.norm(y.values(after) - y.values(before)) if y.told(before) and y.told(after) else 0.0 for y in self.yardsticks)

    def _limit(self, target: float) -> float:
        """What changes less of what is wanted is next to nothing, beside the error that the truth may have or has."""
        return SETTLED * max(target / RESOLVED, self.uncertainty if self.truth else 0.0)

    def _settled(self, target: float) -> set[int]:
        """Dials whose next dearer setting changes next to nothing of what is wanted, and did so beside finer meshes."""
        known = self.truth or self.own
        yardsticks = self.yardsticks if self.truth else [Yardstick(want, known, known) for want in self.wants]
        model = Model(self.dials, self.laboratory.own, self.laboratory.outcomes, yardsticks)
        dearer = {number: dial.own + 1 for number, dial in enumerate(self.dials) if dial.own + 1 in model.settings(number)}
        return {number for number, setting in dearer.items() if model.effect(number, setting) <= self._limit(target)} - self._stirring

    def _cost(self, choice: Choice) -> float:
        """CPU seconds that an over-refined run will take about: what the nearest of those before took, and one setting alone.

        Costs of single settings do not multiply: the forecast is as far off as it was of the truth from the one before.
        """
        if choice in self.laboratory.outcomes:
            return 0.0
        before = [outcome for outcome in (self.own, self.truth, *self.rivals) if outcome]
        near = min(before, key=lambda outcome: sum(a != b for a, b in zip(outcome.choice, choice, strict=True)))
        fit = 1.0
        if self.truth and self._before:
            foretold = self._growth(self._before.choice, self.truth.choice)  # nothing, where no setting alone was dearer
            fit = math.log(max(1.0, self.truth.cost / self._before.cost)) / foretold if foretold > 0.0 else fit
        return near.cost * math.exp(fit * self._growth(near.choice, choice))

    def _growth(self, start: Choice, end: Choice) -> float:
        """Logarithm of how many times dearer one choice is than another, if costs of single settings multiply."""
        known, growth = self.laboratory.outcomes, 0.0
        for number, (dial, one, other) in enumerate(zip(self.dials, start, end, strict=True)):
            if other > one:
                next_one = known.get(self.single(number, dial.own + 1))
                times = max(1.0, next_one.cost / self.own.cost) if next_one else 2.0
                growth += math.log(times) * (_times(dial, other) - _times(dial, one))
        return growth

    def _needed(self, target: float) -> str:
        """Why a target is refused, and what it would take."""
        worst = max(self.yardsticks, key=lambda yardstick: yardstick.uncertainty).want.text
        if not self.uncertainty < NOTHING:
            return f"{worst} is nothing in this scene, or over-refined runs differ by half of it and more"
        finer = (RESOLVED * self.uncertainty / target) ** (1.0 / RATE)
        assert self.truth
        told = (
            f"over-refined runs differ by {percent(self.uncertainty)} in {worst}, and {percent(target)} is less than {RESOLVED:g} times "
            f"that: nobody could tell whether it is reached. Meshes about {finer:.3g} times finer would tell"
        )
        if self._finest:
            return f"{told}, and none that are finer are tried: begin with finer meshes in the scene"
        if self._failure:
            return f"{told}, and over-refined runs on finer ones do not come to their end: {self._failure}"
        needed = duration(sum(run.cost for run in (self.truth, *self.rivals)) * finer**COST)
        return f"{told}, some {needed} of the processor for these, beside {duration(self.laboratory.spent)} of all runs so far (--budget)"

    def _orders(self) -> Iterator[tuple[int, dict[int, int]]]:
        """Orders that all bodies in contact can have, and the settings that are kept for each."""
        numbers = [number for number, dial in enumerate(self.dials) if dial.part == "order"]
        labels = [[setting.label for setting in self.dials[number].settings] for number in numbers]
        tried = self.model
        for label in sorted(set(labels[0]).intersection(*labels[1:]), key=int) if labels else ():
            kept = {number: found.index(label) for number, found in zip(numbers, labels, strict=True)}
            if all(setting in tried.settings(number) for number, setting in kept.items()):
                yield int(label), kept

    def _forecasts(self, *, hopeful: bool) -> Model:
        return Model(self.dials, self.laboratory.own, self.laboratory.outcomes, self.yardsticks, hopeful=hopeful)

    def _cheapest(self, target: float, kept: Mapping[int, int]) -> Tried | None:
        """The cheapest of the runs within a target, with some dials `kept` at a setting; None: there is none."""
        truths = (self.truth, *self.rivals)
        alike = [o for o in self.laboratory.outcomes.values() if o not in truths and all(o.choice[n] == s for n, s in kept.items())]
        return min((o for o in alike if self.error(o) <= target), key=lambda o: o.cost, default=None)

    def _pursued(self, target: float, kept: Mapping[int, int], *, hopeful: bool) -> Tried | None:
        """The same after a search; what is forecast is run, and corrects the forecasts."""
        best = self._cheapest(target, kept)
        for _ in range(TRIES):
            if self._over:
                self._cut = True
                break
            model = self._forecasts(hopeful=hopeful)
            choice = model.cheapest(AIM * target, kept) or model.cheapest(target, kept)
            further = self._further(model, choice, target)
            if further:
                self.laboratory.run(further)
                continue
            if choice is None or (best and model.forecast(choice).cost > WORTH * best.cost):
                break
            (outcome,) = self.laboratory.run([choice])
            if self.error(outcome) <= target and (best is None or outcome.cost < best.cost):
                best = outcome
        return best

    def _further(self, model: Model, choice: Choice | None, target: float) -> list[Choice]:
        """Single settings to try: cheaper ones than the cheapest tried that the choice takes, dearer ones where there is no choice."""
        found = []
        for number, dial in enumerate(self.dials):
            tried = list(model.settings(number))
            end = min(tried) - 1 if choice else max(tried) + 1
            wanted = choice is None or (choice[number] == min(tried) and model.effect(number, min(tried)) < 0.5 * target)
            single = self.single(number, end)
            possible = dial.refines and 0 <= end < len(dial.settings) and single not in self.laboratory.outcomes
            if possible and wanted and (choice or dial.part):
                found.append(single)
        return found

    def _binding(self, choice: Choice) -> str:
        """The dial of which the next dearer setting that was tried changes most."""
        model, changes = self.model, {}
        for number, dial in enumerate(self.dials):
            dearer = [setting for setting in model.settings(number) if setting > choice[number]]
            if dial.refines and dearer:
                changes[dial.name] = abs(model.effect(number, choice[number]) - model.effect(number, min(dearer)))
        return max(changes, key=lambda name: changes[name], default="")


def _times(dial: Dial, setting: int) -> float:
    """How many times a setting is dearer than the scene's own by as much as the next one: of elements on the scale of their number."""
    if dial.part != "elements":
        return float(setting - dial.own)
    own, following, wanted = (math.log(int(dial.settings[n].label)) for n in (dial.own, dial.own + 1, setting))
    return (wanted - own) / (following - own)
