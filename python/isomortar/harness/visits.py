"""States that Newton's method visits in a load step of a scene."""

from __future__ import annotations

from dataclasses import replace
from itertools import groupby

import numpy as np

from isomortar._bindings import Law, Response
from isomortar._frozen import frozen
from isomortar.errors import InputError
from isomortar.geometry.patch import FloatArray
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.solve.contact import Kinematics, PairMechanics
from isomortar.solve.record import ContactState


@frozen
class PairVisit:
    """One contact pair in a visited state: where its slips count from, and the law with the multipliers of that moment."""

    start: ContactState
    law: Law


@frozen
class Visit:
    """A visited state: its positions about the equilibrium's origin, shape (control points, 3), its contact pairs, and its load time."""

    positions: FloatArray
    pairs: tuple[PairVisit, ...]
    time: float = 0.0


Note = tuple[FloatArray, PairVisit]


class RecordingPair(PairMechanics):
    """A contact pair that notes, in a list that all pairs share, every state it evaluates."""

    def __init__(self, pair: PairMechanics, problem: Problem, simulation: Simulation, notes: list[Note]) -> None:
        others = [other.pair for other in simulation.equilibrium.pairs if other.pair is not pair.pair]
        super().__init__(pair.pair, problem.settings, simulation.ledger, simulation.equilibrium.origin, others)
        self._notes = notes

    def kinematics(self, positions: FloatArray, start: ContactState) -> Kinematics:
        """Project and integrate."""
        self._at = positions, start
        return super().kinematics(positions, start)

    def respond(self, kinematics: Kinematics, law: Law) -> Response:
        """Respond to the law; what only helps Newton's method on its way is left out of the note."""
        positions, start = self._at
        plain = replace(law, slip_margin=0.0, forgiving=False, held=np.zeros_like(law.held))
        self._notes.append((positions, PairVisit(start, plain)))
        return super().respond(kinematics, law)


def visited_states(problem: Problem, step: int) -> list[Visit]:
    """Run a problem to a load step and take up to three states of its last increment.

    They are the first iterate after the predictor, the last one before the converged state, and that itself. Increments begin at their
    starts: an extrapolation that leads nowhere has visits of its own.

    Raises
    ------
    InputError
        The problem has no such step.
    """
    if not 1 <= step <= problem.total_steps:
        raise InputError(f"load step {step} does not exist; the scene has steps 1 to {problem.total_steps}", "step")
    measures = tuple(measure for measure in problem.settings.measures if measure != "extrapolation")
    problem = replace(problem, settings=replace(problem.settings, measures=measures))
    simulation = Simulation(problem)
    notes: list[Note] = []
    simulation.equilibrium.pairs[:] = [RecordingPair(pair, problem, simulation, notes) for pair in simulation.equilibrium.pairs]
    for result in simulation.run():
        if result.step == step:
            break
        notes.clear()
    if not notes:
        return [Visit(simulation.state.positions, (), float(step))]
    visits = _of_last_increment(_in_visits(notes, len(problem.contacts)))
    chosen = sorted({0, max(0, len(visits) - 2), len(visits) - 1})
    return [replace(visits[k], time=float(step)) for k in chosen]


def _in_visits(notes: list[Note], pairs: int) -> list[Visit]:
    """Notes of all pairs at the same positions together; an evaluation that broke off is dropped."""
    visits = []
    for _, group in groupby(notes, key=lambda note: id(note[0])):
        same = list(group)
        for k in range(0, len(same) - pairs + 1, pairs):
            visits.append(Visit(same[k][0], tuple(note[1] for note in same[k : k + pairs])))
    return visits


def _of_last_increment(visits: list[Visit]) -> list[Visit]:
    """What followed the last evaluation at the start of the last increment, where slips are still zero and stick turns to slip."""
    own = [visit for visit in visits if visit.pairs[0].start is visits[-1].pairs[0].start]
    first = max(k for k, visit in enumerate(own) if visit.positions is own[0].positions)
    return own[first + 1 :] or own[-1:]
