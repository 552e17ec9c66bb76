"""What is said of bodies that deform into each other, with no contact between them."""

from __future__ import annotations

import re

from told.runs import Heard

from isomortar.harness import Bound, case
from isomortar.march.outlook import outlook
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A beam that a pressure bends towards a block below its end; a first look moves bodies as they are, and sees nothing.
SCENE = """
format = 1
materials.soft = { young = 10, poisson = 0.3 }
bodies.beam = { geometry = { kind = "box", lower = [0, 0, 0.2], upper = [4, 1, 0.6] }, mesh = { order = 2, elements = [6, 1, 1] } }
bodies.block = { geometry = { kind = "box", lower = [3, 0, -1], upper = [4, 1, LEVEL] }, mesh.elements = [1, 1, 1] }
supports = { wall.face = "beam.u0", base.face = "block.w0" }
loads.weight = { face = "beam.w1", pressure = 0.001 }
stages = [{ name = "bend", steps = 1 }, { name = "hold", steps = 1 }]
"""
TOLD = re.compile(r"bodies '(\w+)' and '(\w+)' are in each other at the end of stage '(\w+)', by (\S+), and no contact is between")
_ONCE = [("beam", "block", "bend")]
#: How high the block is, what else is in the scene, and what is to be said.
SCENES = {
    "into it": ("0", (), _ONCE),
    "other first": ("0", ("swap",), [("block", "beam", "bend")]),
    "far below": ("-0.9", (), []),
    "by a fiftieth of the smaller": ("-0.35", (), _ONCE),
    "by less than a hundredth of it": ("-0.363", (), []),
    "in contact": ("0", ('contacts={c={slave="beam.w0",master="block.w1"}}',), []),
    "the other way": ("0", ("loads.weight.pressure=-0.001",), []),
    "in the second stage": ("0", ("stages.bend.loads={weight=0}", "stages.hold.loads={weight=1}"), [("beam", "block", "hold")]),
    "from the start": ("0.3", (), []),
    "to be rigid": ("0", ("bodies.block.rigid=true",), _ONCE),
    "two orders": (
        "0",
        ('contacts={c={slave="beam.w1",plane={point=[0,0,1],normal=[0,0,-1]}}}', "bodies.beam.mesh.contact_order=3"),
        _ONCE,
    ),
}


def before_the_end() -> float:
    """How often it is told of before the last load step of a stage of four, where bodies are in each other from the third on."""
    heard, said = Heard(), list[int]()
    text = SCENE.replace("LEVEL", "0").replace('"bend", steps = 1', '"bend", steps = 4')
    for _ in Simulation(Scene.from_toml(text).problem(), heard).run():
        said.append(sum(TOLD.search(words) is not None for words in heard.said))
    return float(said[2])


def told(level: str, changes: tuple[str, ...]) -> list[tuple[str, str, str]]:
    """Bodies and stages that are told of in a run."""
    text = SCENE.replace("LEVEL", level)
    if changes == ("swap",):
        lines = text.split("\n")
        text, changes = "\n".join([*lines[:3], lines[4], lines[3], *lines[5:]]), ()
    heard = Heard()
    list(Simulation(Scene.from_toml(text, overrides=changes).problem(), heard).run())
    return [(found[1], found[2], found[3]) for said in heard.said if (found := TOLD.search(said))]


@case(
    claim="Bodies that come into each other as they deform, neither in contact nor glued, are told of at the end of the stage, once; "
    "others are not.",
    tier="gate",
    bounds={
        "others": Bound(0.0, 0.0, "definition: scenes of which something else is said"),
        "early": Bound(0.0, 0.0, "definition: sentences before the end of a stage"),
    },
)
def passing() -> dict[str, float]:
    """How many of eleven, and in a stage of several load steps."""
    others = [name for name, (level, changes, said) in SCENES.items() if told(level, changes) != said]
    return {"others": float(len(others)), "early": before_the_end()}


#: Two blocks that are pressed together on both sides of a thin sheet, by more than that is thick.
SHEET = """
format = 1
bodies.sheet = { geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 2, THICK] }, mesh.elements = [4, 4, 1] }
bodies.upper = { geometry = { kind = "box", lower = [0.5, 0.5, THICK], upper = [1.5, 1.5, 1] }, mesh.elements = 3 }
bodies.lower = { geometry = { kind = "box", lower = [0.5, 0.5, -1], upper = [1.5, 1.5, 0] }, mesh.elements = 3 }
contacts.above = { slave = "upper.w0", master = "sheet.w1" }
contacts.below = { slave = "lower.w1", master = "sheet.w0" }
supports = { foot.face = "lower.w0", hand.face = "upper.w1" }
stages = [{ name = "press", steps = 2, motions.hand.translate = [0, 0, -0.1] }]
"""
#: Two blocks on a table, one of which is pressed onto that and drawn into the other.
NEIGHBOURS = """
format = 1
bodies.table = { geometry = { kind = "box", lower = [0, 0, -1], upper = [3, 1, 0] }, mesh.elements = [6, 2, 2] }
bodies.left = { geometry = { kind = "box", lower = [0.2, 0, 0], upper = [1.2, 1, 1] }, mesh.elements = 2 }
bodies.right = { geometry = { kind = "box", lower = [1.3, 0, 0], upper = [2.3, 1, 1] }, mesh.elements = 2 }
contacts = { one = { slave = "left.w0", master = "table.w1" }, two = { slave = "right.w0", master = "table.w1" } }
supports = { foot.face = "table.w0", hand.face = "left.w1", hold.face = "right.w1" }
stages = [{ name = "draw", steps = 4, motions.hand.translate = [0.4, 0, -0.02] }]
"""


@case(
    claim="Blocks that a thin sheet keeps apart are not said to meet, though they go farther than that is thick; of two blocks on one "
    "table, of which one is drawn into the other, that is said.",
    tier="gate",
    grid={"thick": (0.02, 0.05, 0.1)},
    bounds={
        "kept apart": Bound(0.0, 0.0, "definition: sentences on blocks beside a sheet, before the run and in it"),
        "into each other": Bound(1.0, 1.0, "definition: sentences on those on a table, before the run"),
    },
)
def keeps_apart(thick: float) -> dict[str, float]:
    """How many."""
    heard = Heard()
    list(Simulation(Scene.from_toml(SHEET.replace("THICK", str(thick))).problem(), heard).run())
    warnings = outlook(Scene.from_toml(NEIGHBOURS).problem()).warnings
    words = "nothing keeps them apart"
    return {
        "kept apart": float(sum(words in said for said in heard.said)),
        "into each other": float(sum(words in said for said in warnings)),
    }
