"""What is recorded of a load step: its state, forces, works and counts; and the state that a record leads back to."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass, field, replace

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Problem
from isomortar.model.moments import moment
from isomortar.model.symmetry import of_whole
from isomortar.solve.equilibrium import Balance, Equilibrium
from isomortar.solve.method import Increment
from isomortar.solve.record import AugmentationRecord, ContactResult, LoadResult, Reaction, State, StepResult, history_bytes


@dataclass
class Passage:
    """The way through a load step, which its record tells of.

    Attributes
    ----------
    work : ndarray, shape (pairs, 2)
        Friction work and spurious work of each contact pair (theory 3.31).
    log : list of AugmentationRecord
    orders : list of float
        Observed orders of Newton's method, where they could be told.
    cuts : list of str
        Why increments that were too long did not converge.
    substeps : int
        Increments that it took.
    """

    work: FloatArray
    log: list[AugmentationRecord] = field(default_factory=list)
    orders: list[float] = field(default_factory=list)
    cuts: list[str] = field(default_factory=list)
    substeps: int = 0

    def add(self, part: Increment, work: FloatArray) -> None:
        """Go on by an increment, in which work was done."""
        self.log += part.augmentations
        self.orders += [order for order in part.orders if np.isfinite(order)]
        self.work = self.work + work
        self.substeps += 1


class Recording:
    """Records load steps as a user has them: of the whole scene, in its own coordinates.

    Parameters
    ----------
    problem : Problem
        As the user has it.
    equilibrium : Equilibrium
        Of the same about an origin of its own.
    last : StepResult, optional
        Record that a run goes on from.
    """

    def __init__(self, problem: Problem, equilibrium: Equilibrium, last: StepResult | None) -> None:
        self._problem, self._equilibrium = problem, equilibrium
        self._stood: tuple[Reaction, ...] = deepcopy(last.reactions) if last else ()

    def passage(self) -> Passage:
        """The way through a load step, at its beginning."""
        return Passage(np.zeros((len(self._equilibrium.pairs), 2)))

    def state(self, result: StepResult) -> State:
        """The state of a recorded step, to the digits that are recorded: a run that is resumed there comes to the same numbers.

        Far from the origin these are fewer; supports then put what they prescribe in its place anew, or it would seem to move.
        """
        origin, state = self._equilibrium.origin, deepcopy(result.state)  # who has the result may change it
        if not np.any(origin):
            return state
        positions, supports = state.positions - origin, self._equilibrium.standing(result.step)
        supports.anchor(positions, result.time)
        return replace(state, positions=supports.placed(positions, result.time))

    def work(self, start: State, balance: Balance) -> FloatArray:
        """Friction work and spurious work of each contact pair in an increment, shape (pairs, 2) (theory 3.31)."""
        pairs = zip(self._equilibrium.pairs, start.contacts, balance.kinematics, balance.responses, strict=True)
        return np.array([pair.work(start.positions, begun, balance.positions, k, r) for pair, begun, k, r in pairs]).reshape(-1, 2)

    def result(
        self,
        step: int,
        state: State,
        balance: Balance,
        passage: Passage,
        next_increment: float,
    ) -> StepResult:
        """The record of a load step that has come to a state, in balance."""
        pairs = zip(self._equilibrium.pairs, balance.kinematics, balance.responses, passage.work, strict=True)
        origin, problem = self._equilibrium.origin, self._problem
        reactions = self._reactions(float(step), balance.positions, balance.total)
        self._stood = deepcopy(reactions)
        contacts = tuple(_of_whole(_about_origin(pair.result(balance.positions, k, r, w), origin), problem) for pair, k, r, w in pairs)
        timings, counters = self._equilibrium.ledger.take()
        return StepResult(
            step=step,
            stage=problem.stages[problem.stage_of(step)].name,
            time=float(step),
            state=replace(state, positions=state.positions + origin, rates=None if problem.ends_stage(step) else state.rates),
            reactions=reactions,
            contacts=contacts,
            loads=self._loads(float(step), balance.positions),
            augmentations=tuple(passage.log),
            newton_order=float(np.median(passage.orders)) if passage.orders else float("nan"),
            substeps=passage.substeps,
            cuts=len(passage.cuts),
            next_increment=next_increment,
            timings=timings,
            counters={
                **counters,
                "history bytes": history_bytes(state, contacts, [pair.friction.acts for pair in self._equilibrium.pairs]),
            },
            orderings=dict(self._equilibrium.orderings),
        )

    def _reactions(self, time: float, positions: FloatArray, total: FloatArray) -> tuple[Reaction, ...]:
        """Forces that the supports exert: their shares of the residual at the components that they prescribe (theory 8.1)."""
        reactions = []
        supports, origin = self._equilibrium.supports, self._equilibrium.origin
        for k, (support, points) in enumerate(zip(self._equilibrium.problem.supports, supports.points, strict=True)):
            if supports.left(k):
                centre, way, angle = self._stood[k].centre - origin, self._stood[k].displacement, self._stood[k].rotation
            else:
                way, angle = supports.way(support, time, positions), supports.angle(support, time, positions)
                centre = supports.centre(support, time, positions)
            forces = supports.shares[k] * total[points]
            force, turning = forces.sum(axis=0), moment(positions[points] - centre, forces)
            reactions.append(Reaction(*of_whole(self._problem, force, turning, centre + origin), centre + origin, way, angle))
        return tuple(reactions)

    def _loads(self, time: float, positions: FloatArray) -> tuple[LoadResult, ...]:
        """What loads exert on their bodies (theory 8.2)."""
        about = positions + self._equilibrium.origin
        sums = [(forces.sum(axis=0), moment(about, forces)) for forces in self._equilibrium.loads.forces(positions, time)]
        return tuple(LoadResult(*of_whole(self._problem, force, turning, np.zeros(3))) for force, turning in sums)


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
