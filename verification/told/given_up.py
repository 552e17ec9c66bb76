"""What is said of a load step that is given up, word by word: what a singular tangent leaves free, what toggles, and what is behind it."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from told.beside import STOPPED, given_up_at
from told.circling import round_in_a_circle
from told.other_ways import DUAL, pressed
from told.repeated import STUCK
from told.shared import CORNERED
from told.thin_masters import BOWL, FILM, ended
from told.word_by_word import SENTENCES
from told.wrong.causes import said, scene
from told.wrong.contacts import PRESS
from told.wrong.plates import ROLLS
from told.wrong.singular import BLOCK, CORNER, error, explained

from isomortar.errors import ConvergenceError, SingularSystemError
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.model.constants import LARGEST_TURN
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.singular import explain
from isomortar.solve.timing import Ledger
from isomortar.solve.trail import toggling

#: A block that a cohesion holds as it is dragged: its rear edge opens.
COHESIVE = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [0.5, 0.6, 0.4] }, mesh.elements = [2, 1, 1] }
bodies.base.geometry = { kind = "box", lower = [-0.2, -0.2, -0.4], upper = [1.5, 0.9, 0] }
bodies.base.mesh = { order = [2, 2, 1], elements = [3, 2, 1] }
contacts.free = { slave = "block.u0", plane = { point = [-1, 0, 0], normal = [1, 0, 0] } }
contacts.sole = { slave = "block.w0", master = "base.w1", friction = 0.3, cohesion = 0.02 }
supports.base.face = "base.w0"
supports.top = { face = "block.w1", components = ["x", "y"], force = { z = -0.1 } }
stages = [{ name = "press", steps = 1 }, { name = "drag", steps = 1, motions.top.translate = [0.04, 0, 0] }]
solver.max_cuts = 0
"""
#: A load on one body, and another one beside it that supports leave free.
ELSEWHERE = """
format = 1
bodies.pad.geometry = { kind = "box", lower = [0, 0, -1], upper = [1, 1, 0] }
bodies.block.geometry = { kind = "box", lower = [0, 0, 0.2], upper = [1, 1, 1] }
contacts.c = { slave = "block.w0", master = "pad.w1" }
supports.base.face = "pad.w0"
supports.side = { face = "block.u0", components = ["x", "y"] }
loads.wind = { face = "pad.u1", pressure = 0.1 }
stages = [{ name = "blow", steps = 1 }]
"""
#: The same body, pressed from two sides.
BALANCED = ELSEWHERE.replace(
    'loads.wind = { face = "pad.u1", pressure = 0.1 }',
    'loads = { near = { face = "block.v0", pressure = 0.1 }, far = { face = "block.v1", pressure = 0.1 } }',
)


def begun(text: str) -> Simulation:
    """A scene as it is when its first load step is given up."""
    simulation = Simulation(Scene.from_toml(text).problem())
    simulation.equilibrium.time = 1.0
    return simulation


def lifted(height: float) -> Simulation:
    """The block that is dragged, at a height above its base."""
    return begun(COHESIVE.replace("[0, 0, 0], upper = [0.5, 0.6, 0.4]", f"[0, 0, {height}], upper = [0.5, 0.6, {height + 0.4}]"))


def without_digits(sentence: str) -> str:
    """Numbers with an exponent, which are round-off, in short."""
    return re.sub(r"\d(\.\d+)?e[+-]\d+", "#", sentence)


