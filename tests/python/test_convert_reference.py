"""The converter says everything that an explicit scene says, and splits phases into common stages."""

from __future__ import annotations

import json
import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from isomortar.errors import InputError
from isomortar.model.entities import Face, Problem, RigidPlane
from isomortar.scene import Scene

convert = runpy.run_path(str(Path(__file__).parents[2] / "verification/convert_reference.py"))["convert"]


def rational_block(z: float) -> dict[str, Any]:
    """Mixed families, a rational direction, odd knots."""
    points = [[x, y, z + h] for h in (0.0, 0.5) for y in (-1 / 3, 0.1, 0.7) for x in (0.0, 0.3, 1.1)]
    return {
        "kind": ["N", "L", "N"],
        "degrees": [2, 2, 1],
        "knots": [[0, 0, 0, 2, 2, 2], [-1, 1], [0, 0, 1, 1]],
        "n": [3, 3, 2],
        "control_points": points,
        "weights": [1.0, 2 / 3, 1.5] * 6,
    }


def scene() -> dict[str, Any]:
    slanted = [0, 0.6, 0.8]
    return {
        "name": "odd one",
        "bodies": [
            {"name": "block", "E": 7.5, "nu": 0.2, "patch": rational_block(0.0), "quad": [5, 3, 2]},
            {"name": "block", "E": 1e3, "nu": -0.1, "patch": rational_block(-0.5)},
        ],
        "contact": {
            "slave": {"body": 0, "face": "w0"},
            "plane": {"point": [0, 0, -2], "normal": slanted, "t1": [1, 0, 0]},
            "mu": 0.25,
            "quad": [7, 8],
        },
        "bcs": [
            {
                "body": 0,
                "face": "w1",
                "components": [0, 2],
                "centre": [1, 2, 3],
                "axis": [0, 1, 0],
                "phases": [{"steps": 3, "translate": [0, 0, -0.3]}, {"steps": 4, "rotate": 40, "translate": [0.8, 0, 0]}],
            },
            {"body": 1, "face": "w0", "phases": [{"steps": 5, "translate": [0, 0.5, 0]}]},
            {"body": 1, "face": "u0"},
        ],
        "solver": {"newton_tol": 1e-10, "aug_tol": 1e-7, "penalty_base": [50, 4], "max_newton": 12, "max_aug": 99},
    }


def converted(data: dict[str, Any], folder: Path, **options: str) -> Problem:
    source = folder / "odd.json"
    source.write_text(json.dumps(data))
    return Scene.load(convert(source, folder / "out", **options)).problem()


def moved(problem: Problem, support: int) -> list[tuple[list[float], float]]:
    """Translation and angle of a support after every load step."""
    path, offset, angle = [], np.zeros(3), 0.0
    for stage, motion in zip(problem.stages, problem.supports[support].motions, strict=True):
        for step in range(1, stage.steps + 1):
            path.append(((offset + np.array(motion.translate) * step / stage.steps).tolist(), angle + motion.rotate * step / stage.steps))
        offset, angle = offset + motion.translate, angle + motion.rotate
    return path


def without_conflict() -> dict[str, Any]:
    data = scene()
    del data["bcs"][2]
    return data


def test_bodies_keep_every_bit(tmp_path: Path) -> None:
    data, problem = without_conflict(), converted(without_conflict(), tmp_path)
    assert [b.name for b in problem.bodies] == ["block", "block-2"]
    for body, given in zip(problem.bodies, data["bodies"], strict=True):
        assert body.patch.control_points.tolist() == given["patch"]["control_points"]
        assert body.patch.weights.tolist() == given["patch"]["weights"]
        assert [d.knots.tolist() for d in body.patch.directions] == given["patch"]["knots"]
        assert [d.family for d in body.patch.directions] == given["patch"]["kind"]
        assert (body.material.young, body.material.poisson) == (given["E"], given["nu"])
    assert [b.quadrature for b in problem.bodies] == [(5, 3, 2), (4, 4, 2)]


