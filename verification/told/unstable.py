"""What is said of bodies that buckle while all load steps converge, against Euler's loads; and that nothing is said of others."""

from __future__ import annotations

import re
from itertools import product

import numpy as np
from told.runs import Heard

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium

#: A slender column under a plate that slides on it, clamped below.
COLUMN = """
format = 1
materials.m = { young = 1e4, poisson = 0 }
bodies.c = { geometry = { kind = "box", lower = [0, 0, 0], upper = [0.04, 0.1, 1] }, mesh = { order = 3, elements = [1, 2, 8] } }
bodies.p = { rigid = true, geometry = { kind = "box", lower = [-1, -1, 1], upper = [1, 1, 1.5] } }
contacts.top = { slave = "c.w1", master = "p.w0", friction = FRICTION }
supports.base.face = "c.w0"
supports.hand.face = "p.w1"
solver.method = "METHOD"
stages = [{ name = "press", steps = 2, motions.hand.translate = [0, 0, -DOWN] }]
"""
#: The same under a load, beside a plane that it does not reach.
MAST = """
format = 1
materials.m = { young = 1e4, poisson = 0 }
bodies.c = { geometry = { kind = "box", lower = [0, 0, 0], upper = [0.04, 0.1, 1] }, mesh = { order = 3, elements = [1, 2, 8] } }
contacts.wall = { slave = "c.u1", plane = { point = [1, 0, 0], normal = [-1, 0, 0] } }
supports.base.face = "c.w0"
loads.top = { face = "c.w1", traction = [0, 0, -PRESSURE] }
stages = [{ name = "press", steps = 2 }]
"""
#: A cube of which all control points are held.
HELD = """
format = 1
materials.m.young = 1
bodies.c = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { family = "L", order = 1, elements = 1 } }
contacts.floor = { slave = "c.w0", plane = { point = [0, 0, -1] } }
supports = { low.face = "c.w0", high.face = "c.w1" }
stages = [{ name = "stand", steps = 1 }]
"""
#: A block that is pressed onto a floor, and sticks or slips there.
BLOCK = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, WIDE, 1] }
bodies.block.mesh = { order = ORDER, elements = ELEMENTS }
contacts.floor = { slave = "block.w0", plane = { point = [0, 0, 0], normal = [0, 0, 1] }, friction = FRICTION }
supports.top.face = "block.w1"
stages = [{ name = "press", steps = 2, motions.top.translate = [ASIDE, 0, -0.1] }]
"""
#: Eigenvalue of what forces move, over the largest, down to which it is round-off.
ROUND_OFF = -1e-9
BENDING, AREA = 1e4 * 0.1 * 0.04**3 / 12.0, 0.1 * 0.04
#: Euler's loads over pi^2 EI / L^2, by what holds the upper end: nothing, its turn, its turn and its way as well, and so both ends do.
EULER = {"free": 0.25, "sliding": 1.0, "sticking": 4.0, "standing": 4.0}
#: What holds the lower end, and a floor on which it stands instead.
CLAMPED = 'supports.base.face = "c.w0"'
STANDING = 'contacts.floor = { slave = "c.w0", plane = { point = [0, 0, 0], normal = [0, 0, 1] }, friction = 0.5 }'
TOLD = re.compile(
    r"load step (\d+), the last of stage '\w+': the equilibrium is not stable: body '(\w+)' (?:buckles, or snaps,|goes off, or tips over, "
    r"as a whole) where .* control point \d+, along \((.*?)\) or against that"
)
#: A block that lies on a larger one by its weight alone.
LYING = """
format = 1
bodies.base = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh.elements = 4 }
bodies.block = { geometry = { kind = "box", lower = [0.2, 0.2, 1], upper = [0.8, 0.8, 1.6] }, mesh.elements = 3 }
contacts.c = { slave = "block.w0", master = "base.w1", friction = FRICTION }
supports.foot.face = "base.w0"
loads.weight = { body = "block", weight = [0, 0, -0.1] }
stages = [{ name = "lie", steps = 2 }]
"""


def told(text: str) -> list[re.Match[str]]:
    """What is said of buckling in a run."""
    heard = Heard()
    list(Simulation(Scene.from_toml(text).problem(), heard).run())
    return [found for said in heard.said if (found := TOLD.search(said))]


def column(end: str, share: float, method: str) -> str:
    """The scene in which it bears a share of Euler's load."""
    strain = share * EULER[end] * np.pi**2 * BENDING / (1e4 * AREA)
    if end == "free":
        return MAST.replace("PRESSURE", f"{1e4 * strain:.9f}")
    friction = "0" if end == "sliding" else "0.5"
    lower = STANDING if end == "standing" else CLAMPED
    return COLUMN.replace(CLAMPED, lower).replace("FRICTION", friction).replace("DOWN", f"{strain:.9f}").replace("METHOD", method)


