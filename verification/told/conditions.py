"""What a sentence needs before it is said, one thing at a time: with all of it there it is said, and with one thing missing it is not."""

from __future__ import annotations

from dataclasses import replace

from told.either_way import RESTING, SCENE, SLANTING, wrong
from told.wrong.contacts import PAIR, TYRE

from isomortar.harness import Bound, case
from isomortar.march.outlook import outlook
from isomortar.scene import Scene

#: The blocks, with a stage more that goes on in the same direction.
ON = SCENE.replace("} }]", '} }, { name = "two", steps = 10, motions.top = { translate = [0, 0, -0.02] } }]')
#: The upper block between two planes below it, and no other block.
_ABOVE = SCENE[: SCENE.index("bodies.below")] + SCENE[SCENE.index("contacts.c") :].replace('supports.base.face = "below.w0"\n', "")
PLANES = _ABOVE.replace("contacts.c", 'contacts.other = { slave = "above.w0", plane = { point = [0, 0, -0.01] } }\ncontacts.c')
PLANES = PLANES.replace('master = "below.w1"', "plane = {}")
#: Its lower face held down on the plane, in two stages.
PUSHED = _ABOVE.replace('master = "below.w1"', "plane = {}").replace(
    "supports.top.face",
    'supports.held = { face = "above.w1", components = ["x", "y"] }\nsupports.top.components = ["z"]\nsupports.top.face',
)
PUSHED = PUSHED.replace('face = "above.w1"\nstages', 'face = "above.w0"\nstages')
PUSHED = PUSHED.replace("} }]", '} }, { name = "two", steps = 10, motions.top = { translate = [0, 0, -0.03] } }]')
#: Its lower face held, in one stage alone or in both.
HELD = RESTING.replace("below.u0", "above.w0").replace('{ name = "two"', '{ name = "two", motions.top = { translate = [0, 0, -0.01] }')
#: The other end of what the stage's support holds, in a stage.
ALIKE = RESTING.replace("supports.side", 'supports.other = { face = "below.u0", stages = ["STAGE"] }\nsupports.side')
#: A ball by a corner of a large block: their boxes are in each other.
CORNER = (
    SCENE
    + """
[bodies.third]
geometry = { kind = "sphere", centre = [1.25, 1.25, -1.5], inner = 0.1, outer = 0.3, axis = "z" }
[supports.third]
face = "third.v0"
"""
)
_DEEP = "bodies.below.geometry.lower=[-1,-1,-3]"
#: Three halves of a whole, one of them in no contact.
HALVES = PAIR.replace("-0.4, -0.4, 0.0]", "0, -0.4, 0]").replace("[-1, -1, -1]", "[0, -1, -1]") + "motions.lift.translate = [0, 0, 0.1]\n"
HALVES = HALVES.replace(
    "[contacts.pair]",
    '[bodies.aside]\ngeometry = { kind = "box", lower = [0, 2, 0], upper = [1, 3, 1] }\n[supports.aside]\nface = "aside.w0"\n'
    '[supports.lift]\nface = "aside.w1"\n[contacts.pair]',
)
ONE_HELD = HALVES.replace("[supports.base]", '[supports.cut]\nface = "lower.u0"\ncomponents = ["x"]\n[supports.base]')
#: The tyre on a block in the place of the plane.
_BLOCK = """
[bodies.road]
geometry = { kind = "box", lower = [-2, -0.5, -1], upper = [3, 1, 0] }
mesh = { elements = [10, 4, 2] }
[supports.bed]
face = "road.w0"
"""
ROAD = TYRE.replace("plane = { normal = [0, 0, 1] }", 'master = "road.w1"').replace("[[stages]]", f"{_BLOCK}[[stages]]")

#: Two blocks that are glued on the lower one, one or both of their faces there held.
BESIDE = SCENE.replace(
    "contacts.c = { slave =", 'glue = [["above.u1", "beside.u0"]]\ncontacts.c = { slave = ["above.w0", "beside.w0"], was ='
)
BESIDE = BESIDE.replace('was = "above.w0", ', "").replace(
    "bodies.above.geometry",
    'bodies.beside.geometry = { kind = "box", lower = [0.25, -0.25, 0], upper = [0.75, 0.25, 0.5] }\n'
    "bodies.beside.mesh = { order = 2, elements = [4, 2, 2] }\nbodies.above.geometry",
)
BESIDE = BESIDE.replace('top.face = "above.w1"', 'top.face = "above.w0"').replace("stages =", "OTHER\nstages =")
#: The upper block with elements across that are longest in the middle; those at its lower face are longer than at its upper one.
_KNOTS = "knots = [[0, 0, 1, 1], [0, 0, 1, 1], [0, 0, LINES, 1, 1]], control_points = POINTS"


