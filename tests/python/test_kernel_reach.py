"""What is no contact: points deeper than the master's body, and positions that are not finite."""

from __future__ import annotations

import numpy as np
import pytest

from isomortar import _bindings
from isomortar._bindings import FaceArrays, Projections, SlaveArrays
from isomortar._codes import WORK, Status
from isomortar._compiled import kernel
from isomortar._descriptors import Descriptors
from isomortar.errors import LostProjectionError
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.model.numbering import patch_arrays

THICKNESS = 0.5


def bodies(points: np.ndarray) -> tuple[SlaveArrays, FaceArrays, np.ndarray]:
    """Points, each a slave of its own, and the upper face, z = 0, of a plate; with the positions of all."""
    patch = mesh(box((0.0, 0.0, -THICKNESS), (1.0, 1.0, 0.0)), ("N", "N", "N"), (2, 2, 1), (3, 3, 2))
    arrays = patch_arrays(patch, np.arange(len(patch.weights), dtype=np.int32))
    master = FaceArrays(arrays, 3, 1)
    slave = SlaveArrays.of_points(np.arange(len(points), dtype=np.int32) + np.int32(len(patch.weights)))
    return slave, master, np.ascontiguousarray(np.concatenate([patch.control_points, points]))


def project(points: np.ndarray, had: int) -> Projections:
    """Projections of points; 'had': in contact's reach at the last converged state, right above or below."""
    slave, master, positions = bodies(points)
    starts = np.ascontiguousarray(points[:, :2]) if had else np.zeros((len(points), 2))
    return _bindings.project_points(slave, master, positions, starts, np.full(len(points), had, dtype=np.int32))


@pytest.mark.parametrize("had", [0, 1])
@pytest.mark.parametrize("depth", [-3.0, -0.1, 0.0, 0.1, 0.99 * THICKNESS])
def test_points_within_the_body_are_in_reach(depth: float, had: int) -> None:
    assert project(np.array([[0.4, 0.6, -depth]]), had).found.tolist() == [1]


@pytest.mark.parametrize("depth", [1.01 * THICKNESS, 4 * THICKNESS])
def test_a_point_behind_the_body_from_the_start_takes_no_part(depth: float) -> None:
    assert project(np.array([[0.4, 0.6, 0.1], [0.4, 0.6, -depth]]), 0).found.tolist() == [1, 0]


@pytest.mark.parametrize("depth", [1.01 * THICKNESS, 4 * THICKNESS])
def test_a_point_that_was_in_reach_and_is_behind_the_body_has_passed_through(depth: float) -> None:
    with pytest.raises(LostProjectionError, match="quadrature point 1 has passed through the master's body"):
        project(np.array([[0.4, 0.6, 0.1], [0.4, 0.6, -depth]]), 1)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("component", [0, 1, 2])
@pytest.mark.parametrize("point", [50, 74, 76])
@pytest.mark.parametrize("had", [0, 1])
def test_a_position_that_is_not_finite_is_an_error_of_the_kernel(value: float, component: int, point: int, had: int) -> None:
    """Of the master or of the slave: the kernel says so by itself, without the arguments' checks."""
    slave, master, positions = bodies(np.array([[0.4, 0.6, 0.1], [0.5, 0.5, 0.1]]))
    positions[point, component] = value
    flags = np.full(2, had, dtype=np.int32)
    descriptors = Descriptors(kernel)
    handles = descriptors.handle("slave", slave, SlaveArrays), descriptors.handle("master", master, FaceArrays)
    starts, counts = np.full((2, 2), 0.5), np.zeros(len(WORK), np.int64)
    *_, status, place = kernel.project_points(*handles, positions.T, flags, starts.T, flags, 1, counts, starts.copy().T)
    assert (status, place) == (Status.NOT_FINITE, point + 1)