@case(
    claim="A column that bears more than Euler's load, whatever holds its end, is told to buckle, in its weak direction, and below that it "
    "is not; so it is by both methods, and where a load across has bent it.",
    tier="gate",
    grid={"end": tuple(EULER), "method": ("monolithic", "uzawa")},
    bounds={
        "below": Bound(0.0, 0.0, "definition: sentences at 0.92 of Euler's load"),
        "above": Bound(1.0, 1.0, "definition: sentences at 1.08 of it that it buckles, along x"),
    },
)
def buckles(end: str, method: str) -> dict[str, float]:
    """What is said of both."""
    below, above = (told(column(end, share, method)) for share in (0.92, 1.08))
    return {
        "below": float(len(below)),
        "above": float(sum(abs(float(found[3].split(",")[0])) > 0.99 and "buckles" in found[0] for found in above)),
    }


def against(equilibrium: Equilibrium) -> int:
    """How many motions all unit forces, each moving what it does, have that go against what makes them: real eigenvalues below zero."""
    moved = np.array([equilibrium.moved_by(force) for force in np.eye(len(equilibrium.supports.free))])
    values = np.linalg.eigvals(moved)
    largest = np.abs(values).max() if np.abs(moved).max() > 1e-9 else np.inf
    return int(np.sum((np.abs(values.imag) < -ROUND_OFF * largest) & (values.real < ROUND_OFF * largest)))


@case(
    claim="A block that friction holds, or that slips, in its middle or at once, is not said to buckle: forces that slip turn aside go "
    "against what they move as a whole, and where all is held nothing moves but by round-off; no motion goes against its own force, by "
    "all of them.",
    tier="gate",
    grid={"elements": (1, 2, 3), "friction": (0.1, 0.2, 0.5, 1.0, 3.0)},
    bounds={
        "said": Bound(0.0, 0.0, "definition: sentences, of orders 1 and 2, pressed straight and aside, of a cube and a flat block"),
        "against": Bound(0.0, 0.0, "definition: motions that go against their forces, by dense eigenvalues"),
    },
)
def rubs(elements: int, friction: float) -> dict[str, float]:
    """What is said, and whether something buckles."""
    said = found = 0
    for order, aside, wide in product((1, 2), (0.0, 0.03), (1, 2)):
        text = BLOCK.replace("ORDER", str(order)).replace("ELEMENTS", str(elements)).replace("ASIDE", str(aside))
        heard = Heard()
        simulation = Simulation(Scene.from_toml(text.replace("FRICTION", str(friction)).replace("WIDE", str(wide))).problem(), heard)
        list(simulation.run())
        said += sum(bool(TOLD.search(sentence)) for sentence in heard.said)
        found += against(simulation.equilibrium)
    return {"said": float(said), "against": float(found)}


def softest(simulation: Simulation) -> float:
    """Least eigenvalue of the bodies' own stiffness at the end of a run, of all free unknowns without contact, over the largest."""
    equilibrium, positions, step = simulation.equilibrium, simulation.state.positions, 1e-6
    free, columns = equilibrium.supports.free, []
    for unknown in free:
        one = np.zeros(positions.size)
        one[unknown] = step
        ahead, behind = (equilibrium.solid.forces(positions + sign * one.reshape(-1, 3)) for sign in (1.0, -1.0))
        columns.append((ahead - behind).ravel()[free] / (2.0 * step))
    values = np.linalg.eigvalsh(0.5 * (np.array(columns) + np.array(columns).T))
    return float(values[0] / values[-1])


