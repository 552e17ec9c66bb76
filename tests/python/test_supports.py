"""Motions of supports: turns against SciPy's rotations."""

import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from isomortar.model.entities import unit
from isomortar.model.supports import rotation

coordinates = st.floats(-1.0, 1.0)


@given(st.tuples(coordinates, coordinates, coordinates).filter(lambda v: np.linalg.norm(v) > 1e-3), st.floats(-20.0, 20.0))
@example((-0.97, 0.59, -0.1), 20.0)
def test_turn_is_that_of_scipy(axis, angle):
    """SciPy is given the angle as the length of a vector, which rounds it: its last digits grow with it, ours do not."""
    expected = Rotation.from_rotvec(angle * unit(axis)).as_matrix()
    length = 2.5 * abs(angle)  # half a unit in the last place for the products, one each for the axis's length and for the vector's
    np.testing.assert_allclose(rotation(unit(axis), angle), expected, rtol=0.0, atol=(8.0 + length) * np.finfo(float).eps)


def test_small_turns_keep_their_digits():
    # about a skew axis the product of its components comes with 1 - cos, 5e-19 here, of which a difference from one keeps nothing
    turned = rotation(unit((1.0, 1.0, 0.0)), 1e-9)
    np.testing.assert_allclose(turned[0, 1], 0.25e-18, rtol=1e-12)
