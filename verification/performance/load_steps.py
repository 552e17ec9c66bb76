"""What larger load steps cost: convergence and accuracy of the monolithic method.

    python verification/performance/load_steps.py [--scenes twist,iron] [--factors 1,2,4] [--set bodies.master.mesh.order=[3,3,2]]

Every stage is run with its number of load steps divided by the factor (rounded up). For each run: linear solves per load step (median,
most), cut increments, CPU seconds, and the largest deviation of force and moment of the moved body from the run with the scene's own
load steps, at the load steps that both have, relative to the largest force and moment of that run. Friction makes the result depend on the
path, so that the deviation falls with the load step but is not round-off.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Motion, Problem
from isomortar.scene import Scene
from isomortar.solve.simulation import Simulation

#: A load step by its stage and the share of the stage that is done.
Moment = tuple[int, Fraction]


@dataclass(frozen=True)
class Run:
    """Force and moment at every load step, shape (3,) each, and what they cost."""

    force: dict[Moment, FloatArray]
    moment: dict[Moment, FloatArray]
    solves: list[int]
    cuts: int
    seconds: float


def coarsened(problem: Problem, factor: int) -> Problem:
    """The problem with load steps that are larger by a factor."""
    return replace(problem, stages=tuple(replace(stage, steps=-(-stage.steps // factor)) for stage in problem.stages))


def run(problem: Problem, support: int) -> Run:
    """Run to the end; a run that stops raises."""
    start = time.process_time()
    results = list(Simulation(problem).run())
    seconds = time.process_time() - start
    moments = [(k, Fraction(i + 1, stage.steps)) for k, stage in enumerate(problem.stages) for i in range(stage.steps)]
    reactions = [result.reactions[support] for result in results]
    return Run(
        dict(zip(moments, (reaction.force for reaction in reactions), strict=True)),
        dict(zip(moments, (reaction.moment for reaction in reactions), strict=True)),
        [result.counters["solves"] for result in results],
        sum(result.cuts for result in results),
        seconds,
    )


def deviation(coarse: dict[Moment, FloatArray], fine: dict[Moment, FloatArray]) -> float:
    """Largest distance at common load steps, relative to the largest norm of the fine run."""
    apart = [np.linalg.norm(coarse[moment] - fine[moment]) for moment in coarse.keys() & fine.keys()]
    return float(max(apart) / max(np.linalg.norm(value) for value in fine.values()))


def moved_support(problem: Problem) -> int:
    """Number of the first support that moves."""
    return next(k for k, support in enumerate(problem.supports) if any(motion != Motion() for motion in support.motions))


def main() -> None:
    """Measure and print row by row."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", default="twist,iron")
    parser.add_argument("--factors", default="1,2,4")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    options = parser.parse_args()
    print(f"{'scene':9s} {'larger':>6s} {'steps':>5s} {'median':>6s} {'most':>5s} {'cuts':>4s} {'CPU s':>7s} {'force':>9s} {'moment':>9s}")
    for scene in options.scenes.split(","):
        problem = Scene.load(scene, options.set).problem()
        support = moved_support(problem)
        fine: Run | None = None
        for factor in (int(f) for f in options.factors.split(",")):
            found = run(coarsened(problem, factor), support)
            fine = fine or found
            print(
                f"{scene:9s} {factor:5d}x {len(found.solves):5d} {np.median(found.solves):6.1f} {max(found.solves):5d} {found.cuts:4d} "
                f"{found.seconds:7.1f} {deviation(found.force, fine.force):9.1e} {deviation(found.moment, fine.moment):9.1e}",
                flush=True,
            )


if __name__ == "__main__":
    main()
