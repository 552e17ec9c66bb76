"""The order-elevation report: discretisations of scenes, the study's plan, its analysis, and a tiny scene from end to end."""

import json
import math
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from orders.analysis import analyse
from orders.finding import findings, recommended, summary
from orders.plan import Plan
from typer.testing import CliRunner

from isomortar.accuracy.discretisations import Discretisation, discretisation, mesh_overrides, overrides, sweep_of
from isomortar.cli.commands import app
from isomortar.errors import InputError
from isomortar.geometry.primitives import bowl
from isomortar.geometry.refinement import mesh
from isomortar.harness.measurement import Measurement
from isomortar.scene import Scene, bundled_scenes
from isomortar.scene.geometry_file import patch_table
from isomortar.scene.toml_text import dump

CASES = Path(__file__).parents[2] / "verification"
TINY = """
format = 1
[bodies.block]
geometry = { kind = "bowl", half_width = 0.5, bottom = 0.0, rise = 0.1, top = 0.5 }
mesh = { order = [2, 2, 1], elements = [4, 4, 1] }
[contacts.floor]
slave = "block.w0"
plane = {}
friction = 0.0
[supports.top]
face = "block.w1"
[[stages]]
name = "press"
steps = 3
motions.top.translate = [0, 0, -0.15]
"""


def control_points(scene: str, kind: str, factor: float = 1.0) -> int:
    problem = Scene.load(scene, mesh_overrides(Scene.load(scene), kind, factor)).problem()
    return sum(len(body.patch.weights) for body in problem.bodies)


def test_the_discretisations_of_the_paper():
    assert control_points("iron", "N5") == 770
    assert control_points("iron", "N2", 1.5) == 840
    assert control_points("iron", "N2", 2.0) == 1015
    press = Scene.load("press")
    assert mesh_overrides(press, "L3") == [
        'bodies.block.mesh.family=["L","L","L"]', "bodies.block.mesh.order=[3, 3, 1]", "bodies.block.mesh.elements=[4, 4, 6]"
    ]  # fmt: skip
    assert mesh_overrides(press, "N1")[:2] == ['bodies.block.mesh.family=["L","L","N"]', "bodies.block.mesh.order=[1, 1, 2]"]
    assert mesh_overrides(Scene.load("tire"), "L3")[2] == "bodies.tire.mesh.elements=[12, 4, 4]"  # 32 / 3 is none of four arcs


@pytest.mark.parametrize("name", bundled_scenes())
def test_every_bundled_scene_has_every_kind(name):
    for kind in ("N1", "N2", "N5", "L1", "L4"):
        assert control_points(name, kind) > 0


def test_a_scene_of_ones_own_is_varied_on_its_slave_or_the_body_named():
    scene = Scene.load("iron")
    assert sweep_of(Scene.from_toml(TINY)).directions == "uv"
    assert (sweep_of(scene).body, sweep_of(scene).directions) == ("master", "u")
    assert (sweep_of(scene, "slave").body, sweep_of(scene, "slave").directions) == ("slave", "uv")
    with pytest.raises(InputError, match="bodies in contact here: master, slave"):
        sweep_of(scene, "nobody")


def test_a_geometry_of_higher_order_leaves_lower_ones_out():
    cubic = mesh(bowl((0.0, 0.0), 0.5, 0.0, 0.1, 0.5), ("N", "N", "N"), (3, 3, 1), (1, 1, 1))
    data = tomllib.loads(TINY)
    del data["bodies"]["block"]["geometry"]
    data["bodies"]["block"]["patch"] = patch_table(cubic)
    data["bodies"]["block"]["mesh"] = {"order": [3, 3, 1], "elements": [4, 4, 1]}
    plan = Plan.of(Scene.from_toml(dump(data)))
    assert plan.kinds == ("N1", "N3", "N4", "N5", "L1", "L2", "L3", "L4")
    assert plan.sweep.reference == "N3"
    with pytest.raises(InputError, match="is 2 in direction u"):
        Plan.of(plan.scene, ["N2"])


