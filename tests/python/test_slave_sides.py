"""Values of a slave's constraints on its control points, whatever the constraints are."""

from __future__ import annotations

import numpy as np
import pytest

from isomortar.model.enforcement import slave_side
from isomortar.model.numbering import Numbering
from isomortar.scene import Scene
from test_apart import SCENE


@pytest.mark.parametrize("method", ["knots", "kts", "greville", "demko", "mortar"])
@pytest.mark.parametrize("elements", [1, 3])
def test_a_constant_of_the_constraints_is_one_of_the_control_points(method: str, elements: int) -> None:
    """With one element no knot is where the function in the middle is: it takes the value of the nearest one."""
    overrides = [f"bodies.slave.mesh.elements=[{elements},{elements},1]", f'contacts.c.enforcement="{method}"', 'solver.method="uzawa"']
    problem = Scene.from_toml(SCENE, overrides=overrides).problem()
    side = slave_side(problem.contacts[0], problem, Numbering(problem))
    values = side.on_control_points(np.full(side.arrays.test.count, 3.0))
    assert values.shape == ((elements + 2) ** 2,)
    np.testing.assert_allclose(values, 3.0, rtol=1e-12)
    vectors = side.on_control_points(np.tile([1.0, -2.0], (side.arrays.test.count, 1)))
    np.testing.assert_allclose(vectors, np.tile([1.0, -2.0], (len(values), 1)), rtol=1e-12)
