"""What is said of contact of bodies that have turned, or were squeezed, before it began: neither gives way to it."""

from __future__ import annotations

import re

from told.long_masters import CYLINDER
from told.narrow import STRIP
from told.runs import Heard

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

NARROW = re.compile("it is too narrow for its slave|elements of its slave .* are too long for its master")
#: A part of a cylinder on a block, which turn together before it is pressed in.
TURNED = CYLINDER.replace("stages = [{", "stages = [TURN{").replace("[0, 0, -0.05]", "WAY")
TURNED += "supports.foot.axis = [0, 1, 0]\nsupports.hand.axis = [0, 1, 0]\n"
TURN = '{ name = "turn", steps = 3, motions = { foot.rotate = 90, hand.rotate = 90 } }, '
#: A cylinder on a strip of no Poisson's ratio, whose sides are moved in before it is pressed in.
SQUEEZED = STRIP.replace("AT", "0").replace("poisson = 0.3", "poisson = 0").replace("elements = 8 }", "elements = [8, 1, 8] }")
SQUEEZED = SQUEEZED.replace("stages = [", "stages = [SQUEEZE")
SQUEEZED += """
supports.base.components = ["z"]
supports.left = { face = "a.u0", components = ["x"] }
supports.right = { face = "a.u1", components = ["x"] }
"""
SQUEEZE = '{ name = "squeeze", steps = 2, motions = { left.translate = [WAY, 0, 0], right.translate = [-WAY, 0, 0] } }, '
LONG = re.compile(r"elements of its master block.w1 are too long for it, .* too large by about (\d+) %")


def run(text: str) -> list[str]:
    """What is said in a run."""
    heard = Heard()
    list(Simulation(Scene.from_toml(text).problem(), heard).run())
    return heard.said


@case(
    claim="Elements of a master that are too long are told as well where bodies have turned far before: a turn is nothing that gives way.",
    tier="gate",
    bounds={
        "turned": Bound(at_most=0.11, reason="definition: what is told beside what is told without a turn, one digit of two; 1 is nothing"),
    },
)
def after_a_turn() -> dict[str, float]:
    """How far what is told is off."""
    text = TURNED.replace("ORDER", "2").replace("MANY", "3").replace("YOUNG", "100")
    still, turned = (
        [float(found[1]) for words in run(text.replace("TURN", turn).replace("WAY", way)) if (found := LONG.search(words))]
        for turn, way in (("", "[0, 0, -0.05]"), (TURN, "[-0.05, 0, 0]"))
    )
    return {"turned": abs(turned[0] / still[0] - 1.0) if turned and still else 1.0}


@case(
    claim="Narrow contact is told as well on a block that was squeezed along its face before: that is no bending.",
    tier="gate",
    grid={"way": (0.0, 0.2)},
    bounds={"said": Bound(1.0, 1.0, "definition: sentences of a contact that is too narrow")},
)
def squeezed_before(way: float) -> dict[str, float]:
    """How many."""
    said = run(SQUEEZED.replace("SQUEEZE", SQUEEZE if way else "").replace("WAY", str(way)))
    return {"said": float(sum(NARROW.search(words) is not None for words in said))}
