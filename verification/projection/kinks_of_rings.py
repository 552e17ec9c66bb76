"""Where a master has kinks: on a ring of arcs at whichever joint its outline has a corner, the one among them where it meets itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from isomortar.geometry.patch import FloatArray, Patch
from isomortar.geometry.primitives import ring
from isomortar.harness import Bound, case
from isomortar.model.entities import Body, Material
from isomortar.model.kinks import has_kinks
from isomortar.model.sheet import Sheet

#: From where to where rings of three and four arcs go round: two arcs of up to half a circle have no joint.
ANGLES = {"whole": (0.0, 360.0), "begun elsewhere": (45.0, 405.0), "three quarters": (10.0, 280.0)}


def cornered(patch: Patch, row: int) -> Patch:
    """A ring whose outline goes out to a point where a row of control points across it is, and where the same one is again."""
    grid: FloatArray = patch.control_points.reshape(*patch.shape, 3, order="F").copy()
    rows = [k for k in range(patch.shape[0]) if np.allclose(grid[k], grid[row])]
    grid[rows] *= 1.2
    return replace(patch, control_points=grid.reshape(-1, 3, order="F"))


@case(
    claim="A ring has a kink at whichever joint of its arcs it has a corner, the seam among them, and none where arcs go on smoothly.",
    tier="gate",
    grid={"angles": tuple(ANGLES)},
    bounds={
        "missed": Bound(0.0, 0.0, "definition: joints with a corner of which none is seen"),
        "seen": Bound(0.0, 0.0, "definition: faces of the round ring of which some is"),
        "joints": Bound(at_least=2.0, reason="definition: corners that there were"),
    },
)
def corners_of_rings(angles: str) -> dict[str, float]:
    """How many, on both round faces."""
    patch = ring((0.0, 0.0, 0.0), 0.5, 1.0, 0.4, ANGLES[angles])
    closed = angles != "three quarters"
    joints = range(0 if closed else 2, patch.shape[0] - 1 - (0 if closed else 1), 2)
    missed = seen = 0
    for face in ("v0", "v1"):
        seen += has_kinks(Sheet.of_face(_body(patch, closed), face))
        missed += sum(not has_kinks(Sheet.of_face(_body(cornered(patch, row), closed), face)) for row in joints)
    return {"missed": float(missed), "seen": float(seen), "joints": float(len(joints))}


def _body(patch: Patch, closed: bool) -> Body:
    return Body("ring", patch, Material(), (3, 3, 3), "u" if closed else None)