def of_causes() -> Iterator[tuple[str, str]]:
    """Of a scene that is sound but for one number; of one whose lower body is pressed flat."""
    changes: dict[str, dict[str, Any]] = {
        "thin": {"TOP": 1.000001},
        "incompressible": {"POISSON": 0.499999},
        "stiffness": {"HARD": 1e12},
        "penalty": {"METHOD": "uzawa", "PENALTY": 1e4},
        "small penalty": {"METHOD": "uzawa", "PENALTY": 1e-3},
        "points": {"SLAVE": 1, "MASTER": 8},
        "short slip": {"SLIP": 1e-4},
    }
    yield from ((name, "\n".join(said(scene(**changed)))) for name, changed in changes.items())
    yield "few iterations", "\n".join(said(scene(PENALTY="100\nmax_iterations = 2"), ConvergenceError("Newton's method stopped at 1")))
    yield "thin, bent", "\n".join(said(scene(TOP=1.0004), SingularSystemError("")))
    yield "shared edge", "\n".join(said(Simulation(Scene.from_toml(CORNERED).problem())))
    yield "at an edge", "\n".join(said(given_up_at(-0.8, 2.0), ConvergenceError(STOPPED)))
    yield "through a thin master", ended(BOWL).rpartition("). ")[2]
    yield "through a film", ended(FILM).rpartition("). ")[2]
    yield "on the way", "\n".join(said(lifted(0.1)))
    yield "on the way, balanced", "\n".join(said(begun(BALANCED)))
    yield "averages", error(DUAL).partition("iterations. ")[2]
    yield "smooth friction", "\n".join(said(pressed(), ConvergenceError("Newton's method stopped at 1")))
    yield (
        "smooth pressures",
        "\n".join(said(scene(SLIP="0\nfriction = 0"), ConvergenceError("Newton's method stopped at 1; constraints 1 change their states"))),
    )
    flat: Simulation = scene()
    positions = flat.state.positions.copy()
    positions[np.unique(flat.equilibrium.numbering.points["lower"]), 2] *= 0.05
    flat.state = replace(flat.state, positions=positions)
    yield "pressed flat", "\n".join(said(flat))


def of_singular_tangents() -> Iterator[tuple[str, str]]:
    """What moves freely, what repeats, and what rests on nothing."""
    yield "rolls away", re.sub(r"condition [^)]*", "condition #", error(ROLLS))
    yield "slides", without_digits(error(BLOCK + 'supports.top = { face = "block.w1", components = ["y", "z"] }'))
    yield "turns", re.sub(r"\(.*?\)", "(#)", error(BLOCK + 'supports.top = { face = "block.w1", components = ["z"] }'))
    yield "held", explained([4], [])
    sole = "stages.press.motions={top={translate=[0, 0, -0.02]}, sole={translate=[0, 0, -0.02]}}"
    yield "all held", without_digits(error(BLOCK + 'supports.top = { face = "block.w1" }\nsupports.sole = { face = "block.w0" }', sole))
    yield "repeated", explained([], [3, 5])
    yield "held beside friction", without_digits(error(STUCK))
    yield "left", explained([], [3, 5], found=0)
    same = ("contacts.wall.slave='block.w0'", "contacts.wall.plane={ point = [1, 0, 0] }")
    yield "repeat others", re.sub(r"\d+|'\w+'", "#", error(CORNER, *same).partition("the first of them ")[2])
    bodies = Equilibrium(Scene.from_toml(BLOCK + 'supports.top.face = "block.w1"').problem(), Ledger())
    yield "nothing", str(explain(0.0, np.full(3, np.nan), bodies.supports, bodies.numbering.reference, bodies.numbering, []))


