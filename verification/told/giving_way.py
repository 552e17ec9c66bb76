"""How bodies give way to the pressures of a contact, and what is said by it of beams, soft beds, and bodies turned or squeezed before."""

from __future__ import annotations

import re

from told.long_elements import CYLINDER
from told.narrow import STRIP
from told.runs import Heard

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Balance
from isomortar.told.during.giving_way import giving_way

NARROW = re.compile("it is too narrow for its slave|elements of its slave .* are too long for its master")
#: A part of a cylinder on a block, which turn together before it is pressed in.
TURNED = CYLINDER.replace("stages = [{", "stages = [TURN{").replace("[0, 0, -0.05]", "WAY")
TURNED += "supports.foot.axis = [0, 1, 0]\nsupports.hand.axis = [0, 1, 0]\n"
TURN = '{ name = "turn", steps = 3, motions = { foot.rotate = 90, hand.rotate = 90 } }, '
#: A cylinder on a strip of no Poisson's ratio, whose sides are moved in before it is pressed in.
SQUEEZED = STRIP.replace("AT", "0").replace("poisson = 0.3", "poisson = 0").replace("elements = 8 }", "elements = [8, 1, 8] }")
SQUEEZED = SQUEEZED.replace("stages = [", "stages = [SQUEEZE")
SQUEEZED += """
supports.base.components = ["z"]
supports.left = { face = "a.u0", components = ["x"] }
supports.right = { face = "a.u1", components = ["x"] }
"""
SQUEEZE = '{ name = "squeeze", steps = 2, motions = { left.translate = [WAY, 0, 0], right.translate = [-WAY, 0, 0] } }, '
LONG = re.compile(r"elements of its master block.w1 are too long for it, .* too large by about (\d+) %")


def run(text: str) -> list[str]:
    """What is said in a run."""
    heard = Heard()
    list(Simulation(Scene.from_toml(text).problem(), heard).run())
    return heard.said


@case(
    claim="Elements of a master that are too long are told as well where bodies have turned far before: a turn is nothing that gives way.",
    tier="gate",
    bounds={
        "turned": Bound(at_most=0.11, reason="definition: what is told beside what is told without a turn, one digit of two; 1 is nothing"),
    },
)
def after_a_turn() -> dict[str, float]:
    """How far what is told is off."""
    text = TURNED.replace("ORDER", "2").replace("MANY", "3").replace("YOUNG", "100")
    still, turned = (
        [float(found[1]) for words in run(text.replace("TURN", turn).replace("WAY", way)) if (found := LONG.search(words))]
        for turn, way in (("", "[0, 0, -0.05]"), (TURN, "[-0.05, 0, 0]"))
    )
    return {"turned": abs(turned[0] / still[0] - 1.0) if turned and still else 1.0}


@case(
    claim="Narrow contact is told as well on a block that was squeezed along its face before: that is no bending.",
    tier="gate",
    grid={"way": (0.0, 0.2)},
    bounds={"said": Bound(1.0, 1.0, "definition: sentences of a contact that is too narrow")},
)
def squeezed_before(way: float) -> dict[str, float]:
    """How many."""
    said = run(SQUEEZED.replace("SQUEEZE", SQUEEZE if way else "").replace("WAY", str(way)))
    return {"said": float(sum(NARROW.search(words) is not None for words in said))}


