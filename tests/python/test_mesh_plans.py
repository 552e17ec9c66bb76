"""Control points are counted before they are made."""

from __future__ import annotations

from pathlib import Path

import pytest
from told.wrong.contacts import PRESS

from isomortar.geometry.patch import Family
from isomortar.scene import Scene
from isomortar.scene.build import _MeshPlan, coarse_patch


@pytest.mark.parametrize("family", ["N", "L"])
@pytest.mark.parametrize("orders", [(2, 2, 1), (4, 3, 2), (2, 3, 4)])
def test_control_points_are_counted_before_they_are_made(family: Family, orders: tuple[int, int, int]) -> None:
    mesh = f'bodies.block.mesh={{ family = "{family}", order = {list(orders)}, elements = [3, 4, 2] }}'
    scene = Scene.from_toml(PRESS, overrides=[mesh])
    table = scene.tables.bodies["block"]
    plan = _MeshPlan.of(table, coarse_patch("block", table, Path()))
    assert plan.control_points == len(scene.problem().body("block").patch.weights)
