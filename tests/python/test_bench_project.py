"""The project's own benchmarks come to their end on the smallest input. What they take is not judged."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from isomortar.harness.bench import ASIDE
from isomortar.harness.bench.collection import collect
from isomortar.harness.bench.processes import Answer, run
from isomortar.harness.bench.standings import standings

BENCHMARKS = {one.name: one for one in collect(Path(__file__).parents[2] / "verification")}


def tried(name: str) -> Answer:
    return run(BENCHMARKS[name], True, lambda _: None)


@pytest.mark.parametrize(
    "name", ["cost_of_unknowns", "iteration_phases", "linear_solves", "load_steps", "memory", "solid_assembly", "threads"]
)
def test_every_column_is_measured(name: str) -> None:
    answer = tried(name)
    assert not answer.failed, answer.cost.message
    assert answer.rows
    for row in answer.rows:
        assert set(row) == set(BENCHMARKS[name].columns)
        assert all(math.isfinite(value) for value in row.values() if not isinstance(value, str))


@pytest.mark.parametrize("name", ["block", "bulk"])
def test_programs_that_are_there_do_the_same_work_and_others_say_how_to_get_them(name: str) -> None:
    answer = tried(name)
    assert not answer.failed, answer.cost.message
    measured = [row for row in answer.rows if row.keys() & {"CPU", "solve"}]
    assert all("not installed" in str(row["note"]) for row in answer.rows if row not in measured)
    assert "isomortar" in {row["program"] for row in measured}
    for row in measured:
        if name == "bulk":
            assert row["difference"] == ASIDE if row["program"] == "isomortar" else float(row["difference"]) < 1e-10
        else:  # other contact laws on a coarse mesh: some per cent; a wrong material, friction or load step is far off
            own = next(one for one in measured if (one["stages"], one["program"]) == (row["stages"], "isomortar"))
            assert float(row["normal force"]) == pytest.approx(float(own["normal force"]), rel=0.08)
    check_that_nothing_is_met_alone(answer)


def check_that_nothing_is_met_alone(answer: Answer) -> None:
    """Beside a program that is not there isomortar is not known to be as fast, nor to have the same numbers."""
    (standing,) = standings(answer)
    notes = [str(row.get("note")) for row in answer.rows if row["program"] != "CalculiX"]
    if any("not installed" in note for note in notes):
        assert standing.state in ("not compared", "missed")


def test_one_rank_and_two_give_the_force_of_none() -> None:
    answer = tried("mumps")
    assert not answer.failed, answer.cost.message
    own, *others = answer.rows
    assert (own["engine"], own["force off"], len(others)) == ("own", 0.0, 8)
    for row in others:
        if "note" in row:
            assert "tools/setup.sh --mumps" in str(row["note"])
        else:
            assert float(row["force off"]) < 1e-10


def test_multigrid_solves_where_it_is_there_and_else_says_how_to_get_it() -> None:
    answer = tried("multigrid")
    assert not answer.failed, answer.cost.message
    for row in answer.rows:
        assert "note" not in row or "pip install pyamg" in str(row["note"])
        assert "left" not in row or float(row["left"]) < 1e-9  # until 1e-10 is left, by the solver's own count
        assert "iterations" not in row or 1 < int(row["iterations"]) < 40


def test_phases_add_up() -> None:
    (row,) = tried("iteration_phases").rows
    parts = [float(row[phase]) for phase in ("solid", "projection", "contact", "factor", "solve", "other")]
    assert min(parts) >= 0.0
    assert sum(parts) == pytest.approx(float(row["total"]))
    assert row["contact share"] == pytest.approx(100.0 * (parts[1] + parts[2]) / float(row["total"]))


def test_what_grows_with_sizes_grows() -> None:
    small, large = tried("sizes").rows
    for name in ("unknowns", "memory", "expected"):
        assert float(small[name]) < float(large[name])
    assert small["tangents"]
    parts = [float(small[phase]) for phase in ("solid", "projection", "contact", "factor", "solve", "other")]
    assert sum(parts) == pytest.approx(float(small["a step"]))


def test_every_benchmark_is_tried_here() -> None:
    text = Path(__file__).read_text()
    assert all(f'"{name}"' in text for name in BENCHMARKS)


def test_solvers_that_are_there_solve_and_others_say_how_to_get_them() -> None:
    answer = tried("factorisation")
    assert not answer.failed, answer.cost.message
    for row in answer.rows:
        if "note" in row:
            assert "install" in str(row["note"])
        else:
            assert float(row["residual"]) < 1e-8  # round-off times what pivots within a block lose; a wrong solve is of size one
    assert {row["program"] for row in answer.rows if "note" not in row} >= {"isomortar", "SciPy SuperLU"}
    check_that_nothing_is_met_alone(answer)