@case(
    claim="A block whose stiffness is definite even without its floor is not said to buckle, however high the friction is that it slips "
    "under, where motions do go against their forces.",
    tier="gate",
    grid={"poisson": (-0.99, -0.7, 0.45), "friction": (5.0, 10.0)},
    bounds={
        "said": Bound(0.0, 0.0, "definition: sentences"),
        "softest": Bound(at_least=1e-5, reason="definition: least over largest eigenvalue of the block's own stiffness: it cannot buckle"),
    },
)
def jams(poisson: float, friction: float) -> dict[str, float]:
    """What is said of a press by a twentieth."""
    text = (
        BLOCK.replace("ORDER", "2")
        .replace("ELEMENTS", "3")
        .replace("ASIDE", "0")
        .replace("-0.1", "-0.05")
        .replace("steps = 2", "steps = 1")
    )
    text = f"{text.replace('FRICTION', str(friction)).replace('WIDE', '1')}\nmaterials.m.poisson = {poisson}\n"
    heard = Heard()
    simulation = Simulation(Scene.from_toml(text).problem(), heard)
    list(simulation.run())
    return {"said": float(sum(bool(TOLD.search(sentence)) for sentence in heard.said)), "softest": softest(simulation)}


@case(
    claim="Of a column that a load across lets bend nothing is said: it is where it comes to rest; nor is of one that is held everywhere.",
    tier="gate",
    bounds={
        "said": Bound(0.0, 0.0, "definition: sentences of both"),
        "bent": Bound(at_least=0.02, reason="definition: how far it is bent, in lengths, or it might not be stable"),
    },
)
def bends() -> dict[str, float]:
    """What is said, and how far it bends."""
    text = MAST.replace("PRESSURE", f"{1.2 * 0.25 * np.pi**2 * BENDING / AREA:.9f}").replace("steps = 2", "steps = 12")
    heard = Heard()
    text += 'loads.across = { face = "c.w1", traction = [0.02, 0, 0] }\n'
    *_, last = Simulation(Scene.from_toml(text).problem(), heard).run()
    said = sum(bool(TOLD.search(sentence)) for sentence in heard.said) + len(told(HELD))
    return {"said": float(said), "bent": float(last.state.positions[:, 0].max() - 0.04)}


#: What stands beside a column and touches nothing of it: a much softer block, and a much more slender mast of the same material.
BESIDE = {
    "a soft block": """
materials.soft = { young = 1e-4, poisson = 0.3 }
bodies.b = { material = "soft", geometry = { kind = "box", lower = [0, 10, 0], upper = [1, 11, 1] }, mesh.elements = 2 }
contacts.lid = { slave = "b.w1", plane = { point = [0, 0, 2], normal = [0, 0, -1] } }
supports.foot.face = "b.w0"
""",
    "a slender mast": """
bodies.b.material = "m"
bodies.b.geometry = { kind = "box", lower = [0, 10, 0], upper = [0.04, 10.1, 8] }
bodies.b.mesh = { order = 3, elements = [1, 2, 16] }
contacts.lid = { slave = "b.w1", plane = { point = [0, 0, 9], normal = [0, 0, -1] } }
supports.foot.face = "b.w0"
""",
}


@case(
    claim="A column that bears more than Euler's load is told to buckle beside what touches nothing and is far softer or more slender, and "
    "of a column that bears less nothing is said there.",
    tier="gate",
    grid={"beside": tuple(BESIDE), "end": tuple(EULER)},
    bounds={
        "below": Bound(0.0, 0.0, "definition: sentences at 0.92 of Euler's load"),
        "above": Bound(1.0, 1.0, "definition: sentences at 1.08 of it that name the column"),
        "far above": Bound(1.0, 1.0, "definition: the same at five times that load"),
    },
)
def buckles_beside_others(beside: str, end: str) -> dict[str, float]:
    """What is said at three loads."""
    below, above, far = (
        [
            found[2]
            for found in told(column(end, share, "monolithic").replace("bodies.c = {", 'bodies.c = { material = "m",') + BESIDE[beside])
        ]
        for share in (0.92, 1.08, 5.0)
    )
    return {"below": float(len(below)), "above": float(above == ["c"]), "far above": float(far == ["c"])}


