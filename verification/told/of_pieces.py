"""What contacts bear beside the highest pressures of what hangs together with their bodies: less than that leaves open is nothing."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.record import ContactState
from isomortar.told.borne import Borne

#: Three boxes in a row, the first two glued, each on a plane.
SCENE = """
format = 1
glue = [["one.u1", "two.u0"]]
solver.newton_tolerance = 1e-6
stages = [{ name = "stand", steps = 1 }]
"""
BOX = """
bodies.{name}.geometry = {{ kind = "box", lower = [{place}, 0, 0], upper = [{end}, 1, 1] }}
contacts.{name} = {{ slave = "{name}.w0", plane = {{ point = [0, 0, 0] }}, friction = 0 }}
supports.{name}.face = "{name}.w1"
"""
NAMES = ("one", "two", "apart")
#: Which contacts share a piece.
SHARED = np.array([[True, True, False], [True, True, False], [False, False, True]])


@case(
    claim="A pressure is nothing where balance leaves as much open, by the highest one so far of all that hangs together with its bodies.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: pressures on either side of a millionth of the highest one, of nine pairs of contacts")},
)
def of_pieces() -> dict[str, float]:
    """How many are taken for others."""
    boxes = [BOX.format(name=name, place=3 * (k // 2) + k, end=3 * (k // 2) + k + 1) for k, name in enumerate(NAMES)]
    problem, wrong = Scene.from_toml(SCENE + "".join(boxes)).problem(), 0
    states: list[ContactState] = list(Simulation(problem).state.contacts)
    for high, other in np.ndindex(3, 3):
        borne = Borne(problem, states)
        for size in (1e-2, 1e-3):  # the highest so far, not the last
            borne.see([np.array([size if number == high else 0.0, 0.0]) for number in range(3)])
        for pressure in (0.9e-8, 1.1e-8):
            wrong += borne.more_than_nothing(other, pressure) != (pressure > 1e-8 or not SHARED[high, other])
    return {"wrong": float(wrong)}
