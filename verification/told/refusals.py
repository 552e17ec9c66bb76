"""What is refused, on either side of each limit, and beside what is taken for one thing that is other."""

from __future__ import annotations

from told.either_way import PRESSED, RESTING, SCENE
from told.word_by_word import refused
from told.wrong.doubts import DOME, HOLLOW

from isomortar.harness import Bound, case

#: The blocks, and a third body at a place that is far from the origin.
FAR = """
[bodies.far]
geometry = {{ kind = "box", lower = [{place!r}, 0, 0], upper = [{end!r}, 1, 1] }}
[supports.far]
face = "far.w0"
"""
#: The blocks, of which one is held at the side in all stages.
THROUGHOUT = RESTING.replace(', stages = ["one"]', "")

#: The blocks, and a cube whose first direction goes from one x to another.
CUBE = """
[bodies.cube.patch]
order = [1, 1, 1]
knots = [[0, 0, 1, 1], [0, 0, 1, 1], [0, 0, 1, 1]]
control_points = [[{0}, 5, 5], [{1}, 5, 5], [{0}, 6, 5], [{1}, 6, 5], [{0}, 5, 6], [{1}, 5, 6], [{0}, 6, 6], [{1}, 6, 6]]
[supports.cube]
face = "cube.w0"
"""
#: A wedge that stands on a block with its edge, or beside it at a height: points of the block beyond that edge are under no flank.
WEDGE = """
format = 1
bodies.wedge = {{ geometry = {{ kind = "wedge", bottom = [0, 0], top = [-0.4, 0.4], y = [-0.5, 0.5], z = [{0}, {1}] }}, rigid = true }}
bodies.block = {{ geometry = {{ kind = "box", lower = [-1, -0.4, -0.8], upper = [1, 0.4, 0] }}, mesh.elements = [12, 1, 4] }}
contacts.left = {{ slave = "block.w1", master = "wedge.u0" }}
contacts.right = {{ slave = "block.w1", master = "wedge.u1" }}
supports = {{ base.face = "block.w0", top.face = "wedge.w1" }}
stages = [{{ name = "press", steps = 4, motions.top.translate = [0, 0, -0.1] }}]
"""
#: A bowl with its pole on a block.
BOWL = HOLLOW.replace("[2, 2, 1] }\n\n[bodies.lower]", "[4, 1, 2] }\n[bodies.lower]")

_CONTACT = "contacts.c={slave='above.w0',master='below.w1',"
_PAPER = "solver.slip_sum='paper'"
_RAISED = "bodies.above.mesh={order=2,elements=2,contact_order=3}"
_TWO = "supports.top.components=['x','z']"

#: Half of a body that one plane cuts at its middle, with its first direction in two elements, of which one ends at a knot.
CUT = """
format = 1
symmetry = {{ x = 0 }}
[bodies.b.patch]
order = [2, 1, 1]
knots = [[0, 0, 0, {}, 1, 1, 1], [0, 0, 1, 1], [0, 0, 1, 1]]
control_points = [
  [-1, 0, 0], [-0.5, 0, 0], [0.5, 0, 0], [1, 0, 0], [-1, 1, 0], [-0.5, 1, 0], [0.5, 1, 0], [1, 1, 0],
  [-1, 0, 1], [-0.5, 0, 1], [0.5, 0, 1], [1, 0, 1], [-1, 1, 1], [-0.5, 1, 1], [0.5, 1, 1], [1, 1, 1],
]
[contacts.c]
slave = "b.w0"
plane = {{ point = [0, 0, 0] }}
[supports.top]
face = "b.w1"
[[stages]]
name = "press"
steps = 1
motions.top.translate = [0, 0, -0.01]
"""


def far(place: float) -> str:
    """The scene with a third body at a place."""
    return SCENE + FAR.format(place=place, end=place + 1.0)


def loaded(face: str, load: str) -> str:
    """A load on a face."""
    return f"loads={{wind={{face='{face}',{load}}}}}"


