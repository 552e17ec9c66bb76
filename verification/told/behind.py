"""What is said of bodies that come behind a rigid plane with faces that are not in contact with it."""

from __future__ import annotations

import re

from told.runs import Heard

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: Two blocks that are pressed onto a floor, which the first one alone is in contact with.
SCENE = """
format = 1
materials.soft = { young = 10, poisson = 0.3 }
bodies.a = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh.elements = [2, 2, 1] }
bodies.b = { geometry = { kind = "box", lower = [2, 0, 0], upper = [3, 1, 1] }, mesh.elements = [2, 2, 1] }
contacts.floor = { slave = "a.w0", plane = {} }
supports = { a.face = "a.w1", b.face = "b.w1" }
stages = [{ name = "press", steps = 1 }, { name = "more", steps = 1 }]
"""
DOWN = "stages.press.motions={a.translate=[0,0,-0.05],b.translate=[0,0,-0.05]}"
TOLD = re.compile(
    r"body '(\w+)' is behind the plane of contact '(\w+)' at the end of stage '(\w+)', by (\S+), and nothing keeps its face (\S+)"
)
_B = [("b", "floor", "press", "0.05", "b.w0")]
#: What is replaced in the scene, what is changed beside, and what is to be said.
SCENES = {
    "a face without contact": ("", "", (DOWN,), _B),
    "in the second stage": ("", "", (DOWN.replace("press", "more"),), [("b", "floor", "more", "0.05", "b.w0")]),
    "both in contact": ("plane = {} }", 'plane = {} }\ncontacts.also = { slave = "b.w0", plane = {} }', (DOWN,), []),
    "both in contact, one with a lower one": (
        "plane = {} }",
        'plane = {} }\ncontacts.also = { slave = "b.w0", plane = { point = [0, 0, -0.02] } }',
        (DOWN,),
        [],
    ),
    "in contact with a wall": (
        "plane = {} }",
        'plane = {} }\ncontacts.also = { slave = "b.u0", plane = { point = [2, 0, 0], normal = [1, 0, 0] } }',
        (DOWN,),
        _B,
    ),
    "behind from the start": ("[2, 0, 0], upper = [3, 1, 1]", "[2, 0, -2], upper = [3, 1, -1]", (DOWN,), []),
    "by less than it is seen": ("", "", (DOWN.replace("b.translate=[0,0,-0.05]", "b.translate=[0,0,-0.009]"),), []),
    "away from it": ("", "", (DOWN.replace("b.translate=[0,0,-0.05]", "b.translate=[0,0,0.05]"),), []),
    "a side": (
        "",
        "",
        ("stages.press.motions={a.rotate=-30,a.translate=[0,0,-0.05]}", "supports.a.axis=[0,1,0]", "supports.a.centre=[0,0,1]"),
        [],
    ),
    "rigid": ("mesh.elements = [2, 2, 1] }\ncontacts", "rigid = true }\ncontacts", (DOWN,), _B),
}


def told(old: str, new: str, changes: tuple[str, ...]) -> list[tuple[str, ...]]:
    """Bodies, planes, stages, depths and faces that are told of in a run."""
    heard = Heard()
    list(Simulation(Scene.from_toml(SCENE.replace(old, new) if old else SCENE, overrides=changes).problem(), heard).run())
    return [found.groups() for said in heard.said if (found := TOLD.search(said))]


@case(
    claim="Bodies that come behind a plane which they were in front of, with a face that has no contact with it, are told of at the end of "
    "the stage, once, with the face and the depth; others are not.",
    tier="gate",
    bounds={"others": Bound(0.0, 0.0, "definition: scenes of which something else is said")},
)
def behind() -> dict[str, float]:
    """How many of ten."""
    return {"others": float(len([name for name, (old, new, changes, said) in SCENES.items() if told(old, new, changes) != said]))}
