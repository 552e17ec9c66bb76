"""Two beams that one wall holds, one on the other: what either bears of a load."""

from __future__ import annotations

from functools import cache

import numpy as np
from transforms import turned

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: The upper one is loaded; orders, and elements along them, are filled in.
SCENE = """
format = 1
bodies.upper.geometry = { kind = "box", lower = [0, -0.2, 0], upper = [1, 0.2, 0.2] }
bodies.upper.mesh = { order = [ORDER, 2, 2], elements = [UPPER, 1, 1] }
bodies.lower.geometry = { kind = "box", lower = [0, -0.2, -0.2], upper = [1, 0.2, 0] }
bodies.lower.mesh = { order = [ORDER, 2, 2], elements = [LOWER, 1, 1] }
contacts.c = { slave = "lower.w1", master = "upper.w0", enforcement = "KIND", friction = 0 }
supports = { above.face = "upper.u0", below.face = "lower.u0" }
loads.top = { face = "upper.w1", pressure = 0.01 }
stages = [{ name = "load", steps = 1 }]
"""
LOAD = 0.004
#: Orders, and elements of the upper and the lower one.
MESHES = {"order 2": (2, 4, 4), "order 2, finer below": (2, 3, 6), "order 3": (3, 4, 4), "order 3, finer above": (3, 6, 4)}
#: What the scene is turned by: nothing is along an axis then.
TURN = np.array([[2.0, -2.0, 1.0], [1.0, 2.0, 2.0], [-2.0, -1.0, 2.0]]) / 3.0


KINDS = ("mortar", "dual", "knots", "greville")


def borne(kind: str, mesh: tuple[int, int, int], is_turned: bool) -> float:
    """What share of the load the lower beam's support bears."""
    text = SCENE
    for word, value in zip(("KIND", "ORDER", "UPPER", "LOWER"), (kind, *mesh), strict=True):
        text = text.replace(word, str(value))
    problem = Scene.from_toml(text).problem()
    *_, last = Simulation(turned(problem, TURN) if is_turned else problem).run()
    up = TURN[:, 2] if is_turned else np.array([0.0, 0.0, 1.0])
    return float(last.reactions[1].force @ up) / LOAD


@cache
def true() -> float:
    """The same of fine meshes."""
    return borne("mortar", (3, 14, 11), False)


@case(
    claim="Beams that one wall holds, one on the other, share a load as fine ones do, by every kind of constraint, wherever they point: "
    "constraints of control points that supports hold beside what they hold of the master bear nothing.",
    tier="gate",
    grid={"kind": KINDS, "mesh": tuple(MESHES)},
    bounds={
        "off": Bound(at_most=0.1, reason="discretisation: of coarse beams, as a share of the load; by dual functions it was 0.6 to 14"),
        "turned": Bound(at_most=1e-4, reason="round-off: of the same scene elsewhere; averages and dual functions had no tangent there"),
    },
)
def clamped_together(kind: str, mesh: str) -> dict[str, float]:
    """What the lower one bears, apart from that, and from what it bears turned."""
    share, elsewhere = (borne(kind, MESHES[mesh], is_turned) for is_turned in (False, True))
    return {"off": abs(share - true()), "turned": abs(elsewhere - share)}
