"""From which volume on laws resist the less, the more a body shrinks, against the kernel's forces."""

from __future__ import annotations

import numpy as np
import pytest
from told.wrong.runs import SHRINKING

from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.timing import Ledger
from isomortar.told.during.shrunk import LEAST_VOLUMES


def resistance(law: str, volume: float) -> float:
    """Work of the forces of a column that is shrunk to a share of its volume, by length."""
    equilibrium = Equilibrium(Scene.from_toml(SHRINKING.replace("neo-hookean-j", law)).problem(), Ledger())
    places = equilibrium.problem.bodies[0].patch.control_points
    return -float(np.sum(equilibrium.solid.forces(np.ascontiguousarray(places * np.cbrt(volume))) * places))


@pytest.mark.parametrize("law", ["neo-hookean", "neo-hookean-j"])
def test_a_law_resists_most_at_its_least_volume(law: str) -> None:
    volumes = np.geomspace(0.05, 0.99, 200)
    most = volumes[np.argmax([resistance(law, volume) for volume in volumes])]
    assert most == pytest.approx(LEAST_VOLUMES.get(law, volumes[0]), rel=0.02)
