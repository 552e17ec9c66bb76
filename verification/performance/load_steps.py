"""What larger load steps cost: convergence and accuracy of the monolithic method."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from time import process_time

import numpy as np
from performance.problems import problem

from isomortar.geometry.patch import FloatArray
from isomortar.harness.bench import Row, benchmark
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Motion, Problem

#: A load step by its stage and the share of the stage that is done.
Moment = tuple[int, Fraction]


@dataclass(frozen=True)
class History:
    """Force and moment at every load step, shape (3,) each, and what they cost."""

    force: dict[Moment, FloatArray]
    moment: dict[Moment, FloatArray]
    tangents: list[int]
    cuts: int
    seconds: float


@benchmark(
    question="What do larger load steps cost, in tangents and in accuracy?",
    columns={
        "scene": "",
        "larger": "",
        "steps": "",
        "median": "",
        "most": "",
        "tangents": "",
        "cuts": "",
        "CPU": "s",
        "force": "",
        "moment": "",
    },
)
def load_steps(quick: bool) -> Iterator[Row]:
    """Every stage with its load steps divided by a factor, rounded up: tangents per load step (median, most) and in all.

    `force` and `moment` are the largest deviation of the moved body's from the run with the scene's own load steps, at the load steps that
    both have, relative to the largest of that run. Friction makes the result depend on the path: the deviation falls
    with the load step but is not round-off.
    """
    for scene in ("press",) if quick else ("twist", "iron"):
        own = problem(scene, "N2", (4, 4, 2) if quick else None)
        support = moved_support(own)
        fine: History | None = None
        for factor in (1, 5) if quick else (1, 2, 4):
            found = run(coarsened(own, factor), support)
            fine = fine or found
            deviations = {"force": deviation(found.force, fine.force), "moment": deviation(found.moment, fine.moment)}
            counts = {
                "median": float(np.median(found.tangents)),
                "most": max(found.tangents),
                "tangents": sum(found.tangents),
                "cuts": found.cuts,
            }
            yield {"scene": scene, "larger": factor, "steps": len(found.tangents), **counts, "CPU": found.seconds, **deviations}


def coarsened(problem: Problem, factor: int) -> Problem:
    """The problem with load steps that are larger by a factor."""
    return replace(problem, stages=tuple(replace(stage, steps=-(-stage.steps // factor)) for stage in problem.stages))


def run(problem: Problem, support: int) -> History:
    """Run to the end; a run that stops raises."""
    start = process_time()
    results = list(Simulation(problem).run())
    seconds = process_time() - start
    moments = [(k, Fraction(i + 1, stage.steps)) for k, stage in enumerate(problem.stages) for i in range(stage.steps)]
    reactions = [result.reactions[support] for result in results]
    return History(
        dict(zip(moments, (reaction.force for reaction in reactions), strict=True)),
        dict(zip(moments, (reaction.moment for reaction in reactions), strict=True)),
        [result.counters["factorisations"] for result in results],
        sum(result.cuts for result in results),
        seconds,
    )


def deviation(coarse: dict[Moment, FloatArray], fine: dict[Moment, FloatArray]) -> float:
    """Largest distance at common load steps, relative to the largest norm of the fine run."""
    apart = [np.linalg.norm(coarse[moment] - fine[moment]) for moment in coarse.keys() & fine.keys()]
    return float(np.max(apart) / np.max([np.linalg.norm(value) for value in fine.values()]))


def moved_support(problem: Problem) -> int:
    """Number of the first support that moves."""
    return next(k for k, support in enumerate(problem.supports) if any(motion != Motion() for motion in support.motions))
