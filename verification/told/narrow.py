"""What is said of contact that is narrower than its slave can carry, against forces of finer slaves; and that nothing is said of others."""

from __future__ import annotations

import functools
import re

import numpy as np
from told.runs import Heard

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.told.during import narrow
from isomortar.told.during.giving_way import Yields

#: A block under something rigid, which is pressed into it.
SCENE = """
format = 1
SYMMETRY
materials.m = { young = 10, poisson = 0.3 }
bodies.a = { geometry = BLOCK, mesh = { family = "N", order = 2, elements = 8 } }
bodies.b = { rigid = true, geometry = PUNCH, mesh = { order = [2, ALONG, 1], elements = [8, 8, 1] } }
contacts.c = { slave = "a.w1", master = "b.FACE", friction = 0, projection = "closest" }
supports.base.face = "a.w0"
supports.top.face = "b.TOP"
SIDES
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.02] }]
"""
Changes = tuple[str, ...]


def _scene(**words: str) -> str:
    text = SCENE
    for word, value in words.items():
        text = text.replace(word.upper(), value)
    return text


#: A strip below a cylinder, and below a flat block.
STRIP = _scene(
    symmetry="",
    block='{ kind = "box", lower = [-1, 0, -1], upper = [1, 0.2, 0] }',
    punch='{ kind = "ring", inner = 0.2, outer = 1, width = 0.4, centre = [AT, 0.1, 1], axis = "y" }',
    along="1",
    face="v1",
    top="v0",
    sides='supports.back = { face = "a.v0", components = ["y"] }\nsupports.front = { face = "a.v1", components = ["y"] }',
)
_PUNCH = next(line for line in STRIP.splitlines() if line.startswith("bodies.b"))
FLAT = STRIP.replace(_PUNCH, 'bodies.b = { rigid = true, geometry = { kind = "box", lower = [-2, -1, 0], upper = [2, 1, 1] } }')
FLAT = FLAT.replace("b.v1", "b.w0").replace("b.v0", "b.w1")
#: A block below a bowl that is round as a ball of radius one, and a quarter of both.
BALL = _scene(
    symmetry="",
    block='{ kind = "box", lower = [-1, -1, -1], upper = [1, 1, 0] }',
    punch='{ kind = "bowl", centre = [0.05, 0.03], half_width = 1, bottom = 0, rise = 0.5, top = 1.5 }',
    along="2",
    face="w0",
    top="w1",
    sides="",
)
QUARTER = BALL.replace("[0.05, 0.03]", "[0, 0]").replace("format = 1", "format = 1\nsymmetry = { x = 0.0, y = 0.0 }")
NARROW = re.compile(
    r"contact '(?P<contact>\w+)', load step (?P<step>\d+), the last of stage '\w+': it is too narrow for its slave [^:]+: (?P<rows>\S+) of "
    r"\d+ rows of (control points|constraints) along \w and \S+ of \d+ along \w bear it.*\. Forces under given motions may be off by "
    r"about (?P<share>.+), pressures by more\. Take twice as many elements or more along (?P<along>\w|\w and \w) \("
)


def depth(way: float) -> str:
    """A change of how deep it is pressed in."""
    return f"stages.press.motions.top.translate=[0, 0, {-way}]"


def run(text: str, changes: Changes = ()) -> tuple[list[re.Match[str]], float]:
    """What is said of narrow contact in a run, and the force at its end."""
    heard = Heard()
    *_, last = Simulation(Scene.from_toml(text, overrides=changes).problem(), heard).run()
    return [found for said in heard.said if (found := NARROW.search(said))], abs(float(last.contacts[0].force_slave[2]))


def strip(family: str, order: int, elements: int, at: float) -> tuple[str, Changes]:
    """That of the strip below a cylinder."""
    across = 1 if family == "L" else min(order, 2)
    mesh = (f'family="{family}"', f"order=[{order}, {across}, {order}]", f"elements=[{elements}, 1, {max(1, elements // 2)}]")
    return STRIP.replace("AT", str(at)), tuple(f"bodies.a.mesh.{words}" for words in mesh)


#: Strips that do not carry contact which is 0.02 deep: family, order, elements, and where the cylinder is.
STRIPS: dict[str, tuple[str, int, int, float]] = {
    "N1": ("N", 1, 8, 0.125),
    "N2 on a knot": ("N", 2, 8, 0.0),
    "N2 beside it": ("N", 2, 6, 1 / 6),
    "N3": ("N", 3, 8, 0.125),
    "N4": ("N", 4, 8, 0.125),
}


