"""The material near zero strain: residual and tangent keep their digits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from isomortar import _bindings, _twin
from isomortar._bindings import BodyArrays, Pattern
from isomortar.errors import FoldedElementError
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.model.entities import Material
from isomortar.model.numbering import patch_arrays

MATERIAL = Material(10.0, 0.3)
PATCH = mesh(box((0.0, 0.0, 0.0), (1.0, 2.0, 1.0)), ("N", "N", "N"), (2, 1, 2), (1, 1, 1))
ARRAYS = patch_arrays(PATCH, np.arange(len(PATCH.weights), dtype=np.int32))
REFERENCE = PATCH.control_points
#: Displacements that add to the (dyadic) reference positions without rounding.
SHAPE = np.random.default_rng(2).integers(-8, 9, REFERENCE.shape) / 8.0
BODY = BodyArrays(ARRAYS, (3, 3, 3), REFERENCE)


def forces(positions: np.ndarray) -> np.ndarray:
    result = np.zeros_like(REFERENCE)
    _bindings.add_body(BODY, MATERIAL.arrays, positions, result)
    return result


def tangent(positions: np.ndarray) -> np.ndarray:
    """The tangent as a dense matrix."""
    n = len(REFERENCE)
    pattern = Pattern(np.arange(0, n * n + 1, n, dtype=np.int32), np.tile(np.arange(n, dtype=np.int32), n))
    blocks = np.zeros((n * n, 3, 3))
    _bindings.add_body(BODY, MATERIAL.arrays, positions, np.zeros_like(REFERENCE), pattern, blocks)
    return blocks.reshape(n, n, 3, 3).transpose(0, 2, 1, 3).reshape(3 * n, 3 * n)


@pytest.mark.parametrize("power", [-20, -30, -40])
def test_stress_of_small_strains_keeps_its_digits(power: int) -> None:
    """At 2^-30 (1e-9), and far below: forces over strain against the twin's slope, even in strain up to its square."""
    strain = 2.0**power
    slope = _twin.solid_difference(BODY, MATERIAL.arrays, REFERENCE, SHAPE, step=strain)
    odd = (forces(REFERENCE + strain * SHAPE) - forces(REFERENCE - strain * SHAPE)) / (2.0 * strain)
    assert np.linalg.norm(odd - slope) < 1e-13 * np.linalg.norm(slope)


@pytest.mark.parametrize("strain", [0.0, 2.0**-30, 2.0**-4])
def test_tangent_from_no_strain_to_a_large_one(strain: float) -> None:
    positions, along = REFERENCE + strain * SHAPE, np.random.default_rng(3).standard_normal(REFERENCE.shape)
    twin = _twin.solid_difference(BODY, MATERIAL.arrays, positions, along)
    matrix = tangent(positions)
    assert np.linalg.norm(matrix @ along.ravel() - twin.ravel()) < 1e-14 * np.linalg.norm(twin)
    assert np.linalg.norm(matrix - matrix.T) < 1e-15 * np.linalg.norm(matrix)


