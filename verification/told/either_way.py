"""Doubts beside their limits: on one side of each something is said, and on the other side nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from told.wrong.doubts import DOUBTFUL
from transforms import with_patches

from isomortar.harness import Bound, case
from isomortar.march.outlook import outlook
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.told.before.doubts import doubts

#: A block on a block.
SCENE = """
format = 1
bodies.above.geometry = { kind = "box", lower = [-0.25, -0.25, 0], upper = [0.25, 0.25, 0.5] }
bodies.above.mesh = { order = 2, elements = [4, 2, 2] }
bodies.below.geometry = { kind = "box", lower = [-1, -1, -0.5], upper = [1, 1, 0] }
bodies.below.mesh = { order = 2, elements = [4, 4, 1] }
contacts.c = { slave = "above.w0", master = "below.w1", friction = 0.3 }
supports.top.face = "above.w1"
supports.base.face = "below.w0"
stages = [{ name = "one", steps = 10, motions.top = { translate = [0, 0, -0.02] } }]
"""
#: A small body wholly inside the lower block, or beside it, from some x and y on.
THIRD = """
[bodies.third]
geometry = {{ kind = "box", lower = [{x}, {x}, -1.6], upper = [{end}, {end}, -1.4] }}
mesh = {{ order = 1 }}
[supports.third]
face = "third.w1"
"""
#: A ball with its poles along an axis in the place of the upper block.
_BOX = 'kind = "box", lower = [-0.25, -0.25, 0], upper = [0.25, 0.25, 0.5]'
_BALL = 'kind = "sphere", centre = [0, 0, 0.5], inner = 0.1, outer = 0.5, axis = "AXIS"'
BALL = (
    SCENE.replace(_BOX, _BALL).replace("supports.top", "supports.hub").replace("above.w1", "above.v0").replace("motions.top", "motions.hub")
)
_DEEP = ("bodies.below.geometry.lower=[-1,-1,-3]",)
_MASTER = 'contacts.c={slave="below.w1",master="above.v1",friction=0.3}'


def third(x: float) -> str:
    """The scene with the small body."""
    return SCENE + THIRD.format(x=x, end=x + 0.2)


#: The blocks, and a slanting plane that goes through the lower one and is in the upper one's way.
SLANTING = SCENE.replace(
    "supports.top.face",
    'contacts.floor = { slave = "above.w0", plane = { point = [0, 0, -0.05], normal = [0.1, 0, 1] }, friction = 0.3 }\nsupports.top.face',
)
#: The blocks in a stage more, in which nothing moves; a support of one of both.
RESTING = SCENE.replace("stages = [", 'supports.side = { face = "below.u0", stages = ["one"] }\nstages = [')
RESTING = RESTING.replace("} }]", '} }, { name = "two", steps = 2 }]')
#: A scene, what is changed in it, and words of what is said of it; none: nothing is said.
SAID = (
    (SCENE, ("bodies.above.mesh.quadrature=[2,2,2]",), ""),
    (SCENE, ("bodies.above.mesh.quadrature=[2,2,1]",), "Gauss points an element do not see"),
    (SCENE, ("contacts.c.quadrature=[3,3]",), ""),
    (SCENE, ("contacts.c.quadrature=[3,2]",), "quadrature points an element do not tell its functions apart"),
    (SCENE, ('loads={wind={face="below.u0",pressure=0.001}}',), ""),
    (SCENE, ('loads={wind={face="below.w1",pressure=0.001}}',), "a face of contact 'c'"),
    (SCENE, ('loads={wind={face="above.w0",pressure=0.001}}',), "a face of contact 'c'"),
    (SCENE, ('loads={own={body="above",weight=[0,0,-9]}}',), ""),
    (SCENE, ('loads={own={body="above",weight=[0,0,-11]}}',), "times the size of its body, 0.5, comes to 5.5 force per area"),
    (SCENE, ('loads={wind={face="above.u0",pressure=4.9}}',), ""),
    (SCENE, ('loads={wind={face="above.u0",pressure=5.1}}',), "comes to 5.1 force per area"),
    (SLANTING, (), ""),
    (SLANTING, ("contacts.floor.plane={point=[0,0,0],normal=[0,0,1]}",), "is at or behind the plane"),
    (RESTING, (), ""),
    (RESTING, ("supports.side.stages=['two']",), ""),
    (RESTING, ("supports.side.stages=['one','two']",), "compute the same state again"),
    (third(0.3), _DEEP, "bodies 'below' and 'third' meet"),
    (third(1.2), _DEEP, "is in no contact"),
    (BALL.replace("AXIS", "z"), ('contacts.c.slave="above.v1"',), ""),
    (BALL.replace("AXIS", "z"), (_MASTER,), "has a pole"),
    (BALL.replace("AXIS", "y"), (_MASTER, "stages.one.motions.hub.rotate=3"), "has a pole"),
    (BALL.replace("AXIS", "y"), (_MASTER, "stages.one.motions.hub.rotate=3", "bodies.above.mesh.elements=[4,2,4]"), ""),
)


def wrong(scene: str, changes: tuple[str, ...], words: str) -> bool:
    """Whether something else is said than one sentence with these words, or, where there are none, nothing."""
    warnings = outlook(Scene.from_toml(scene, overrides=changes).problem()).warnings
    return len(warnings) != bool(words) or any(words not in warning for warning in warnings)


def slanting(share: float) -> float:
    """Whether half a model is taken for one with its bodies slanting, by a share of x, from the plane where they end."""
    text, old, new, words = DOUBTFUL["half a model"]
    slant = np.array([[1.0, 0.0, share], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    problem = with_patches(
        Scene.from_toml(text.replace(old, new)).problem(), lambda patch: replace(patch, control_points=patch.control_points @ slant)
    )
    return float(any(words in warning for warning in outlook(problem).warnings))


@case(
    claim="Bodies that end at one plane are taken for halves where they come to it at right angles; not where they slant, up or down.",
    tier="gate",
    grid={"share": (-0.2, 0.0, 0.2)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: halves that are not taken for such, or what is none that is")},
)
def as_halves(share: float) -> dict[str, float]:
    """Whether it is wrong."""
    return {"wrong": abs(slanting(share) - float(share == 0.0))}


@case(
    claim="What is right is not doubted, and what is wrong is: numbers of points, loads, planes in the way, and bodies that meet "
    "without a contact.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: scenes of which something else is said")},
)
def doubted() -> dict[str, float]:
    """How many."""
    return {"wrong": float(sum(wrong(*scene) for scene in SAID))}


#: What is changed of the upper block's elements, and words of what is said where it deforms.
OF_ELEMENTS = (
    (("bodies.above.geometry.upper=[0.25,0.25,1e6]", "bodies.above.mesh={order=7,elements=1}"), "round-off of its positions"),
    (("bodies.above.mesh.elements=[45,2,2]",), "take fewer along u"),
)


@case(
    claim="What elements do as they deform is said of bodies that deform, and not of rigid ones.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: sentences on rigid bodies, or none on others")},
)
def of_rigid_bodies() -> dict[str, float]:
    """How many."""
    wrong = 0
    for changes, words in OF_ELEMENTS:
        for rigid in (False, True):
            scene = Scene.from_toml(SCENE, overrides=(*changes, f"bodies.above.rigid={str(rigid).lower()}"))
            wrong += any(words in warning for warning in outlook(scene.problem()).warnings) == rigid
    return {"wrong": float(wrong)}


#: The blocks with a material for each.
OF_TWO = SCENE.replace("format = 1", "format = 1\nmaterials = { soft = { young = 1 }, hard = { young = 1 } }")
OF_TWO = OF_TWO.replace("bodies.above.mesh", 'bodies.above.material = "soft"\nbodies.below.material = "hard"\nbodies.above.mesh')
#: What is changed, a number on either side of a limit, of which the second is doubted, and words of that.
LIMITS: tuple[tuple[str, float, float, str], ...] = (
    ("materials.hard.young={}", 2.9e5, 3.1e5, "times as stiff as body 'above'"),
    ("materials.hard.poisson={}", 0.4425, 0.4435, "its elements of order 2 lock"),
    ("materials.soft.poisson={}", 0.0, -0.01, "grows thicker as it is pulled"),
    ("contacts.c.elastic_slip={}", 0.049, 0.051, "nothing slides before it has gone that far"),
    ("contacts.c.cohesion={}", 1.1e-7, 0.9e-7, "is as good as no traction"),
    ("contacts.c.cohesion={}", 0.99, 1.01, "makes all stick"),
    ("contacts.c.friction={}", 2.0, 2.01, "is above what materials have"),
    ("bodies.above.mesh.elements=[{:.0f},2,2]", 40, 41, "take fewer along u, or more along v"),
    ("bodies.above.mesh.grading=[1,1,{}]", 0.34, 0.33, "mesh.grading along w above 1"),
    ("bodies.below.mesh={{order=2,elements=[4,4,2],grading=[1,1,{}]}}", 2.95, 3.05, "mesh.grading along w below 1"),
    ("solver.newton_tolerance={}", 1e-4, 1.01e-4, "leaves that share of forces"),
    ("bodies.above.geometry.lower=[-0.25,-0.25,{}]", -0.0095, -0.0105, "overlap by 0.0105 at the start"),
    ("loads={{own={{body='above',weight=[0,0,-{}]}}}}", 0.99, 1.01, "comes to 0.505 force per area"),
    ("stages.one.motions.top.rotate={}", 3.1381, 3.1389, "If radians were meant, give 180"),
    ("stages.one.motions.top.rotate={}", 9.435, 9.425, "If radians were meant, give 540"),
)
#: The blocks pressed by a force.
PRESSED = OF_TWO.replace('supports.top.face = "above.w1"', 'supports.top = { face = "above.w1", components = ["x", "y"], force.z = -0.01 }')
PRESSED = PRESSED.replace(", motions.top = { translate = [0, 0, -0.02] }", "")
FORCE = ("supports.top.force.z={}", -0.124, -0.126, "presses by 0.504 force per area of its face")


def half(text: str) -> str:
    """The scene on one side of a plane of symmetry."""
    return text.replace("format = 1", "format = 1\nsymmetry = { x = 0 }")


@case(
    claim="Numbers are doubted from their limits on: moduli, friction, loads, forces on halves, elements, overlaps, tolerances, angles.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: numbers within a limit that are doubted, and beyond it that are not")},
)
def limits() -> dict[str, float]:
    """Of how many."""
    asked = [(OF_TWO, *limit) for limit in LIMITS] + [(text, *FORCE) for text in (PRESSED, half(PRESSED))]
    wrong = [
        told_of(text, change, within) != "" or words not in told_of(text, change, beyond) for text, change, within, beyond, words in asked
    ]
    return {"wrong": float(sum(wrong))}


def told_of(text: str, change: str, value: float) -> str:
    """The one sentence that is said of blocks with a number changed; none, or that there are several."""
    problem = Scene.from_toml(text, overrides=(change.format(value),)).problem()
    said = list(doubts(problem, Simulation(problem).state))
    return said[0] if len(said) == 1 else "several" * bool(said)