def layered(lines: tuple[float, float]) -> str:
    """The blocks with knot lines of the upper one at such shares of its height."""
    points = [[x, y, 0.5 * z] for z in (0, *lines, 1) for y in (-0.25, 0.25) for x in (-0.25, 0.25)]
    patch = _KNOTS.replace("LINES", ", ".join(map(str, lines))).replace("POINTS", str(points))
    geometry = 'bodies.above.geometry = { kind = "box", lower = [-0.25, -0.25, 0], upper = [0.25, 0.25, 0.5] }'
    return SCENE.replace(geometry, f"bodies.above.patch = {{ order = [1, 1, 1], {patch} }}").replace(
        "elements = [4, 2, 2]", "elements = [4, 4, 3]"
    )


_SLIDES = "stages.roll.motions.rim.rotate=3"
_SIDE = 'contacts.c.slave="above.u1"'
_RIGID = ("bodies.above.rigid=true", "bodies.below.mesh.elements=[8,8,1]")
_GRADED = "bodies.above.mesh={order=2,elements=[1,1,2],grading=[1,1,0.2]}"
_FLOOR = "contacts.floor.plane={point=[0,0,0],normal=[0,0,1]}"
_HARD = "materials={stuff={young=100}}"
_GRAVITY = "as the acceleration of gravity is"
_ROUND_OFF = "round-off of its positions"


def tall(height: float, orders: str) -> tuple[str, str]:
    """A block of some height and orders."""
    return f"bodies.above.geometry.upper=[0.25,0.25,{height}]", f"bodies.above.mesh={{order={orders},elements=1}}"


def weighs(kind: str) -> tuple[str, str]:
    """A load on the upper of two hard blocks."""
    return _HARD, f"loads={{own={{{kind}}}}}"


