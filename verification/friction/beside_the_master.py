"""A slave that hangs partly beside its master and touches nothing: nothing presses, penetrates or pulls."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.record import ContactResult

#: Of functions of both signs what is left of a weight beyond the master's edge may be negative.
SCENE = """
format = 1
bodies.upper.geometry = {{ kind = "box", lower = [0.0, 0.0, 0.01], upper = [1.0, 0.5, 0.5] }}
bodies.upper.mesh = {{ family = "L", order = 2, elements = [2, 2, 1] }}
bodies.lower.geometry = {{ kind = "box", lower = [0.0, {overhang}, -0.5], upper = [1.0, 1.0, 0.0] }}
contacts.pair = {{ slave = "upper.w0", master = "lower.w1", projection = "{projection}", enforcement = "{enforcement}" }}
supports.top.face = "upper.w1"
supports.base.face = "lower.w0"
stages = [{{ name = "hang", steps = 1, motions.top.translate = [0.0, 0.0, -0.001] }}]
"""
#: Places of the master's edge below the slave, whose negative weights are not those of the same constraints.
OVERHANGS = (0.03, 0.1, 0.16, 0.22, 0.3, 0.37, 0.45)


def hanging(projection: str, enforcement: str) -> list[ContactResult]:
    """What is found of the contact at each place of the master's edge."""
    texts = [SCENE.format(overhang=overhang, projection=projection, enforcement=enforcement) for overhang in OVERHANGS]
    return [step.contacts[0] for text in texts for step in Simulation(Scene.from_toml(text).problem()).run()]


@case(
    claim="Bodies that are apart bear nothing, however far the slave reaches beside its master and whatever signs its functions have.",
    tier="gate",
    grid={"projection": ("closest", "averaged"), "enforcement": ("mortar", "dual")},
    bounds={
        "active": Bound(at_most=0, reason="definition: bodies 0.009 apart"),
        "penetration": Bound(at_most=0.0, reason="definition: the same"),
        "force": Bound(at_most=1e-15, reason="round-off: nothing strains a body that moves as a whole; its modulus is 10, its size 1"),
        "beside": Bound(at_least=1, reason="definition: points of the slave have no foot in any of the runs"),
    },
)
def beside_the_master(projection: str, enforcement: str) -> dict[str, float]:
    """Worst over places of the master's edge."""
    contacts = hanging(projection, enforcement)
    return {
        "active": float(np.max([contact.active for contact in contacts])),
        "penetration": float(np.maximum(0.0, np.max([contact.gap for contact in contacts]))),
        "force": float(np.max(np.abs([contact.force_slave for contact in contacts]))),
        "beside": float(np.min([contact.excluded for contact in contacts])),
    }


@case(
    claim="Where a slave reaches beside its master the gap is told of what lies above it, or not at all.",
    tier="gate",
    grid={"enforcement": ("mortar", "dual")},
    bounds={
        "gap": Bound(at_most=1e-12, reason="round-off: of the distance"),
        "told": Bound(at_least=4, reason="definition: points lie above"),
    },
)
def gap_beside_the_master(enforcement: str) -> dict[str, float]:
    """Worst over places of the master's edge; averaged normals' gaps are those of all points of a function, and smaller."""
    gaps = [contact.gap[contact.gap != 0.0] for contact in hanging("closest", enforcement)]
    return {"gap": float(np.max(np.abs(np.concatenate(gaps) / -0.009 - 1.0))), "told": float(np.min([len(told) for told in gaps]))}