def test_a_lagrange_scene_counts_its_nodes():
    scene = Scene.from_toml(TINY, overrides=["bodies.block.mesh={family=['L','L','N'],order=[2,2,1],elements=[2,2,1]}"])
    sweep = sweep_of(scene)
    assert discretisation(scene, sweep, "N3") == Discretisation("N3", (4, 4, 1))
    assert overrides(scene, sweep, Discretisation("N3", (4, 4, 1)))[0] == 'bodies.block.mesh.family=["N","N","N"]'


def test_every_kind_gets_four_meshes_that_an_order_can_be_told_from():
    whole = [(name, False) for name in ("press", "iron", "tire")]
    for name, quick in [*whole, *((name, True) for name in bundled_scenes())]:
        plan = Plan.of(Scene.load(name), quick=quick)
        sizes = {kind: np.array([plan.size(each) for each in plan.meshes(kind)]) for kind in plan.kinds}
        for of_kind in sizes.values():
            assert len(of_kind) >= 4
            assert (of_kind[:-1] >= 1.2 * of_kind[1:]).all()
        coarse, medium, fine = map(plan.size, plan.reference)
        assert coarse == pytest.approx(2 * medium)
        assert medium == pytest.approx(2 * fine)
        assert all((fine < 0.501 * of_kind).all() for kind, of_kind in sizes.items() if kind[0] == "N")


@pytest.mark.parametrize("kinds", [["N0"], ["N11"], ["L5"], ["Q2"], ["N"]])
def test_unknown_kinds_are_refused(kinds):
    with pytest.raises(InputError, match="N1 to N10 and L1 to L4"):
        Plan.of(Scene.from_toml(TINY), kinds)


def test_a_scene_at_rest_is_refused():
    with pytest.raises(InputError, match="no support of the scene moves"):
        Plan.of(Scene.from_toml(TINY, overrides=["stages.press.motions={}"]), ["N2"])


def synthetic(plan: Plan, error: dict, reference_order: float = 2.0) -> dict:
    """Runs whose force is off by `error` (constant, order) times size**order from 1, nothing else varies."""
    areas, volumes = plan.grids()
    found = {}
    for chosen in plan.runs:
        constant, order = error.get(chosen.kind, (1.0, reference_order))
        if chosen in plan.reference:
            constant, order = 1.0, reference_order
        force = 1.0 + constant * plan.size(chosen) ** order
        numbers = {
            "time": [1.0, 2.0, 3.0],
            "stage": [0, 0, 0],
            "force": [[[0.0, 0.0, force], [0.0, 0.0, force], [0.0, 0.0, force * 1.5]]],
            "moment": [[[0.0, 0.0, 1e-12]] * 3],
            "pressure": np.full(len(areas.weights), force).tolist(),
            "displacement": np.full((len(volumes.weights), 3), force).tolist(),
            "control_points": 10 * math.prod(chosen.elements),
            "tangents": 12,
            "cuts": 0,
            "cpu_seconds": float(math.prod(chosen.elements)),
        }
        found[chosen] = Measurement("measured", numbers)
    return found


@pytest.fixture(scope="module")
def plan():
    big = Scene.from_toml(TINY, overrides=["bodies.block.mesh.elements=[12,12,1]"])
    return Plan.of(big, ["N1", "N2", "N3"])


def test_errors_verdicts_and_floor(plan):
    found = analyse(plan, synthetic(plan, {"N1": (400.0, 2.0), "N3": (0.02, 2.0)}, reference_order=3.0))
    assert found.measures == ("force", "pressure", "displacement")  # the moment is round-off
    h = 1 / 24
    truth = 1 + h**3
    fine = found.points[plan.meshes("N1")[-1]]
    assert fine.errors["force"] == pytest.approx((400 / 144 - h**3) / truth, rel=1e-12)
    assert found.uncertainty["force"] == pytest.approx(7 * h**3 / truth, rel=1e-12)  # what the last refinement changed
    assert found.verdicts["N1"]["force"].judgement == "confirmed"
    assert fine.floor == ()
    assert "force" in found.points[plan.meshes("N3")[-1]].floor
    assert found.verdicts["N3"]["force"].judgement != "confirmed"
    assert fine.roughness["force"] == pytest.approx(((1 + 400 / 144) / truth) ** 2, rel=1e-12)


