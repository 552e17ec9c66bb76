"""The pressure field of a slave that reaches over its master's edge: its ends are those at points above the master alone."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A block of trilinear elements, a part of which is beside its master; its quadrature points are Gauss's, three by direction.
SCENE = """
format = 1
bodies.slave = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }, mesh = { order = 1, elements = [3, 2, 1] } }
bodies.master = { geometry = { kind = "box", lower = [-0.5, -0.5, -0.5], upper = [0.55, 1.5, 0] }, mesh = { order = 1 } }
contacts.c = { slave = "slave.w0", master = "master.w1", projection = "PROJECTION", quadrature = 3, subcells = 0 }
supports = { top = { face = "slave.w1", axis = [0, 1, 0], centre = [0.5, 0.5, 0.5] }, below.face = "master.w0" }
stages = [{ name = "press", steps = 1, motions.top = { translate = [0, 0, -0.02], rotate = TURN } }]
"""
ELEMENTS, POINTS = (3, 2), 3


def field(control: np.ndarray) -> np.ndarray:
    """The bilinear field of control values at the quadrature points, element by element, the first coordinate fastest."""
    places, _ = np.polynomial.legendre.leggauss(POINTS)
    values = control.reshape(ELEMENTS[1] + 1, ELEMENTS[0] + 1)
    found = []
    for row in range(ELEMENTS[1]):
        for column in range(ELEMENTS[0]):
            corners = values[row : row + 2, column : column + 2]
            for y in 0.5 * (1.0 + places):
                for x in 0.5 * (1.0 + places):
                    found.append(np.array([1.0 - y, y]) @ corners @ np.array([1.0 - x, x]))
    return np.array(found)


@case(
    claim="The pressure field is told of the points that are above the master, whatever multipliers would make of it beside that.",
    tier="gate",
    grid={"projection": ("closest", "averaged"), "turn": (-2, 2)},
    bounds={
        "field": Bound(at_most=1e-12, reason="round-off: sums of four products, over the largest pressure"),
        "beside": Bound(at_least=10.0, reason="definition: points that are beside the master"),
        "other": Bound(at_least=1e-3, reason="definition: all points would make something else of the ends, over the largest pressure"),
    },
)
def field_beside(projection: str, turn: int) -> dict[str, float]:
    """Largest difference of the field's ends; points beside the master; how far the ends over all points are from them."""
    (result,) = Simulation(Scene.from_toml(SCENE.replace("PROJECTION", projection).replace("TURN", str(turn))).problem()).run()
    contact, state = result.contacts[0], result.state.contacts[0]
    pressures, there = field(state.pressure), state.projected > 0
    ends = [np.array([some.min(), some.max()]) for some in (pressures[there], pressures)]
    size = float(np.abs(pressures).max())
    return {
        "field": float(np.abs(contact.pressure_field - ends[0]).max()) / size,
        "beside": float(np.count_nonzero(~there)),
        "other": float(np.abs(ends[0] - ends[1]).max()) / size,
    }
