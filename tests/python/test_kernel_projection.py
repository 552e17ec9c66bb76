"""The closest-point projection onto a cylinder: the same point from any start, and the exact one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from isomortar import _bindings
from isomortar._bindings import FaceArrays, Projections, SlaveArrays
from isomortar._codes import WORK
from isomortar.geometry.primitives import box, ring
from isomortar.geometry.refinement import mesh
from isomortar.model.numbering import patch_arrays

RADIUS = 0.5


def cylinder(order: int, elements: int) -> tuple[FaceArrays, np.ndarray]:
    """The outer face of a ring about the y-axis (coordinates: across, round), and the control points of the ring."""
    patch = mesh(ring((0.0, 0.0, 0.0), 0.3, RADIUS, 2.0), ("N", "N", "N"), (order, 1, 1), (elements, 1, 2))
    arrays = patch_arrays(patch, np.arange(len(patch.weights), dtype=np.int32))
    return FaceArrays(arrays, 2, 1), patch.control_points


def project(order: int, elements: int, points: np.ndarray, starts: np.ndarray | None) -> tuple[Projections, np.ndarray]:
    """Projections of points from starts (None: the coarse search), and their gaps."""
    master, control_points = cylinder(order, elements)
    positions = np.ascontiguousarray(np.concatenate([control_points, points]))
    slave = SlaveArrays.of_points(np.arange(len(points), dtype=np.int32) + np.int32(len(control_points)))
    had = np.full(len(points), int(starts is not None), dtype=np.int32)
    projections = _bindings.project_points(slave, master, positions, np.zeros((len(points), 2)) if starts is None else starts, had)
    control = _bindings.control_quantities(slave, master, positions, replace(projections, slip=np.zeros((len(points), 2))))
    return projections, control.gap


def scattered(count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Points near and away from the cylinder, in the ring's body and outside, and their distances from its axis."""
    random = np.random.default_rng(seed)
    angle, distance = random.uniform(0.0, 2.0 * np.pi, count), random.uniform(0.32, 1.0, count)
    points = np.column_stack([distance * np.sin(angle), random.uniform(-0.9, 0.9, count), distance * np.cos(angle)])
    return points, distance


@pytest.mark.parametrize(("order", "elements"), [(2, 4), (2, 16), (3, 12), (4, 8)])
def test_gap_is_the_distance_from_the_cylinder(order: int, elements: int) -> None:
    points, distance = scattered(200, seed=1)
    projections, gap = project(order, elements, points, None)
    assert np.all(projections.found == 1)
    np.testing.assert_allclose(gap, RADIUS - distance, rtol=0, atol=1e-14)


@pytest.mark.parametrize(("order", "elements"), [(2, 16), (3, 12)])
def test_the_same_point_from_any_start_on_the_side_of_the_point(order: int, elements: int) -> None:
    """From anywhere within a quarter turn and across the whole width."""
    points, distance = scattered(40, seed=2)
    exact, _ = project(order, elements, points, None)
    random = np.random.default_rng(3)
    for _ in range(20):
        starts = exact.xi + np.column_stack([np.zeros(40), random.uniform(-1.0, 1.0, 40)])  # a unit of u is a quarter turn
        starts[:, 1] = np.clip(starts[:, 1], 0.0, 4.0)
        starts[:, 0] = random.uniform(0.0, 1.0, 40)
        found, gap = project(order, elements, points, starts)
        np.testing.assert_allclose(gap, RADIUS - distance, rtol=0, atol=1e-14)
        np.testing.assert_allclose(found.xi, exact.xi, rtol=0, atol=1e-13)


