"""Patch tests of solid and contact, at a size for every run; `verification/patch_tests` has the whole grids."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "verification/patch_tests"
bulk = runpy.run_path(str(FOLDER / "bulk.py"))
contact = runpy.run_path(str(FOLDER / "contact.py"))


@pytest.mark.parametrize("kind", ["N1", "N2", "N3", "L1", "L2", "L3", "L4"])
def test_affine_motion_is_in_balance(kind: str) -> None:
    assert bulk["residual"](bulk["distorted"](kind), (16, 16, 16)) < 1e-12


def test_too_few_points_are_seen() -> None:
    assert bulk["residual"](bulk["distorted"]("N3"), (4, 4, 4)) > 1e-5


@pytest.mark.parametrize("tilt", [0.0, 30.0])
@pytest.mark.parametrize(("slave", "master"), [(1, 1), (2, 3), (3, 2)])
def test_uniform_pressure_between_nested_meshes(slave: int, master: int, tilt: float) -> None:
    found = contact["errors"](contact["problem"](slave, master, tilt, slave + master + 1, 3))
    assert found.field < 1e-11
    assert found.position < 1e-11


@pytest.mark.parametrize("tilt", [0.0, 30.0])
def test_error_between_other_meshes_is_the_quadratures(tilt: float) -> None:
    coarse, fine = (contact["errors"](contact["problem"](2, 2, tilt, points, 4)).field for points in (6, 12))
    assert coarse < 1e-3
    assert fine < 0.5 * coarse


def test_limit_is_none_where_points_see_all_knots_and_falls_with_points() -> None:
    assert contact["pressure_limit"](3, 2, 3, 4) < 1e-13
    limits = [contact["pressure_limit"](3, 2, 4, points) for points in (4, 8, 16)]
    assert 0.1 > limits[0] > 4 * limits[1] > 16 * limits[2] > 0.0


@pytest.mark.parametrize(("slave", "master"), [(1, 1), (2, 3), (4, 1)])
def test_pressure_misses_what_the_load_misses(slave: int, master: int) -> None:
    for points in (4, 6):
        limit = contact["pressure_limit"](slave, master, 4, points)
        found = contact["errors"](contact["problem"](slave, master, 0.0, points, 4)).field
        assert 0.03 * limit < found < limit
