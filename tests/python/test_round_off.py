"""Scales of round-off: numbers are brought to size without changing a bit of them."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from isomortar.solve.scales import PieceMeasures, _power_of_two


@pytest.mark.parametrize("largest", [1e-300, 3e-160, 0.7, 1.0, 5.0, 1e160, 1e300])
def test_numbers_divided_by_their_size_are_the_same_bits(largest: float) -> None:
    values = largest * np.array([[1.0, -0.3], [1e-7, 0.0]])
    size = _power_of_two(values)
    assert np.frexp(size)[0] == 0.5
    assert 0.5 <= np.abs(values / size).max() <= 1.0
    assert np.array_equal(values / size * size, values)


def test_of_nothing_the_size_is_one() -> None:
    assert _power_of_two(np.zeros(3)) == _power_of_two(np.zeros(0)) == 1.0


def measures(rigid: tuple[bool, ...], free: np.ndarray) -> PieceMeasures:
    """Those of pieces of two control points each."""
    pieces = [[SimpleNamespace(rigid=flag)] for flag in rigid]
    numbering = SimpleNamespace(starts=2 * np.arange(len(rigid)), pieces=pieces)
    return PieceMeasures(numbering, SimpleNamespace(balanced=free), None)  # type: ignore[arg-type]


@pytest.mark.parametrize("size", [1e-300, 1e-200, 1e-155, 1.0, 1e155, 1e200, 1e300])
def test_norms_of_forces_of_any_size_keep_their_digits(size: float) -> None:
    """Beside a body with none as well, and one whose forces are as large as its neighbour's are small."""
    forces = np.random.default_rng(3).uniform(0.5, 1.0, (6, 3))
    forces[2:4] = 0.0
    expected = [np.linalg.norm(forces[k : k + 2]) for k in (0, 2, 4)]
    of = measures((False,) * 3, np.ones((6, 3), dtype=bool))
    np.testing.assert_allclose(of.norms(size * forces) / size, expected, rtol=1e-14)
    forces[4:] *= 1e-3
    np.testing.assert_allclose(of.norms(size * forces) / size, [expected[0], 0.0, 1e-3 * expected[2]], rtol=1e-14)
    assert of.norms(np.vstack([size * forces[:4], forces[:2]]))[0] == pytest.approx(size * expected[0], rel=1e-14)


def test_forces_are_measured_by_those_inside_and_on_rigid_bodies_by_all() -> None:
    """Of what is left there what is at free unknowns, which may be more than what is at all: a rigid body's reactions."""
    inside, total, left = np.random.default_rng(4).uniform(0.5, 1.0, (3, 6, 3))
    free = np.arange(18).reshape(6, 3) % 2 == 0
    norms = [[float(np.linalg.norm(of[k : k + 2])) for k in (0, 2, 4)] for of in (inside, total, 9.0 * left * free, 0.1 * left * free)]
    of = measures((False, True, False), free)
    np.testing.assert_allclose(of.sizes(inside, total, 9.0 * left), [norms[0][0], norms[2][1], norms[0][2]], rtol=1e-14)
    np.testing.assert_allclose(of.sizes(inside, total, 0.1 * left), [norms[0][0], norms[1][1], norms[0][2]], rtol=1e-14)
    none = measures((False,) * 3, free)
    np.testing.assert_allclose(none.sizes(inside, total, 9.0 * left), norms[0], rtol=1e-14)
