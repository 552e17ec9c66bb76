"""What is said of friction that counts by the area in contact, on few elements, against forces of finer slaves."""

from __future__ import annotations

import functools
import re

from told.runs import Heard

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: Half of a soft ball on a plane, pressed and dragged from above.
BALL = """
format = 1
symmetry = { y = 0.0 }
materials.m = { young = 10, poisson = 0.3 }
bodies.a.geometry = { kind = "cap", half_width = 0.5, radius = 1, bottom = 0, top = 0.6 }
bodies.a.mesh = { order = 2, elements = [6, 6, 2] }
contacts.c = { slave = "a.w0", plane = {}, friction = 0.3, traction_max = 0.1 }
supports.top.face = "a.w1"
[[stages]]
name = "press"
steps = 1
motions.top.translate = [0, 0, -0.08]
[[stages]]
name = "drag"
steps = 1
motions.top.translate = [0.3, 0, 0]
"""
#: A stage more, in which it slides on as before.
ON = """
[[stages]]
name = "on"
steps = 1
motions.top.translate = [0.1, 0, 0]
"""
ON_AREAS = re.compile(
    r"contact 'c', load step (\d+): its (?:cohesion|traction_max|cohesion and traction_max) counts by the area under pressure, which "
    r"elements of its slave a\.w0 are too long to tell: friction may be too small by about (\S+) %\. Take twice as many elements or more "
    r"along u and v \(bodies\.a\.mesh\.elements\)"
)
Changes = tuple[str, ...]
#: A cohesion beside a largest traction, and a block in the place of the ball.
BOTH: Changes = ("contacts.c.cohesion=0.05", "contacts.c.traction_max=0.2")
FLAT = 'bodies.a.geometry={ kind = "box", lower = [-0.5, -0.5, 0], upper = [0.5, 0.5, 0.6] }'


def said(changes: Changes = (), more: str = "") -> tuple[list[re.Match[str]], float]:
    """What is said of areas in a run, and the force that drags at its end."""
    heard = Heard()
    *_, last = Simulation(Scene.from_toml(BALL + more, overrides=changes).problem(), heard).run()
    return [found for words in heard.said if (found := ON_AREAS.search(words))], abs(float(last.contacts[0].force_slave[0]))


def elements(across: int) -> str:
    """A change of the slave's."""
    return f"bodies.a.mesh.elements=[{across}, {across}, 2]"


@functools.cache
def fine(changes: Changes) -> tuple[int, float]:
    """Sentences, and the force, of a finer slave."""
    found, force = said((*changes, elements(18)))
    return len(found), force


#: Changes of a scene, also of the finer one, and a number of elements across.
COARSE: dict[str, tuple[Changes, int]] = {"largest traction": ((), 6), "and cohesion": (BOTH, 8)}


@case(
    claim="Friction up to a cohesion or a largest traction, of contact on few elements, is told to be too small, once and as it slides, by "
    "about as much as it is; of a finer slave nothing is said.",
    tier="gate",
    grid={"scene": tuple(COARSE)},
    bounds={
        "said": Bound(1.0, 1.0, "definition: sentences of the coarse slave"),
        "step": Bound(2.0, 2.0, "definition: the load step that drags it"),
        "off": Bound(at_least=0.1, reason="definition: share of the friction that is missing: or there is nothing to tell of"),
        "told over off": Bound(at_least=0.6, at_most=1.7, reason="definition: an estimate, of which the first digit counts"),
        "others": Bound(0.0, 0.0, "definition: sentences of the fine slave"),
    },
)
def friction(scene: str) -> dict[str, float]:
    """What is said of a coarse slave and of a fine one, and what the coarse one's friction lacks."""
    changes, across = COARSE[scene]
    found, force = said((*changes, elements(across)), ON)
    others, whole = fine(changes)
    off = 1.0 - force / whole
    return {
        "said": float(len(found)),
        "step": float(found[0][1]) if found else 0.0,
        "off": off,
        "told over off": 0.01 * float(found[0][2]) / off if found else 0.0,
        "others": float(others),
    }


#: Changes of the scene by which all of the friction is there, or none as a whole.
NOTHING_LACKS: dict[str, Changes] = {
    "flat": (FLAT,),
    "along an edge": (
        FLAT,
        "bodies.a.mesh.elements=[12, 2, 2]",
        "contacts.c.plane={ normal = [0.0871557, 0, 0.9961947], point = [-0.5, 0, 0] }",
        "contacts.c.traction_max=0.05",
        "stages.press.motions.top.translate=[0, 0, -0.005]",
        "stages.drag.motions.top.translate=[-0.1, 0, 0.00875]",
    ),
    "pressed": ("stages.drag.motions.top.translate=[0, 0, -0.01]",),
    "sticks": ("stages.drag.motions.top.translate=[0.0001, 0, 0]",),
    "never at its largest": ("contacts.c.traction_max=2",),
    "points": ('contacts.c.enforcement="greville"',),
}


@case(
    claim="Nothing is said of areas that end where their slaves do, of blocks on an edge, of what slips to all sides or sticks, of "
    "tractions below their largest, nor of constraints at points.",
    tier="gate",
    grid={"scene": tuple(NOTHING_LACKS)},
    bounds={"said": Bound(0.0, 0.0, "definition: sentences")},
)
def nothing_lacks(scene: str) -> dict[str, float]:
    """What is."""
    return {"said": float(len(said(NOTHING_LACKS[scene])[0]))}
