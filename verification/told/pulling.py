"""What is said of contact whose pressures have both signs between control points, as dual functions make them: not that it pulls."""

from __future__ import annotations

from told.runs import Heard

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A cap that is pressed onto a block.
SCENE = """
format = 1
bodies.cap.geometry = { kind = "cap", radius = 1, half_width = 0.5, bottom = 0, top = 0.8 }
bodies.cap.mesh = { order = ORDER, elements = [4, 4, 1] }
bodies.block.geometry = { kind = "box", lower = [-0.6, -0.6, -0.5], upper = [0.6, 0.6, 0] }
bodies.block.mesh = { order = 2, elements = [3, 3, 1] }
contacts.c = { slave = "cap.w0", master = "block.w1", friction = 0, enforcement = "METHOD" }
supports = { hand.face = "cap.w1", foot.face = "block.w0" }
stages = [{ name = "press", steps = 1, motions.hand.translate = [0, 0, -0.05] }]
"""


@case(
    claim="Of a cap that is pressed onto a block it is not said that it pulls, whatever functions, of one sign or both, keep it out.",
    tier="gate",
    grid={"enforcement": ("mortar", "dual", "greville"), "order": (2, 3)},
    bounds={
        "said": Bound(0.0, 0.0, "definition: warnings that it pulls"),
        "pressed": Bound(at_least=1e-3, reason="definition: the force that presses"),
    },
)
def pressed_by_both_signs(enforcement: str, order: int) -> dict[str, float]:
    """How many warnings say so, and the force."""
    heard, scene = Heard(), Scene.from_toml(SCENE.replace("METHOD", enforcement).replace("ORDER", str(order)))
    *_, last = Simulation(scene.problem(), heard).run()
    return {"said": float(sum("it pulls" in said for said in heard.said)), "pressed": float(last.contacts[0].force_slave[2])}
