"""The cases that compare with another program compute its scenes, find all its numbers, and fail where one is off."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bundled_scenes import mesh_overrides
from import_references import not_the_same, numbers, steps_of, uncertainties
from other_code.agreement import GROUPS
from reference_scenes import RUNS, find, load, measure

from isomortar.harness.compare import judge
from isomortar.harness.measurement import Measurement, stored
from isomortar.harness.references import finder

ROOT = Path(__file__).parents[2]
PATCHES = json.loads((ROOT / "reference_data/scene_patches/patches.json").read_text())
KNOWN = {(fact["scene"], fact["body"], *fact["overrides"]) for fact in PATCHES}
LOOKUP = finder(ROOT / "reference_data")
CELLS = [cell for made in GROUPS.values() for cell in made.cells]
RECORD = {
    "bcs": [{"force": [0, 0, 2.0], "moment": [0, 0, 0]}],
    "p_control": [0, 3.0],
    "p_field_qp": [-0.1, 2.5],
    "tau_norm_max": 0.2,
    "n_active": 4,
    "n_slip": 1,
    "n_excluded_points": 0,
}


@pytest.mark.parametrize(("group", "name"), [(group, name) for group, runs in RUNS.items() for name in runs])
def test_bodies_are_those_that_were_compared_with_the_other_programs(group: str, name: str) -> None:
    run = find(group, name)
    for body in load(run).problem().bodies:
        assert (run.scene, body.name, *mesh_overrides(body)) in KNOWN


@pytest.mark.parametrize("cell", CELLS, ids=lambda cell: cell.name)
def test_every_number_has_its_dataset(cell) -> None:
    for number in cell.case.bounds_of(cell.settings):
        expected = LOOKUP(f"other_code_{cell.case.function.__name__}", cell, number)
        assert expected is not None
        assert expected.kind == "other code"


def test_one_number_that_is_off_is_seen() -> None:
    (cell,) = [cell for cell in GROUPS["local"].cells if cell.settings["scene"] == "press_L2_6"]
    found = measure("local", "press_L2_6")
    judged = {check.name: check.state for check in judge(cell, Measurement("measured", {k: stored(v) for k, v in found.items()}), LOOKUP)}
    assert set(judged.values()) == {"passed"}
    for number, value in found.items():
        changed = value.copy()
        expected = LOOKUP("other_code_local", cell, number)
        changed.flat[-1] += 1.0 if number == "points" else 2.1 * expected.uncertainty + 1.1e-10 * np.abs(value).max()
        off = Measurement("measured", {k: stored(changed if k == number else v) for k, v in found.items()})
        assert [check.name for check in judge(cell, off, LOOKUP) if check.state != "passed"] == [number]


def test_the_beginning_of_a_run_takes_its_load_steps_only() -> None:
    run = find("local", "twist_N2_first14")
    assert (run.steps, run.mesh, find("tight", "twist_N2_first17").steps) == (14, None, 17)
    kept = numbers({"records": [RECORD] * 15}, run, end=False)
    assert (kept["force"].shape, kept["pressure"][0].tolist(), kept["points"][0].tolist()) == ((14, 1, 3), [3.0, 2.5], [4, 1, 0])
    with pytest.raises(SystemExit, match="13 load steps, 14"):
        numbers({"records": [RECORD] * 13}, run, end=False)


def test_a_moment_that_is_nothing_has_the_uncertainty_of_forces() -> None:
    worth = uncertainties("local", numbers({"records": [RECORD] * 5}, find("local", "press_N2_6"), end=False), size=3.0)
    assert (worth["force"], worth["moment"], worth["points"]) == (pytest.approx(2e-9), pytest.approx(6e-9), 0.0)


def test_motions_are_shared_among_load_steps() -> None:
    motions = steps_of(load(find("local", "tire_N2_32_q")).problem())
    assert motions.shape == (100, 1, 4)
    assert motions.sum(axis=0)[0] == pytest.approx([2.214822820780804, 0, -0.1, 270])


def explicit(run, folder: Path) -> tuple[Path, dict[str, Any]]:
    """The explicit scene of a run on a rigid plane, with one support and one stage, as another program would give it."""
    problem = load(run).problem()
    (body,), (contact,), (support,), (stage,) = problem.bodies, problem.contacts, problem.supports, problem.stages
    patch, plane = body.patch, contact.master
    data = {
        "bodies": [
            {
                "name": body.name,
                "E": body.material.young,
                "nu": body.material.poisson,
                "patch": {
                    "kind": [d.family for d in patch.directions],
                    "degrees": [d.order for d in patch.directions],
                    "knots": [d.knots.tolist() for d in patch.directions],
                    "control_points": patch.control_points.tolist(),
                    "weights": patch.weights.tolist(),
                },
            }
        ],
        "contact": {
            "slave": {"body": 0, "face": contact.slave.face},
            "plane": {"point": list(plane.point), "normal": list(plane.normal), "t1": list(plane.tangent)},
            "mu": contact.friction,
        },
        "bcs": [
            {"body": 0, "face": support.place.face, "phases": [{"steps": stage.steps, "translate": list(support.motions[0].translate)}]}
        ],
    }
    return folder / "press.json", data


CHANGES: dict[str, Callable[[dict[str, Any]], object]] = {
    "control points": lambda d: d["bodies"][0]["patch"]["control_points"][7].__setitem__(2, 0.5),
    "weights": lambda d: d["bodies"][0]["patch"]["weights"].__setitem__(3, 1.0 + 1e-12),
    "material": lambda d: d["bodies"][0].update(nu=0.31),
    "contacts": lambda d: d["contact"].update(mu=0.2),
    "motions": lambda d: d["bcs"][0]["phases"][0].update(translate=[0, 0, -0.3 * (1 + 1e-12)]),
}


@pytest.mark.parametrize("change", CHANGES)
def test_another_scene_is_not_taken(tmp_path: Path, change: str) -> None:
    run = find("local", "press_N2_6")
    source, data = explicit(run, tmp_path)
    source.write_text(json.dumps(data))
    assert not_the_same(run, source) == []
    CHANGES[change](data)
    source.write_text(json.dumps(data))
    (found,) = not_the_same(run, source)
    assert found.startswith(change)
