"""The march through the load steps: cutting, growing back, recording."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from isomortar.errors import ConvergenceError, FoldedElementError, LostProjectionError, PathError, SingularSystemError
from isomortar.geometry.patch import FloatArray
from isomortar.model import constants
from isomortar.model.checks import check
from isomortar.model.entities import Problem
from isomortar.model.moments import moment
from isomortar.model.symmetry import of_whole
from isomortar.solve.advice import StepAdvice, advice_on_problem
from isomortar.solve.astray import Astray
from isomortar.solve.behind import Behind
from isomortar.solve.causes import causes
from isomortar.solve.distances import between, largest
from isomortar.solve.doubts import doubts
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.extrapolation import with_rates
from isomortar.solve.inside_out import InsideOut
from isomortar.solve.lost import LostDigits
from isomortar.solve.method import Increment, Method
from isomortar.solve.monolithic import Monolithic
from isomortar.solve.narrow import Narrow
from isomortar.solve.passing import Passing
from isomortar.solve.pulling import Pulling
from isomortar.solve.record import AugmentationRecord, ContactResult, LoadResult, Observer, Reaction, State, StepResult, history_bytes
from isomortar.solve.sharing import Sharing
from isomortar.solve.small_strains import SmallStrains
from isomortar.solve.snapping import Snapping
from isomortar.solve.timing import Ledger
from isomortar.solve.unseen import Unseen
from isomortar.solve.unstable import Unstable
from isomortar.solve.uzawa import Uzawa

_REASONS_TO_CUT = (ConvergenceError, FoldedElementError, LostProjectionError, SingularSystemError)


_METHODS: dict[str, type[Method]] = {"monolithic": Monolithic, "uzawa": Uzawa}


class Simulation:
    """A computation of a problem, step by step.

    Parameters
    ----------
    problem : Problem
    observer : Observer, optional
        Watches iterations, augmentations, cuts and recorded steps.
    resume_from : StepResult, optional
        Last recorded step of an earlier run of the same problem.

    Raises
    ------
    InputError
        The problem cannot have a solution, or not a single one (`isomortar.model.checks`), folded elements among that.

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
        self.problem = problem
        self.ledger = Ledger()
        self.equilibrium = Equilibrium(problem, self.ledger)
        self._observer = observer or Observer()
        self._method = _METHODS[problem.settings.method](self.equilibrium, self._observer)
        self._extrapolates = problem.settings.method == "monolithic" and "extrapolation" in problem.settings.measures
        self._lost, self._pulling, self._sharing = LostDigits(self.equilibrium), Pulling(self.equilibrium), Sharing(self.equilibrium)
        self._small_strains, self._unseen = SmallStrains(self.equilibrium), Unseen(self.equilibrium)
        self._snapping, self._inside_out, self._astray = Snapping(self.equilibrium), InsideOut(self.equilibrium), Astray(self.equilibrium)
        self._of_stages = [watch for watch in (Passing(self.equilibrium.problem), Behind(self.equilibrium.problem)) if watch.needed]
        self._step = resume_from.step if resume_from else 0
        self._increment = resume_from.next_increment if resume_from else 1.0
        self.equilibrium.orderings = dict(resume_from.orderings) if resume_from else {}
        self._stood: tuple[Reaction, ...] = resume_from.reactions if resume_from else ()
        self.state = self._from_record(resume_from) if resume_from else self.equilibrium.initial_state()
        self._narrow, self._unstable = Narrow(self.equilibrium, self.state.contacts), Unstable(self.equilibrium)

    def run(self) -> Iterator[StepResult]:
        """Compute the load steps that are left, one recorded step at a time.

        Raises
        ------
        ConvergenceError
            A load increment did not converge and could not be cut further. Steps yielded before stand.
        """
        self._observer.started(self.problem.total_steps, self._step + 1)
        self._warn(self.doubts())
        advice = StepAdvice(self.problem, self._step, self.state.contacts)
        while self._step < self.problem.total_steps:
            result = self._advance_step(self._step + 1)
            self._step, self.state, self._stood = result.step, self._from_record(result), result.reactions
            self._observer.recorded(result)
            self._warn(advice.after_step(result.step, result.contacts, self.state.contacts))
            yield result
        self._warn(advice.at_the_end(self._unseen.depths))

    def doubts(self) -> Iterator[str]:
        """Warnings that are due before the next load step; the scene's geometry is looked at before the first one."""
        if self._step == 0:
            yield from doubts(self.equilibrium.problem, self.state)
        yield from advice_on_problem(self.problem, self.equilibrium.pairs)

    def _warn(self, warnings: Iterator[str]) -> None:
        for warning in warnings:
            self._observer.warned(warning)

    def _advance_step(self, step: int) -> StepResult:
        """One recorded load step, in as many increments as it takes."""
        state, time = self.state, float(step - 1)
        log: list[AugmentationRecord] = []
        orders: list[float] = []
        cuts = substeps = 0
        work = np.zeros((len(self.equilibrium.pairs), 2))
        self.equilibrium.enter(step, state)
        longest = self.equilibrium.supports.longest_increment(step)
        while time < step:
            increment = min(self._increment * longest, step - time)
            target = float(step) if increment > step - time - constants.SAME_TIME else time + increment
            try:
                parts = self._advance(state, time, target, step)
                self._snapping.look(state.positions, parts[-1].balance.positions, increment / longest)
                with self.ledger.phase("solid"):
                    self._inside_out.look(state.positions, parts[-1].balance.positions, increment / longest)
            except _REASONS_TO_CUT as error:
                self._cut(step, state, target, increment, longest, error)
                cuts += 1
                continue
            for part, end in zip(parts, np.linspace(time, target, len(parts) + 1)[1:], strict=True):
                log += part.augmentations
                orders += [order for order in part.orders if np.isfinite(order)]
                work += self._work(state, part.balance)
                state = self._reached(state, part.balance, float(end), (target - time) / len(parts))
            time, substeps = target, substeps + len(parts)
            self._grow(increment / longest, parts)
        unstable = list(self._unstable.after_stage(parts[-1].balance, step)) if self._ends_stage(step) else []  # its solves are this step's
        result = self._result(step, state, parts[-1].balance, work, tuple(log), orders, substeps, cuts)
        self._warn(self._lost.after_step(parts[-1].balance, result))
        self._warn(self._pulling.after_step(parts[-1].balance, step))
        self._warn(self._sharing.after_step(result))
        self._warn(self._small_strains.after_step(parts[-1].balance, step))
        self._warn(self._snapping.after_step(step))
        self._warn(self._inside_out.after_step(step))
        self._warn(self._astray.after_step(parts[-1].balance, step))
        self._warn(self._narrow.after_step(parts[-1].balance, step, self._ends_stage(step)))
        self._unseen.after_step(parts[-1].balance)
        self._warn(iter(unstable))
        if self._of_stages and self._ends_stage(step):
            deformed = self.equilibrium.numbering.deformed(state.positions)
            for watch in self._of_stages:
                self._warn(watch.after_stage(deformed, self._stage_of(step)))
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

    def _cut(self, step: int, state: State, time: float, increment: float, longest: float, error: Exception) -> None:
        """Halve the load increment, or give up with a sentence that says where and why; `state` is where the increment began."""
        self._increment = 0.5 * increment / longest
        if self._increment < 0.5**self.problem.settings.max_cuts or time - 0.5 * increment == time:
            likely = causes(self.equilibrium, state, error)
            raise ConvergenceError(
                f"load step {step} (stage {self._stage_of(step)!r}) does not converge at load time {time:.6g}, even with an increment of "
                f"1/{round(1 / increment)} step: {error}{''.join(f'. {cause[0].upper()}{cause[1:]}' for cause in likely)}"
            ) from error
        self._observer.cut(step, time, 0.5 * increment, str(error))

    def _ends_stage(self, step: int) -> bool:
        """Whether a load step is the last one of its stage: the next one does not go on as it did."""
        return step in np.cumsum([stage.steps for stage in self.problem.stages])

    def _stage_of(self, step: int) -> str:
        return self.problem.stages[self.problem.stage_of(step)].name

    def _from_record(self, result: StepResult) -> State:
        """The state of a recorded step, to the digits that are recorded: a run that is resumed there comes to the same numbers.

        Far from the origin these are fewer; supports then put what they prescribe in its place anew, or it would seem to move.
        """
        origin = self.equilibrium.origin
        if not np.any(origin):
            return result.state
        positions, supports = result.state.positions - origin, self.equilibrium.standing(result.step)
        supports.anchor(positions, result.time)
        return replace(result.state, positions=supports.placed(positions, result.time))

    def _reactions(self, time: float, positions: FloatArray, total: FloatArray) -> tuple[Reaction, ...]:
        """Forces that the supports exert: their shares of the residual at the components that they prescribe (theory 8.1)."""
        reactions = []
        supports, origin = self.equilibrium.supports, self.equilibrium.origin
        for k, (support, points) in enumerate(zip(self.equilibrium.problem.supports, supports.points, strict=True)):
            if supports.left(k):
                centre, way, angle = self._stood[k].centre - origin, self._stood[k].displacement, self._stood[k].rotation
            else:
                way, angle = supports.way(support, time, positions), supports.angle(support, time, positions)
                centre = supports.centre(support, time, positions)
            forces = supports.shares[k] * total[points]
            force, turning = forces.sum(axis=0), moment(positions[points] - centre, forces)
            reactions.append(Reaction(*of_whole(self.problem, force, turning, centre + origin), centre + origin, way, angle))
        return tuple(reactions)

    def _loads(self, time: float, positions: FloatArray) -> tuple[LoadResult, ...]:
        """What loads exert on their bodies (theory 8.2)."""
        about = positions + self.equilibrium.origin
        sums = [(forces.sum(axis=0), moment(about, forces)) for forces in self.equilibrium.loads.forces(positions, time)]
        return tuple(LoadResult(*of_whole(self.problem, force, turning, np.zeros(3))) for force, turning in sums)

    def _work(self, start: State, balance: Balance) -> FloatArray:
        """Friction work and spurious work of each contact pair in an increment, shape (pairs, 2) (theory 3.31)."""
        pairs = zip(self.equilibrium.pairs, start.contacts, balance.kinematics, balance.responses, strict=True)
        return np.array([pair.work(start.positions, begun, balance.positions, k, r) for pair, begun, k, r in pairs]).reshape(-1, 2)

    def _result(
        self,
        step: int,
        state: State,
        balance: Balance,
        work: FloatArray,
        log: tuple[AugmentationRecord, ...],
        orders: list[float],
        substeps: int,
        cuts: int,
    ) -> StepResult:
        pairs = zip(self.equilibrium.pairs, balance.kinematics, balance.responses, work, strict=True)
        origin, problem = self.equilibrium.origin, self.problem
        contacts = tuple(_of_whole(_about_origin(pair.result(balance.positions, k, r, w), origin), problem) for pair, k, r, w in pairs)
        timings, counters = self.ledger.take()
        return StepResult(
            step=step,
            stage=self._stage_of(step),
            time=float(step),
            state=replace(state, positions=state.positions + origin, rates=None if self._ends_stage(step) else state.rates),
            reactions=self._reactions(float(step), balance.positions, balance.total),
            contacts=contacts,
            loads=self._loads(float(step), balance.positions),
            augmentations=log,
            newton_order=float(np.median(orders)) if orders else float("nan"),
            substeps=substeps,
            cuts=cuts,
            next_increment=self._increment,
            timings=timings,
            counters={**counters, "history bytes": history_bytes(state, contacts, [pair.friction.acts for pair in self.equilibrium.pairs])},
            orderings=dict(self.equilibrium.orderings),
        )


def _about_origin(result: ContactResult, own: FloatArray) -> ContactResult:
    """The result with moments about the origin in place of those about an origin of its own (theory 8.2)."""
    return replace(
        result,
        moment_slave=result.moment_slave + moment(own[None], result.force_slave[None]),
        moment_master=result.moment_master + moment(own[None], result.force_master[None]),
    )


def _of_whole(result: ContactResult, problem: Problem) -> ContactResult:
    """The result with forces, moments and works of the whole in place of those on one side of planes of symmetry (theory 8.5)."""
    slave = of_whole(problem, result.force_slave, result.moment_slave, np.zeros(3))
    master = of_whole(problem, result.force_master, result.moment_master, np.zeros(3))
    return replace(
        result,
        force_slave=slave[0],
        moment_slave=slave[1],
        force_master=master[0],
        moment_master=master[1],
        friction_work=problem.images * result.friction_work,
        spurious_work=problem.images * result.spurious_work,
    )
