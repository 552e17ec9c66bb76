"""Control points that supports hold along the normal, and push into a plane: they bear, whatever the unit of length."""

from __future__ import annotations

import numpy as np
from transforms import scaled

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A block of which a side goes into the plane by a share of the block's size, and the rest follows.
SCENE = """
format = 1
bodies.block = {{ geometry = {{ kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }}, mesh = {{ order = 2, elements = [2, 1, 1] }} }}
contacts.floor = {{ slave = "block.w0", plane = {{}}, friction = 0 }}
supports.top.face = "block.w1"
supports.side.face = "block.u0"
{beside}
stages = [{{ name = "press", steps = 1, motions = {{ top.translate = [0, 0, {way}], side.translate = [0, 0, {way}] }} }}]
"""
#: A body that touches nothing, far away.
FAR = """
bodies.far = {{ geometry = {{ kind = "box", lower = [{at}, 0, 0], upper = [{end}, 1, 1] }}, mesh = {{ order = 2, elements = 1 }} }}
supports.far.face = "far.w0"
"""


@case(
    claim="What is pushed into a plane bears on it, by the same pressures in any unit of length.",
    tier="gate",
    grid={"depth": (2e-3, 2e-5)},
    bounds={
        "pressures": Bound(at_most=1e-6, reason="theory: what Newton's method leaves, of the largest pressure"),
        "bearing": Bound(at_least=3.0, reason="definition: control points that are held, and bear"),
    },
)
def in_any_unit(depth: float) -> dict[str, float]:
    """Largest difference of pressures of three units, over the largest; control points of the side that bear."""
    problem = Scene.from_toml(SCENE.format(way=-depth, beside="")).problem()
    found, bearing = [], []
    for length in (1.0, 2.0**-12, 2.0**12):
        simulation = Simulation(scaled(problem, length, 1.0))
        (last,) = simulation.run()
        found.append(last.state.contacts[0].pressure)
        side = np.isin(simulation.equilibrium.pairs[0].pair.slave.point, simulation.equilibrium.supports.points[1])
        bearing.append(np.count_nonzero(found[-1][side]))
    return {
        "pressures": float(np.max([np.abs(other - found[0]).max() for other in found]) / np.abs(found[0]).max()),
        "bearing": float(np.min(bearing)),
    }


@case(
    claim="What is pushed into a plane bears on it by the same pressures, however far away another body is that touches nothing.",
    tier="gate",
    grid={"away": (1e2, 1e6)},
    bounds={"pressures": Bound(at_most=1e-6, reason="theory: what Newton's method leaves, of the largest pressure")},
)
def beside_what_is_far(away: float) -> dict[str, float]:
    """Largest difference of pressures with and without that body, over the largest."""
    alone, other = (
        Simulation(Scene.from_toml(SCENE.format(way=-2e-5, beside=beside)).problem())
        for beside in ("", FAR.format(at=away, end=away + 1.0))
    )
    (right,), (found,) = alone.run(), other.run()
    pressure = right.state.contacts[0].pressure
    return {"pressures": float(np.abs(found.state.contacts[0].pressure - pressure).max() / np.abs(pressure).max())}
