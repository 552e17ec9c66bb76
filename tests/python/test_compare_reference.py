"""The comparison with another program's results fails whenever something is off or missing."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from compare_reference import Comparison, compare, main
from convert_reference import convert

from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

BLOCK = {
    "kind": ["L", "L", "L"],
    "degrees": [1, 1, 1],
    "knots": [[0, 1], [0, 1], [0, 1]],
    "n": [2, 2, 2],
    "control_points": [[x, y, z] for z in (0.0, 0.9) for y in (0.0, 1.0) for x in (0.0, 1.0)],
    "weights": [1.0] * 8,
}
SCENE = {
    "name": "block",
    "bodies": [{"name": "block", "E": 10.0, "nu": 0.3, "patch": BLOCK}],
    "contact": {"slave": {"body": 0, "face": "w0"}, "plane": {"point": [0, 0, 0], "normal": [0, 0, 1], "t1": [1, 0, 0]}, "mu": 0.3},
    "bcs": [{"body": 0, "face": "w1", "phases": [{"steps": 2, "translate": [0.01, 0, -0.1]}]}],
}


def result_of(source: Path, folder: Path) -> dict[str, Any]:
    """What another program would write that computes the same."""
    results = list(Simulation(Scene.load(convert(source, folder)).problem()).run())
    last = results[-1].state
    return {
        "completed": True,
        "records": [
            {
                "t": result.time,
                "bcs": [{"force": r.force.tolist(), "moment": r.moment.tolist()} for r in result.reactions],
                "n_active": result.contacts[0].active,
                "n_slip": result.contacts[0].slip,
                "n_excluded_points": result.contacts[0].excluded,
                "p_control": [float(state.pressure.min()), float(state.pressure.max())],
                "p_field_qp": result.contacts[0].pressure_field.tolist(),
                "tau_norm_max": float(result.contacts[0].traction_norm.max()),
            }
            for result in results
            for state in result.state.contacts
        ],
        "final": {
            "x": last.positions.tolist(),
            "p_control": last.contacts[0].pressure.tolist(),
            "tau_control": last.contacts[0].traction.tolist(),
        },
    }


@pytest.fixture(scope="module")
def own(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    folder = tmp_path_factory.mktemp("block")
    source = folder / "block.json"
    source.write_text(json.dumps(SCENE))
    return source, result_of(source, folder)


def compared(own: tuple[Path, dict[str, Any]], folder: Path, change: Callable[[dict[str, Any]], object]) -> Comparison:
    source, result = own
    changed = json.loads(json.dumps(result))
    change(changed)
    source.with_suffix(".result.json").write_text(json.dumps(changed))
    return compare(source, [], folder)


def test_own_result_holds(own: tuple[Path, dict[str, Any]], tmp_path: Path) -> None:
    comparison = compared(own, tmp_path, lambda _: None)
    assert comparison.steps == 2
    assert comparison.holds(1e-13), comparison


CHANGES: dict[str, Callable[[dict[str, Any]], object]] = {
    "force": lambda r: r["records"][0]["bcs"][0]["force"].__setitem__(2, r["records"][0]["bcs"][0]["force"][2] * (1 + 2e-6)),
    "moment": lambda r: r["records"][1]["bcs"][0]["moment"].__setitem__(0, float("nan")),
    "active": lambda r: r["records"][1].update(n_active=3),
    "slip": lambda r: r["records"][1].update(n_slip=r["records"][1]["n_slip"] + 1),
    "pressure": lambda r: r["final"]["p_control"].__setitem__(0, 2.0),
    "traction": lambda r: r["final"]["tau_control"][1].__setitem__(0, float("inf")),
    "position": lambda r: r["final"]["x"][2].__setitem__(1, r["final"]["x"][2][1] + 1e-5),
    "a load step too few": lambda r: r["records"].pop(),
    "other control points": lambda r: r["final"]["x"].pop(),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES.keys())
def test_anything_off_fails(own: tuple[Path, dict[str, Any]], tmp_path: Path, change: Callable[[dict[str, Any]], object]) -> None:
    assert not compared(own, tmp_path, change).holds(1e-6)


def test_missing_key_is_an_error(own: tuple[Path, dict[str, Any]], tmp_path: Path) -> None:
    with pytest.raises(KeyError, match="tau_norm_max"):
        compared(own, tmp_path, lambda r: r["records"][1].pop("tau_norm_max"))


def test_nothing_compared_does_not_hold() -> None:
    assert not Comparison().holds(1.0)


def test_shapes_that_differ_are_faults() -> None:
    comparison = Comparison(steps=1)
    comparison.add("force", 1, np.zeros(2), np.zeros(3), 1.0)
    assert not comparison.holds(1.0)


def test_results_without_their_scenes_are_no_comparison(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A pattern that matches results alone must not end as if all held."""
    monkeypatch.setattr(sys, "argv", ["compare_reference.py", str(tmp_path / "block.result.json")])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2