def test_contact_supports_and_solver(tmp_path: Path) -> None:
    problem = converted(without_conflict(), tmp_path, slip_sum="paper", augmentation_norm="paper")
    (contact,) = problem.contacts
    assert (contact.slave, contact.friction, contact.quadrature, contact.reference_area) == (Face("block", "w0"), 0.25, (7, 8), 1.0)
    assert isinstance(contact.master, RigidPlane)
    assert contact.master.normal == pytest.approx((0, 0.6, 0.8), abs=1e-16)
    assert contact.master.tangent == (1, 0, 0)
    first, second = problem.supports
    assert (first.components, first.centre, first.axis) == ((0, 2), (1, 2, 3), (0, 1, 0))
    assert (second.place, second.components, second.centre, second.axis) == (Face("block-2", "w0"), (0, 1, 2), (0, 0, 0), (0, 0, 1))
    solver = problem.settings
    assert (solver.newton_tolerance, solver.augmentation_tolerance) == (1e-10, 1e-7)
    assert (solver.penalty_normal, solver.penalty_tangential, solver.penalty_growth) == (50, 4, 1)
    assert (solver.max_iterations, solver.max_augmentations) == (12, 99)
    assert (solver.slip_sum, solver.augmentation_norm) == ("paper", "paper")


def test_phases_of_different_lengths_become_common_stages(tmp_path: Path) -> None:
    problem = converted(without_conflict(), tmp_path)
    assert [stage.steps for stage in problem.stages] == [3, 2, 2]
    translations, angles = zip(*moved(problem, 0), strict=True)
    assert angles == pytest.approx([0, 0, 0, 10, 20, 30, 40], rel=1e-15)
    expected = [[0, 0, -0.1], [0, 0, -0.2], [0, 0, -0.3], [0.2, 0, -0.3], [0.4, 0, -0.3], [0.6, 0, -0.3], [0.8, 0, -0.3]]
    np.testing.assert_allclose(translations, expected, rtol=0, atol=1e-15)
    translations, angles = zip(*moved(problem, 1), strict=True)
    np.testing.assert_allclose(translations, [[0, 0.1 * min(t, 5), 0] for t in range(1, 8)], rtol=0, atol=1e-15)
    assert set(angles) == {0.0}


def test_nothing_moves_is_one_load_step(tmp_path: Path) -> None:
    data = without_conflict()
    for bc in data["bcs"]:
        bc.pop("phases", None)
    assert [s.steps for s in converted(data, tmp_path).stages] == [1]


def test_contradicting_supports_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="support 'block-2-w0' moves differently"):
        converted(scene(), tmp_path)


def test_nothing_is_dropped_silently(tmp_path: Path) -> None:
    data = without_conflict()
    data["contact"]["cohesion"] = 1.0
    with pytest.raises(InputError, match="contact has cohesion"):
        converted(data, tmp_path)
    data = without_conflict()
    data["solver"]["trust_radius"] = 1.0
    with pytest.warns(UserWarning, match="left out: trust_radius"):
        converted(data, tmp_path)


def test_cells_are_whole_as_there(tmp_path: Path) -> None:
    """The other program integrates over whole elements, at p + 3 points, whatever this one would do by itself."""

    def block(low: float, *inner: float) -> dict[str, Any]:
        knots, n = [[0.0] * 4 + [*inner] + [1.0] * 4] * 2 + [[0.0, 0.0, 1.0, 1.0]], 4 + len(inner)
        line = np.linspace(0.0, 1.0, n).tolist()
        points = [[x, y, low + h] for h in (0.0, 0.5) for y in line for x in line]
        patch = {"kind": ["N"] * 3, "degrees": [3, 3, 1], "knots": knots, "n": [n, n, 2]}
        return {"name": "block", "E": 1.0, "nu": 0.3, "patch": patch | {"control_points": points, "weights": [1.0] * (2 * n * n)}}

    explicit = without_conflict() | {"bodies": [block(0.5), block(0.0, 0.4)]}
    explicit["contact"] = {"slave": {"body": 0, "face": "w0"}, "master": {"body": 1, "face": "w1"}, "mu": 0.25}
    source = tmp_path / "cubic.json"
    source.write_text(json.dumps(explicit))
    (contact,) = Scene.load(convert(source, tmp_path)).problem().contacts
    assert (contact.subcells, contact.quadrature) == (0, (6, 6))
