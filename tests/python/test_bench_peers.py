"""What stands beside isomortar's times."""

from __future__ import annotations

import json
import re
import runpy
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from isomortar.harness.cases import Case
from isomortar.harness.collection import cases_of
from isomortar.harness.compare import judge
from isomortar.harness.measurement import measure
from isomortar.harness.references import finder
from isomortar.program import getfem
from isomortar.program.getfem import GetFEM
from isomortar.program.process import End, Finished
from isomortar.scene import Scene

VERIFICATION = Path(__file__).parents[2] / "verification"

bulk_work = runpy.run_path(str(VERIFICATION / "performance/peers/bulk_work.py"))
programs = runpy.run_path(str(VERIFICATION / "performance/peers/programs.py"))
block = runpy.run_path(str(VERIFICATION / "performance/block.py"))


def test_pressing_alone_is_the_first_stage() -> None:
    coarse = Scene.load("block", block["COARSE"])
    alone = Scene.load("block", [*block["COARSE"], block["pressing"](coarse)]).problem()
    assert alone.stages == coarse.problem().stages[:1]
    assert [support.motions[0] for support in alone.supports] == [support.motions[0] for support in coarse.problem().supports]


def test_a_problem_at_rest_has_no_load_step() -> None:
    rest = block["at_rest"](Scene.load("block", block["COARSE"]).problem())
    assert rest.total_steps == 0
    assert [len(support.motions) for support in rest.supports] == [0, 0]


def test_a_program_that_is_not_there_is_a_note() -> None:
    row = block["other_run"](GetFEM("/no/such/python"), Scene.load("block", block["COARSE"]), 1, "aside")
    assert row == {"note": "GetFEM is not installed: apt-get install python3-getfem"}


def test_getfem_is_not_charged_with_works_that_it_integrates_for_us(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []

    def run(command: list[str]) -> Finished:
        asked.append(json.loads(Path(command[-1]).read_text())["works"])
        return Finished(End("crashed", "", 1), "", "", 1.0)

    monkeypatch.setattr(getfem, "has_module", lambda *_: True)
    monkeypatch.setattr(getfem, "run", run)
    assert next(block["block"].function(True))["program"] == "GetFEM"
    assert asked == [False, False], "the run, and its start-up"
    GetFEM().run(Scene.load("block", block["COARSE"]).problem())
    assert asked[-1], "studies do show them"


def test_time_is_compared_only_where_both_came_to_the_end() -> None:
    own = {"load steps": 5, "CPU": 1.0}
    assert block["compared"](own, {"load steps": 5, "CPU": 4.0})["of GetFEM"] == 0.25
    assert "of GetFEM" not in block["compared"](own, {"load steps": 3, "CPU": 4.0, "note": "did not converge"})
    assert "apt-get" in block["compared"](own, {"note": "not installed: apt-get install python3-getfem"})["note"]
    assert block["compared"]({**own, "note": "ended"}, {"load steps": 5, "CPU": 4.0}) == {**own, "note": "ended"}


@dataclass(frozen=True)
class _Run:
    cpu_seconds: float


@pytest.mark.parametrize(("spent", "runs", "median"), [([1.0, 3.0, 2.0], 3, 2.0), ([100.0], 1, 100.0)])
def test_short_work_is_timed_more_than_once(spent: list[float], runs: int, median: float) -> None:
    left = iter(spent)
    last, seconds = programs["timed"](lambda: _Run(next(left)), 3)
    assert (last.cpu_seconds, seconds, len(spent)) == (spent[-1], median, runs)


def test_multilinear_fields() -> None:
    coefficients = np.arange(21.0).reshape(3, 7)
    found = bulk_work["multilinear"](coefficients, [[1.0, 2.0, 3.0]])
    np.testing.assert_allclose(found, [coefficients @ [1.0, 2.0, 3.0, 2.0, 6.0, 3.0, 6.0]])


def test_nodes_are_compared_whatever_their_order() -> None:
    points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    vectors = {"forces": points + 1.0, "action": points + 2.0, "correction": points + 3.0}
    shuffled = {name: vector[[2, 0, 1]] for name, vector in vectors.items()}
    one = bulk_work["answer"](1.0, 2.0, points, vectors, points)
    other = bulk_work["answer"](1.0, 2.0, points[[2, 0, 1]], shuffled, points[[2, 0, 1]])
    assert one["nodes"] == other["nodes"]
    assert one["numbers"] == pytest.approx(other["numbers"])
    assert "nodes" not in bulk_work["answer"](1.0, 2.0, points, vectors)


@pytest.fixture
def instructions() -> Case:
    (case,) = cases_of(VERIFICATION / "speed/instructions.py")
    return case


def test_without_a_counter_nothing_passes(instructions: Case, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shutil.which", lambda _: None)
    for cell in instructions.cells:
        checks = judge(cell, measure(cell), finder(VERIFICATION.parent / "reference_data"))
        assert {check.state for check in checks} == {"skipped"}
        assert {"imbalance", "solid", "load steps"} < {check.name for check in checks}


def test_every_routine_that_works_on_a_load_step_is_counted() -> None:
    module = runpy.run_path(str(VERIFICATION / "speed/instructions.py"))
    counted = {name for names in module["WORK"].values() for name in names} | set(module["OTHERS"])
    api = VERIFICATION.parent / "fortran" / "api"
    sources = set(api.glob("*_api.f90")) - {api / "extended_api.f90", api / "mumps_api.f90"}  # extensions of their own
    named = {f"{name}_" for path in sources for name in re.findall(r"^(?:recursive )?subroutine (\w+)", path.read_text(), re.MULTILINE)}
    assert named - {"working_precision_", "material_stress_"} == counted