def test_refinement_against_elevation(plan):
    found = analyse(plan, synthetic(plan, {"N2": (100.0, 1.0), "N3": (1.0, 1.0)}, reference_order=3.0))
    by_way = {(step.way, step.end.label): step for step in found.steps}
    assert sorted(by_way) == [("h", "N2 12x12x1"), ("h", "N2 8x8x1"), ("k", "N3 6x6x1")]
    # the reference's own meshes, 6 and 12, are what the reference says; 8 is 100 / 8 off
    assert by_way["h", "N2 8x8x1"].unknowns == pytest.approx(64 / 36)
    assert by_way["k", "N3 6x6x1"].cpu == 1.0
    # forces 1 + h**3 and 1 + h at h = 1/6, of which the roughness is the square
    assert by_way["k", "N3 6x6x1"].roughness["force"] == pytest.approx(((1 + 1 / 6) / (1 + 1 / 216)) ** 2, rel=1e-12)
    step, truth = by_way["h", "N2 8x8x1"], 1 / 24**3
    assert step.gains["pressure"] == pytest.approx((1 / 6**3 - truth) / (100 / 8 - truth), rel=1e-12)


def test_the_finding_is_the_cheapest_run_that_is_within_an_error_and_stays_there(plan):
    """Of N3 errors are a small part of those of N1; N2, of which the reference is, is known to be off by what it changes."""
    found = analyse(plan, synthetic(plan, {"N1": (400.0, 2.0), "N3": (1.0, 2.0)}, reference_order=3.0))
    force = findings(found)[0]
    assert (force.measure, force.target) == ("force", 0.01)
    by_kind = {point.discretisation.kind: point for point in force.within}
    for kind, point in by_kind.items():
        assert all(finer.errors["force"] <= 0.01 for finer in found.sequence(kind) if finer.unknowns >= point.unknowns)
    assert "N1" in force.beyond
    assert recommended(found, [force]) == overrides(plan.scene, plan.sweep, force.within[0].discretisation)
    assert force.sentence.startswith("The force within 1 %: ")
    assert "N1 is not within it" in force.sentence


def test_a_mesh_that_is_right_by_luck_is_not_recommended(plan):
    runs = synthetic(plan, {"N1": (400.0, 2.0), "N3": (400.0, 2.0)}, reference_order=3.0)
    lucky = plan.meshes("N3")[0]
    runs[lucky] = runs[plan.reference[2]]
    assert all(point.discretisation != lucky for finding in findings(analyse(plan, runs)) for point in finding.within)


def test_raising_the_order_is_said_to_pay_or_not(plan):
    runs = synthetic(plan, {"N1": (400.0, 2.0), "N2": (4.0, 2.0), "N3": (0.04, 2.0)}, reference_order=3.0)
    (force, *_) = findings(analyse(plan, runs))
    assert force.elevation.startswith("Raising the order pays: N3 takes ")
    slow = {chosen: replace(m, numbers=m.numbers | {"cpu_seconds": 1e4}) if chosen.kind == "N3" else m for chosen, m in runs.items()}
    assert findings(analyse(plan, slow))[0].elevation.startswith("Raising the order does not pay: N3 takes ")


def test_where_the_reference_tells_nothing_nothing_is_recommended(plan):
    runs = synthetic(plan, {})
    runs[plan.reference[0]] = replace(runs[plan.reference[0]], ending="crashed")
    assert summary(analyse(plan, runs)) == ["No run is known to be within 50 % of anything: nothing is recommended."]


def test_a_failed_run_leaves_the_others(plan):
    runs = synthetic(plan, {})
    lost = plan.meshes("N1")[0]
    runs[lost] = Measurement("not converged", message="Traceback\n  ...\nisomortar.errors.ConvergenceError: load step 2 does not converge")
    found = analyse(plan, runs)
    assert [p.failure for p in found.failed] == ["load step 2 does not converge"]
    assert found.verdicts["N1"]["force"].why == "3 meshes; an order needs at least 4"
    assert found.points[plan.meshes("N1")[1]].errors