#: A scene, what is changed in it, and words of why it is refused; none: it is taken.
CASES: tuple[tuple[str, tuple[str, ...], str], ...] = (
    (SCENE, ("solver={method='uzawa',path_tolerance=0.01}",), ""),
    (SCENE, ("solver={method='uzawa',path_tolerance=0.0099}",), "below solver.augmentation_tolerance = 0.01"),
    (SCENE, ("solver={method='monolithic',path_tolerance=0.0099}",), ""),
    (far(8e12), (), ""),
    (far(9e12), (), "stands 9e+12 from the origin and is 1 long"),
    (SCENE, ("supports.top.centre=[0,4e12,0]",), ""),
    (SCENE, ("supports.top.centre=[0,5e12,0]",), "is 5e+12 from the origin"),
    (SCENE, ("stages.one.motions.top.translate=[0,4e12,0]",), ""),
    (SCENE, ("stages.one.motions.top.translate=[0,5e12,0]",), "has gone 5e+12 by the end of the stage"),
    (SCENE, ("stages.one.motions.top.rotate=36000",), ""),
    (SCENE, ("stages.one.motions.top.rotate=36100",), "100 times in 10 load steps"),
    (SCENE, (_CONTACT + "friction=0,projection='averaged'}", _PAPER), ""),
    (SCENE, (_CONTACT + "friction=0.3,projection='averaged'}", _PAPER), 'is "averaged", and solver.slip_sum is "paper"'),
    (SCENE, (_CONTACT + "friction=0,enforcement='dual'}", _PAPER), ""),
    (SCENE, (_CONTACT + "friction=0.3,enforcement='dual'}", _PAPER), 'is "dual", and solver.slip_sum is "paper"'),
    (SCENE, (_CONTACT + "friction=0,smoothing=0.067}",), ""),
    (SCENE, (_CONTACT + "friction=0,smoothing=0.068}",), "would be pressed away from afar"),
    (SCENE, ("bodies.above.geometry.lower=[-0.25,-0.25,-0.44]",), ""),
    (SCENE, ("bodies.above.geometry.lower=[-0.25,-0.25,-0.46]",), "they have passed through each other"),
    (WEDGE.format(0.0, 0.4), (), ""),
    (WEDGE.format(-0.3, 0.1), (), "they have passed through each other"),
    (SCENE, (_RAISED, loaded("above.w0", "pressure=0.1")), ""),
    (SCENE, (_RAISED, loaded("above.u0", "traction=[0.1,0,0]")), ""),
    (SCENE, (_RAISED, loaded("above.u0", "pressure=0.1")), "functions of 'above' are of another order at w0"),
    (SCENE, (_TWO, loaded("above.w1", "pressure=0.1")), ""),
    (SCENE, (loaded("above.w1", "pressure=0.1"),), "prescribes all components or their forces"),
    (SCENE, (_TWO, loaded("above.w1", "traction=[0,0.1,0]")), ""),
    (SCENE, (_TWO, loaded("above.w1", "traction=[0.1,0,0]")), "acts along x on above.w1"),
    (BOWL.replace("slave =", 'enforcement = "kts"\nslave ='), ("solver.method='uzawa'",), ""),
    *((BOWL.replace("slave =", f'enforcement = "{name}"\nslave ='), (), "has a pole") for name in ("knots", "greville", "demko")),
    (DOME.replace("slave =", 'projection = "averaged"\nslave ='), (), "where elements have no normal"),
    (SCENE, (_CONTACT + "enforcement='kts'}", "solver.method='uzawa'"), ""),
    (SCENE, (_CONTACT + "enforcement='kts',quadrature=[1,1]}",), ""),
    (SCENE, (_CONTACT + "enforcement='kts'}",), "with 288 conditions for the 24 control points"),
    (SCENE, (_CONTACT + "enforcement='demko'}",), ""),
    (SCENE, (_CONTACT + "enforcement='greville'}", "bodies.above.mesh.family='L'"), ""),
    (SCENE, (_CONTACT + "enforcement='demko'}", "bodies.above.mesh.family='L'"), "which have no such abscissae"),
    (SCENE + CUBE.format(5, 6), (), ""),
    (SCENE + CUBE.format(6, 5), (), "is left-handed"),
    (SCENE, (_RAISED.replace("}", ",family='L'}"),), "of NURBS: 3 to 10"),
    (SCENE, (_RAISED.replace("order=3", "order=2"),), "is 2 along w0; allowed there: 3 to 10"),
    (SCENE, ("stages.0.steps=2", "stages.one.steps=3", "supports.top.face=above.w1"), ""),
    (SCENE, ("stages.1.steps=2",), "no such entry; allowed: 0 to 0, one"),
    (SCENE, ("stages.two.steps=2",), "no such entry; allowed: 0 to 0, one"),
    (SCENE, ("contacts.d.friction=0.1",), "an override changes what the scene has; contacts there: c"),
    (SCENE, ("contacts.c.slave.x=2",), "is the single value 'above.w0'"),
    (SCENE, ("contacts.c.friction",), "is not of the form KEY=VALUE"),
    (SCENE, ("contacts c.friction=0.1",), "is not of the form KEY=VALUE"),
    (SCENE, ("contacts.c.friction=0,1",), "is not a TOML value"),
    (SCENE, ("contacts.c.friction=[0,\n1]",), "more than one line"),
    (PRESSED, ("stages.one.motions.top={translate=[0.01,0,0]}",), ""),
    *((PRESSED, (f"stages.one.motions.top={{translate=[0,0,{way}]}}",), "along z, where supports.top.force does") for way in (0.01, -0.01)),
    (CUT.format(0.5), (), ""),
    (CUT.format(0.4), (), "is not its own mirror image in the plane x = 0"),
    (RESTING, (loaded("below.u0", "pressure=0.1"),), ""),
    (THROUGHOUT, (loaded("below.u0", "pressure=0.1"),), "prescribes all components or their forces"),
)


def wrong(text: str, changes: tuple[str, ...], words: str) -> bool:
    """Whether a scene is refused that is to be taken, or taken, or refused for something else."""
    said = refused(text, *changes)
    return bool(said) != bool(words) or words not in said


@case(
    claim="Scenes are refused from a limit on, and for all that they are refused for: places, ways and turns, tolerances, slip sums, "
    "smoothing, overlaps, loads where supports are, points of contacts, poles, left-handed bodies, and overrides.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: scenes that are taken and are to be refused, or the other way round")},
)
def refusals() -> dict[str, float]:
    """How many."""
    return {"wrong": float(sum(wrong(*scene) for scene in CASES))}
