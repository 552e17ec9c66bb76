"""The tangent of built-in bodies in contact, at poles too: exact in every part at states that Newton's method visits."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.harness.tangents import BOUND, check_tangent
from isomortar.scene import Scene

_SCENE = """
format = 1
bodies.body = {{ geometry = {{ {geometry} }}, mesh = {{ {mesh} }} }}
bodies.base.geometry = {{ kind = "box", lower = [-1.1, -1, -1], upper = [1, 1.2, 0] }}
bodies.base.mesh = {{ order = [2, 2, 1], elements = [4, 4, 1] }}
contacts.between = {{ slave = "body.{slave}", master = "base.w1", friction = 0.3, quadrature = 4, projection = "{projection}" }}
supports.base.face = "base.w0"
supports.top = {{ face = "body.{top}", axis = [0, 0, 1] }}
stages = [
    {{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.12] }},
    {{ name = "drag", steps = 2, motions.top.translate = [0.05, 0.02, 0] }},
]
"""
#: Bodies that stand on z = 0 with their lowest point; the first two with the pole of the slave there.
_STANDING = {
    "ball": ('kind = "sphere", centre = [0, 0, 0.5], outer = 0.5, latitudes = [-90, 0]', "v1", "w0"),
    "shell": ('kind = "sphere", centre = [0, 0, 0.5], inner = 0.3, outer = 0.5, latitudes = [-90, -10]', "v1", "w0"),
    "turned shell": ('kind = "sphere", centre = [0, 0, 0.5], outer = 0.5, inner = 0.3, latitudes = [0, 90], axis = "x"', "v1", "v0"),
    "pipe": ('kind = "ring", centre = [0, 0, 0.5], inner = 0.3, outer = 0.5, width = 0.6, angles = [90, 270]', "v1", "v0"),
    "torus": ('kind = "torus", centre = [0, 0, 0.35], radius = 0.5, outer = 0.35, latitudes = [-180, 0]', "v1", "w0"),
    "cap": ('kind = "cap", radius = 0.6, half_width = 0.4, bottom = 0, top = 0.6', "w0", "w1"),
    "wedge": ('kind = "wedge", bottom = [-0.2, 0.1], top = [-0.5, 0.4], y = [-0.3, 0.3], z = [0, 0.5]', "w0", "w1"),
}
#: Discretisations: kind, and elements by direction of what is round and of what is not.
_MESHES = {
    "N2": ("order = 2, elements = [4, 1, 2]", "order = 2, elements = [3, 3, 1]"),
    "N3": ("order = [3, 2, 3], elements = [4, 1, 2]", "order = [3, 3, 2], elements = [3, 3, 1]"),
    "L2": ('family = "L", order = 2, elements = [4, 1, 2]', 'family = "L", order = 2, elements = [2, 2, 1]'),
}
#: Cells of the gate.
_GATE = (("shell", "N2", "closest"), ("cap", "N2", "closest"), ("ball", "L2", "averaged"))


@case(
    claim="The tangent of a built-in body that is pressed and dragged is exact, at the pole of a slave, too.",
    grid={"body": list(_STANDING), "mesh": list(_MESHES), "projection": ["closest", "averaged"]},
    tier=lambda body, mesh, projection: "gate" if (body, mesh, projection) in _GATE else "nightly",
    bounds={
        "worst": Bound(at_most=BOUND, reason="round-off: products with the twin's differences in extended precision, part by part"),
        "active": Bound(at_least=1.0, reason="definition: there is contact"),
    },
)
def tangent(body: str, mesh: str, projection: str) -> dict[str, float]:
    """Largest error of a part, and the fewest active constraints at a state, in the third load step."""
    geometry, slave, top = _STANDING[body]
    text = _SCENE.format(geometry=geometry, slave=slave, top=top, projection=projection, mesh=_MESHES[mesh][body in ("cap", "wedge")])
    report = check_tangent(Scene.from_toml(text).problem(), 3, directions=1)
    errors = {row.part: row.error for row in report.rows if row.part != "symmetry"}
    return {
        "worst": float(np.max(list(errors.values()))),
        "active": float(np.min(report.active)),
    }