@case(
    claim="A block that lies without friction in the middle of another one, from where it slides off to any side, is told to go off as a "
    "whole, along the ground; with friction nothing is said, and what buckles is told to buckle.",
    tier="gate",
    bounds={
        "goes": Bound(1.0, 1.0, "definition: sentences without friction, that it goes as a whole, and aside"),
        "lies": Bound(0.0, 0.0, "definition: sentences with friction"),
        "buckles": Bound(1.0, 1.0, "definition: sentences on a column, that it buckles"),
    },
)
def goes_off() -> dict[str, float]:
    """What is said."""
    goes, lies = (told(LYING.replace("FRICTION", friction)) for friction in ("0", "0.3"))
    return {
        "goes": float(sum("as a whole" in found[0] and abs(float(found[3].split(",")[2])) < 0.1 for found in goes)),
        "lies": float(len(lies)),
        "buckles": float(sum("buckles" in found[0] for found in told(column("sliding", 1.08, "monolithic")))),
    }


#: A column of two glued halves that is held in its middle, where that takes no force, and let go while nothing else changes.
LET_GO = """
format = 1
materials.m = { young = 1e4, poisson = 0 }
bodies.c = { geometry = { kind = "box", lower = [0, 0, 0], upper = [0.02, 0.1, 1] }, mesh = { order = 3, elements = [1, 2, 8] } }
bodies.d = { geometry = { kind = "box", lower = [0.02, 0, 0], upper = [0.04, 0.1, 1] }, mesh = { order = 3, elements = [1, 2, 8] } }
glue = [["c.u1", "d.u0"]]
contacts.wall = { slave = "d.u1", plane = { point = [1, 0, 0], normal = [-1, 0, 0] } }
supports = { base.face = "c.w0", other.face = "d.w0", side = { edge = "c.u1.w1", components = ["x"], stages = ["press"] } }
loads = { one = { face = "c.w1", traction = [0, 0, -PRESSURE] }, other = { face = "d.w1", traction = [0, 0, -PRESSURE] } }
solver.method = "METHOD"
stages = [{ name = "press", steps = 2 }, { name = "let", steps = 1 }]
"""


@case(
    claim="A column that is let go while nothing moves, so that its load step takes no solve, is told to buckle above Euler's load, and "
    "below it is not.",
    tier="gate",
    grid={"method": ("monolithic", "uzawa")},
    bounds={
        "below": Bound(0.0, 0.0, "definition: sentences at 0.92 of Euler's load"),
        "above": Bound(1.0, 1.0, "definition: sentences at 1.08 of it, of the last load step"),
        "solves": Bound(0.0, 0.0, "definition: iterations of that load step, or nothing is tried"),
    },
)
def let_go(method: str) -> dict[str, float]:
    """What is said."""
    below, above = list[str](), list[str]()
    for share, said in ((0.92, below), (1.08, above)):
        heard, strain = Heard(), share * EULER["free"] * np.pi**2 * BENDING / (1e4 * AREA)
        text = LET_GO.replace("PRESSURE", f"{1e4 * strain:.9f}").replace("METHOD", method)
        *_, last = Simulation(Scene.from_toml(text).problem(), heard).run()
        said += [found[1] for sentence in heard.said if (found := TOLD.search(sentence))]
    solves = sum(len(record.iterations) - 1 for record in last.augmentations)
    return {"below": float(len(below)), "above": float(above == ["3"]), "solves": float(solves)}


@case(
    claim="A mast is told to buckle in however few load steps its load comes: factors of where one began would serve, as nothing bends.",
    tier="gate",
    grid={"steps": (1, 2, 3)},
    bounds={
        "below": Bound(0.0, 0.0, "definition: sentences at 0.92 of Euler's load"),
        "above": Bound(2.0, 2.0, "definition: sentences at 1.08 and at five times it"),
    },
)
def at_once(steps: int) -> dict[str, float]:
    """What is said at three loads."""
    below, above, far = (len(told(column("free", share, "").replace("steps = 2", f"steps = {steps}"))) for share in (0.92, 1.08, 5.0))
    return {"below": float(below), "above": float(above + far)}
