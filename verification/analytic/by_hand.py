"""Scenes whose forces, work or pressures are known by hand: ramps, grooves, rods on rough planes, plates that touch down, tubes, beams."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from isomortar._frozen import frozen
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.solve.record import ContactResult, StepResult


@frozen
class Run:
    """A run of a scene."""

    problem: Problem
    results: Sequence[StepResult]

    @property
    def last(self) -> ContactResult:
        """The first contact at the end."""
        return self.results[-1].contacts[0]

    def support(self, step: int, name: str, component: int) -> float:
        """A component of what a support exerts."""
        number = [support.name for support in self.problem.supports].index(name)
        return float(self.results[step].reactions[number].force[component])

    def work(self, first: int, last: int) -> float:
        """What friction takes up in load steps, the last one left out."""
        return sum(result.contacts[0].friction_work for result in self.results[first:last])


#: What is computed, and what it is by hand.
Known = list[tuple[float, float]]

#: A block of a weight on a ramp of 15 degrees, whose axes are those of the scene, pushed up along it and let down again.
RAMP = f"""
format = 1
materials.m = {{ young = 1e4, poisson = 0.3 }}
bodies.b.geometry = {{ kind = "box", lower = [0, 0, 0], upper = [1, 0.5, 0.6] }}
bodies.b.mesh.elements = [3, 2, 2]
contacts.c = {{ slave = "b.w0", plane = {{}}, friction = 0.2 }}
loads.weight = {{ body = "b", weight = [{-math.sin(math.radians(15))}, 0, {-math.cos(math.radians(15))}] }}
supports.hand = {{ face = "b.u0", components = ["x"] }}
[[stages]]
name = "rest"
steps = 1
[[stages]]
name = "up"
steps = 3
motions.hand.translate = [0.1, 0, 0]
[[stages]]
name = "down"
steps = 4
motions.hand.translate = [-0.15, 0, 0]
"""


def _ramp(run: Run) -> Known:
    along, across = (0.3 * function(math.radians(15)) for function in (math.sin, math.cos))
    up, down = (run.support(step, "hand", 0) for step in (3, 7))
    return [(up, along + 0.2 * across), (down, along - 0.2 * across), (run.work(0, 4), 0.2 * across * 0.1)]


#: A block under a pressure that is sheared to and fro, and across: all of it slides, but for what the block gives way.
TO_AND_FRO = """
format = 1
materials.m = { young = 1e4, poisson = 0.3 }
bodies.b.geometry = { kind = "box", lower = [-0.5, -0.5, 0], upper = [0.5, 0.5, 0.2] }
bodies.b.mesh.elements = [3, 3, 2]
contacts.c = { slave = "b.w0", plane = {}, friction = 0.4 }
loads.p = { face = "b.w1", pressure = 1 }
supports.hand = { face = "b.w1", components = ["x", "y"] }
stages = [
    { name = "rest", steps = 1 },
    { name = "to", steps = 2, motions.hand.translate = [0.02, 0, 0] },
    { name = "back", steps = 4, motions.hand.translate = [-0.04, 0, 0] },
    { name = "again", steps = 4, motions.hand.translate = [0.04, 0, 0] },
    { name = "across", steps = 4, motions.hand.translate = [0, 0.04, 0] },
]
"""


def _to_and_fro(run: Run) -> Known:
    gives = 0.4 * 0.2 * 2.6 / 1e4
    return [(run.work(3, 11), 0.4 * 2.0 * (0.04 - 2.0 * gives)), (run.support(-1, "hand", 1), 0.4)]


#: A wedge of 20 degrees that a load presses into a groove.
GROOVE = f"""
format = 1
materials.m = {{ young = 1e4, poisson = 0.3 }}
bodies.w.geometry = {{ kind = "wedge", bottom = [-0.2, 0.2], top = [{-0.2 - 0.5 * math.tan(math.radians(20))}, \
{0.2 + 0.5 * math.tan(math.radians(20))}], y = [0, 0.4], z = [0, 0.5] }}
bodies.w.mesh.elements = [3, 2, 3]
contacts.l = {{ slave = "w.u0", friction = 0.15, plane = {{ point = [-0.2, 0, 0], normal = [{math.cos(math.radians(20))}, 0, \
{math.sin(math.radians(20))}] }} }}
contacts.r = {{ slave = "w.u1", friction = 0.15, plane = {{ point = [0.2, 0, 0], normal = [{-math.cos(math.radians(20))}, 0, \
{math.sin(math.radians(20))}] }} }}
loads.p = {{ face = "w.w1", traction = [0, 0, -10] }}
supports = {{ side = {{ face = "w.v0", components = ["y"] }}, middle = {{ face = "w.w1", components = ["x"] }} }}
stages = [{{ name = "in", steps = 2 }}]
"""


def _groove(run: Run) -> Known:
    return [(float(contact.force_slave[2]), 2.0 * (0.4 + math.tan(math.radians(20)))) for contact in run.results[-1].contacts]


#: A plate between walls that a load bends down on a floor: it touches down where w'''' = p brings it there without slope and moment.
TOUCHES_DOWN = """
format = 1
materials.m = { young = 1000, poisson = 0, law = "linear-elastic" }
bodies.s.geometry = { kind = "box", lower = [0, 0, 0.02], upper = [1.5, 0.1, 0.04] }
bodies.s.mesh = { order = [3, 2, 2], elements = [48, 1, 1] }
contacts.c = { slave = "s.w0", plane = {}, friction = 0 }
loads.p = { face = "s.w1", traction = [0, 0, -0.08] }
supports.wall.face = "s.u0"
supports.middle = { face = "s.u1", components = ["x"] }
supports.side = { face = "s.v0", components = ["y"] }
stages = [{ name = "load", steps = 4 }]
"""


def _touches_down(run: Run) -> Known:
    span = (72.0 * 1000.0 * 0.02**3 / 12.0 * 0.02 / 0.08) ** 0.25
    wall = 0.1 * 0.08 * span * 2.0 / 3.0
    return [(run.support(-1, "wall", 2), wall), (float(run.last.force_slave[2]), 0.1 * 0.08 * 1.5 - wall)]


#: A heavy strip whose end is lifted off the floor: by w'''' = w, too.
LIFTED = """
format = 1
materials.m = { young = 1000, poisson = 0, law = "linear-elastic" }
bodies.s.geometry = { kind = "box", lower = [0, 0, 0], upper = [3, 0.1, 0.02] }
bodies.s.mesh = { order = [3, 2, 2], elements = [60, 1, 1] }
contacts.c = { slave = "s.w0", plane = {}, friction = 0 }
loads.w = { body = "s", weight = [0, 0, -2.5] }
supports.end = { edge = "s.u1.w0", components = ["z"] }
supports.middle = { face = "s.u0", components = ["x"] }
supports.side = { face = "s.v0", components = ["y"] }
stages = [{ name = "rest", steps = 1 }, { name = "lift", steps = 4, motions.end.translate = [0, 0, 0.05] }]
"""


def _lifted(run: Run) -> Known:
    end = 0.5 * 0.1 * 0.05 * (24.0 * 1000.0 * 0.02**3 / 12.0 * 0.05 / 0.05) ** 0.25
    return [(run.support(-1, "end", 2), end), (float(run.last.force_slave[2]), 0.1 * 0.05 * 3.0 - end)]


#: A long thin rod under a pressure on a rough plane that a force at its end pushes along: it slips as far as friction does not bear that.
ROD = """
format = 1
materials.m = { young = 1000, poisson = 0, law = "linear-elastic" }
bodies.r.geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 0.1, 0.02] }
bodies.r.mesh.elements = [40, 1, 1]
contacts.c = { slave = "r.w0", plane = {}, friction = 0.5 }
loads.p = { face = "r.w1", pressure = 1 }
loads.f = { face = "r.u0", traction = [37.5, 0, 0] }
supports.side = { face = "r.v0", components = ["y"] }
stages = [{ name = "rest", steps = 1, loads.f = 0 }, { name = "push", steps = 4, loads.f = 1 }]
"""


def _rod(run: Run) -> Known:
    return [(run.work(0, 5), 0.1 * 0.75**3 / (6.0 * 0.5 * 1000.0 * 0.02)), (-float(run.last.force_slave[0]), 0.075)]


#: A tube that is shrunk on another one, by Lamé; a quarter of both, free along their axis.
SHRUNK = """
format = 1
materials.m = { young = 1000, poisson = 0.3, law = "linear-elastic" }
bodies.in.geometry = { kind = "ring", inner = 0.5, outer = 1.0005, width = 0.5, angles = [0, 90] }
bodies.in.mesh.elements = [3, 3, 2]
bodies.out.geometry = { kind = "ring", inner = 0.9995, outer = 1.6, width = 0.5, angles = [0, 90] }
bodies.out.mesh.elements = [4, 3, 2]
contacts.c = { slave = "in.v1", master = "out.v0", friction = 0 }
supports.a = { face = "in.u0", components = ["x"] }
supports.b = { face = "in.u1", components = ["z"] }
supports.c = { face = "out.u0", components = ["x"] }
supports.d = { face = "out.u1", components = ["z"] }
supports.e = { face = "in.w0", components = ["y"] }
supports.f = { face = "out.w0", components = ["y"] }
stages = [{ name = "fit", steps = 1 }]
"""


def _shrunk(run: Run) -> Known:
    soft = (1.0 + 0.25) / (1.0 - 0.25) + (2.56 + 1.0) / (2.56 - 1.0)
    return [(float(end), 1.0 / soft) for end in run.last.pressure_field]


#: Two beams out of one wall, one on the other without friction, pressed down at the end: the front of their contact goes over them by a row
#: a tangent, however short load increments are.
BEAMS = """
format = 1
materials.m = { young = 1000, poisson = 0, law = "linear-elastic" }
bodies.a.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 0.1, 0.05] }
bodies.a.mesh = { family = "L", order = [3, 2, 2], elements = [10, 1, 1] }
bodies.b.geometry = { kind = "box", lower = [0, 0, -0.05], upper = [1, 0.1, 0] }
bodies.b.mesh = { family = "L", order = [3, 2, 2], elements = [7, 1, 1] }
contacts.c = { slave = "a.w0", master = "b.w1", friction = 0 }
supports = { a.face = "a.u0", b.face = "b.u0", tip = { edge = "a.u1.w1", components = ["z"] } }
stages = [{ name = "press", steps = 2, motions.tip.translate = [0, 0, -0.02] }]
solver.max_cuts = 0
"""


def _beams(run: Run) -> Known:
    return [(-run.support(-1, "tip", 2), 2.0 * 0.02 * 3.0 * 1000.0 * 0.1 * 0.05**3 / 12.0)]


SCENES: dict[str, tuple[str, Callable[[Run], Known]]] = {
    "ramp, up and down": (RAMP, _ramp),
    "to and fro, and across": (TO_AND_FRO, _to_and_fro),
    "wedge in a groove": (GROOVE, _groove),
    "plate that touches down": (TOUCHES_DOWN, _touches_down),
    "strip that is lifted": (LIFTED, _lifted),
    "rod that slips in part": (ROD, _rod),
    "tube that is shrunk on another": (SHRUNK, _shrunk),
    "beams out of one wall": (BEAMS, _beams),
}
#: What bounds are, where they are not those of exact sums: of beams, whose order is not told, and of rods of some elements.
OFF = {
    "plate that touches down": 2e-3,
    "strip that is lifted": 5e-3,
    "rod that slips in part": 0.03,
    "tube that is shrunk on another": 1e-3,
    "beams out of one wall": 5e-3,
}


def _bounds(scene: str) -> dict[str, Bound]:
    return {
        "off": Bound(at_most=OFF.get(scene, 1e-3), reason="theory: of rigid blocks, of thin rods and plates, of Lamé; meshes are coarse")
    }


def off(scene: str, changes: Sequence[str] = ()) -> float:
    """The largest share that any number is off by."""
    text, known = SCENES[scene]
    problem = Scene.from_toml(text, overrides=tuple(changes)).problem()
    found = known(Run(problem, list(Simulation(problem).run())))
    return sorted(abs(number / true - 1.0) for number, true in found)[-1]


@case(
    claim="Forces, the work of friction and pressures are as by hand: of blocks on ramps and in grooves, of rods that slip in part, of "
    "plates that touch down or are lifted, of a tube that is shrunk on another, and of beams out of one wall.",
    tier="gate",
    grid={"scene": tuple(SCENES)},
    bounds=_bounds,
)
def by_hand(scene: str) -> dict[str, float]:
    """How far off they are."""
    return {"off": off(scene)}


@case(
    claim="What slides over a plane takes the forces and the work that are known by hand, whatever is constrained and by either method.",
    tier="gate",
    grid={
        "scene": ("ramp, up and down", "to and fro, and across", "wedge in a groove"),
        "way": ("dual", "knots", "greville", "demko", "uzawa"),
    },
    bounds={"off": Bound(at_most=5e-3, reason="theory: of rigid blocks; augmentations end at a thousandth")},
)
def by_hand_otherwise(scene: str, way: str) -> dict[str, float]:
    """How far off they are."""
    uzawa = ["solver.method='uzawa'", "solver.augmentation_tolerance=1e-3"]
    names = [name for name in ("c", "l", "r") if f"contacts.{name} =" in SCENES[scene][0]]
    return {"off": off(scene, uzawa if way == "uzawa" else [f"contacts.{name}.enforcement='{way}'" for name in names])}
