"""What loads do on rigid motions of bodies that are no longer where they began."""

from __future__ import annotations

import numpy as np

from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.free_motions import free_motions
from isomortar.solve.timing import Ledger
from isomortar.told.after.load_work import load_works

#: A block that a force takes along at its corner while the same support shifts it.
SCENE = """
format = 1
materials.soft.young = 100
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 1, 1] }
contacts.floor = { slave = "block.w0", plane = {} }
supports.hand = { face = "block.w1", components = ["y", "z"], centre = [0, 0, 1], axis = [0, 0, 1], force.x = 3, moment = 0 }
stages = [{ name = "go", steps = 1, motions.hand.translate = [0, 5, 0] }]
"""


def test_a_force_works_where_its_plate_is() -> None:
    equilibrium = Equilibrium(Scene.from_toml(SCENE).problem(), Ledger())
    equilibrium.time = 1.0
    positions = equilibrium.numbering.reference + np.array([0.0, 5.0, 0.0])
    corner = int(np.argmin(np.linalg.norm(positions - [0.0, 5.0, 1.0], axis=1)))
    motions = free_motions(equilibrium.problem, equilibrium.numbering, equilibrium.supports, positions)
    works = load_works(equilibrium, positions, motions)
    assert len(works) > 1
    np.testing.assert_allclose(works, [3.0 * motion.displacement[corner, 0] for motion in motions], atol=1e-12)
    assert np.ptp(works) > 0.1
