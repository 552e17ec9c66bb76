"""The study of programs: what is stated of curves that are made up, who is not measured, and the page."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest
import typer
from programs.found import Evidence, Found, common
from programs.plan import SETUPS, Planned, Setup, planned
from programs.statements import STATEMENTS
from programs.study import _written, study

from isomortar.cli.verification import conduct
from isomortar.harness.measurement import Measurement, stored
from isomortar.harness.runner import Result
from isomortar.program.calculix import LAWS
from isomortar.program.getfem import ENERGIES
from isomortar.program.lagrange import LagrangeProblem

#: Two load steps of pressing, two of dragging, on the coarsest elements.
TINY = Setup(
    scene="block",
    title="Tiny <blocks>",
    changes=(
        "materials.rubber.law=neo-hookean-j",
        "stages.press.steps=2",
        "stages.press.motions.top.translate=[0,0,-0.1]",
        "stages.slide.steps=2",
        "stages.slide.motions.top.translate=[0.02,0,0]",
    ),
    elements={"L1": ((1, 1, 1), (2, 2, 1)), "N2": ((1, 1, 1), (2, 2, 1))},
)
#: How far the forces of each program are off those of isomortar, over what the mesh changes.
OFF = {"isomortar": 0.0, "GetFEM": 0.5, "CalculiX": -0.9}


def forces(planned: Planned, off: float, steps: int = 4) -> np.ndarray:
    """Forces on both supports, in balance; the fine mesh changes those of isomortar by a tenth."""
    size = (1.0 if planned.mesh == "coarse" else 0.9) + 0.1 * off * (1.5 if planned.mesh == "coarse" else 1.0)
    top = size * np.array([[0.0, 0.0, -1.0], [0.0, 0.0, -2.0], [0.2, 0.0, -2.0], [0.4, 0.0, -2.0]])[:steps]
    return np.stack([top, -top], axis=1)


def made_up(**otherwise: Measurement) -> list[Found]:
    """Runs of the tiny setup with forces as above, of some programs as given."""
    runs = []
    for entry in planned((TINY,)):
        cell = entry.run.case
        measurement = otherwise.get(entry.program) or measured(forces(entry, OFF[entry.program]))
        runs.append(Found(Result(cell, measurement, (), True), entry))  # type: ignore[arg-type]
    return runs


def measured(force: np.ndarray, words: str = "") -> Measurement:
    numbers = {
        "missing": float(4 - len(force)),
        "force": stored(force),
        "words": {"type": "words", "text": words},
        "solves": 9.0,
        "cpu_seconds": 1.5,
    }
    return Measurement("measured", numbers)


def verdicts(runs: list[Found]) -> dict[tuple[str, str], tuple[str, dict[str, float], str]]:
    judged = [statement.judged([Evidence(common(runs), method) for method in statement.methods]) for statement in STATEMENTS]
    return {(j.statement.section, v.method): (v.state, dict(v.values), v.why) for j in judged for v in j.verdicts}


def test_differences_are_judged_beside_those_of_the_mesh() -> None:
    found = verdicts(made_up())
    assert {state for state, _, _ in found.values()} == {"holds"}
    assert found["pressed", "GetFEM"][1] == {"block L1": pytest.approx(0.5)}
    assert found["dragged", "CalculiX"][1] == {"block L1": pytest.approx(0.9)}
    assert found["refined", "GetFEM"][1] == {f"block L1 {stage}": pytest.approx(1 / 1.5) for stage in ("pressed", "dragged")}
    assert ("pressed", "isomortar") not in found, "it is what others are compared with"


def test_a_program_that_is_further_off_than_the_mesh_does_not_hold() -> None:
    runs = made_up()
    for run in runs:
        if run.planned.program == "GetFEM":
            fine = run.planned.mesh == "fine"
            run.result.measurement.numbers["force"] = stored(forces(run.planned, 1.1 if fine else 0.1))
    found = verdicts(runs)
    assert [found[name, "GetFEM"][0] for name in ("pressed", "dragged", "refined", "balance")] == ["does not hold"] * 3 + ["holds"]


def test_forces_out_of_balance_do_not_hold() -> None:
    runs = made_up()
    shifted = forces(runs[1].planned, OFF[runs[1].planned.program])
    shifted[2, 1, 1] += 1e-5
    runs[1].result.measurement.numbers["force"] = stored(shifted)
    assert verdicts(runs)["balance", runs[1].planned.program][0] == "does not hold"


def test_a_program_that_is_not_installed_never_holds() -> None:
    missing = Measurement("skipped", message="CalculiX is not installed: apt-get install calculix-ccx")
    runs = made_up(CalculiX=missing)
    found = verdicts(runs)
    for (_, method), (state, _, why) in found.items():
        assert state == ("not measured" if method == "CalculiX" else "holds")
        assert why == ("CalculiX: CalculiX is not installed: apt-get install calculix-ccx" if method == "CalculiX" else "")
    assert {run.ending for run in runs if run.planned.program == "CalculiX"} == {"not measured"}


def test_nothing_is_compared_with_a_run_of_ours_that_is_lost() -> None:
    found = verdicts(made_up(isomortar=Measurement("crashed", message="Traceback\nValueError: no")))
    assert found["pressed", "GetFEM"][::2] == ("not measured", "isomortar: ValueError: no")
    assert found["balance", "GetFEM"][0] == "holds"


def test_what_stops_is_told_with_what_had_converged() -> None:
    runs = made_up()
    stopped = next(run for run in runs if run.planned.program == "GetFEM" and run.planned.mesh == "fine")
    numbers = measured(forces(stopped.planned, 0.5, steps=2), "gave up in load step 3").numbers
    stopped.result.measurement.numbers.update(numbers)
    assert (stopped.ending, stopped.missing, stopped.words) == ("not converged", 2, "gave up in load step 3")
    assert stopped.last("pressed") == pytest.approx(-2.0 * 0.95)
    assert np.isnan(stopped.last("dragged"))
    found = verdicts(runs)
    assert found["ending", "GetFEM"][:2] == ("does not hold", {"block L1 coarse": 0.0, "block L1 fine": 2.0})
    assert found["pressed", "GetFEM"][::2] == ("holds", "")
    assert found["dragged", "GetFEM"][0] == "not measured"
    assert "without block L1 fine by GetFEM, not converged" in found["dragged", "GetFEM"][2]
    assert found["refined", "GetFEM"][0] == "partly measured"
    assert found["refined", "GetFEM"][1].keys() == {"block L1 pressed"}


def test_the_page_has_curves_endings_and_numbers(tmp_path: Path) -> None:
    missing = Measurement("skipped", message="GetFEM is not installed")
    runs = made_up(GetFEM=missing)
    found = _written([run.planned for run in runs], tmp_path, [run.result for run in runs], datetime(2026, 1, 2).astimezone())
    assert (found.failed, found.complete) == (2, False)
    assert found.summary == "0 holds, 5 partly measured, 0 not measured, 0 does not hold"
    text = found.page.read_text()
    assert text.count("<svg") == 1
    assert text.count("GetFEM is not installed") == 5 + 2
    assert "Tiny &lt;blocks&gt;" in text
    assert len(re.findall(r"CalculiX</td><td class=\"text\"><span class=\"state measured\">measured", text)) == 2
    assert not re.search(r'(src|href)="(?!#|data:)', text)
    data = json.loads(found.page.with_suffix(".json").read_text())
    assert len(data["runs"]) == 8
    assert data["runs"][0]["cpu_seconds"] == 1.5
    assert data["runs"][1]["cpu_seconds"] is None


def test_it_runs_from_end_to_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With elements that isomortar alone has: of others nothing is measured."""
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[2] / "verification"))  # for the measuring processes
    with pytest.raises(typer.Exit):
        conduct(study((replace(TINY, elements={"N2": TINY.elements["N2"]}),)), tmp_path, 1)
    data = json.loads((tmp_path / "report.json").read_text())
    assert [(run["name"], run["ending"], np.shape(run["force"])) for run in data["runs"]] == [
        (f"block N2 {mesh}", "measured", (4, 2, 3)) for mesh in ("coarse", "fine")
    ]
    assert {statement["verdict"] for statement in data["statements"]} == {"not measured"}


@pytest.mark.parametrize("setup", SETUPS, ids=lambda setup: setup.scene)
def test_all_programs_can_express_the_scenes(setup: Setup) -> None:
    for kind in ("L1", "L2"):
        problem = setup.load(kind, "coarse").problem()
        assert [len(problem.supports), len(problem.stages)] == [2, 2]
        LagrangeProblem(problem, "CalculiX", LAWS)
        LagrangeProblem(problem, "GetFEM", ENERGIES)