@case(
    claim="Contact of a cylinder that elements of each order are too long for is told, once, along the direction that is too coarse, and "
    "by about as much as the force is off; of a slave with four times as many elements, whose force is right, nothing is said.",
    tier="gate",
    grid={"slave": tuple(STRIPS)},
    bounds={
        "said": Bound(1.0, 1.0, "definition: sentences of the coarse slave"),
        "along": Bound(1.0, 1.0, "definition: that it is to be refined along u alone, at load step 1"),
        "off": Bound(at_least=0.3, reason="definition: share of the force that is missing: or there is nothing to tell of"),
        "told over off": Bound(at_least=0.7, at_most=1.5, reason="definition: an estimate, of which the first digit counts"),
        "others": Bound(0.0, 0.0, "definition: sentences of the fine slave"),
        "left": Bound(at_most=0.05, reason="definition: what the force of the fine slave is off by"),
    },
)
def strips(slave: str) -> dict[str, float]:
    """What is said of a coarse strip and of a fine one, and how far they are off one of order 2 and 40 elements."""
    family, order, elements, at = STRIPS[slave]
    _, true = run(*strip("N", 2, 40, at))
    said, force = run(*strip(family, order, elements, at))
    others, right = run(*strip(family, order, 4 * elements, at))
    off = 1.0 - force / true
    return {
        "said": float(len(said)),
        "along": float(all((words["step"], words["along"]) == ("1", "u") for words in said)),
        "off": off,
        "told over off": 0.01 * float(said[0]["share"].removesuffix(" %")) / off if said else 0.0,
        "others": float(len(others)),
        "left": abs(right / true - 1.0),
    }


@functools.cache
def truth(way: float) -> float:
    """The force on a ball that is so deep, of a quarter of 16 x 16 elements."""
    return run(QUARTER, (depth(way), "bodies.a.mesh.elements=[16, 16, 6]"))[1]


#: Balls on blocks that do not carry their contact: scene, changes, depth, and the share that is told where it is no estimate.
EXCHANGED = ('contacts.c.slave="b.w0"', 'contacts.c.master="a.w1"')
BALLS: dict[str, tuple[str, Changes, float, str]] = {
    "closest": (BALL, (), 0.025, ""),
    "averaged": (BALL, ('contacts.c.projection="averaged"',), 0.025, ""),
    "uzawa": (BALL, ('solver.method="uzawa"',), 0.025, ""),
    "exchanged": (BALL, EXCHANGED, 0.05, ""),
    "a quarter": (QUARTER, ("bodies.a.mesh.order=1", "bodies.a.mesh.elements=[4, 4, 4]"), 0.05, ""),
    "one row": (QUARTER, (), 0.05, "20 %"),
    "constraints at knots": (QUARTER, ('contacts.c.enforcement="knots"',), 0.025, "50 %, at the worst by 200 %"),
}
#: What makes of each a contact that is carried.
DEEP = (depth(0.15), "stages.press.steps=3", "bodies.a.mesh.elements=[12, 12, 4]", "bodies.b.mesh.elements=[12, 12, 1]")


@case(
    claim="Contact of a ball that elements are too long for is told, once, with closest points and averaged normals, by both methods, of "
    "a slave that is the ball and of a quarter of all; with a deeper contact of finer elements nothing is said.",
    tier="gate",
    grid={"scene": tuple(BALLS)},
    bounds={
        "said": Bound(1.0, 1.0, "definition: sentences of the shallow contact"),
        "rows": Bound(at_most=2.0, reason="definition: that bear it, along either direction"),
        "off": Bound(at_least=0.1, reason="definition: share of the force that is missing: or there is nothing to tell of"),
        "told over off": Bound(at_least=0.6, at_most=1.6, reason="definition: an estimate, of which the first digit counts"),
        "others": Bound(0.0, 0.0, "definition: sentences of the deep contact"),
    },
)
def balls(scene: str) -> dict[str, float]:
    """What is said, and how far the force is off that of a quarter of 16 x 16 elements."""
    text, changes, way, fixed = BALLS[scene]
    said, force = run(text, (*changes, depth(way)))
    others, _ = run(QUARTER, (*changes, *DEEP))
    off, told = abs(1.0 - force / truth(way)), [words["share"] for words in said]
    share = 0.01 * float(told[0].removesuffix(" %")) if told and not fixed else 0.2
    return {
        "said": float(len(said)) if bool(told and (told[0] == fixed or not fixed)) else -1.0,
        "rows": float(np.min([float(words["rows"]) for words in said])) if said else np.inf,
        "off": off,
        "told over off": 1.0 if fixed else share / off,
        "others": float(len(others)),
    }


@case(
    claim="A row of functions with kinks that carries contact along a line alone is told, and its force is off by more than a tenth.",
    tier="gate",
    bounds={
        "said": Bound(1.0, 1.0, "definition: sentences"),
        "off": Bound(at_least=0.1, at_most=0.3, reason="definition: share of the force; 20 % are told"),
    },
)
def kinks() -> dict[str, float]:
    """How much is said, and how far the force is off."""
    at, way = 0.0, (depth(0.03),)
    (true, fine), (text, changes) = strip("N", 2, 40, at), strip("N", 1, 8, at)
    said, force = run(text, (*changes, *way))
    return {"said": float(sum(words["share"] == "20 %" for words in said)), "off": abs(force / run(true, (*fine, *way))[1] - 1.0)}


