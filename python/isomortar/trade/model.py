"""What a combination of settings will cost and miss, by what was measured of single ones: errors add, costs multiply."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from isomortar._frozen import frozen
from isomortar.geometry.patch import FloatArray
from isomortar.trade.knobs import Dial
from isomortar.trade.laboratory import Choice, Tried
from isomortar.trade.want import Want

#: CPU seconds of the same work differ by about this share, on a machine with other work: what differs by less costs the same.
NOISE = 0.05


@frozen
class Forecast:
    """Error and CPU seconds that a choice is expected to have."""

    error: float
    cost: float


class Yardstick:
    """How far runs are from the truth in what is wanted.

    Parameters
    ----------
    want : Want
    truth : Tried
    *rivals : Tried
        Other over-refined runs: how far they are from the truth is the truth's uncertainty.
    """

    def __init__(self, want: Want, truth: Tried, *rivals: Tried) -> None:
        self.want, self._truth = want, truth.numbers
        self.truth = self.values(truth)
        self.weights = want.weights(truth.numbers)
        self.size = want.size(self.truth, self.weights) if math.isnan(want.whole) else want.whole
        self.uncertainty = max(map(self.error, rivals))

    def values(self, outcome: Tried) -> FloatArray:
        """What is wanted, of a run, shape (n,)."""
        return self.want.values(outcome.numbers, self._truth)

    def norm(self, values: FloatArray) -> float:
        """Norm of some values over that of the truth, or what else errors are a share of."""
        return self.want.size(values, self.weights) / self.size if self.size > 0.0 else math.inf

    def error(self, outcome: Tried) -> float:
        """Distance of a run from the truth over the size of the truth; infinite where it failed, or does not tell what is wanted."""
        return self.norm(self.values(outcome) - self.truth) if self.told(outcome) else math.inf

    def told(self, outcome: Tried) -> bool:
        """Whether a run came to its end and tells what is wanted: a gap is no number where a foot was lost."""
        return not outcome.failure and bool(np.isfinite(self.values(outcome)).all())


class Model:
    """Forecasts from the runs that are there.

    A choice is forecast from the run that shares most of its settings. What refines moves the result as it did alone; what coarsens adds
    the size of what it changed alone: that errors cancel is luck, and a forecast that is not hopeful counts on none.

    Parameters
    ----------
    dials : sequence of Dial
    own : Choice
        The scene's own settings.
    outcomes : mapping
        All runs.
    yardsticks : sequence of Yardstick
        The largest of their errors counts.
    hopeful : bool
        Whether what coarsens, too, moves the result as it did alone.
    """

    def __init__(
        self,
        dials: Sequence[Dial],
        own: Choice,
        outcomes: Mapping[Choice, Tried],
        yardsticks: Sequence[Yardstick],
        *,
        hopeful: bool = False,
    ) -> None:
        self._dials, self._yardsticks, self._hopeful = dials, yardsticks, hopeful
        self._centres = [outcome for outcome in outcomes.values() if all(y.told(outcome) for y in yardsticks)]
        self._failed = outcomes.keys() - {outcome.choice for outcome in self._centres}
        base = outcomes[own]
        self._costs, self._effects = {}, {}
        self._forecasts: dict[Choice, Forecast] = {}
        for outcome in self._centres:
            moved = [number for number, (a, b) in enumerate(zip(outcome.choice, own, strict=True)) if a != b]
            if len(moved) <= 1:
                for number in moved or range(len(dials)):
                    key = (number, outcome.choice[number])
                    change = math.log(outcome.cost / base.cost)
                    self._costs[key] = change if abs(change) > NOISE else 0.0
                    self._effects[key] = [y.values(outcome) - y.values(base) for y in yardsticks]
        self._centres = [o for o in self._centres if all((n, s) in self._effects for n, s in enumerate(o.choice))]
        self._choices = np.array([o.choice for o in self._centres])
        self._errors = [[y.values(o) - y.truth for y in yardsticks] for o in self._centres]

    def settings(self, number: int) -> Iterator[int]:
        """The settings of a dial that were tried alone."""
        return (setting for setting in range(len(self._dials[number].settings)) if (number, setting) in self._effects)

    def effect(self, number: int, setting: int) -> float:
        """How much a setting alone changes what is wanted, as a share of the truth."""
        return max(y.norm(e) for y, e in zip(self._yardsticks, self._effects[number, setting], strict=True))

    def forecast(self, choice: Choice) -> Forecast:
        """Error and cost of a choice whose settings were all tried alone; each is asked for from several sides, and forecast once."""
        if choice not in self._forecasts:
            self._forecasts[choice] = self._forecast(choice)
        return self._forecasts[choice]

    def _forecast(self, choice: Choice) -> Forecast:
        if choice in self._failed:
            return Forecast(math.inf, math.inf)
        wanted = np.array(choice)
        centre = int((self._choices != wanted).sum(axis=1).argmin())
        near, cost = self._choices[centre], self._centres[centre].cost
        errors, lost = [error.copy() for error in self._errors[centre]], [0.0] * len(self._yardsticks)
        for number in map(int, np.flatnonzero(near != wanted)):
            here, there = (number, int(near[number])), (number, int(wanted[number]))
            cost *= math.exp(self._costs[there] - self._costs[here])
            moves = self._hopeful or (self._dials[number].refines and there[1] > here[1])
            for k, yardstick in enumerate(self._yardsticks):
                change = self._effects[there][k] - self._effects[here][k]
                if moves:
                    errors[k] += change
                else:
                    lost[k] += yardstick.norm(change)
        return Forecast(max(y.norm(e) + lost[k] for k, (y, e) in enumerate(zip(self._yardsticks, errors, strict=True))), cost)

    def cheapest(self, target: float, kept: Mapping[int, int]) -> Choice | None:
        """The cheapest choice within a target by forecast, with some dials `kept` at a setting; None: there is none.

        Greedily from every run and every single setting, by turning one dial at a time; then two at a time from the best of these.
        """
        starts = {tuple(kept.get(n, s) for n, s in enumerate(outcome.choice)) for outcome in self._centres}
        for outcome in self._centres[:1]:
            for number in range(len(self._dials)):
                starts |= {self._turned(outcome.choice, number, s, kept) for s in self.settings(number)}
        known = sorted(start for start in starts - self._failed if all((n, s) in self._effects for n, s in enumerate(start)))
        ends = [end for end in (self._descended(start, target, kept) for start in known) if end]
        best = min(ends, key=lambda choice: self.forecast(choice).cost, default=None)
        while best is not None:
            cheaper = self._exchanged(best, target, kept)
            if cheaper is None:
                break
            best = self._descended(cheaper, target, kept) or cheaper
        return best

    def _turns(self, choice: Choice, kept: Mapping[int, int]) -> set[Choice]:
        """All choices that differ by one setting that was tried alone, of a dial that is not kept."""
        free = (n for n in range(len(self._dials)) if n not in kept)
        return {(*choice[:n], s, *choice[n + 1 :]) for n in free for s in self.settings(n)} - {choice}

    def _exchanged(self, choice: Choice, target: float, kept: Mapping[int, int]) -> Choice | None:
        """The cheapest choice within a target of those that differ by two settings, where it is cheaper."""
        now = self.forecast(choice).cost
        two = {other for one in self._turns(choice, kept) for other in self._turns(one, kept)} - {choice}
        found = {other: self.forecast(other) for other in two}
        better = {other: f.cost for other, f in found.items() if f.error <= target and f.cost < 0.99 * now}
        return min(better, key=lambda other: (better[other], other), default=None)

    def _turned(self, choice: Choice, number: int, setting: int, kept: Mapping[int, int]) -> Choice:
        return tuple(kept.get(n, setting if n == number else s) for n, s in enumerate(choice))

    def _descended(self, start: Choice, target: float, kept: Mapping[int, int]) -> Choice | None:
        """Turn one dial at a time: towards the target as long as it is missed, then to what is cheaper within it."""
        choice, now = start, self.forecast(start)
        while True:
            found = {turned: self.forecast(turned) for turned in self._turns(choice, kept)}
            if now.error > target:
                better = {turned: f for turned, f in found.items() if f.error < now.error}
                gain = {turned: (now.error - max(f.error, target)) / max(math.log(f.cost / now.cost), 1e-3) for turned, f in better.items()}
            else:
                better = {turned: f for turned, f in found.items() if f.error <= target and f.cost < 0.99 * now.cost}
                gain = {turned: math.log(now.cost / f.cost) / max(f.error - now.error, 1e-3 * target) for turned, f in better.items()}
            if not better:
                return choice if now.error <= target else None
            choice = max(gain, key=lambda turned: (gain[turned], turned))
            now = found[choice]