def test_rigid_motion_leaves_no_forces() -> None:
    turn = np.array([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
    size = np.linalg.norm(forces(REFERENCE * 1.01))
    assert np.linalg.norm(forces(REFERENCE @ turn.T + [3.0, -2.0, 1.0])) < 1e-12 * size


def test_twin_is_in_extended_precision() -> None:
    """Where the difference of two nearly equal double-precision forces has four digits left, the twin's has all."""
    positions, step = REFERENCE + 0.03 * SHAPE, 1e-12
    rough = (forces(positions + step * SHAPE) - forces(positions - step * SHAPE)) / (2.0 * step)
    fine = _twin.solid_difference(BODY, MATERIAL.arrays, positions, SHAPE, step=step)
    exact = (tangent(positions) @ SHAPE.ravel()).reshape(-1, 3)
    assert np.linalg.norm(fine - exact) < 1e-13 * np.linalg.norm(exact)
    assert np.linalg.norm(rough - exact) > 1e-7 * np.linalg.norm(exact)


@pytest.mark.parametrize("spread", [0.0, 0.3])
def test_what_is_kept_of_the_reference_configuration_is_what_is_computed_with_forces(spread: float) -> None:
    """To the bit, whether weights differ or are all the same, and of what size they are."""
    weights = 2.0 * (1.0 + spread * np.linspace(0.0, 1.0, len(PATCH.weights)))
    arrays = patch_arrays(replace(PATCH, weights=weights), ARRAYS.point)
    found = []
    for often in (True, False):
        result = np.zeros_like(REFERENCE)
        for _ in range(2):
            _bindings.add_body(BodyArrays(arrays, BODY.gauss, REFERENCE, often), MATERIAL.arrays, REFERENCE + 0.03 * SHAPE, result)
        found.append(result)
    np.testing.assert_array_equal(*found)
    assert (np.linalg.norm(found[0] - 2.0 * forces(REFERENCE + 0.03 * SHAPE)) > 1e-3) == (spread > 0.0)


def test_a_folded_element_is_named_with_its_jacobian() -> None:
    with pytest.raises(FoldedElementError, match=r"^element 0 is folded \(J = -0\.75\)$"):
        forces(np.ascontiguousarray(REFERENCE * [1.0, -0.75, 1.0]))
    told = r"^element 0 is folded \(J = -2\) in the reference configuration$"
    for often in (True, False):
        turned = BodyArrays(ARRAYS, BODY.gauss, np.ascontiguousarray(-REFERENCE), often)
        with pytest.raises(FoldedElementError, match=told):
            _bindings.add_body(turned, MATERIAL.arrays, REFERENCE, np.zeros_like(REFERENCE))
        with pytest.raises(FoldedElementError, match=told):
            _bindings.control_volumes(turned)


@pytest.mark.parametrize("element", range(6))
@pytest.mark.parametrize("often", [True, False])
def test_the_folded_element_among_those_beside_it_is_named(element: int, often: bool) -> None:
    """One of six in a row, which are computed four side by side; of two that fold the first one."""
    patch = mesh(box((0.0, 0.0, 0.0), (6.0, 1.0, 1.0)), ("L", "L", "L"), (1, 1, 1), (6, 1, 1))
    reference = patch.control_points
    arrays = patch_arrays(patch, np.arange(len(reference), dtype=np.int32))
    # An element lies between x = element and element + 1: its far end goes behind its near one, and the elements beyond with it.
    beyond = reference[:, 0] > element + 0.5
    turned = reference - np.outer(beyond, [1.5, 0.0, 0.0])
    also = turned - np.outer(reference[:, 0] > 4.5, [2.0, 0.0, 0.0])
    for folded, first, jacobian in ((turned, element, -0.5), (also, min(element, 4), {4: -2.5, 5: -1}.get(element, -0.5))):
        body, mirrored = (BodyArrays(arrays, (2, 2, 2), points, often) for points in (reference, folded))
        forces, told = np.zeros_like(reference), rf"^element {first} is folded \(J = {jacobian}\)"
        with pytest.raises(FoldedElementError, match=told + "$"):
            _bindings.add_body(body, MATERIAL.arrays, folded, forces)
        with pytest.raises(FoldedElementError, match=rf"^element {first} is .* reference"):
            _bindings.add_body(mirrored, MATERIAL.arrays, reference, forces)
        with pytest.raises(FoldedElementError, match=rf"^element {first} is .* reference"):
            _bindings.control_volumes(mirrored)


@pytest.mark.parametrize("element", range(6))
@pytest.mark.parametrize("often", [True, False])
def test_an_element_without_any_thickness_is_named(element: int, often: bool) -> None:
    """A determinant of nothing at all is as good as a negative one: of six in a row the one whose ends are one plane."""
    patch = mesh(box((0.0, 0.0, 0.0), (6.0, 1.0, 1.0)), ("L", "L", "L"), (1, 1, 1), (6, 1, 1))
    reference = patch.control_points
    flat = reference - np.outer(reference[:, 0] > element + 0.5, [1.0, 0.0, 0.0])
    arrays = patch_arrays(patch, np.arange(len(reference), dtype=np.int32))
    told = rf"^element {element} is folded \(J = 0, flat but for round-off\)"
    sound, wrong = (BodyArrays(arrays, (2, 2, 2), points, often) for points in (reference, flat))
    with pytest.raises(FoldedElementError, match=told + "$"):
        _bindings.add_body(sound, MATERIAL.arrays, flat, np.zeros_like(reference))
    with pytest.raises(FoldedElementError, match=told + " in the reference"):
        _bindings.add_body(wrong, MATERIAL.arrays, reference, np.zeros_like(reference))
    with pytest.raises(FoldedElementError, match=told + " in the reference"):
        _bindings.control_volumes(wrong)
