"""When a first look says that slave and master should be exchanged: where edges of the master bear within the slave's face."""

from __future__ import annotations

import re

from isomortar.harness import Bound, case
from isomortar.march.outlook import outlook
from isomortar.scene import Scene

SCENE = """
format = 1
bodies.plate.geometry = { kind = "box", lower = [-1, -1, -0.5], upper = [1, 1, 0] }
bodies.plate.mesh = { order = [2, 2, 1], elements = [5, 6, 1] }
bodies.punch = { geometry = PUNCH, mesh = { elements = [3, 2, 1] } }
contacts.c = { slave = "plate.w1", master = "punch.w0" }
supports = { plate.face = "plate.w0", punch.face = "punch.w1" }
stages = [{ name = "press", steps = 1, motions.punch.translate = [0, 0, -0.02] }]
"""
FLAT = '{ kind = "box", lower = [-0.4, -0.3, 0], upper = [0.4, 0.3, 0.5] }'
ROUND = ('contacts.c.master="punch.v1"', 'supports.punch.face="punch.v0"', "bodies.punch.mesh.elements=[8,1,2]")
#: Punches, and what else is changed: the plate's edges go on beyond those of the punch, which bear.
TOLD = {
    "flat": (FLAT, ()),
    "edges on lines of the plate": (FLAT.replace("0.3", "0.5"), ("bodies.plate.mesh.elements=[4,4,1]",)),
    "a little apart": (FLAT.replace("0.3, 0]", "0.3, 0.01]"), ()),
    "farther apart": (FLAT.replace("0.3, 0]", "0.3, 0.1]"), ()),
    "overlapping": (FLAT.replace("0.3, 0]", "0.3, -0.01]"), ()),
    "along averaged normals": (FLAT, ('contacts.c.projection="averaged"',)),
    "by dual functions": (FLAT, ('contacts.c.enforcement="dual"',)),
    "over one edge": (FLAT.replace("upper = [0.4, 0.3", "upper = [1, 1"), ()),
    "of linear elements": (FLAT, ("bodies.punch.mesh.order=1", 'bodies.punch.mesh.family="L"')),
    "of a short roll": ('{ kind = "ring", centre = [0, 0, 0.4], inner = 0.2, outer = 0.4, width = 0.6 }', ROUND),
}
_ACROSS = FLAT.replace("lower = [-0.4", "lower = [-1.5").replace("upper = [0.4", "upper = [1.5")
#: Nothing bears at an edge, an exchange does not help, or there is nothing to exchange.
QUIET = {
    "round": ('{ kind = "bowl", half_width = 0.4, bottom = 0, rise = 0.1, top = 0.5 }', ()),
    "as wide as the plate": ('{ kind = "box", lower = [-1, -1, 0], upper = [1, 1, 0.5] }', ()),
    "wider": ('{ kind = "box", lower = [-1.2, -1.2, 0], upper = [1.2, 1.2, 0.5] }', ()),
    "across each other": (_ACROSS, ()),
    "as the slave": (FLAT, ('contacts.c.slave="punch.w0"', 'contacts.c.master="plate.w1"')),
    "rigid": (FLAT, ("bodies.punch.rigid=true",)),
    "round its axis": ('{ kind = "ring", centre = [0, 0, 0.4], inner = 0.2, outer = 0.4, width = 2.4 }', ROUND),
    "of a ball": ('{ kind = "sphere", centre = [0, 0, 0.4], inner = 0.2, outer = 0.4, latitudes = [-90, -20] }', ROUND),
}


#: Another contact, of the same faces the other way round.
BOTH_WAYS = 'contacts.d = { slave = "punch.w0", master = "plate.w1" }\n'
#: Two blocks on the plate, which are joined, or are not, each in a contact of its own.
GLUE = 'glue = [["one.u1", "other.u0"]]\n'
HALVES = f"""
format = 1
{GLUE}bodies.plate.geometry = {{ kind = "box", lower = [-1, -1, -0.5], upper = [1, 1, 0] }}
bodies.plate.mesh = {{ order = [2, 2, 1], elements = [5, 6, 1] }}
bodies.one.geometry = {{ kind = "box", lower = [-0.4, -0.3, 0], upper = [0, 0.3, 0.5] }}
bodies.one.mesh.elements = [2, 2, 1]
bodies.other.geometry = {{ kind = "box", lower = [0, -0.3, 0], upper = [0.4, 0.3, 0.5] }}
bodies.other.mesh.elements = [2, 2, 1]
contacts.one = {{ slave = "plate.w1", master = "one.w0" }}
contacts.other = {{ slave = "plate.w1", master = "other.w0" }}
supports = {{ plate.face = "plate.w0", one.face = "one.w1", other.face = "other.w1" }}
stages = [{{ name = "press", steps = 1, motions = {{ one.translate = [0, 0, -0.02], other.translate = [0, 0, -0.02] }} }}]
"""
JOINED = 'remove contact \'other\': contacts.one.master = ["one.w0", "other.w0"]'


def told(punch: str, changes: tuple[str, ...], more: str = "") -> list[tuple[str, str]]:
    """Faces that are told to end within others, and these."""
    warnings = outlook(Scene.from_toml(SCENE.replace("PUNCH", punch) + more, overrides=changes).problem()).warnings
    return [words for warning in warnings for words in re.findall(r"Exchange the two: (.*) ends within (.*)$", warning)]


@case(
    claim="A first look says that slave and master should be exchanged where the slave goes on beyond edges of its master that bear, and "
    "would not the other way round; else it does not.",
    tier="gate",
    bounds={
        "silent": Bound(0.0, 0.0, "definition: scenes of which it is to be said, and is not, once, with the faces"),
        "doubted": Bound(0.0, 0.0, "definition: scenes of which it is not to be said"),
    },
)
def exchanged() -> dict[str, float]:
    """How many of each kind."""
    silent = [name for name, scene in TOLD.items() if told(*scene) != [("punch.v1" if ROUND in scene else "punch.w0", "plate.w1")]]
    doubted = [name for name, scene in QUIET.items() if told(*scene)]
    doubted += ["both ways"] if told(FLAT, (), BOTH_WAYS) else []
    return {"silent": float(len(silent)), "doubted": float(len(doubted))}


@case(
    claim="Where a master goes on in that of another contact of the slave, with the same friction, a first look says that one contact has "
    "both; else it does not.",
    tier="gate",
    grid={"changes": ("joined", "apart", "of other friction")},
    bounds={"off": Bound(0.0, 0.0, "definition: whether the other is said than should be")},
)
def masters_joined(changes: str) -> dict[str, float]:
    """Whether it is."""
    overrides = {"joined": [], "apart": ["glue=[]"], "of other friction": ["contacts.other.friction=0.1"]}[changes]
    warnings = outlook(Scene.from_toml(HALVES, overrides=overrides).problem()).warnings
    return {"off": float(any(JOINED in warning for warning in warnings) != (changes == "joined"))}
