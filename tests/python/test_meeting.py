"""What of a body is beside the nearest cell of another one: farther from its middle, along it, than a square of its area is wide."""

from __future__ import annotations

import numpy as np
import pytest

from isomortar.geometry.faces import cells
from isomortar.scene import Scene
from isomortar.told.before.meeting import heights_above

#: A block of square cells, of some size.
BLOCK = """
format = 1
bodies.a = { geometry = { kind = "box", lower = [0, 0, 0], upper = [SIZE, SIZE, SIZE] }, mesh = { order = 1, elements = [3, 3, 3] } }
supports.base.face = "a.w0"
stages = [{ name = "stay", steps = 1 }]
"""


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_what_is_beside_the_nearest_cell_is_so_in_any_unit_and_at_any_height(size: float) -> None:
    body = Scene.from_toml(BLOCK.replace("SIZE", f"{size:g}")).problem().body("a")
    top = cells(body.patch, "w1")
    width = float(np.sqrt(top.areas[0]))
    middle = top.centres[:, 1].min()
    over = top.centres + np.array([0.0, 0.0, 2.0 * width])
    beyond = np.array([[size + share * width, middle, size + 2.0 * width] for share in (0.3, 0.45, 0.55, 0.7)])
    above, out, beside = heights_above(np.concatenate([over, beyond]), body)
    np.testing.assert_allclose(above, 2.0 * width, rtol=1e-9)
    np.testing.assert_allclose(out, np.broadcast_to([0.0, 0.0, 1.0], out.shape), atol=1e-12)
    assert beside.tolist() == [False] * len(over) + [False, False, True, True]
