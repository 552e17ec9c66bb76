"""What a computation leaves behind, step by step: plain data that results files store and progress displays show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field

import numpy as np

from isomortar._frozen import frozen
from isomortar._sparse import Ordering
from isomortar.geometry.patch import FloatArray, IntArray


@frozen
class ContactState:
    """State of one contact pair, enough to restart.

    Parameters
    ----------
    pressure : ndarray, shape (n,)
        Pressures p^J of the n constraints: slave control points (mortar), or points of the slave; force per area.
    traction : ndarray, shape (n, 2)
        Covariant tractions tau_alpha^J of the constraints.
    projection : ndarray, shape (q, 2)
        Master coordinates of each slave quadrature point at the end of the step.
    projected : ndarray of int32, shape (q,)
        1 where the quadrature point has a projection on the master, else 0.
    """

    pressure: FloatArray
    traction: FloatArray
    projection: FloatArray
    projected: IntArray


@frozen
class ContactRates:
    """How fast a load increment changed the pressures, shape (n,), and tractions, shape (n, 2), of a contact pair, per load step."""

    pressure: FloatArray
    traction: FloatArray


@frozen
class Rates:
    """How fast a load increment changed things, per load step (theory 6.7).

    Parameters
    ----------
    time : float
        Load time at which it ended.
    positions : ndarray, shape (n, 3)
    contacts : tuple of ContactRates
    """

    time: float
    positions: FloatArray
    contacts: tuple[ContactRates, ...]


@frozen
class State:
    """Positions of all control points, shape (n, 3), and the state of each contact pair; rates where all may go on like that."""

    positions: FloatArray
    contacts: tuple[ContactState, ...]
    rates: Rates | None = None


@frozen
class IterationRecord:
    """One Newton iteration: number, what was left before the solve (`Iterate.merit`), counts of constraints by state, what acted."""

    iteration: int
    residual: float
    active: int
    stick: int
    slip: int
    notes: tuple[str, ...] = ()


@frozen
class AugmentationRecord:
    """One augmentation (Uzawa) with its Newton iterations and the change of multipliers that it made."""

    augmentation: int
    penalty_normal: float
    penalty_tangential: float
    change_pressure: float
    change_traction: float
    iterations: tuple[IterationRecord, ...]


@frozen
class Reaction:
    """Force that a support exerts on its body, moment about the moving centre, that centre, and how far it has gone; each shape (3,).

    `rotation`: by how many degrees it has turned about its axis. What a program did not tell, or a file does not hold, is not a number.
    """

    force: FloatArray
    moment: FloatArray
    centre: FloatArray
    displacement: FloatArray = field(default_factory=lambda: np.full(3, np.nan))
    rotation: float = np.nan


@frozen
class LoadResult:
    """Force of a load on its body, and its moment about the origin; each shape (3,)."""

    force: FloatArray
    moment: FloatArray


@frozen
class ContactResult:
    """Measured quantities of one contact pair at the end of a load step.

    `force_slave`, `force_master`: resultants of the contact forces on each side, `moment_*` about the origin, shape (3,); 0 on a plane.
    `active`, `slip`: numbers of constraints. `traction_norm`: metric norm of the traction of each, shape (n,).
    `status`: of each constraint 0 open, 1 stick, 2 slip, shape (n,). `gap`: g^J of each, shape (n,);
    positive is penetration. `pressure_field`: smallest and largest p at the contact quadrature points, shape (2,).
    `excluded`: number of quadrature points without a projection. `friction_work`, `spurious_work`: what friction, and pressures along
    averaged normals, took up within the load step (theory 3.31); by closest points these make none, and a file from before has NaN.
    """

    force_slave: FloatArray
    force_master: FloatArray
    moment_slave: FloatArray
    moment_master: FloatArray
    active: int
    slip: int
    traction_norm: FloatArray
    status: IntArray
    gap: FloatArray
    pressure_field: FloatArray
    excluded: int
    friction_work: float
    spurious_work: float

    @property
    def work(self) -> FloatArray:
        """Friction work and spurious work, shape (2,)."""
        return np.array([self.friction_work, self.spurious_work])


def history_bytes(state: State, contacts: Sequence[ContactResult], frictional: Sequence[bool]) -> int:
    """What the state of a load step takes in a results file, which holds tractions where there is friction, and the step's number."""
    arrays: list[np.ndarray | np.generic] = [state.positions, np.int64(0)]
    for contact, result, rubs in zip(state.contacts, contacts, frictional, strict=True):
        arrays += [contact.pressure, contact.projection, contact.projected, result.status, result.gap]
        arrays += [contact.traction, result.traction_norm] if rubs else []
    return sum(array.nbytes for array in arrays)


@frozen
class StepResult:
    """One recorded load step.

    Parameters
    ----------
    step : int
        Number of the load step, counted from 1 over all stages.
    stage : str
    time : float
        Load time: equals `step` at recorded steps.
    state : State
    reactions : tuple of Reaction
        One a support.
    contacts : tuple of ContactResult
        One a contact pair.
    augmentations : tuple of AugmentationRecord
        Iteration log, over all sub-steps.
    newton_order : float
        Observed order of Newton's method, median over the converged solves of the step; NaN: too few iterations with a
        tangent of their own.
    substeps, cuts : int
        Load increments that the step was made of, and how often an increment was cut.
    next_increment : float
        Load increment that the step-size control would try next, as a share of the longest one that the supports' turns allow (part of
        the restart state).
    timings : dict
        CPU seconds, of all threads, by phase within the step: solid, projection, contact, factor, solve, other, total.
    counters : dict
        What was done within the step, by name (docs/method.md, "What a run costs").
    orderings : dict
        Orderings of the unknowns that are in use, by the number of matrices that make up the system (part of the restart state: which
        one is better was tried on the first of them).
    loads : tuple of LoadResult
        One a load.
    """

    step: int
    stage: str
    time: float
    state: State
    reactions: tuple[Reaction, ...]
    contacts: tuple[ContactResult, ...]
    augmentations: tuple[AugmentationRecord, ...]
    newton_order: float
    substeps: int
    cuts: int
    next_increment: float
    timings: dict[str, float]
    counters: dict[str, int]
    orderings: dict[int, Ordering]
    loads: tuple[LoadResult, ...] = ()


class Observer:
    """Watches a computation; every method may be overridden, none has to be.

    A raised `KeyboardInterrupt` stops the computation; what had been recorded stays.
    """

    def started(self, total_steps: int, first_step: int) -> None:
        """Called once before the first load step that is computed."""

    def iteration(self, step: int, time: float, augmentation: int, record: IterationRecord) -> None:
        """Called after every Newton iteration."""

    def augmented(self, step: int, time: float, record: AugmentationRecord) -> None:
        """Called after every augmentation."""

    def cut(self, step: int, time: float, increment: float, reason: str) -> None:
        """Called when a load increment failed and is cut; `increment` is the new one."""

    def recorded(self, result: StepResult) -> None:
        """Called when a recorded load step is complete."""

    def warned(self, message: str) -> None:
        """Called with a warning that a person should read."""
