"""A program that computes contact: a problem goes in, load steps come out (docs/programs.md)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol

from isomortar._frozen import frozen
from isomortar.errors import IsomortarError
from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Problem
from isomortar.model.moments import moment
from isomortar.model.numbering import Numbering
from isomortar.model.supports import Supports
from isomortar.model.symmetry import of_whole
from isomortar.program.process import Ending
from isomortar.solve.record import Reaction


class NotInstalledError(IsomortarError):
    """A program is not on this machine; the text says how to install it."""


@frozen
class LoadStep:
    """What a program found at the end of a load step.

    Parameters
    ----------
    step : int
        Number of the load step, counted from 1 over all stages.
    positions : ndarray, shape (n, 3)
        Of all control points, or nodes, in the order of `Numbering`; NaN where the program has no node.
    reactions : tuple of Reaction
        One a support: what it exerts on its body.
    works : tuple of float
        Friction work and spurious work (theory 3.31) of all contacts within the load step; NaN: the program does not tell.
    """

    step: int
    positions: FloatArray
    reactions: tuple[Reaction, ...]
    works: tuple[float, float] = (math.nan, math.nan)


@frozen
class Outcome:
    """What became of a problem.

    Parameters
    ----------
    ending : str
        "measured" where all load steps are there, else why not.
    words : str
        What the program said of that.
    steps : tuple of LoadStep
        Those that converged.
    solves : int
        Linear solves of all load steps, of those that failed too; 0: not known.
    cpu_seconds : float
        User and system time, that of starting the program included where it has a process of its own.
    """

    ending: Ending
    words: str
    steps: tuple[LoadStep, ...]
    solves: int
    cpu_seconds: float


class Program(Protocol):
    """What a study runs problems with."""

    @property
    def name(self) -> str:
        """As people call it."""

    def run(self, problem: Problem) -> Outcome:
        """Compute all load steps, or as many as converge.

        Raises
        ------
        InputError
            The program cannot express the problem; `field` is the key of the scene file that it has no word for.
        NotInstalledError
        """


def load_step(problem: Problem, step: int, positions: FloatArray, forces: FloatArray) -> LoadStep:
    """A load step from what is known at control points.

    Parameters
    ----------
    problem : Problem
    step : int
    positions : ndarray, shape (n, 3)
        In the order of `Numbering`.
    forces : ndarray, shape (n, 3)
        That hold the prescribed components in their place: what supports exert on their body. What is said of other components is
        not looked at.
    """
    supports = Supports(problem, Numbering(problem))
    reactions = []
    for support, points, share in zip(problem.supports, supports.points, supports.shares, strict=True):
        held, centre = share * forces[points], supports.centre(support, step)
        bearing = held.any(axis=1)  # where there is no node nothing is borne
        force, turning = held.sum(axis=0), moment(positions[points][bearing] - centre, held[bearing])
        reactions.append(Reaction(*of_whole(problem, force, turning, centre), centre))
    return LoadStep(step, positions, tuple(reactions))


def ended(steps: Sequence[LoadStep], problem: Problem, ending: Ending, words: str) -> tuple[Ending, str]:
    """Why a run ended: it was measured where all load steps are there, whatever came after, and never where they are not."""
    if len(steps) == problem.total_steps:
        return "measured", ""
    return "crashed" if ending == "measured" else ending, words
