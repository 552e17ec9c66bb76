"""Normal forces by which contacts are told to pull: in all those that act, whatever the sizes of a slave's elements."""

from __future__ import annotations

import numpy as np
import pytest

from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.told.during import pulling

#: A block between planes; elements of its lower face are long and short, along both directions.
SCENE = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }
bodies.block.mesh = { order = [2, 2, 1], elements = [3, 3, 1], grading = GRADING }
contacts.floor = { slave = "block.w0", plane = {}, friction = 0.2 }
supports.top.face = "block.w1"
stages = [{ name = "press", steps = 1, motions.top.translate = [0.02, 0, -0.05] }]
"""


@pytest.mark.parametrize("grading", ["1", "[4, 0.3, 1]"])
def test_their_sum_is_the_force_that_acts(grading: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """And no more than that, where all of them press; tangential ones are none of them."""
    found = []
    monkeypatch.setattr(pulling, "pulls", lambda *given: found.append(pulling.normal_forces(*given)) or False)  # type: ignore[func-returns-value]
    problem = Scene.from_toml(SCENE.replace("GRADING", grading)).problem()
    (step,) = Simulation(problem).run()
    on_slave, outward = found[-1]
    force = step.contacts[0].force_slave[2]
    np.testing.assert_allclose(on_slave.sum(axis=0), [0.0, 0.0, force], atol=1e-12 * force)
    assert np.linalg.norm(on_slave, axis=1).sum() == pytest.approx(force, rel=1e-12)
    np.testing.assert_allclose(np.linalg.norm(outward, axis=1), 1.0, rtol=1e-12)
    assert outward[:, 2].max() < -0.9
