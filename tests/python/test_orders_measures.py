"""What the order-elevation report measures, on curves and fields whose numbers are known exactly."""

import math

import numpy as np
import pytest

from isomortar.accuracy.measures import (
    curve_error,
    expected_order,
    on_common_times,
    reference_uncertainty,
    relative_error,
    roughness,
)
from isomortar.accuracy.sampling import body_grid, face_grid, values_at
from isomortar.errors import InputError
from isomortar.geometry.primitives import bowl, box, ring
from isomortar.geometry.refinement import mesh
from isomortar.results.bezier import functions_at


def test_relative_error_of_known_values():
    assert relative_error([3.0, 0.0], [2.0, 0.0], [1.0, 1.0]) == 0.5
    assert relative_error([[3.0, 4.0]], [[0.0, 4.0]], [7.0]) == 0.75
    assert relative_error([1.0, 2.0], [1.0, 1.0], [3.0, 1.0]) == 0.5  # sqrt(1 / 4)
    assert math.isnan(relative_error([1.0], [0.0], [1.0]))


def test_relative_error_wants_one_shape():
    with pytest.raises(InputError, match="shapes differ"):
        relative_error([1.0, 2.0], [1.0], [1.0])
    with pytest.raises(InputError, match="shapes differ"):
        relative_error([1.0, 2.0], [1.0, 2.0], [1.0])


def test_curves_meet_on_the_times_of_both():
    times, values = on_common_times([0.0, 2.0, 4.0], [0.0, 2.0, 0.0], [1.0, 2.0, 5.0])
    assert times.tolist() == [1.0, 2.0, 4.0]
    assert values.tolist() == [1.0, 2.0, 0.0]
    _, vectors = on_common_times([0.0, 2.0], [[0.0, 4.0], [2.0, 0.0]], [0.0, 1.0, 2.0])
    assert vectors.tolist() == [[0.0, 4.0], [1.0, 2.0], [2.0, 0.0]]


@pytest.mark.parametrize("other", [[3.0, 4.0], [2.0, 3.0]])
def test_curves_without_a_common_range_are_an_error(other):
    with pytest.raises(InputError, match="have no load times in common"):
        on_common_times([0.0, 1.0, 2.0], [0.0, 0.0, 0.0], other)


def test_curve_error_is_an_integral_over_time():
    times = [0.0, 1.0, 3.0]
    assert curve_error(times, [2.0, 2.0, 2.0], times, [1.0, 1.0, 1.0]) == 1.0
    # trapezoidal weights 1/2, 3/2, 1: the middle alone is off by 1 of 2
    assert curve_error(times, [2.0, 3.0, 2.0], times, [2.0, 2.0, 2.0]) == pytest.approx(0.5 * math.sqrt(0.5), rel=1e-15)
    # the same line with fewer points is the same curve
    assert curve_error([0.0, 4.0], [0.0, 8.0], [0.0, 1.0, 2.0, 4.0], [0.0, 2.0, 4.0, 8.0]) == 0.0


def test_roughness_of_polynomials():
    t = np.arange(1.0, 8.0)
    one = np.zeros(7)
    assert roughness(t, 3 * t - 1, one) == 0.0
    assert roughness(t, t**2, one) == 5 * 4.0  # second differences 2
    assert roughness(t, t**3, one) == 36.0 * sum(k**2 for k in range(2, 7))  # 6 t at the inner times
    assert roughness(t, np.column_stack([t**2, -(t**2)]), one) == 2 * 5 * 4.0


def test_roughness_on_uneven_times_sees_the_second_derivative():
    t = np.array([0.0, 1.0, 3.0, 3.5])
    assert roughness(t, t**2, np.zeros(4)) == pytest.approx(2 * 4.0, rel=1e-14)


def test_the_kink_between_stages_is_not_roughness():
    t = np.arange(1.0, 7.0)
    kinked = np.where(t <= 3, t, 6 - t)
    assert roughness(t, kinked, [0, 0, 0, 1, 1, 1]) == 0.0
    assert roughness(t, kinked, np.zeros(6)) == 4.0


