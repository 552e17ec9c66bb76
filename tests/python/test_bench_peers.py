"""What is written for other programs and read from them, and what stands beside isomortar's times."""

from __future__ import annotations

import re
import runpy
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from isomortar.harness.cases import Case
from isomortar.harness.collection import cases_of
from isomortar.harness.compare import judge
from isomortar.harness.measurement import measure
from isomortar.harness.references import finder
from isomortar.scene import Scene

VERIFICATION = Path(__file__).parents[2] / "verification"

calculix = runpy.run_path(str(VERIFICATION / "performance/peers/calculix.py"))
bulk_work = runpy.run_path(str(VERIFICATION / "performance/peers/bulk_work.py"))
programs = runpy.run_path(str(VERIFICATION / "performance/peers/programs.py"))
block = runpy.run_path(str(VERIFICATION / "performance/block.py"))


@pytest.fixture(scope="module")
def problem() -> dict[str, Any]:
    return block["description"](Scene.load("block", block["COARSE"]))  # type: ignore[no-any-return]


def test_the_description_is_the_scene(problem: dict[str, Any]) -> None:
    assert problem["slave"] == {"lower": [-0.35, -0.35, 0.025], "upper": [0.35, 0.35, 0.525], "elements": [2, 2, 1]}
    assert problem["friction"] == 0.3
    assert [(stage["steps"], stage["translate"]) for stage in problem["stages"]] == [(2, [0.0, 0.0, -0.1]), (2, [0.02, 0.0, 0.0])]


def test_pressing_alone_is_the_first_stage(problem: dict[str, Any]) -> None:
    coarse = Scene.load("block", block["COARSE"])
    alone = block["description"](Scene.load("block", [*block["COARSE"], block["pressing"](coarse)]))
    assert alone == {**problem, "stages": problem["stages"][:1]}


def test_calculix_deck_has_all_nodes_elements_and_faces(problem: dict[str, Any]) -> None:
    lines = calculix["deck"](problem).splitlines()
    first = lines.index("*NODE, NSET=slave") + 1
    points = np.array([[float(x) for x in line.split(",")] for line in lines[first : first + 18]])
    assert lines[first + 18] == "*ELEMENT, TYPE=C3D8, ELSET=slave"
    np.testing.assert_array_equal(points[:, 0], np.arange(1, 19))
    np.testing.assert_allclose(points[[0, -1], 1:], [problem["slave"]["lower"], problem["slave"]["upper"]])
    corners = np.array([int(n) for n in lines[first + 19].split(",")])[1:] - 1
    a, b, c = (points[corners[k], 1:] - points[corners[0], 1:] for k in (1, 3, 4))
    np.testing.assert_allclose(np.linalg.det([a, b, c]), 0.35 * 0.35 * 0.5)
    # The slave touches with the faces below of its four elements, the master with those above of its upper layer.
    assert lines[lines.index("*SURFACE, NAME=FACE_slave") + 1] == "1, S1"
    assert lines[lines.index("*SURFACE, NAME=FACE_master") + 1] == "14, S2"
    assert [line for line in lines if line.startswith("TOP, ")] == [
        *("TOP, 1, 1, 0", "TOP, 2, 2, 0", "TOP, 3, 3, -0.1"),
        *("TOP, 1, 1, 0.02", "TOP, 2, 2, 0", "TOP, 3, 3, -0.1"),
    ]


def test_calculix_forces_are_those_at_load_steps() -> None:
    heading = " total force (fx,fy,fz) for set TOP and time  {}\n\n  {}  0.0  {}\n"
    dat = "".join(heading.format(*entry) for entry in ((0.5, 0.0, -1.0), (0.75, 0.0, -1.5), (1.0, 0.0, -2.0), (1.5, 0.25, -1.75)))
    stages = [{"steps": 2}, {"steps": 2}]
    assert calculix["forces"](dat, stages) == [[0.0, 0.0, -1.0], [0.0, 0.0, -2.0], [0.25, 0.0, -1.75]]


def test_calculix_iterations_are_counted() -> None:
    assert calculix["linear_solves"](" SUMMARY\n STEP INC\n\n 1 1 1 1 0.5\n 1 1 1 2 0.1\n 2 1 1 1 0.3\n") == 3


def test_time_is_compared_only_where_both_came_to_the_end() -> None:
    own = {"load steps": 5, "CPU": 1.0}
    assert block["compared"](own, {"load steps": 5, "CPU": 4.0})["of GetFEM"] == 0.25
    assert "of GetFEM" not in block["compared"](own, {"load steps": 3, "CPU": 4.0, "note": "did not converge"})
    assert "apt-get" in block["compared"](own, {"note": "not installed: apt-get install python3-getfem"})["note"]
    assert block["compared"]({**own, "note": "ended"}, {"load steps": 5, "CPU": 4.0}) == {**own, "note": "ended"}


def test_a_program_is_timed_with_what_it_says() -> None:
    code = "import sys; print('first'); print(sys.stdin.read()); sum(range(3_000_000))"
    finished, seconds = programs["timed"]([sys.executable, "-c", code], '{"a": 1}', repeats=1)
    assert finished.answer() == {"a": 1}
    assert finished.status == 0
    assert seconds == finished.seconds > 0.01
    assert programs["run"]([sys.executable, "-c", "raise ValueError('the last words')"]).last_words == "ValueError: the last words"
    assert programs["has_module"](sys.executable, "json")
    assert not programs["has_module"](sys.executable, "no_such_module")
    assert not programs["has_module"]("/no/such/python", "json")


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
    sources = (VERIFICATION.parent / "fortran" / "api").glob("*_api.f90")
    named = {f"{name}_" for path in sources for name in re.findall(r"^(?:recursive )?subroutine (\w+)", path.read_text(), re.MULTILINE)}
    aside = {"solid_difference_", "contact_difference_", "working_precision_", "material_stress_", "surface_hulls_"}
    assert named - aside == counted