#: Two columns on each other, of other lengths and moduli, that do not widen; the upper one under a motion, a force, or a pressure alone.
COLUMNS = """
format = 1
materials = { soft = { young = 1, poisson = 0 }, hard = { young = 4, poisson = 0 } }
bodies.a.material = "soft"
bodies.a.mesh = { order = 1, elements = [1, 1, 5] }
bodies.a.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 2] }
bodies.b.material = "hard"
bodies.b.mesh = { order = 1, elements = [1, 1, 2] }
bodies.b.geometry = { kind = "box", lower = [0, 0, -1], upper = [1, 1, 0] }
contacts.c = { slave = "a.w0", master = "b.w1", friction = 0.5 }
supports.base.face = "b.w0"
PUSHED
"""
_STEP = 'stages = [{ name = "press", steps = 1 MOTION }]'
PUSHED = {
    "motion": 'supports.top = { face = "a.w1", axis = [0, 0, 1], centre = [0.5, 0.5, 2] }\n'
    + _STEP.replace("MOTION", ", motions.top = { translate = [0, 0, -1e-5], rotate = 1e-4 }"),
    "force": 'supports.top = { face = "a.w1", force.z = -1e-6 }\n' + _STEP.replace("MOTION", ""),
    "pressure": 'supports.top = { face = "a.w1", components = ["x", "y"] }\nloads.top = { face = "a.w1", pressure = 1e-6 }\n'
    + _STEP.replace("MOTION", ""),
}


@case(
    claim="Columns give way to the pressure of their contact by its length over modulus, whether a motion, a force or a pressure pushes "
    "them, and whatever friction does; one that nothing holds along it as a chain of masses does that is pushed at its end.",
    tier="gate",
    grid={"pushed": tuple(PUSHED)},
    bounds={
        "slave": Bound(at_most=1e-4, reason="theory: of columns, and of the chain, (n - 1) (2 n - 1) / 6 n; strains are 1e-6"),
        "master": Bound(at_most=1e-4, reason="theory: of columns; strains are 1e-6"),
    },
)
def columns(pushed: str) -> dict[str, float]:
    """How far what is told is off."""
    simulation = Simulation(Scene.from_toml(COLUMNS.replace("PUSHED", PUSHED[pushed])).problem())
    kept, after_step = list[Balance](), simulation._watches.after_step
    simulation._watches.after_step = lambda balance, *other: kept.append(balance) or after_step(balance, *other)  # type: ignore[method-assign, func-returns-value]
    (last,) = simulation.run()
    pressure = abs(float(last.contacts[0].force_slave[2]))
    chain = 0.4 * 5 * 11 / 36
    slave, master = giving_way(simulation.equilibrium, kept[-1], 0)
    return {
        "slave": abs(slave / (pressure * (chain if pushed == "pressure" else 2.0)) - 1.0),
        "master": abs(master / (pressure * 0.25) - 1.0),
    }


#: A thin beam that is bent by a cylinder narrower than its elements, or by an edge; and a block on a soft bed under a cylinder.
CYLINDER_ON_BEAM = """
format = 1
materials.m = { young = 100, poisson = 0.3 }
bodies.a = { geometry = { kind = "box", lower = [0, 0, -0.1], upper = [2, 0.2, 0] }, mesh = { order = [2, 1, 2], elements = MESH } }
bodies.b = { rigid = true, geometry = { kind = "ring", inner = 0.02, outer = 0.1, width = 0.4, centre = [1.8, 0.1, 0.1], axis = "y" } }
contacts.c = { slave = "a.w1", master = "b.v1", friction = 0, projection = "closest" }
supports = { base.face = "a.u0", top.face = "b.v0" }
stages = [{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.1] }]
"""
EDGE = (
    CYLINDER_ON_BEAM.replace(
        '{ kind = "ring", inner = 0.02, outer = 0.1, width = 0.4, centre = [1.8, 0.1, 0.1], axis = "y" }',
        '{ kind = "box", lower = [1.5, -0.1, 0], upper = [1.6, 0.3, 0.2] }',
    )
    .replace("b.v1", "b.w0")
    .replace("b.v0", "b.w1")
    .replace(', projection = "closest"', "")
)
BED = (
    STRIP.replace("AT", "0")
    .replace("order = 2, elements = 8 }", 'order = [2, 1, 2], elements = MESH }, material = "m"')
    .replace("-0.02]", "-0.15]")
    .replace("a.w0", "bed.w0")
    + """
materials.soft = { young = 0.05, poisson = 0.3 }
bodies.bed.material = "soft"
bodies.bed.geometry = { kind = "box", lower = [-1, 0, -2], upper = [1, 0.2, -1] }
bodies.bed.mesh = { order = [2, 1, 2], elements = MESH }
glue = [["a.w0", "bed.w1"]]
"""
)
#: Each with elements that are too long, and with many; what bends is told as far as a contact costs it.
BENT = {
    "cylinder": (CYLINDER_ON_BEAM, "[8, 1, 1]", "[80, 1, 4]"),
    "bed": (BED, "[8, 1, 4]", "[64, 1, 16]"),
    "edge": (EDGE, "[6, 1, 1]", "[100, 1, 4]"),
}
SHARE = re.compile(r"Forces under given motions may be (?:off|too large) by about (\d+) %")