#: The lower part of a ball, whose pole presses on a plane, and how deep it does with elements along its meridians that are too long.
POLE = """
format = 1
materials.m = { young = 10, poisson = 0.3 }
bodies.ball = { geometry = { kind = "sphere", centre = [0, 0, 1], inner = 0.5, outer = 1, latitudes = [-90, -30] } }
contacts.c = { slave = "ball.v1", friction = 0, plane = {} }
supports.top.face = "ball.v0"
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.02] }]
"""
POLES = {2: 0.08, 4: 0.02}


@case(
    claim="Contact that a pole of its slave bears alone is told once, along the meridians: elements round the pole are no matter there.",
    tier="gate",
    grid={"elements": tuple(POLES)},
    bounds={
        "said": Bound(1.0, 1.0, "definition: sentences of the coarse slave, that it is to be refined along w alone"),
        "off": Bound(at_least=0.05, reason="definition: share of the force that is missing or too much: or there is nothing to tell of"),
        "round": Bound(at_most=0.03, reason="definition: by what share twice as many elements round the pole change the force"),
        "others": Bound(0.0, 0.0, "definition: sentences of a slave with eight times as many elements along w"),
    },
)
def poles(elements: int) -> dict[str, float]:
    """What is said, and how far the force is off that of the fine slave."""
    way = depth(POLES[elements])
    said, force = run(POLE, (way, f"bodies.ball.mesh.elements=[8, 2, {elements}]"))
    _, round_it = run(POLE, (way, f"bodies.ball.mesh.elements=[16, 2, {elements}]"))
    others, true = run(POLE, (way, f"bodies.ball.mesh.elements=[8, 2, {8 * elements}]"))
    return {
        "said": float(len(said)) if all(words["along"] == "w" for words in said) else -1.0,
        "off": abs(1.0 - force / true),
        "round": abs(round_it / force - 1.0),
        "others": float(len(others)),
    }


#: Another block beside that under the ball, glued to it and hardly there, whose face goes on that of the first.
BESIDE = """
materials.soft = { young = 1e-6, poisson = 0.3 }
bodies.s.geometry = { kind = "box", lower = [1, -1, -1], upper = [1.5, 1, 0] }
bodies.s.mesh = { order = 2, elements = [2, 8, 8] }
bodies.s.material = "soft"
glue = [["a.u1", "s.u0"]]
"""
JOINED = {"slave": 'contacts.c.slave=["a.w1", "s.w1"]', "master": 'contacts.c.master=["a.w1", "s.w1"]'}


@case(
    claim="What narrow contact costs is told by the bodies that it acts on, also where faces of softer ones are joined to theirs.",
    tier="gate",
    grid={"side": tuple(JOINED)},
    bounds={
        "apart": Bound(at_most=0.05, reason="definition: what is told with the softer body over what is told without it, one digit of two")
    },
)
def joined(side: str) -> dict[str, float]:
    """How far apart the shares are."""
    changes = (*EXCHANGED, depth(0.05)) if side == "master" else (depth(0.025),)
    scenes = ((BALL, changes), (BALL + BESIDE, (*changes, JOINED[side], 'bodies.a.material="m"')))
    shares = [words["share"].removesuffix(" %") for text, also in scenes for words in run(text, also)[0]]
    alone, both = map(float, shares) if len(shares) == 2 else (1.0, np.inf)
    return {"apart": abs(both / alone - 1.0)}


#: The ball pressed in, in load steps of which the first is narrow, and lifted nearly out of the block; a flat punch on all of some strip.
LIFTED = BALL.replace("\n]", "").replace("stages = [", 'stages = [{ name = "deep", steps = 6, motions.top.translate = [0, 0, -0.15] }, ')
SOUND: dict[str, tuple[str, Changes]] = {
    "on the way": (BALL, (depth(0.15), "stages.press.steps=6")),
    "lifted": (LIFTED, (depth(-0.125),)),
    "one row of smooth functions": (STRIP.replace("AT", "0.125"), (*strip("N", 2, 8, 0.125)[1], depth(0.03))),
    **{f"one element, {family}{order}": (FLAT, strip(family, order, 1, 0.0)[1]) for family, order in (("N", 1), ("N", 2), ("L", 2))},
}


@case(
    claim="Of contact that is narrow at first, or about to open, along a line that one row of smooth functions carries, and of faces all "
    "of whose few control points bear nothing is said.",
    tier="gate",
    grid={"scene": tuple(SOUND)},
    bounds={"said": Bound(0.0, 0.0, "definition: sentences")},
)
def broad(scene: str) -> dict[str, float]:
    """How many."""
    said, force = run(*SOUND[scene])
    return {"said": float(len(said)) if force > 0.0 else np.nan}


