"""What is said of bodies that roll on few elements, whose friction builds up where there is none, against drags of finer ones."""

from __future__ import annotations

import re

import numpy as np
from told.runs import Heard

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A ring that is pressed on a plane, then rolled along it by as much as its hub turns on a radius that is a fiftieth smaller.
RING = """
format = 1
bodies.r.geometry = { kind = "ring", centre = [0, 0, 0.5], inner = 0.2, outer = 0.5, width = 0.3 }
bodies.r.mesh = { order = 2, elements = [12, 1, 1] }
contacts.c = { slave = "r.v1", plane = { tangent = [1, 1, 0] }, friction = 0.3 }
supports.hub = { face = "r.v0", centre = [0, 0, 0.5], axis = [0, 1, 0] }
[[stages]]
name = "press"
steps = 3
motions.hub.translate = [0, 0, -0.04]
[[stages]]
name = "roll"
steps = 9
motions.hub = { translate = [0.77, 0, 0], rotate = 90 }
"""
#: A block in place of the plane.
ON_A_BLOCK = RING.replace("plane = { tangent = [1, 1, 0] }", 'master = "b.w1"').replace(
    "supports.hub",
    """bodies.b.geometry = { kind = "box", lower = [-0.4, -0.3, -0.3], upper = [1.2, 0.3, 0] }
bodies.b.mesh = { order = [2, 1, 1], elements = [12, 1, 1] }
supports.base.face = "b.w0"
supports.hub""",
)
ROLLS = re.compile(
    r"contact 'c', load step (\d+): it rolls on elements of its slave r\.v1 that are too long for its friction, or by load steps that are: "
    r"control points stick in the mean of all that they reach, and what presses creeps\. Drag and moments may be off by about (\S+) % of "
    r"what friction bears\. Take twice as many elements or more along its way \(bodies\.r\.mesh\.elements\), and twice as many load steps"
)
Changes = tuple[str, ...]


def said(text: str, changes: Changes = ()) -> tuple[list[re.Match[str]], np.ndarray]:
    """What is said of rolling in a run, and drag over what friction bears, by load steps that roll."""
    heard = Heard()
    problem = Scene.from_toml(text, overrides=changes).problem()
    forces = np.array([result.reactions[-1].force for result in Simulation(problem, heard).run()])[3:]
    friction = problem.contacts[0].friction or 1.0
    return [found for words in heard.said if (found := ROLLS.search(words))], forces[:, 0] / (friction * np.abs(forces[:, 2]))


def elements(around: int) -> str:
    """A change of the ring's."""
    return f"bodies.r.mesh.elements=[{around}, 1, 1]"


#: Rings that roll on too few elements.
FEW: dict[str, tuple[str, Changes]] = {"on a plane": (RING, ()), "on a block": (ON_A_BLOCK, (elements(8),))}


@case(
    claim="A ring that rolls on few elements is told, once, to have a drag that is off by a share of what friction bears, by about as much "
    "as it is at the worst; of one by more elements nothing is said.",
    tier="gate",
    grid={"scene": tuple(FEW)},
    bounds={
        "said": Bound(1.0, 1.0, "definition: sentences of the coarse ring"),
        "off": Bound(at_least=0.25, reason="definition: at the worst, of what friction bears: or there is nothing to tell of"),
        "told over off": Bound(at_least=0.5, at_most=2.0, reason="definition: an estimate, of which the size counts"),
        "others": Bound(0.0, 0.0, "definition: sentences of the fine ring"),
        "left": Bound(at_most=0.2, reason="definition: its drag, of what friction bears, which is next to nothing: less than is told"),
    },
)
def few_elements(scene: str) -> dict[str, float]:
    """What is said of a coarse ring and of a finer one, and what their drags are."""
    text, changes = FEW[scene]
    found, coarse = said(text, changes)
    others, fine = said(text, (elements(24),))
    off = float(np.abs(coarse - fine.mean()).max())
    return {
        "said": float(len(found)),
        "off": off,
        "told over off": 0.01 * float(found[0][2]) / off if found else 0.0,
        "others": float(len(others)),
        "left": float(np.abs(fine).max()),
    }


#: Changes of the coarse ring by which nothing rolls, or nothing sticks in the mean.
NOTHING_ROLLS: dict[str, Changes] = {
    "dragged": ("stages.roll.motions.hub={ translate = [0.2, 0, 0] }",),
    "sticks": ("stages.roll.motions.hub={ translate = [0.005, 0, 0] }",),
    "skids": ("stages.roll.motions.hub={ rotate = 90 }",),
    "without friction": ("contacts.c.friction=0",),
    "points": ('contacts.c.enforcement="greville"',),
    "elastic slips": ("contacts.c.elastic_slip=0.02",),
    "not a width": ("stages.roll.steps=5", "stages.roll.motions.hub={ translate = [0.428, 0, 0], rotate = 50 }"),
}


@case(
    claim="Nothing is said of rings that are dragged, stick or skid, have no friction or have hardly rolled, nor of constraints at points, "
    "which have each slip as it is, or slips that are elastic.",
    tier="gate",
    grid={"scene": tuple(NOTHING_ROLLS)},
    bounds={"said": Bound(0.0, 0.0, "definition: sentences")},
)
def nothing_rolls(scene: str) -> dict[str, float]:
    """What is."""
    return {"said": float(len(said(RING, NOTHING_ROLLS[scene])[0]))}
