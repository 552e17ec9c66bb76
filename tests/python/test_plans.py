"""What is known of bodies before any array is made, nets that are turned, and tolerances: none of them knows a unit of length."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from isomortar.errors import InputError
from isomortar.geometry.net import Net
from isomortar.geometry.patch import Direction, Family
from isomortar.geometry.primitives import ring
from isomortar.model.entities import Body, Material
from isomortar.model.numbering import check_closed
from isomortar.scene import Scene
from isomortar.scene.build import _MeshPlan, coarse_patch
from isomortar.solve.simulation import Simulation
from test_scene_contacts import PRESS


@pytest.mark.parametrize("family", ["N", "L"])
@pytest.mark.parametrize("orders", [(2, 2, 1), (4, 3, 2), (2, 3, 4)])
def test_control_points_are_counted_before_they_are_made(family: Family, orders: tuple[int, int, int]) -> None:
    mesh = f'bodies.block.mesh={{ family = "{family}", order = {list(orders)}, elements = [3, 4, 2] }}'
    scene = Scene.from_toml(PRESS, overrides=[mesh])
    table = scene.tables.bodies["block"]
    plan = _MeshPlan.of(table, coarse_patch("block", table, Path()))
    assert plan.control_points == len(scene.problem().body("block").patch.weights)


@pytest.mark.parametrize("axis", [0, 1])
def test_a_net_that_is_reversed_along_one_coordinate_is_as_it_was_along_the_other(axis: int) -> None:
    uneven = (Direction("N", 2, np.array([0, 0, 0, 0.2, 1, 1, 1])), Direction("N", 1, np.array([0, 0, 0.7, 1, 1])))
    numbers = np.arange(12, dtype=np.int32).reshape(3, 4)
    points = np.random.default_rng(0).standard_normal((3, 4, 3))
    net = Net("uv", uneven, numbers, points, 1.0 + numbers / 12)
    back = net.reversed(axis)
    assert np.array_equal(back.directions[1 - axis].knots, uneven[1 - axis].knots)
    assert np.allclose(back.directions[axis].knots, 1.0 - uneven[axis].knots[::-1])
    for whole, turned in ((numbers, back.numbers), (points, back.points), (net.weights, back.weights)):
        assert np.array_equal(turned, whole[:, ::-1] if axis == 0 else whole[::-1])
    again = back.reversed(axis)
    assert all(np.allclose(one.knots, other.knots) for one, other in zip(again.directions, uneven, strict=True))


@pytest.mark.parametrize("unit", [1e-6, 1.0, 1e6])
def test_a_ring_closes_or_not_whatever_the_unit_of_length(unit: float) -> None:
    patch = ring((0.0, 0.0, 0.0), unit, 2.0 * unit, unit)
    ends = patch.face_points("u1")

    def moved(share: float) -> Body:
        points = patch.control_points.copy()
        points[ends, 1] += share * unit
        return Body("ring", replace(patch, control_points=points), Material(), (3, 2, 2), closed="u")

    check_closed(moved(0.0))
    check_closed(moved(1e-13))
    with pytest.raises(InputError, match="differ"):
        check_closed(moved(1e-6))


@pytest.mark.parametrize(
    ("setting", "value"), [("newton_tolerance", -1.0), ("max_cuts", -1), ("method", "guess"), ("newton_tolerance", np.nan)]
)
def test_settings_made_in_python_are_checked_as_those_of_a_file(setting: str, value: object) -> None:
    problem = Scene.from_toml(PRESS).problem()
    wrong = replace(problem, settings=replace(problem.settings, **{setting: value}))  # type: ignore[arg-type]
    with pytest.raises(InputError, match=rf"solver\.{setting}: "):
        Simulation(wrong)