#: A scene, what is changed in it, and words of what is said of it; none: nothing is said.
CASES: tuple[tuple[str, tuple[str, ...], str], ...] = (
    # A slave that does not look at its master, where nothing turns it.
    (SCENE, (_SIDE,), "no part of above.u1 looks at its master"),
    (SCENE, (_SIDE, "supports.top.axis=[0,1,0]", "stages.one.motions.top.rotate=90"), ""),
    # Motions away, where the sides are not pressed from the start.
    (SCENE, ("stages.one.motions.top.translate=[0,0,0.02]",), "take its sides away from each other"),
    (SCENE, ("stages.one.motions.top.translate=[0,0,0.02]", "bodies.above.geometry.lower=[-0.25,-0.25,-0.005]"), ""),
    # A face in contact that is held, in all stages.
    (HELD.replace(', stages = ["one"]', ""), (), "nothing dents it"),
    (HELD, (), ""),
    (BESIDE.replace("OTHER", 'supports.other.face = "beside.w0"'), ("stages.one.motions.other.translate=[0,0,-0.02]",), "nothing dents it"),
    (BESIDE.replace("OTHER", ""), (), ""),
    # Elements that are longest at a face in contact, and not elsewhere.
    (layered((0.65, 0.9)), (), "mesh.grading along w above 1"),
    (layered((0.4, 0.9)), (), ""),
    # A plane behind another one, which is parallel to it, and what stays there.
    (PLANES, (), "the plane of 'other' is at or behind the plane of 'c'"),
    (PLANES, ("contacts.other.plane={point=[0,0,-0.01],normal=[0.01,0,1]}",), ""),
    (SLANTING, (_FLOOR,), "is at or behind the plane of 'floor'"),
    (SLANTING, (_FLOOR, "stages.one.motions.base.translate=[0,0,0.01]"), ""),
    # Two supports of one place, at the same time.
    (ALIKE.replace("STAGE", "one"), (), "both prescribe x, y, z of below.u0"),
    (ALIKE.replace("STAGE", "two"), (), ""),
    # Bodies that meet: their boxes alone do not.
    (CORNER, (_DEEP,), "body 'third' is in no contact"),
    (CORNER, (_DEEP, "bodies.third.geometry.centre=[1.1,1.1,-1.5]"), "bodies 'below' and 'third' meet"),
    # Halves: none held, some held.
    (HALVES, (), 'nothing holds them there: they bulge through it. If they are halves, give supports with components = ["x"] to upper.u0,'),
    (ONE_HELD, (), "nothing holds all of them there"),
    # Tall bodies, from a height on that their higher order along the face counts for.
    (SCENE, tall(1.65e5, "7"), ""),
    (SCENE, tall(1.7e5, "7"), _ROUND_OFF),
    (SCENE, tall(1.7e5, "[6,7,7]"), ""),
    (SCENE, tall(1e6, "[6,7,7]"), "and of order 7 there"),
    # Elements of bodies that deform.
    (SCENE, (_GRADED.replace("[1,1,2]", "[4,4,2]"),), "mesh.grading along w above 1"),
    (SCENE, (_GRADED, *_RIGID), ""),
    (SCENE, ("bodies.above.mesh={order=2,elements=1}", _RIGID[1]), "is a single element"),
    (SCENE, ("bodies.above.mesh={order=2,elements=1}", *_RIGID), ""),
    # Quadrature points of contacts that have some of their own.
    (SCENE, ("contacts.c={slave='above.w0',master='below.w1',friction=0.3,enforcement='knots',quadrature=[3,2]}",), ""),
    # How deep, and when.
    (PUSHED, (), "by 0.05 at the end of stage 'two'"),
    (PUSHED, ("stages.two.motions.top.translate=[0,0,0.015]",), "by 0.02 at the end of stage 'one'"),
    # Ways that are said again, while another goes on.
    (ON, (), ""),
    (ON, ("stages.one.motions.top.translate=[0.1,0,-0.02]", "stages.two.motions.top.translate=[0.05,0,-0.02]"), "as much along z"),
    # Weights as large as the acceleration of gravity, and nothing else of them.
    (SCENE, weighs("body='above',weight=[0,0,-9.825]"), _GRAVITY),
    (SCENE, weighs("body='above',weight=[0,0,-9.835]"), ""),
    (SCENE, weighs("body='above',weight=[0,0,-9825]"), _GRAVITY),
    (SCENE, weighs("body='above',weight=[0,0,-9835]"), "times the size of its body"),
    (SCENE, weighs("face='above.u0',pressure=9.81"), ""),
    # Bounds of friction.
    (SCENE, ("contacts.c.friction=2.05",), "a coefficient of friction of 2.05 is above what materials have"),
    (SCENE, ("contacts.c.friction=2",), ""),
    (SCENE, ("contacts.c.friction=2.05", "contacts.c.traction_max=0.1"), ""),
    (SCENE, ("contacts.c={slave='above.w0',master='below.w1',friction=0.3,traction_max=1.1e-6}",), ""),
    (SCENE, ("contacts.c={slave='above.w0',master='below.w1',friction=0.3,traction_max=0.9e-6}",), "traction_max = 9e-07 is as good as"),
    # Turns of round bodies: about a line that is far from them, or beside their middle, and where they go along what they touch.
    (TYRE, ("supports.rim.centre=[0,0,10]", "stages.roll.motions.rim={rotate=30}"), "round on a large circle"),
    (TYRE, ("supports.rim.centre=[0,0,1.5]", "stages.roll.motions.rim={rotate=30}"), "0.5 beside the body's middle, [0, 0, 1]"),
    (TYRE, ("stages.roll.motions.rim={translate=[0.1,0,-0.02],rotate=30}",), "it slides by"),
    (ROAD, (_SLIDES,), "it slides by"),
    (ROAD, (_SLIDES, "stages.roll.motions.bed.translate=[0.01,0,0]"), ""),
    (ROAD, (_SLIDES, "supports.bed.components=['x','y']", "supports.bed.moment=0"), ""),
    (TYRE, ("stages.roll.motions.rim={translate=[0.05,0,-0.03],rotate=30}",), ""),
)


@case(
    claim="Sentences on a scene are said where all is there that makes them due, and not where one thing is missing.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: scenes of which something else is said")},
)
def due() -> dict[str, float]:
    """How many."""
    return {"wrong": float(sum(wrong(*scene) for scene in CASES))}


@case(
    claim="Loads that Python makes, without factors, act in all stages: of them nothing is said.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: sentences on a load that is there and small")},
)
def without_factors() -> dict[str, float]:
    """How many."""
    problem = Scene.from_toml(SCENE, overrides=("loads={wind={face='above.u0',pressure=0.01}}",)).problem()
    loads = tuple(replace(load, factors=()) for load in problem.loads)
    return {"wrong": float(len(outlook(replace(problem, loads=loads)).warnings))}
