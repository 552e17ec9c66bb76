"""The same octant of a ball pressed on a plane, its pole where it touches, or on the rim, where nothing does: the pole is not felt."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, Shown, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

_OCTANT = """
format = 1
bodies.ball.geometry = {{ kind = "sphere", outer = 1, {place} }}
bodies.ball.mesh = {{ {mesh}, elements = {elements}, grading = {grading} }}
contacts.floor = {{ slave = "ball.v1", plane = {{ point = [0, 0, -1] }}, friction = 0 }}
supports.top = {{ face = "ball.{top}", components = ["z"] }}
supports.x = {{ face = "ball.{x}", components = ["x"] }}
supports.y = {{ face = "ball.{y}", components = ["y"] }}
solver.newton_tolerance = 1e-11
stages = [{{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.08] }}]
"""
#: Where the pole is, the faces that are on planes, and how elements are graded towards the contact: along u, v and w.
POLES = {
    "in contact": ({"place": "latitudes = [-90, 0], angles = [0, 90]", "top": "w0", "x": "u1", "y": "u0"}, (1.0, 0.2, 0.15)),
    "on the rim": ({"place": 'latitudes = [0, 90], angles = [-90, 0], axis = "x"', "top": "u1", "x": "w1", "y": "u0"}, (6.0, 0.2, 0.15)),
}
MESHES = {"N2": "order = 2", "N3": "order = 3", "L1": 'family = "L", order = 1'}
#: Elements towards the contact of a coarse and a fine mesh.
SIZES = (4, 12)


def force(pole: str, mesh: str, elements: int) -> float:
    """What presses the octant, of so many elements towards the contact."""
    names, grading = POLES[pole]
    along = elements // 2 if pole == "in contact" else elements
    counts = [along, elements // 2, elements]
    text = _OCTANT.format(**names, mesh=MESHES[mesh], elements=counts, grading=list(grading))
    *_, result = Simulation(Scene.from_toml(text).problem()).run()
    return -float(result.reactions[0].force[2])


@case(
    claim="A ball is pressed by the same force whether its pole is where it touches or elsewhere, the more so the finer it is.",
    grid={"mesh": list(MESHES)},
    tier=lambda mesh: "nightly" if mesh == "N3" else "gate",
    bounds={
        "apart": Bound(at_most=0.015, reason="discretisation: of both, on the finer mesh"),
        "falls": Bound(at_least=2.0, reason="discretisation: a third of the element size leaves less of the difference"),
        "force": Shown(reason="discretisation: on the finer mesh, pole on the rim"),
    },
)
def pole_is_not_felt(mesh: str) -> dict[str, float]:
    """Difference of the forces over the force on the finer of two meshes, by how much it is less than on the coarser, and that force."""
    found = np.array([[force(pole, mesh, elements) for pole in POLES] for elements in SIZES])
    apart = np.abs(found[:, 0] / found[:, 1] - 1.0)
    return {"apart": float(apart[1]), "falls": float(apart[0] / apart[1]), "force": float(found[1, 1])}