def of_iterations() -> Iterator[tuple[str, str]]:
    """What goes to and fro from iteration to iteration, and augmentations that are too few."""
    states = [np.array(s, dtype=np.int32).tobytes() for s in ([0, 1, 2, 1], [0, 1, 2, 2])]
    places = [np.zeros((2, 4), dtype=np.int32), np.array([[0, 0, 0, 0], [1, 0, 0, 0]], dtype=np.int32)]
    away, near = np.zeros(2, dtype=bool), np.ones(2, dtype=bool)
    none, opening = np.zeros(4, dtype=bool), [np.array(s, dtype=np.int32).tobytes() for s in ([0, 1, 0, 1], [2, 1, 1, 2])]
    yield "changing states", toggling(states, places, away, summed=False, cohesive=~none)
    yield "changing states, paper's sum", toggling(states, places, away, summed=True, cohesive=none)
    yield "opening without a cohesion", toggling(opening, places, away, summed=False, cohesive=none)
    yield "opening with a cohesion", toggling(opening, places, away, summed=False, cohesive=np.array([True, True, False, True]))
    yield "opens where dragged", without_digits(error(COHESIVE))
    yield "opens without a cohesion", without_digits(error(COHESIVE, "contacts.sole.cohesion=0", "solver.max_iterations=3"))
    yield "knot lines", toggling(states[:1] * 2, places, away, summed=True, cohesive=none)
    yield "poles", toggling(states[:1] * 2, places, near, summed=True, cohesive=none)
    yield "nothing changes", toggling(states[:1] * 2, places[:1] * 2, near, summed=True, cohesive=none)
    yield "circle", re.sub(r"points [\d, ]+\.\.\.", "points #", without_digits(round_in_a_circle(4)).replace("slip of #", "slip of 1e-09"))
    few = ("solver.method=uzawa", "solver.max_augmentations=2", "solver.max_cuts=0")
    yield "augmentations", without_digits(error(PRESS, *few))


def all_told() -> dict[str, str]:
    """What is said, by name."""
    return {name: text for told in (of_causes, of_singular_tangents, of_iterations) for name, text in told()}


@case(
    claim="Of a load step that is given up it is said what is behind it, by the one sentence that people read of it: what is singular, "
    "what changes from iteration to iteration, what of the scene is too extreme.",
    tier="gate",
    bounds={
        "others": Bound(0.0, 0.0, "definition: load steps of which something else is said, or nothing, or more"),
        "told": Bound(at_least=20.0, reason="definition: or nothing is tried"),
    },
    files=[SENTENCES],
)
def given_up() -> dict[str, float]:
    """Of how many."""
    expected = tomllib.loads(SENTENCES.read_text(encoding="utf-8"))["given_up"]
    told = all_told()
    others = [name for name in told.keys() | expected.keys() if told.get(name) != expected.get(name)]
    return {"others": float(len(others)), "told": float(len(told))}


@case(
    claim="Of a body that its loads move to a contact, or deform until it touches, it is said, where that is given up, that nothing bears "
    "it: while no support holds it and it has a way to go, and not where the tangent is singular, which tells what can move freely.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: what is said of bodies that are borne or held, or not said of one on its way")},
)
def on_the_way() -> dict[str, float]:
    """Of eight."""
    waits, touches, words = lifted(0.1), lifted(0.0), "touches nothing where that begins"
    held = Simulation(Scene.from_toml(BLOCK + "supports.top.face = 'block.w1'").problem())
    next(touches.run())
    apart = 0.01 * float(np.sqrt(0.5 * 0.6))  # a hundredth of the face's size is no way to go
    silent = [words not in "".join(said(other)) for other in (waits, begun(BALANCED), lifted(1.02 * apart))]
    wrong = [*silent, *(words in "".join(said(other)) for other in (touches, held, begun(ELSEWHERE), lifted(0.98 * apart)))]
    return {"wrong": float(sum(wrong) + (words in "".join(said(waits, SingularSystemError("")))))}


@case(
    claim="What a body can do freely is told whatever its modulus is, and in whatever unit that is.",
    tier="gate",
    grid={"young": (1e-12, 1.0, 1e12)},
    bounds={"silent": Bound(0.0, 0.0, "definition: motions that are free and are not told")},
)
def freely(young: float) -> dict[str, float]:
    """Of two: a way, and a turn."""
    block = BLOCK + f"materials.m.young = {young}\nsupports.top.face = 'block.w1'\nsupports.top.components = "
    told = {"['y', 'z']": "can move along (1, 0, 0) freely", "['z']": "can turn about an axis along ("}
    return {"silent": float(sum(words not in error(block + components) for components, words in told.items()))}


