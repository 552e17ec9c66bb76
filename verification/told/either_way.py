"""Doubts beside their limits: on one side of each something is said, and on the other side nothing."""

from __future__ import annotations

from isomortar.harness import Bound, case
from isomortar.scene import Scene
from isomortar.solve.outlook import outlook

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
    (third(0.3), _DEEP, "bodies 'below' and 'third' meet"),
    (third(1.2), _DEEP, "is in no contact"),
    (BALL.replace("AXIS", "z"), ('contacts.c.slave="above.v1"',), ""),
    (BALL.replace("AXIS", "z"), (_MASTER,), "has a pole"),
    (BALL.replace("AXIS", "y"), (_MASTER, "stages.one.motions.hub.rotate=3"), ""),
)


def wrong(scene: str, changes: tuple[str, ...], words: str) -> bool:
    """Whether something else is said than one sentence with these words, or, where there are none, nothing."""
    warnings = outlook(Scene.from_toml(scene, overrides=changes).problem()).warnings
    return len(warnings) != bool(words) or any(words not in warning for warning in warnings)


@case(
    claim="What is right is not doubted, and what is wrong is: numbers of points, loads, planes in the way, and bodies that meet "
    "without a contact.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: scenes of which something else is said")},
)
def doubted() -> dict[str, float]:
    """How many."""
    return {"wrong": float(sum(wrong(*scene) for scene in SAID))}
