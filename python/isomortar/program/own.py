"""isomortar's own solver as a program."""

from __future__ import annotations

from time import process_time

import numpy as np

from isomortar.errors import ConvergenceError
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.program.declaration import LoadStep, Outcome
from isomortar.program.process import Ending


class Isomortar:
    """The program itself, in this process."""

    name = "isomortar"

    def run(self, problem: Problem) -> Outcome:
        """Compute all load steps, or as many as converge.

        Raises
        ------
        InputError
            The problem cannot have a solution, or not a single one.
        """
        start, solves = process_time(), 0
        steps: list[LoadStep] = []
        ending: Ending = "measured"
        words = ""
        try:
            for result in Simulation(problem).run():
                friction, spurious = sum((contact.work for contact in result.contacts), np.zeros(2)).tolist()
                steps.append(LoadStep(result.step, result.state.positions, result.reactions, (friction, spurious)))
                solves += result.counters["solves"]
        except ConvergenceError as error:
            ending, words = "not converged", str(error)
        return Outcome(ending, words, tuple(steps), solves, process_time() - start)
