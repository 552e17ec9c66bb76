"""Warnings at load steps: what contacts show that is likely to disappoint, and what to do about it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from isomortar.model.entities import Problem
from isomortar.solve.record import ContactResult, ContactState
from isomortar.told.borne import Borne

#: Control pressures this many times above the field's largest value oscillate.
OSCILLATION = 1.5
#: Along averaged normals feet are found up to a distance: what is farther away has none, although the master may be opposite.
FAR = " (or gone beyond the reach of its averaged normals)"
#: Spurious work over friction work above which the master is too coarse.
SPURIOUS = 0.02


class StepAdvice:
    """Warnings at recorded load steps; each is given once a contact.

    Parameters
    ----------
    problem : Problem
    step : int
        Load step that the run goes on from; 0: a run from the beginning.
    states : sequence of ContactState
        Those of the contacts at its end.
    """

    def __init__(self, problem: Problem, step: int, states: Sequence[ContactState]) -> None:
        self._slaves = {contact.name: contact.slave.words for contact in problem.contacts}
        self._far = {contact.name: FAR if contact.averaged else "" for contact in problem.contacts}
        self._borne = Borne(problem, states)
        self._begun = self._last = step
        self._closed = {name: step for name, state in zip(self._slaves, states, strict=True) if np.any(state.pressure)}
        self._given: set[tuple[str, str]] = set()
        self._excluded = [int(np.count_nonzero(state.projected == 0)) for state in states]
        self._work = {name: np.zeros(2) for name in self._slaves}
        self._slid = set[str]()

    def after_step(self, step: int, results: Sequence[ContactResult], states: Sequence[ContactState]) -> Iterator[str]:
        """Warnings that the end of a load step gives rise to."""
        before, self._excluded, self._last = self._excluded, [result.excluded for result in results], step
        self._borne.see(state.pressure for state in states)
        for number, (name, result, state, excluded) in enumerate(zip(self._slaves, results, states, before, strict=True)):
            if result.active:
                self._closed[name] = step
            self._work[name] += result.work
            self._slid |= {name} if result.slip else set()
            if result.excluded == len(state.projected) > excluded and self._first(name, "beside"):
                yield (
                    f"contact {name!r}, load step {step}: the slave face {self._slaves[name]} is wholly beside its master now"
                    f"{self._far[name]}, and touches nothing. Use a larger master, or look at the motions"
                )
            largest, field = float(state.pressure.max()), float(result.pressure_field[1])
            bears = self._borne.more_than_nothing(number, field)
            if result.active > 3 and bears and largest > OSCILLATION * field and self._first(name, "oscillation"):
                yield (
                    f"contact {name!r}, load step {step}: control pressures reach {largest:.3g} where the pressure field reaches "
                    f"{field:.3g}; {_why_large(result.excluded)}: look at the field, not at them"
                )

    def at_the_end(self, unseen: Mapping[str, float]) -> Iterator[str]:
        """Warnings that the whole run gives rise to; what was closed before the step that it went on from is not known.

        `unseen`: how deep slave points of contacts were inside the master without a constraint that saw it.
        """
        for name in self._slaves:
            closed = self._closed.get(name)
            if closed is None and not self._begun:
                yield f"contact {name!r} never closed: it was open at the end of every load step{_why_open(unseen.get(name))}"
            if closed is not None and self._last - closed > 1:
                yield (
                    f"contact {name!r} opened in load step {closed + 1} and stayed open: all load steps after it computed bodies apart. "
                    "If that is not meant, look at the directions of the motions"
                )
            friction, spurious = self._work[name]
            if name in self._slid and abs(spurious) > SPURIOUS * friction > 0.0:  # else the friction work is round-off
                yield (
                    f"contact {name!r}: spurious work of pressures along averaged normals is {spurious / friction:.1%} of the friction "
                    "work; forces along the sliding may be off by as much. Refine the master, or take elements of a higher order there"
                )

    def _first(self, name: str, kind: str) -> bool:
        if (name, kind) in self._given:
            return False
        self._given.add((name, kind))
        return True


def _why_large(excluded: int) -> str:
    """What coefficients that are larger than their field are due to, by the slave points that have no foot."""
    if excluded:
        return "the slave goes beyond its master, and coefficients are large of which little is over it"
    return "single coefficients oscillate (conditioning of the basis)"


def _why_open(depth: float | None) -> str:
    """What to look at of a contact that never closed; `depth` of its slave points inside the master, where they were."""
    if depth is None:
        return "; check faces, places and motions"
    return (
        f", although slave points were up to {depth:.2g} inside the master: its constraints are averages over elements that are too long "
        "to see it. Refine the slave's face where it touches"
    )
