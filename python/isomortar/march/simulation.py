"""The march through the load steps: cutting and growing back."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from types import NoneType

import numpy as np

from isomortar._arguments import kind
from isomortar.errors import ConvergenceError, InputError, PathError
from isomortar.march.recording import Recording
from isomortar.model import constants
from isomortar.model.checks import check
from isomortar.model.entities import Problem
from isomortar.solve.distances import between, largest
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.extrapolation import with_rates
from isomortar.solve.method import FAILURES, Increment, Method
from isomortar.solve.monolithic import Monolithic
from isomortar.solve.record import Observer, State, StepResult
from isomortar.solve.timing import Ledger
from isomortar.solve.uzawa import Uzawa
from isomortar.told.before.doubts import doubts
from isomortar.told.before.pairing import of_pairing
from isomortar.told.during.watches import Watches

_METHODS: dict[str, type[Method]] = {"monolithic": Monolithic, "uzawa": Uzawa}


class Simulation:
    """A computation of a problem, step by step.

    Parameters
    ----------
    problem : Problem
        That of a scene is `Scene.problem()`.
    observer : Observer, optional
        Watches iterations, augmentations, cuts and recorded steps, and hears warnings; without one nobody does.
    resume_from : StepResult, optional
        Last recorded step of an earlier run of the same problem.

    Raises
    ------
    InputError
        The problem cannot have a solution, or not a single one (`isomortar.model.checks`), folded elements among that; or the record is
        of another one.

    Attributes
    ----------
    state : State
        What the next load step starts from, in coordinates about `equilibrium.origin`.

    Examples
    --------
    >>> for result in Simulation(problem).run():  # doctest: +SKIP
    ...     print(result.step, result.reactions[0].force)
    """

    def __init__(self, problem: Problem, observer: Observer | None = None, resume_from: StepResult | None = None) -> None:
        check(problem)
        kind("observer", observer, Observer, NoneType)
        kind("resume_from", resume_from, StepResult, NoneType)
        self.problem = problem
        self.ledger = Ledger()
        self.equilibrium = Equilibrium(problem, self.ledger)
        self._observer = observer or Observer()
        self._method = _METHODS[problem.settings.method](self.equilibrium, self._observer)
        self._extrapolates = problem.settings.method == "monolithic" and "extrapolation" in problem.settings.measures
        if resume_from:
            _check_fit(resume_from, self.equilibrium)
        self._recording = Recording(problem, self.equilibrium, resume_from)
        self._step = resume_from.step if resume_from else 0
        self._increment = resume_from.next_increment if resume_from else 1.0
        self.equilibrium.orderings.update(resume_from.orderings if resume_from else {})
        self.state = self._recording.state(resume_from) if resume_from else self.equilibrium.initial_state()
        self._watches = Watches(self.equilibrium, self._step, self.state.contacts)

    def run(self) -> Iterator[StepResult]:
        """Compute the load steps that are left, one recorded step at a time.

        Raises
        ------
        ConvergenceError
            A load increment did not converge and could not be cut further. Steps yielded before stand.
        """
        self._observer.started(self.problem.total_steps, self._step + 1)
        self._warn(self.doubts())
        while self._step < self.problem.total_steps:
            result = self._advance_step(self._step + 1)
            self._step, self.state = result.step, self._recording.state(result)
            self._observer.recorded(result)
            yield result
        self._warn(self._watches.at_the_end())

    def doubts(self) -> Iterator[str]:
        """Warnings that are due before the next load step; the scene's geometry is looked at before the first one."""
        if self._step == 0:
            yield from doubts(self.equilibrium.problem, self.state)
        yield from of_pairing(self.problem, self.equilibrium.pairs)

    def _warn(self, warnings: Iterable[str]) -> None:
        for warning in warnings:
            self._observer.warned(warning)

    def _advance_step(self, step: int) -> StepResult:
        """One recorded load step, in as many increments as it takes."""
        state, time = self.state, float(step - 1)
        passage, ends = self._recording.passage(), self.problem.ends_stage(step)
        self.equilibrium.enter(step, state)
        longest = self.equilibrium.supports.longest_increment(step)
        while time < step:
            increment = min(self._increment * longest, step - time)
            target = float(step) if increment > step - time - constants.SAME_TIME else time + increment
            try:
                parts = self._advance(state, time, target, step)
                self._watches.look(state.positions, parts[-1].balance.positions, increment / longest)
            except FAILURES as error:
                self._cut(step, state, target, increment, longest, error, passage.cuts)
                passage.cuts.append(str(error))
                continue
            for part, end in zip(parts, np.linspace(time, target, len(parts) + 1)[1:], strict=True):
                passage.add(part, self._recording.work(state, part.balance))
                state = self._reached(state, part.balance, float(end), (target - time) / len(parts))
            time = target
            self._grow(increment / longest, parts)
        balance = parts[-1].balance
        by_factors = self._watches.by_factors(balance, step) if ends else []
        result = self._recording.result(step, state, balance, passage, self._increment)
        self._warn(self._watches.after_step(balance, result, ends))
        self._warn(by_factors)
        return result

    def _advance(self, state: State, time: float, target: float, step: int) -> list[Increment]:
        """One load increment; with a path tolerance in two halves, whose distance from the whole estimates its error (theory 5.9)."""
        whole = self._method.advance(state, target, step)
        tolerance = self.problem.settings.path_tolerance
        if tolerance is None:
            return [whole]
        middle = 0.5 * (time + target)
        first = self._method.advance(state, middle, step)
        second = self._method.advance(self._reached(state, first.balance, middle, 0.5 * (target - time)), target, step)
        error = self._distance(whole.balance, second.balance)
        if not error <= tolerance:
            raise PathError(error, tolerance)
        return [first, second]

    def _reached(self, start: State, balance: Balance, time: float, length: float) -> State:
        """The state that an increment of some length leads to, at a load time."""
        reached = self.equilibrium.state(balance)
        return with_rates(start, reached, time, length) if self._extrapolates else reached

    def _distance(self, whole: Balance, halves: Balance) -> float:
        """Largest relative distance between the pressures, or the tractions, of two solutions of an increment (theory 5.9)."""
        pairs = zip(self.equilibrium.pairs, halves.kinematics, whole.responses, halves.responses, strict=True)
        with self.ledger.phase("solid"):
            scales = self.equilibrium.measures.scales(halves.positions)
        return float(np.max(largest(between(pair, halves.positions, k, a, b, scales) for pair, k, a, b in pairs)))

    def _grow(self, increment: float, parts: Sequence[Increment]) -> None:
        """The next load increment, a share of the longest: longer after few linear solves, shorter after many tangents."""
        if max(part.iterations for part in parts) <= constants.EASY_ITERATIONS:
            self._increment = min(1.0, 2.0 * increment)
        elif max(part.tangents for part in parts) >= constants.HARD_TANGENTS:
            self._increment = max(0.5 * increment, 0.5**self.problem.settings.max_cuts)
        else:
            self._increment = min(1.0, max(increment, self._increment))

    def _cut(self, step: int, state: State, time: float, increment: float, longest: float, error: Exception, cuts: Sequence[str]) -> None:
        """Halve the load increment, or give up with a sentence that says where and why.

        It began at `state`; `cuts` says why longer ones of the load step were cut.
        """
        self._increment = 0.5 * increment / longest
        if self._increment < 0.5**self.problem.settings.max_cuts or time - 0.5 * increment == time:
            from isomortar.told.after.causes import causes  # within: a run that comes to its end gives none up

            stage, likely = self.problem.stages[self.problem.stage_of(step)].name, causes(self.equilibrium, state, error, cuts)
            alone = "" if self.problem.settings.max_cuts else ", the only one that solver.max_cuts = 0 allows"
            raise ConvergenceError(
                f"load step {step} (stage {stage!r}) does not converge at load time {time:.6g}, even with an increment of "
                f"1/{round(1 / increment)} step{alone}: {error}{''.join(f'. {cause[0].upper()}{cause[1:]}' for cause in likely)}"
            ) from error
        self._observer.cut(step, time, 0.5 * increment, str(error))


def _check_fit(last: StepResult, equilibrium: Equilibrium) -> None:
    """Refuse a record that has other control points, constraints, quadrature points or supports than a problem."""
    begun = equilibrium.initial_state()
    found, wanted = (
        [("control points", len(state.positions)), ("supports", supports), ("contacts", len(state.contacts))]
        + [
            (f"{what} of contact {contact.name!r}", len(values))
            for contact, of_one in zip(equilibrium.problem.contacts, state.contacts, strict=False)
            for what, values in (("constraints", of_one.pressure), ("quadrature points", of_one.projection))
        ]
        for state, supports in ((last.state, len(last.reactions)), (begun, len(equilibrium.problem.supports)))
    )
    for (what, has), (_, needs) in zip(found, wanted, strict=False):
        if has != needs:
            raise InputError(f"is of another problem: it has {has} {what}, and this one {needs}", "resume_from")