@case(
    claim="Of a beam that is bent by a cylinder, and of a block on a soft bed, it is told by how much elements that are too long for the "
    "contact cost its force; of a beam that is bent by an edge, where they cost little, nothing is, nor with many elements.",
    tier="gate",
    grid={"scene": tuple(BENT)},
    bounds={
        "told": Bound(at_most=0.06, reason="definition: the share that is told less that which is missing, one digit of two"),
        "fine": Bound(0.0, 0.0, "definition: sentences with many elements"),
    },
)
def bent(scene: str) -> dict[str, float]:
    """How far what is told is off."""
    text, coarse, fine = BENT[scene]
    said, forces = list[list[str]](), list[float]()
    for mesh in (coarse, fine):
        heard = Heard()
        *_, last = Simulation(Scene.from_toml(text.replace("MESH", mesh)).problem(), heard).run()
        said.append([found[1] for words in heard.said if (found := SHARE.search(words))])
        forces.append(abs(float(last.contacts[0].force_slave[2])))
    share = 0.01 * float(said[0][0]) if said[0] else 0.0
    return {"told": abs(share - abs(forces[0] / forces[1] - 1.0)), "fine": float(len(said[1]))}


#: A strip that lies on a rigid floor by a contact, or is held on its base, under a cylinder narrower than its elements.
LYING = """
format = 1
materials.m = { young = 10, poisson = 0.3 }
bodies.a = { geometry = { kind = "box", lower = [-1, 0, -0.2], upper = [1, 0.2, 0] }, mesh = { order = [2, 1, 2], elements = [6, 1, 2] } }
bodies.b.rigid = true
bodies.b.geometry = { kind = "ring", inner = 0.2, outer = 1, width = 0.4, centre = [0.1, 0.1, 1], axis = "y" }
bodies.b.mesh = { order = [2, 1, 1], elements = [8, 8, 1] }
bodies.floor = { rigid = true, geometry = { kind = "box", lower = [-2, -1, -1.2], upper = [2, 1, -0.2] } }
contacts.c = { slave = "a.w1", master = "b.v1", friction = 0, projection = "closest" }
HOW
supports.end = { face = "a.u0", components = ["x"] }
supports.top.face = "b.v0"
supports.back = { face = "a.v0", components = ["y"] }
supports.front = { face = "a.v1", components = ["y"] }
supports.floor.face = "floor.w0"
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.02] }]
"""
HOW = (
    'contacts.f = { slave = "a.w0", master = "floor.w1", friction = 0 }',
    'supports.base = { face = "a.w0", components = ["z"] }',
)


@case(
    claim="A strip that another contact keeps from bending is told what narrow contact costs it as one that supports hold: by itself it "
    "would bend far more.",
    tier="gate",
    bounds={
        "told": Bound(at_least=0.5, reason="definition: share of the force that is missing, 68 % beside 96 elements"),
        "apart": Bound(at_most=0.03, reason="definition: what is told of both, one digit of two"),
    },
)
def lying() -> dict[str, float]:
    """The share of the strip that lies, and by how much that of the other one differs."""
    lies, held = ([0.01 * float(found[1]) for words in run(LYING.replace("HOW", how)) if (found := SHARE.search(words))] for how in HOW)
    return {"told": lies[0] if lies else 0.0, "apart": abs(lies[0] - held[0]) if lies and held else 1.0}
