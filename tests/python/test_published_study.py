"""The study of published benchmarks: what other programs are told of them, what becomes of their runs, and the page."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest
from published import others, punches, roller
from published.benchmark import Benchmark, Beside, at_force, reaction
from published.benchmarks import BENCHMARKS
from published.others import OWN, PROGRAMS, by_program
from published.page import write
from published.study import study

from isomortar.errors import ConvergenceError
from isomortar.harness.cases import Cell, SkippedError
from isomortar.harness.measurement import Measurement
from isomortar.harness.runner import Result
from isomortar.model.entities import Problem
from isomortar.model.numbering import Numbering
from isomortar.program import calculix, getfem
from isomortar.program.declaration import LoadStep, NotInstalledError, Outcome, load_step
from isomortar.program.lagrange import LagrangeProblem

TOLD = [(benchmark, beside) for benchmark in BENCHMARKS if isinstance(beside := benchmark.beside, Beside)]
RUNS = by_program.grid["run"]
SMOOTH = next(benchmark for benchmark in BENCHMARKS if benchmark.name == "nafems_punch-friction-0")


def kinds() -> list[tuple[Benchmark, Beside, str]]:
    return [(benchmark, beside, kind) for benchmark, beside in TOLD for kind in beside.kinds]


def still(problem: Problem) -> list[LoadStep]:
    """Load steps in which nothing moves, held by forces that grow."""
    nodes = Numbering(problem).reference
    return [load_step(problem, step, nodes, np.full_like(nodes, -1e5 * step)) for step in range(1, problem.total_steps + 1)]


def test_every_benchmark_tells_of_other_programs() -> None:
    assert len({benchmark.name for benchmark in BENCHMARKS}) == len(BENCHMARKS)
    for benchmark in BENCHMARKS:
        assert isinstance(benchmark.beside, Beside) or benchmark.beside.endswith("."), benchmark.name
        beside = benchmark.beside
        if isinstance(beside, Beside):
            assert beside.within.keys() <= {quantity.name for quantity in benchmark.quantities}
            assert beside.stops.keys() <= {f"{kind} {program}" for kind in beside.kinds for program in PROGRAMS if program != OWN}


def test_what_stops_is_not_run() -> None:
    for benchmark, beside, kind in kinds():
        for program in PROGRAMS:
            assert (f"{benchmark.name} {kind} {program}" in RUNS) == (f"{kind} {program}" not in beside.stops)


@pytest.mark.parametrize(("beside", "kind"), [pytest.param(beside, kind, id=f"{entry.name} {kind}") for entry, beside, kind in kinds()])
def test_all_programs_can_express_the_benchmark(beside: Beside, kind: str) -> None:
    problem = beside.problem(kind)
    LagrangeProblem(problem, "GetFEM", getfem.ENERGIES)
    calculix._check(LagrangeProblem(problem, "CalculiX", calculix.LAWS))
    numbers = beside.numbers(problem, still(problem))
    assert numbers.keys() == beside.within.keys()


def test_a_value_is_told_at_the_force() -> None:
    assert at_force(3.0, [2.0, 4.0], [1.0, 2.0]) == pytest.approx(1.5)
    assert np.isnan(at_force(5.0, [2.0, 4.0], [1.0, 2.0])), "the way ended before that force"


def test_the_punch_settles_where_its_axis_does() -> None:
    problem = punches.problem(40.0, 10.0, punches._NAFEMS, "L1 coarse", {"a": {"young": 2.0}, "b": {"young": 1.0}}, {})
    nodes = Numbering(problem).reference
    axis = np.argmin(np.linalg.norm(nodes - [0.5, 0.0, 0.0], axis=1))
    lower = Numbering(problem).points["cylinder"]
    moved = nodes.copy()
    moved[lower[np.isclose(nodes[lower, 2], 0.0) & (np.hypot(*nodes[lower, :2].T) < 0.51)], 2] -= 0.25
    assert np.hypot(*nodes[axis, :2]) == pytest.approx(0.5)
    assert punches.settled(problem, moved) == pytest.approx(-0.25)


def test_the_roller_is_pressed_past_its_force_by_way() -> None:
    problem = roller.by_way("L1", "linear-elastic", 0.0)
    found = roller.by_others(problem, still(problem))
    assert found == {"settled": 0.0}
    assert reaction(problem, still(problem)[-1], "top")[2] < -0.5 * roller.FORCE


class Stub:
    """A program that answers with what it was given."""

    name = OWN

    def __init__(self, outcome: Outcome | Exception) -> None:
        self.outcome = outcome

    def run(self, problem: Problem) -> Outcome:
        if isinstance(self.outcome, Exception):
            raise self.outcome
        return self.outcome


def ran(monkeypatch: pytest.MonkeyPatch, outcome: Outcome | Exception) -> Mapping[str, object]:
    monkeypatch.setitem(others.PROGRAMS, "CalculiX", Stub(outcome))
    return by_program.function(run=f"{SMOOTH.name} L1 CalculiX")


def test_numbers_are_those_of_the_load_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    assert isinstance(SMOOTH.beside, Beside)
    steps = tuple(still(SMOOTH.beside.problem("L1")))
    found = ran(monkeypatch, Outcome("measured", "", steps, 7, 1.5))
    assert found == {"middle": 0.0, "nodes": len(steps[0].positions), "solves": 7, "cpu_seconds": 1.5}
    assert found.keys() == by_program.bounds_of({"run": f"{SMOOTH.name} L1 CalculiX"}).keys()


def test_a_program_that_is_not_there_or_stops_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(SkippedError, match="apt-get install calculix-ccx"):
        ran(monkeypatch, NotInstalledError("CalculiX is not installed: apt-get install calculix-ccx"))
    with pytest.raises(ConvergenceError, match="load step 1: too many cutbacks"):
        ran(monkeypatch, Outcome("not converged", "too many cutbacks", (), 7, 1.5))


def made_up(run: str) -> Result:
    """A run by GetFEM or by us whose numbers differ by a tenth; CalculiX is not installed."""
    cell = Cell(by_program, {"run": run})
    if run.endswith("CalculiX"):
        return Result(cell, Measurement("skipped", message="CalculiX is not installed: apt-get install calculix-ccx"), (), True)
    value = -0.13 * (1.1 if run.endswith("GetFEM") else 1.0)
    return Result(cell, Measurement("measured", {"middle": value, "nodes": 99.0, "solves": 7.0, "cpu_seconds": 1.25}), (), True)


def test_the_page_has_programs_beside_each_other_and_says_what_is_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Result, "state", property(lambda result: "passed" if result.measurement.numbers else "skipped"))
    results = [made_up(run) for run in RUNS if run.startswith(f"{SMOOTH.name} ")]
    found = write(tmp_path, [replace(entry, drawings=()) for entry in (SMOOTH, BENCHMARKS[0])], results, datetime(2026, 1, 2).astimezone())
    assert (found.failed, found.complete) == (0, True), "a machine without other programs does not fail"
    text = found.page.read_text()
    assert text.count("CalculiX is not installed: apt-get install calculix-ccx") == 3, "at the top, and at both kinds"
    assert len(re.findall(r"-0\.143 <span class=\"soft\">\+10\.00 %", text)) == 2
    assert text.count("Lagrange elements: with facets in the place of circles") == 1
    assert "nan" not in re.sub(r"<style>.*?</style>", "", text, flags=re.DOTALL), "what was not measured is a dash"


def test_the_study_runs_all_of_it() -> None:
    root = Path(__file__).parents[2] / "verification"
    names = {run.name for run in study(root / "published").runs if isinstance(run, Cell)}
    assert {f"published/by_program[run={run}]" for run in RUNS} <= names
    assert {"published/nafems_punch[mesh=N3 fine, friction=0.1]", "published/nested_hemispheres[mesh=N2 fine, friction=0.0]"} <= names