@case(
    claim="Of contact that is about to open nothing is said, either, where the run was resumed after it had borne most.",
    tier="gate",
    bounds={
        "said": Bound(0.0, 0.0, "definition: sentences"),
        "left": Bound(at_least=1e-6, at_most=0.1, reason="definition: share of the force before that is left"),
    },
)
def resumed() -> dict[str, float]:
    """How many, and how much is left."""
    problem, heard = Scene.from_toml(LIFTED, overrides=(depth(-0.125),)).problem(), Heard()
    *_, before, last = Simulation(problem).run()
    list(Simulation(problem, heard, resume_from=before).run())
    left, most = (abs(float(result.contacts[0].force_slave[2])) for result in (last, before))
    return {"said": float(sum(NARROW.search(said) is not None for said in heard.said)), "left": left / most}


#: Bundled scenes and how many load steps their stages are cut down to; those that take longer are nightly.
BUNDLED = {"block": 5, "iron-round": 5, "press": 5, "twist": 4, "twist-sharp": 4, "iron": 5, "reversal": 5, "tire": 5}


@case(
    claim="Of bundled scenes nothing is said: their contact is broad at the ends of stages.",
    tier=lambda scene: "nightly" if scene in {"iron", "reversal", "tire"} else "gate",
    grid={"scene": tuple(BUNDLED)},
    bounds={"said": Bound(0.0, 0.0, "definition: sentences")},
)
def broad_scenes(scene: str) -> dict[str, float]:
    """How many."""
    steps = [f"stages.{stage.name}.steps={min(stage.steps, BUNDLED[scene])}" for stage in Scene.load(scene).problem().stages]
    heard = Heard()
    list(Simulation(Scene.load(scene, steps).problem(), heard).run())
    return {"said": float(sum(NARROW.search(said) is not None for said in heard.said))}


#: A block that is pressed on a plane and touches nothing of the others; YOUNG times as stiff as they are.
ELSEWHERE = """
materials.stiff = { young = YOUNG, poisson = 0.3 }
bodies.d = { material = "stiff", geometry = { kind = "box", lower = [0, 10, 0], upper = [1, 11, 1] }, mesh.elements = 2 }
contacts.floor = { slave = "d.w0", plane = {} }
supports.hand.face = "d.w1"
"""


@case(
    claim="Contact that is too narrow is told beside another one that touches nothing of it, however much more that bears.",
    tier="gate",
    grid={"stiffer": (1.0, 1e10)},
    bounds={"said": Bound(1.0, 1.0, "definition: sentences, on the narrow contact")},
)
def narrow_beside_others(stiffer: float) -> dict[str, float]:
    """What is said of a ball on a block that does not carry it."""
    text = BALL.replace("bodies.a = {", 'bodies.a = { material = "m",') + ELSEWHERE.replace("YOUNG", str(10.0 * stiffer))
    said, _ = run(text, (depth(0.025), "stages.press.motions.hand.translate=[0, 0, -0.025]"))
    return {"said": float([words["contact"] for words in said] == ["c"])}


#: Rows that bear along each coordinate, of how many, whether a pole goes round it, and the coordinates along which more elements are named.
FEW = (
    ((1.5, 1.5), (9, 9), (False, False), "u and v"),
    ((1.5, 6.0), (9, 9), (False, False), "u"),
    ((6.0, 1.5), (9, 9), (False, False), "v"),
    ((1.5, 2.0), (9, 2), (False, False), "u"),
    ((2.0, 1.5), (2, 9), (False, False), "v"),
    ((1.5, 2.0), (9, 3), (False, False), "u and v"),
    ((2.4, 2.6), (9, 9), (False, False), "u"),
    ((3.0, 3.5), (9, 9), (False, False), "u"),
    ((8.0, 8.0), (9, 9), (True, False), "v"),
    ((8.0, 8.0), (9, 9), (False, True), "u"),
)


@case(
    claim="Of a contact that is too narrow more elements are named along the coordinates along which few rows bear it, and not along one "
    "all of whose rows do, nor round a pole.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: coordinates that are others, of ten ways to bear")},
)
def along_which() -> dict[str, float]:
    """How many."""
    problem, wrong = Scene.load("press").problem(), 0
    for rows, counts, poles, along in FEW:
        none, yields = (False, False), Yields(np.zeros(2), np.zeros(2))
        found = narrow.Bearing(np.array(rows), counts, np.full(2, 4.0), none, poles, none, True, 0.0, yields)
        said = found.sentence(problem, problem.contacts[0], 1)
        wrong += f"many elements or more along {along} (" not in said
    return {"wrong": float(wrong)}
