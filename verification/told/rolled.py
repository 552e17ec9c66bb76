"""What is said of contact that pulls: of a slave that high friction rolls over its own edge, and of one that is behind its master."""

from __future__ import annotations

from told.runs import Heard
from told.wrong.runs import RUNS

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A block that sticks as it is dragged, and whose front edge turns under.
DRAGGED = """
format = 1
bodies.base = { geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 1, 0.6] }, mesh.elements = [5, 3, 2] }
bodies.block = { geometry = { kind = "box", lower = [0.3, 0.2, 0.6], upper = [0.9, 0.8, 1.2] }, mesh.elements = 3 }
contacts.c = { slave = "block.w0", master = "base.w1", friction = 5 }
supports = { base.face = "base.w0", hand.face = "block.w1" }
[[stages]]
name = "press"
steps = 2
motions.hand.translate = [0, 0, -0.05]
[[stages]]
name = "drag"
steps = 4
motions.hand.translate = [0.4, 0, 0]
"""
#: A body that is turned over, and one on the far side of its master.
BEHIND = [RUNS[name][0] for name in ("turned over and pushed through", "far side of the master")]
ROLLED, THROUGH = "has rolled over an edge of its own", "as if it had come through it from behind"


def heard(scene: str) -> str:
    """What is said of contact that pulls."""
    observer = Heard()
    list(Simulation(Scene.from_toml(scene).problem(), observer).run())
    return " ".join(said for said in observer.said if "pulls where" in said)


@case(
    claim="A slave that friction rolls over its own edge is told that, one that is behind its master that, and neither the other.",
    tier="gate",
    bounds={
        "rolled": Bound(1.0, 1.0, "definition: sentences on the block that is dragged that say it"),
        "behind": Bound(2.0, 2.0, "definition: sentences on two that are behind what they touch that say it"),
        "others": Bound(0.0, 0.0, "definition: those that say the other"),
    },
)
def rolled() -> dict[str, float]:
    """How many."""
    dragged, behind = heard(DRAGGED), " ".join(map(heard, BEHIND))
    return {
        "rolled": float(dragged.count(ROLLED)),
        "behind": float(behind.count(THROUGH)),
        "others": float(dragged.count(THROUGH) + behind.count(ROLLED)),
    }
