"""What the law of small strains leaves out, of motions whose gradients are known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from told.wrong.contacts import PRESS
from transforms import scaled

from isomortar.scene import Scene
from isomortar.told.during.small_strains import left_out

BOWL = Scene.from_toml(PRESS).problem()


@pytest.mark.parametrize("length", [1e-75, 1.0, 1e75])
@pytest.mark.parametrize(
    ("motion", "strain"),
    [
        (np.eye(3), 0.0),
        (Rotation.from_rotvec([10.0, 0.0, 0.0], degrees=True).as_matrix(), 1.0 - np.cos(np.radians(10.0))),
        (Rotation.from_rotvec([60.0, -60.0, 60.0], degrees=True).as_matrix(), 1.0 - np.cos(np.radians(60.0 * np.sqrt(3.0)))),
        (np.diag([1.0, 0.7, 1.1]), 0.045),
        (np.eye(3) + 0.2 * np.eye(3, k=1)[:, ::-1], 0.02),
    ],
    ids=["nothing", "turn", "turn about any axis", "stretches", "shear"],
)
def test_of_affine_motions(motion: np.ndarray, strain: float, length: float) -> None:
    body = scaled(BOWL, length, 1.0).bodies[0]
    positions = body.patch.control_points @ motion.T + 3.0 * length
    assert left_out(body, positions) == pytest.approx(strain, abs=1e-13)
