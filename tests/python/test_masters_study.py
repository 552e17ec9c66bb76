"""The study of masters with kinks: its scenes, what is stated of runs that are made up, and the page."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest
from masters.found import Beside, Evidence, Found, refinement, slide
from masters.plan import FULL, QUICK, WAYS, beside, by_getfem, planned
from masters.statements import STATEMENTS
from masters.study import _written, study
from paper.sections import Section

from isomortar.harness.measurement import Measurement, stored
from isomortar.harness.runner import Result
from isomortar.scene import Scene

BLOCK, TWIST, IRON = QUICK
GETFEM = beside(BLOCK)


def made_up(section: Section, **changed: dict[str, np.ndarray]) -> list[Found]:
    """Runs of a section; numbers of some variants as given."""
    return [Found(result(section, entry.variant.name, **changed.get(entry.variant.name, {})), entry) for entry in planned((section,))]


def result(section: Section, name: str, **changed: np.ndarray) -> Result:
    """A run that comes to its end: curves rise, those of kinks off by a tenth, of the friction work a tenth is spurious."""
    entry = next(entry for entry in planned((section,)) if entry.variant.name == name)
    stages = section.load(entry.variant, "monolithic").problem().stages
    count = sum(stage.steps for stage in stages)
    curve = (1.0 if "smooth" in entry.way else 1.1) * np.tile(np.arange(1.0, count + 1), (3, 1)).T
    numbers = {
        "step": np.arange(1, count + 1),
        "time": np.arange(1.0, count + 1),
        "stage": np.repeat(np.arange(len(stages)), [stage.steps for stage in stages]),
        "share": np.concatenate([np.arange(1, stage.steps + 1) / stage.steps for stage in stages]),
        "force": curve,
        "moment": curve,
        "factorisations": np.full(count, 4),
        "solves": np.full(count, 7),
        "friction_work": np.full(count, 2.0),
        "spurious_work": np.full(count, 0.2 if entry.way == "averaged" else 0.0),
        "cuts": 0,
    }
    measured = {key: stored(value) for key, value in {**numbers, **changed}.items()}
    return Result(entry.run.cell(Path("none")), Measurement("measured", measured, cpu_seconds=1.0), (), True)


def getfem(ending: str = "measured", pushed: float = 1.0) -> Beside:
    """The block by it; the tangential force makes so much of the work that is made up above."""
    force = np.zeros((15, 2, 3))
    force[:, 0] = pushed * np.arange(1.0, 16)[:, None]
    works = np.tile([2.0, -0.1], (15, 1))
    numbers = {"missing": 0, "force": force, "works": works, "words": {"type": "words", "text": ""}, "solves": 9, "cpu_seconds": 1.0}
    found = {name: value if isinstance(value, dict) else stored(value) for name, value in numbers.items()}
    measurement = Measurement("measured", found) if ending == "measured" else Measurement("skipped", message="GetFEM is not installed")
    return Beside(Result(by_getfem(GETFEM).cell(Path("none")), measurement, (), True), GETFEM)


def verdicts(runs: list[Found], other: Beside) -> dict[tuple[str, str], tuple[str, dict[str, float]]]:
    judged = [statement.judged([Evidence(runs, method, getfem=[other]) for method in statement.methods]) for statement in STATEMENTS]
    return {(j.statement.section, v.method): (v.state, dict(v.values)) for j in judged for v in j.verdicts}


@pytest.fixture(autouse=True)
def _scenes_go_to_a_folder_of_the_test(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("sections", [FULL, QUICK])
def test_every_run_builds_and_finds_feet_as_it_says(sections: tuple[Section, ...]) -> None:
    for entry in planned(sections):
        (contact,) = entry.section.load(entry.variant, "monolithic").problem().contacts
        assert contact.averaged == ("averaged" in entry.way)
        assert ("smooth" in entry.way) == (entry.variant.kind in ("N2", "N3"))
    names = [(entry.name, entry.way) for entry in planned(sections)]
    assert len(set(names)) == len(names)
    assert {way for _, way in names} == set(WAYS)


def test_scenes_are_those_that_are_bundled() -> None:
    block, twist, iron = FULL
    linear, bundled = (scene.problem() for scene in (block.load(beside(block).variant, "monolithic"), Scene.load("block")))
    meshes = [[(d.family, d.order, d.elements) for body in problem.bodies for d in body.patch.directions] for problem in (linear, bundled)]
    assert meshes[0] == meshes[1]
    assert linear.contacts == bundled.contacts
    assert [section.load(section.variant("N2"), "monolithic").problem().total_steps for section in (block, twist, iron)] == [15, 50, 50]
    refined = [(entry.name, entry.way) for entry in planned((iron,)) if entry.finer]
    assert refined[0] == ("iron N2 10 x 5", "smooth, averaged")
    finer = [("L1", "averaged"), ("N2", "smooth"), ("N2", "smooth, averaged")]
    assert refined[1:] == [(f"iron {kind} {mesh}", way) for mesh in ("20 x 10", "40 x 20") for kind, way in finer]


def test_runs_that_go_well_hold() -> None:
    nearer = 1.05 * np.tile(np.arange(1.0, 9), (3, 1)).T
    fine = {"L1-averaged-8x4": {"spurious_work": np.full(8, 0.1), "force": nearer}}
    found = verdicts([*made_up(BLOCK), *made_up(TWIST), *made_up(IRON, **fine)], getfem(pushed=1.1))
    assert {state for state, _ in found.values()} == {"holds"}
    assert set(found["tangents", "averaged"][1].values()) == {4.0}
    assert found["block, tangents", "averaged"][1] == {"block L1 4 x 4": 60.0}
    assert found["spurious work", "averaged"][1] == {"iron L1 8 x 4 / iron L1 5 x 2": pytest.approx(0.5)}
    assert found["drag", "averaged"][1] == {"iron L1 8 x 4 / iron L1 5 x 2": pytest.approx(0.5)}


def test_the_work_of_pushing_is_judged_beside_what_is_spurious() -> None:
    runs = made_up(BLOCK)
    own = runs[3].slid
    assert (own["N(5)"], own["N(15)"], own["T(15)"]) == pytest.approx((-5.5, -16.5, 16.5))
    assert own["pushed"] == pytest.approx(11.0 * 0.2)  # the mean of 5 to 15, on the quick way
    assert (own["friction"], own["spurious"]) == pytest.approx((20.0, 2.0))
    state, values = verdicts([*runs, *made_up(IRON)], getfem(pushed=3.0))["GetFEM", "averaged"]
    assert (state, values) == ("does not hold", {"block L1 4 x 4": pytest.approx((6.0 - 2.2) / (2.0 + 1.0))})


def test_without_getfem_nothing_is_said_of_it() -> None:
    found = verdicts([*made_up(BLOCK), *made_up(IRON)], getfem("skipped"))
    assert found["GetFEM", "averaged"] == ("not measured", {})
    assert found["ending", "averaged"][0] == "holds"
    assert np.isnan(getfem("skipped").slid["T(15)"])


def test_too_many_tangents_and_cuts_do_not_hold() -> None:
    slow = {"factorisations": np.full(15, 7), "cuts": np.array(6.0)}
    found = verdicts([*made_up(BLOCK, **{"L1-averaged": slow}), *made_up(IRON)], getfem())
    assert [found[name, "averaged"][0] for name in ("tangents", "cuts", "block, cuts", "block, tangents")] == ["does not hold"] * 4
    assert found["cuts", "averaged"][1] == {"all": 6.0}


def test_cuts_of_the_refinement_are_its_own() -> None:
    found = verdicts([*made_up(BLOCK), *made_up(IRON, **{"L1-averaged-8x4": {"cuts": np.array(9.0)}})], getfem())
    assert found["cuts", "averaged"][1] == {"all": 0.0}


def test_a_smooth_master_that_stops_is_compared_as_far_as_it_came() -> None:
    short = {
        name: np.array(result(IRON, "N2-averaged-8x4").measurement.numbers[name])[:6]
        for name in ("step", "time", "stage", "share", "force")
    }
    runs = made_up(IRON, **{"N2-averaged-8x4": short})
    evidence = Evidence(runs, "averaged")
    assert evidence.apart() == {"iron L1 8 x 4 / iron L1 5 x 2": pytest.approx(1.0)}
    assert evidence.without == "iron N2 8 x 4 (smooth, averaged) after load step 6"
    at_once = {name: values[:3] for name, values in short.items()}
    before = Evidence(made_up(IRON, **{"N2-averaged-8x4": at_once}), "averaged")
    assert (before.apart(), before.without) == ({}, "iron N2 8 x 4 (smooth, averaged) after load step 3")


def stopped(run: Found, reason: str) -> Found:
    """The run, of which no load step is left."""
    return replace(
        run, result=replace(run.result, measurement=Measurement("not converged", message=f"isomortar.ConvergenceError: {reason}"))
    )


def test_a_run_that_stops_is_shown_with_the_reason_and_does_not_hold(tmp_path: Path) -> None:
    runs = [*made_up(BLOCK), *made_up(TWIST), *made_up(IRON)]
    for number, run in enumerate(runs):
        if run.planned.section is BLOCK and run.planned.variant.name in ("L1", "L1-averaged"):
            runs[number] = stopped(run, "load step 12 <does> not converge")
    found = verdicts(runs, getfem())
    assert found["ending", "averaged"][0] == "does not hold"
    assert found["ending", "averaged"][1]["block L1 4 x 4"] == 15.0
    assert found["block, cuts", "averaged"][0] == "not measured"
    results = [*(run.result for run in runs), getfem().result]
    wrote = _written([run.planned for run in runs], GETFEM, tmp_path, results, datetime(2026, 1, 1))
    text = wrote.page.read_text(encoding="utf-8")
    assert (wrote.failed, wrote.complete) == (2, False)
    assert text.count('<td class="text why soft" colspan="10">load step 12 &lt;does&gt; not converge</td>') == 2
    rows = [row for rows in json.loads(wrote.page.with_suffix(".json").read_text(encoding="utf-8"))["scenes"] for row in rows]
    assert [(row["name"], row["way"]) for row in rows] == [(run.name, run.method) for run in runs]
    assert {row["words"] for row in rows} == {"", "load step 12 <does> not converge"}


def test_the_page_has_figures_and_forces_of_both_programs(tmp_path: Path) -> None:
    runs = [*made_up(BLOCK), *made_up(TWIST), *made_up(IRON)]
    results = [*(run.result for run in runs), getfem().result]
    wrote = _written([run.planned for run in runs], GETFEM, tmp_path, results, datetime(2026, 1, 1))
    text = wrote.page.read_text(encoding="utf-8")
    assert text.count("<svg") == 3 * 2 + 2
    data = json.loads(wrote.page.with_suffix(".json").read_text(encoding="utf-8"))
    assert [row["way"] for row in data["slid"]] == [*(run.method for run in runs if run.planned.section is BLOCK), "GetFEM"]
    assert (wrote.failed, wrote.complete) == (0, True)


def test_refined_masters_stand_beside_smooth_ones_of_the_same_elements() -> None:
    pairs = refinement(made_up(IRON))
    assert [(kinks.name, smooth.name) for kinks, smooth in pairs] == [
        ("iron L1 5 x 2", "iron N2 5 x 2"),
        ("iron L1 8 x 4", "iron N2 8 x 4"),
    ]
    assert {(kinks.method, smooth.method) for kinks, smooth in pairs} == {("averaged", "smooth, averaged")}
    assert refinement(made_up(TWIST)) == []


def test_a_block_that_stopped_on_its_way_has_the_force_that_it_came_to() -> None:
    found = slide(GETFEM, np.arange(18.0).reshape(6, 3), np.zeros((6, 2)))
    assert found["N(5)"] == -14.0
    assert np.isnan([found[name] for name in ("N(15)", "T(15)", "pushed", "friction", "spurious")]).all()


def test_curves_are_told_by_their_mean_roughness_and_share_of_spurious_work() -> None:
    run = made_up(BLOCK, **{"L1-averaged": {"force": np.tile([4.0, 0, 0], (15, 1)) + np.outer((-1.0) ** np.arange(15), [1, 0, 0])}})[3]
    assert (run.mean, run.roughness) == pytest.approx((4.0, 1.0))
    assert run.share == pytest.approx(0.1)
    none = made_up(BLOCK, **{"L1-averaged": {"friction_work": np.zeros(15)}})[3]
    assert np.isnan(none.share)


def test_all_runs_are_planned() -> None:
    assert len(study().runs) == 3 * 6 + 7 + 1
    assert len(study(quick=True).runs) == 3 * 6 + 4 + 1
