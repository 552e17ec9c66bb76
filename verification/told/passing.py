"""What is said of bodies that deform into each other, with no contact between them."""

from __future__ import annotations

import re

from told.runs import Heard

from isomortar.harness import Bound, case
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
    "by a twentieth of the thinner one": ("-0.35", (), _ONCE),
    "by a fiftieth of the thinner one": ("-0.365", (), _ONCE),
    "by less than a hundredth of it": ("-0.371", (), []),
    "thin ones that cross": (
        "0",
        (
            "bodies.beam.geometry.upper=[4,1,0.24]",
            "bodies.beam.mesh.order=3",
            'bodies.block.geometry={kind="box",lower=[3,-1,-0.02],upper=[3.04,2,0.16]}',
            "bodies.block.mesh.elements=[1,4,2]",
            "loads.weight.pressure=4e-7",
        ),
        _ONCE,
    ),
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
    """How many of thirteen, and in a stage of several load steps."""
    others = [name for name, (level, changes, said) in SCENES.items() if told(level, changes) != said]
    return {"others": float(len(others)), "early": before_the_end()}