def test_uncertainty_of_a_sequence_that_converges_with_known_order():
    error = [16.0, 4.0, 1.0]  # order 2: changes 12 and 3
    assert reference_uncertainty(12.0, 3.0, expected=3.0) == pytest.approx(error[2], rel=1e-15)
    assert reference_uncertainty(12.0, 3.0, expected=1.0) == 3.0  # theory allows order 1 only: not believed
    assert reference_uncertainty(4.0, 3.0, expected=2.0) == pytest.approx(9.0, rel=1e-15)


@pytest.mark.parametrize("changes", [(1.0, 1.0), (1.0, 2.0), (math.nan, 0.1), (1.0, math.nan), (0.0, 0.0), (math.inf, 1.0)])
def test_changes_that_do_not_fall_leave_the_reference_uncertain(changes):
    assert reference_uncertainty(*changes, expected=2.0) == math.inf


def test_expected_orders():
    assert expected_order("pressure", 3, slave_refined=True) == 1.0
    assert [expected_order("displacement", p, slave_refined=True) for p in (1, 2)] == [2.0, 2.5]
    assert [expected_order("force", p, slave_refined=True) for p in (1, 2)] == [2.0, 3.0]
    assert [expected_order("pressure", p, slave_refined=False) for p in (1, 2, 5)] == [2.0, 3.0, 4.0]
    assert [expected_order("moment", p, slave_refined=False) for p in (1, 2, 5)] == [2.0, 4.0, 6.0]


def test_grids_measure_the_geometry():
    block = box((0.0, 0.0, 0.0), (2.0, 1.0, 0.5))
    grid = body_grid(block, 1000)
    assert grid.shape == (20, 10, 5)
    assert grid.weights == pytest.approx(np.full(1000, 1e-3), rel=1e-12)
    assert face_grid(block, "v0", 400).shape == (10, 40)  # surface coordinates (w, u)
    tire = ring((0.0, 0.0, 0.5), 0.25, 0.5, 0.25)
    assert face_grid(tire, "v1", 4096).weights.sum() == pytest.approx(0.25 * np.pi, rel=1e-4)


@pytest.mark.parametrize(("families", "orders"), [("NNN", (3, 2, 2)), ("NNN", (5, 4, 1)), ("LLL", (2, 2, 1)), ("LLN", (1, 2, 3))])
def test_samples_are_at_the_same_material_points_on_every_mesh(families, orders):
    block = box((0.0, 0.0, 0.0), (2.0, 1.0, 0.5))
    patch = mesh(block, tuple(families), orders, (3, 4, 2))
    grid = body_grid(block, 500)
    exact = values_at(block.directions, block.weights, block.control_points, grid)
    assert values_at(patch.directions, patch.weights, patch.control_points, grid) == pytest.approx(exact, abs=1e-14)


def test_samples_of_a_curved_patch_are_on_it():
    coarse = bowl((0.0, 0.0), 0.5, 0.0, 0.2, 0.8)
    patch = mesh(coarse, ("N", "N", "N"), (4, 3, 2), (3, 5, 2))
    numbers, grid = patch.face_points("w0"), face_grid(coarse, "w0", 400)
    x, y, z = values_at(patch.face_directions("w0"), patch.weights[numbers], patch.control_points[numbers], grid).T
    assert z == pytest.approx(0.2 * (x**2 + y**2) / 0.25, abs=1e-14)


def test_basis_at_the_ends_and_on_knots():
    direction = mesh(box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), ("N", "L", "N"), (2, 3, 1), (4, 4, 1)).directions
    for d in direction[:2]:
        assert functions_at(d, d.boundaries)[0].sum(axis=1) == pytest.approx(np.ones(5), abs=1e-14)
        assert functions_at(d, np.array([0.0, 1.0]))[0][[0, 1], [0, -1]] == pytest.approx([1.0, 1.0], abs=1e-14)
