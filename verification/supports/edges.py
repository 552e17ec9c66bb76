"""Supports on an edge and on a corner: they keep a body in its place and bear nothing of what is in balance without them."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Material
from isomortar.results.stress import first_piola_stress
from isomortar.scene import Scene

#: A block that is pulled along z, free to contract: nothing holds a whole face of it along x or y.
_PULLED = """
format = 1
bodies.block = {{ geometry = {{ kind = "box", lower = [0.1, -0.3, 0], upper = [0.9, 0.7, 1.2] }}, mesh = {{ {mesh} }} }}
supports.foot = {{ face = "block.w0", components = ["z"] }}
supports.side = {{ edge = "block.{edge}", components = ["x"] }}
supports.pin = {{ corner = "block.{corner}", components = ["y"] }}
supports.top = {{ face = "block.w1", components = ["z"] }}
solver.newton_tolerance = 1e-12
stages = [{{ name = "pull", steps = 1, motions.top.translate = [0, 0, 0.24] }}]
"""
_LOWER, _UPPER = np.array([0.1, -0.3, 0.0]), np.array([0.9, 0.7, 1.2])
_STRETCH = 1.2
#: An edge along y, and a corner on it, named in any order of the faces.
PLACES = {"lower": ("u0.w0", "u0.v0.w0"), "upper": ("w1.u1", "w1.v1.u1")}
_MESHES = {
    "N2": "order = 2, elements = [2, 3, 2]",
    "L2": 'family = "L", order = 2, elements = [2, 2, 2]',
    "graded N3": "order = 3, elements = 3, grading = [0.3, 1, 4]",
}


def contraction() -> tuple[float, float]:
    """Stretch across, and force per area, of uniaxial tension: the law alone."""
    material = Material()

    def stress(across: float) -> np.ndarray:
        return np.asarray(first_piola_stress(material, np.diag([across, across, _STRETCH])[None])[0])

    across = float(brentq(lambda x: stress(x)[0, 0], 0.7, 1.0, xtol=1e-15))
    return across, float(stress(across)[2, 2])


@case(
    claim="A block that an edge and a corner keep in place is stretched as by the law alone, and these bear nothing.",
    tier="gate",
    grid={"place": list(PLACES), "mesh": list(_MESHES)},
    bounds={
        "positions": Bound(at_most=1e-11, reason="theory: a homogeneous deformation about the edge; Newton's method stops at 1e-12"),
        "force": Bound(at_most=1e-11, reason="theory: stress times area; Newton's method stops at 1e-12"),
        "borne": Bound(at_most=1e-11, reason="theory: the block is in balance without them; Newton's method stops at 1e-12"),
    },
)
def uniaxial(place: str, mesh: str) -> dict[str, float]:
    """Largest distance of control points, error of the force, and largest force of edge and corner, over that."""
    edge, corner = PLACES[place]
    simulation = Simulation(Scene.from_toml(_PULLED.format(mesh=_MESHES[mesh], edge=edge, corner=corner)).problem())
    (result,) = simulation.run()
    across, stress = contraction()
    held = np.array([*(_LOWER if place == "lower" else _UPPER)[:2], 0.0])
    reference = simulation.equilibrium.numbering.reference
    exact = held + (reference - held) * [across, across, _STRETCH]
    force = stress * float(np.prod((_UPPER - _LOWER)[:2]))
    forces = {support.name: reaction.force for support, reaction in zip(simulation.problem.supports, result.reactions, strict=True)}
    return {
        "positions": float(np.abs(result.state.positions - exact).max()),
        "force": abs(forces["top"][2] / force - 1.0),
        "borne": float(np.abs([forces["side"], forces["pin"]]).max()) / force,
    }


_PRESSED = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = 2, elements = [3, 2, 3] } }
supports.foot.face = "block.w0"
supports.ridge = { edge = "block.u1.w1", components = ["y"], force = { x = 0.05, z = -0.1 } }
solver.newton_tolerance = 1e-12
stages = [{ name = "press", steps = 2 }]
"""


@case(
    claim="An edge that is pressed bears its force, goes as one, and the foot bears the rest.",
    tier="gate",
    bounds={
        "force": Bound(at_most=1e-10, reason="theory: balance; Newton's method stops at 1e-12"),
        "apart": Bound(at_most=1e-14, reason="definition: its control points move alike along what is pressed"),
        "points": Bound(at_least=4.0, at_most=4.0, reason="definition: those of the edge, and no others"),
    },
)
def pressed_edge() -> dict[str, float]:
    """Error of the forces over the prescribed one, how far points of the edge are from going alike, and their number."""
    simulation = Simulation(Scene.from_toml(_PRESSED).problem())
    *_, result = simulation.run()
    foot, ridge = (reaction.force for reaction in result.reactions)
    prescribed = np.array([0.05, 0.0, -0.1])
    points = simulation.equilibrium.supports.points[1]
    ways = (result.state.positions - simulation.equilibrium.numbering.reference)[points][:, [0, 2]]
    errors = [(ridge - prescribed)[[0, 2]], (foot + ridge)]
    return {
        "force": float(np.abs(np.concatenate(errors)).max()) / 0.1,
        "apart": float(np.ptp(ways, axis=0).max()),
        "points": float(len(points)),
    }