@pytest.mark.parametrize("had", [0, 1])
def test_a_search_that_begins_at_other_feet_is_shorter_and_ends_the_same(had: int) -> None:
    """Slips count from the origin all the same, of points that had a foot there; a point that had none in `near` begins there too."""
    points, distance = scattered(40, seed=4)
    points[:, ::2] *= (RADIUS + 0.1 * (distance - 0.6))[:, None] / distance[:, None]  # near the face: no other element is searched
    master, control_points = cylinder(3, 12)
    slave = SlaveArrays.of_points(np.arange(len(points), dtype=np.int32) + np.int32(len(control_points)))
    moved = [points + way * np.array([0.3, 0.1, 0.2]) for way in (0.0, 0.01, 0.01001)]
    whole = [np.ascontiguousarray(np.concatenate([control_points, there])) for there in moved]
    first = _bindings.project_points(slave, master, whole[0], np.zeros((40, 2)), np.zeros(40, dtype=np.int32))
    near = _bindings.project_points(slave, master, whole[1], first.xi, first.found)
    near = replace(near, found=np.where(np.arange(40) < 5, 0, near.found).astype(np.int32))
    flags, counts = np.full(40, had, dtype=np.int32), np.zeros((2, 8), dtype=np.int64)
    one = _bindings.project_points(slave, master, whole[2], first.xi, flags, counts=counts[0])
    other = _bindings.project_points(slave, master, whole[2], first.xi, flags, counts=counts[1], near=near)
    np.testing.assert_allclose(other.xi, one.xi, rtol=0, atol=1e-13)
    assert np.array_equal(other.element, one.element)
    assert np.array_equal(other.found, one.found)
    assert np.array_equal(other.origin, first.xi)
    assert np.array_equal(other.slips, flags)
    np.testing.assert_allclose(other.slip, had * (other.xi - first.xi), rtol=0, atol=1e-15)
    cold, evaluations = WORK.index("cold projections"), WORK.index("evaluations to order 2")
    assert counts[:, cold].tolist() == ([0, 0] if had else [40, 5])
    assert counts[1, evaluations] < 0.8 * counts[0, evaluations]


def project_on_roof(points: np.ndarray, starts: np.ndarray | None = None) -> Projections:
    """Projections onto four linear elements, ridged along x = 0: -1 < x < 1, 0 < y < 1, z = -0.4 |x|."""
    patch = mesh(box((-1.0, 0.0, -1.0), (1.0, 1.0, 0.0)), ("L", "L", "L"), (1, 1, 1), (2, 2, 1))
    control_points = patch.control_points.copy()
    top = control_points[:, 2] > -0.5
    control_points[top, 2] = -0.4 * np.abs(control_points[top, 0])
    arrays = patch_arrays(patch, np.arange(len(patch.weights), dtype=np.int32))
    master = FaceArrays(arrays, 3, 1)
    slave = SlaveArrays.of_points(np.arange(len(points), dtype=np.int32) + np.int32(len(control_points)))
    positions = np.ascontiguousarray(np.concatenate([control_points, points]))
    had = np.full(len(points), int(starts is not None), dtype=np.int32)
    return _bindings.project_points(slave, master, positions, np.zeros((len(points), 2)) if starts is None else starts, had)


@pytest.mark.parametrize("start", [None, 0.1, 0.5, 0.9])
def test_foot_on_a_ridge_is_fixed_across_it_and_in_the_lower_element(start: float | None) -> None:
    points = np.array([[0.02, 0.3, 0.1], [-0.02, 0.3, 0.1], [0.5, 0.3, 0.1]])
    feet = project_on_roof(points, None if start is None else np.full((3, 2), start))
    assert feet.fixed.tolist() == [[1, 0], [1, 0], [0, 0]]
    assert feet.element.tolist() == [[0, 0], [0, 0], [1, 0]]
    np.testing.assert_allclose(feet.xi[:2], [[0.5, 0.3], [0.5, 0.3]], rtol=0, atol=1e-15)


def test_beyond_the_edge_above_a_ridge_there_is_no_projection() -> None:
    assert project_on_roof(np.array([[0.0, 1.1, 0.1], [0.01, -0.1, 0.1]])).found.tolist() == [0, 0]


@pytest.mark.parametrize("far", [1e160, 1e300])
def test_points_whose_squared_distance_is_no_number_harm_no_others(far: float) -> None:
    """Any start will do where no sample is the nearest, but it has to be one."""
    points = np.array([[far, 0.0, 0.0], [0.0, far, -far], [0.0, 0.1, 0.6]])
    projections, gap = project(2, 4, points, None)
    assert projections.found[2] == 1
    assert gap[2] == pytest.approx(-0.1)