#: A rigid ram above a block, which a force takes away from it.
TAKEN_AWAY = """
format = 1
bodies.low = { geometry = { kind = "box", lower = [-1, -1, -1], upper = [1, 1, 0] }, mesh.elements = [2, 2, 1] }
bodies.ram = { rigid = true, geometry = { kind = "box", lower = [-0.5, -0.5, 0.2], upper = [0.5, 0.5, 0.5] }, mesh.order = 1 }
contacts.c = { slave = "low.w1", master = "ram.w0" }
supports.base.face = "low.w0"
supports.hand = { face = "ram.w1", components = ["x", "y"], force.z = 0.1 }
stages = [{ name = "take", steps = 2 }]
solver.max_cuts = 2
"""


@case(
    claim="A rigid body that a force takes away from all contact is told to move freely, by both methods.",
    tier="gate",
    grid={"method": ("monolithic", "uzawa")},
    bounds={"silent": Bound(0.0, 0.0, "definition: rigid bodies that are free and are not told")},
)
def rigid_freely(method: str) -> dict[str, float]:
    """Whether it is not."""
    return {"silent": float("body 'ram' can move along (0, 0, 1) freely" not in error(TAKEN_AWAY, f"solver.method={method}"))}


@case(
    claim="Where less than half of the quadrature points are on the master, a deformation that nothing resists is put down to those that "
    "are beside it; else not.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: numbers of points of which something else is said")},
)
def points_beside() -> dict[str, float]:
    """Of how many numbers of points."""
    total = int(re.findall(r"of the (\d+) quadrature points", explained([], [3, 5], found=0))[0])
    told = [
        f"rest on {total - beside} of the {total} quadrature points" in explained([4], [], beside=beside) for beside in range(total + 1)
    ]
    right = [2 * (total - beside) < total for beside in range(total + 1)]
    return {"wrong": float(sum(one != other for one, other in zip(told, right, strict=True)))}


@case(
    claim="The shortest load increment that is named is the one that was tried last, also where turns of supports make all shorter.",
    tier="gate",
    grid={"degrees": (0.0, 30.0, 90.0), "cuts": (0, 2)},
    bounds={"off": Bound(0.0, 0.0, reason="definition: it began at rest, so that it ended at the load time that is named")},
)
def shortest_increment(degrees: float, cuts: int) -> dict[str, float]:
    """One over it, by its words and by its load time, apart from one over the longest one that turns allow, halved as often as allowed."""
    turning = "supports.top = { face = 'block.w1', components = ['y', 'z'], axis = [1, 0, 0] }"
    said = error(BLOCK + turning, f"solver.max_cuts={cuts}", f"stages.press.motions.top.rotate={degrees}")
    time, parts = re.findall(r"at load time (\S+), even with an increment of 1/(\d+) step", said)[0]
    expected = int(np.maximum(np.ceil(degrees / LARGEST_TURN), 1.0)) * 2**cuts
    return {"off": abs(int(parts) - expected) + abs(round(1.0 / float(time)) - expected)}


#: A block that is pressed, and touches nothing.
ALONE = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh.elements = 2 }
supports = { top.face = "block.w1", base.face = "block.w0" }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.9] }]
solver = { max_iterations = 1, max_cuts = 1 }
"""


@case(
    claim="A load step of a scene without contact that is given up says why, by both methods.",
    tier="gate",
    grid={"method": ("monolithic", "uzawa")},
    bounds={"wrong": Bound(0.0, 0.0, "definition: whether something else is said, or it ends otherwise")},
)
def without_contact(method: str) -> dict[str, float]:
    """Whether it is."""
    said_of = error(ALONE, f"solver.method={method}")
    return {"wrong": float("after 1 iterations. Load steps may need more than solver.max_iterations = 1" not in said_of)}