def test_a_run_with_numbers_that_are_not_finite_has_failed(plan):
    runs = synthetic(plan, {})
    lost = plan.meshes("N1")[0]
    runs[lost].numbers["force"][0][1][2] = math.nan
    assert [p.failure for p in analyse(plan, runs).failed] == ["not finite: force"]


def test_without_its_coarser_meshes_the_reference_is_worth_nothing(plan):
    runs = synthetic(plan, {"N1": (400.0, 2.0)})
    runs[plan.reference[0]] = replace(runs[plan.reference[0]], ending="crashed")
    found = analyse(plan, runs)
    assert found.uncertainty["force"] == math.inf
    assert found.verdicts["N1"]["force"].judgement == "at the floor"
    assert all("force" in p.floor for p in found.points.values() if p.errors)


def test_changes_of_round_off_tell_that_the_reference_is_exact(plan):
    """That they do not fall leaves nothing unknown."""
    runs = synthetic(plan, {})
    for chosen, force in zip(plan.reference, (1.0, 1.0 + 1e-12, 1.0 - 1e-12), strict=True):
        runs[chosen] = replace(runs[chosen], numbers=runs[chosen].numbers | {"force": [[[0.0, 0.0, force]] * 3]})
    assert analyse(plan, runs).uncertainty["force"] == pytest.approx(3e-12, rel=1e-3)


def test_without_a_reference_nothing_is_compared(plan):
    runs = synthetic(plan, {})
    runs[plan.reference[2]] = Measurement("timed out", message="no result after 1 s")
    found = analyse(plan, runs)
    assert found.failed
    assert not any(p.errors for p in found.points.values())


@pytest.fixture
def run_orders(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def call(*options: str, text: str = TINY):
        (tmp_path / "tiny.toml").write_text(text)
        return CliRunner().invoke(app, ["report", "orders", "tiny.toml", "--quick", "--out", "out", "--cases", str(CASES), *options])

    return call


def test_a_tiny_scene_from_end_to_end(run_orders, tmp_path):
    result = run_orders("--orders", "N2,L1")
    assert result.exit_code == 0, result.output
    data = json.loads((tmp_path / "out/report.json").read_text())
    assert data["reference"]["runs"] == ["N2 2x2x1", "N2 4x4x1", "N2 8x8x1"]
    runs = {(r["kind"], *r["elements"]): r for r in data["runs"]}
    assert runs["N2", 8, 8, 1]["errors"]["force"] == 0.0
    assert 0 < runs["N2", 4, 4, 1]["errors"]["force"] < runs["L1", 2, 2, 1]["errors"]["force"] < 1
    assert runs["L1", 2, 2, 1]["control_points"] == 18
    assert runs["L1", 2, 2, 1]["tangents"] >= 3
    page = (tmp_path / "out/report.html").read_text()
    assert page.count("<svg") >= 5
    assert "verdict on the order of accuracy of L1" in page
    assert all(sentence.split("'")[0] in result.output.replace("\n", " ") for sentence in data["finding"])
    assert "<b>Quick:</b>" in page
    assert Scene.load(tmp_path / "out/scenes/tiny-L1-2x2x1.toml").problem().bodies[0].patch.shape == (3, 3, 2)
    again = run_orders("--orders", "N2,L1")
    assert again.exit_code == 0
    assert [r["cpu_seconds"] for r in json.loads((tmp_path / "out/report.json").read_text())["runs"]] == [
        r["cpu_seconds"] for r in data["runs"]
    ]  # nothing was run again


def test_failed_runs_are_shown_and_tell_the_exit_code(run_orders, tmp_path):
    result = run_orders("--orders", "N2", text=TINY.replace("-0.15", "-0.6") + "[solver]\nmax_cuts = 0\n")
    assert result.exit_code == 1
    data = json.loads((tmp_path / "out/report.json").read_text())
    assert all("load step" in run["failure"] for run in data["runs"] if run["failure"])
    assert any(run["failure"] for run in data["runs"])
    assert "failed" in (tmp_path / "out/report.html").read_text()


def test_bad_input_runs_nothing(run_orders, tmp_path):
    result = run_orders("--orders", "N2,X3")
    assert isinstance(result.exception, InputError)
    assert not (tmp_path / "out").exists()
