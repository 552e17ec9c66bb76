"""What is said of bodies whose forces are lost in round-off: how much is out of balance, and what supports, loads and contacts bear."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from told.runs import Heard

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Balance
from isomortar.solve.record import StepResult
from isomortar.told.during.lost import DEFORMED, LOST, LostDigits

#: A block between a rigid plane and another block, of size 2, on whose upper side a load is.
SCENE = """
format = 1
bodies.low.geometry = { kind = "box", lower = [-1, -1, 0], upper = [1, 1, 0.5] }
bodies.low.mesh = { family = "L", order = 1, elements = [2, 2, 1] }
bodies.high.geometry = { kind = "box", lower = [-1, -1, 0.5], upper = [1, 1, 1] }
bodies.high.mesh = { family = "L", order = 1, elements = [2, 2, 1] }
contacts.floor = { slave = "low.w0", plane = {}, friction = 0 }
contacts.between = { slave = "high.w0", master = "low.w1", friction = 0 }
supports.side = { edge = "low.u0.w1", components = ["x", "y"] }
supports.top.face = "high.w1"
loads.wind = { face = "low.u1", pressure = 0.001 }
loads.gale = { face = "high.u1", pressure = 0.001 }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.02] }]
"""
SIZE = 2.0
#: A plane of symmetry doubles what is out of balance.
SYMMETRIES = ("", "symmetry = { y = 0.0 }\n")
#: A force whose components are not alike, and its length.
FORCE, LENGTH = np.array([2.0, -3.0, 6.0]), 7.0
SAID = re.compile(r"body '(\w+)', load step 1: its forces are lost in round-off: (\S+) is out of balance where .* bear (\S+?)\. It is")


def nothing(result: StepResult) -> StepResult:
    """The result, of which nothing bears anything."""
    zero = np.zeros(3)
    return replace(
        result,
        reactions=tuple(replace(reaction, force=zero, moment=zero) for reaction in result.reactions),
        loads=tuple(replace(load, force=zero, moment=zero) for load in result.loads),
        contacts=tuple(replace(contact, force_slave=zero, force_master=zero) for contact in result.contacts),
    )


def by_support(name: int, by_moment: bool) -> Callable[[StepResult, FloatArray], StepResult]:
    """What a support bears; a moment counts by the size of the body."""

    def bears(result: StepResult, force: FloatArray) -> StepResult:
        reactions = list(result.reactions)
        change = {"moment": SIZE * force} if by_moment else {"force": force}
        reactions[name] = replace(reactions[name], **change)  # type: ignore[arg-type]
        return replace(result, reactions=tuple(reactions))

    return bears


def by_load(name: int) -> Callable[[StepResult, FloatArray], StepResult]:
    """What a load is."""

    def bears(result: StepResult, force: FloatArray) -> StepResult:
        loads = list(result.loads)
        loads[name] = replace(loads[name], force=force)
        return replace(result, loads=tuple(loads))

    return bears


def by_contact(name: int) -> Callable[[StepResult, FloatArray], StepResult]:
    """What a contact bears, on both of its sides."""

    def bears(result: StepResult, force: FloatArray) -> StepResult:
        contacts = list(result.contacts)
        contacts[name] = replace(contacts[name], force_slave=force, force_master=-force)
        return replace(result, contacts=tuple(contacts))

    return bears


#: What bears something, and which of the two bodies that counts for.
BEARING = (
    (by_support(0, by_moment=False), {"low"}),
    (by_support(0, by_moment=True), {"low"}),
    (by_support(1, by_moment=False), {"high"}),
    (by_support(1, by_moment=True), {"high"}),
    (by_load(0), {"low"}),
    (by_load(1), {"high"}),
    (by_contact(0), {"low"}),
    (by_contact(1), {"low", "high"}),
)


def left_over(simulation: Simulation) -> Balance:
    """A deformed state that leaves a known force on each body, on free unknowns; on those that are held it does not count."""
    equilibrium = simulation.equilibrium
    positions, held = equilibrium.numbering.reference.copy(), equilibrium.supports.held
    positions[:, 2] *= 1.0 + 0.1 * positions[:, 0]
    forces = np.where(held, 1e3, 0.0)
    for piece in range(2):
        own = equilibrium.numbering.piece_points(piece)
        free = own.start + np.flatnonzero(~held[own].any(axis=1))
        forces[free[0]], forces[free[1]] = 0.25 * FORCE, 0.75 * FORCE
    internal = equilibrium.solid.forces(positions)
    return Balance(positions, internal, internal, forces, (), ())


@case(
    claim="Of a body it is said that its forces are lost in round-off where what is left of them, of the whole, is more than a share of "
    "the largest force of a support, load or contact on it, or of a support's moment over its size.",
    tier="gate",
    grid={"symmetry": SYMMETRIES},
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: bodies of which it is said, or not, wrongly"),
        "left": Bound(0.0, 0.0, "definition: sentences with another force that is out of balance than the one of the whole"),
    },
)
def lost(symmetry: str) -> dict[str, float]:
    """How many, of what bears just enough, just not enough, and of many that each bear not enough."""
    simulation = Simulation(Scene.from_toml(SCENE.replace("stages", symmetry + "stages")).problem())
    images = 2 if symmetry else 1
    balance, result = left_over(simulation), nothing(next(iter(simulation.run())))
    enough = images * FORCE / LOST
    cases = [(bears(result, 1.01 * enough), bodies) for bears, bodies in BEARING]
    cases += [(bears(result, 0.99 * enough), set[str]()) for bears, _ in BEARING]
    together = result
    for bears, _ in BEARING:
        together = bears(together, 0.6 * enough)
    wrong = others = 0
    for given, bodies in [*cases, (together, set[str]())]:
        told = [
            found.groups() for sentence in LostDigits(simulation.equilibrium).after_step(balance, given) if (found := SAID.search(sentence))
        ]
        wrong += len({body for body, *_ in told} ^ ({"low", "high"} - bodies))
        others += sum(float(left) != images * LENGTH for _, left, _ in told)
    return {"wrong": float(wrong), "left": float(others)}


@case(
    claim="A body deforms by one control point that is pushed aside by more than round-off, whichever way; by round-off it does not.",
    tier="gate",
    grid={"axis": (0, 1, 2), "way": (-1, 1)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: bodies whose forces are lost and of which it is not said, or the other way round")},
)
def pushed_aside(axis: int, way: int) -> dict[str, float]:
    """Of two bodies, by twice the share of their size from which on it counts, and by half of it."""
    simulation = Simulation(Scene.from_toml(SCENE).problem())
    result, numbering = nothing(next(iter(simulation.run()))), simulation.equilibrium.numbering
    balance, wrong = left_over(simulation), 0
    for share, bodies in ((2.0, {"low", "high"}), (0.5, set[str]())):
        positions = numbering.reference.copy()
        for piece in range(2):
            own = numbering.piece_points(piece)
            middle = np.linalg.norm(positions[own] - positions[own].mean(axis=0), axis=1).argmin()
            positions[own.start + middle, axis] += way * share * DEFORMED * SIZE
        told = LostDigits(simulation.equilibrium).after_step(replace(balance, positions=positions), result)
        wrong += len({found[1] for sentence in told if (found := SAID.search(sentence))} ^ bodies)
    return {"wrong": float(wrong)}


#: A block on another one, pressed by what is next to nothing, in four ways; the first load is one of a size that nothing is lost of.
SMALL = """
format = 1
bodies.low = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1.2, 1.1, 0.5] }, mesh = { order = 2, elements = [3, 3, 1] } }
bodies.up = { geometry = { kind = "box", lower = [0.3, 0.25, 0.5], upper = [0.9, 0.8, 1.0] }, mesh = { order = 2, elements = [2, 2, 1] } }
contacts.c = { slave = "up.w0", master = "low.w1", friction = 0.3 }
supports.base.face = "low.w0"
WAY
"""
_FREE = 'supports.top = { face = "up.w1", components = ["x", "y"]'
WAYS = {
    "motion": 'supports.top.face = "up.w1"\nstages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -SIZE] }]',
    "force": _FREE + ', force = { z = -SIZE } }\nstages = [{ name = "press", steps = 1 }]',
    "pressure": _FREE + ' }\nloads.wind = { face = "up.w1", pressure = SIZE }\nstages = [{ name = "press", steps = 1 }]',
    "weight": _FREE + ' }\nloads.own = { body = "up", weight = [0, 0, -SIZE] }\nstages = [{ name = "press", steps = 1 }]',
}
SIZES = (1e-8, 1e-11, 1e-14, 1e-15, 1e-16, 1e-18, 1e-20)


def borne(way: str, size: float) -> tuple[float, bool]:
    """The force of a contact over the size of what presses it, and whether anything is said of round-off."""
    heard = Heard()
    (result,) = Simulation(Scene.from_toml(SMALL.replace("WAY", WAYS[way].replace("SIZE", repr(size)))).problem(), heard).run()
    return float(result.contacts[0].force_slave[2]) / size, any("round-off" in said for said in heard.said)


@case(
    claim="Loads and motions so small that round-off takes a twentieth of what a contact bears of them are told; others are not.",
    tier="gate",
    grid={"way": tuple(WAYS)},
    bounds={
        "silent": Bound(0.0, 0.0, "definition: of sizes, those at which a twentieth is lost and nothing is said"),
        "wrong": Bound(0.0, 0.0, "definition: those at which a ten-thousandth is lost at the most, and it is said"),
        "lost": Bound(at_least=1.0, reason="definition: of the first, or nothing is tried"),
    },
)
def too_small(way: str) -> dict[str, float]:
    """How many of each."""
    found = [borne(way, size) for size in SIZES]
    off = [(abs(force / found[0][0] - 1.0), told) for force, told in found]
    return {
        "silent": float(sum(share > 0.05 and not told for share, told in off)),
        "wrong": float(sum(share < 1e-4 and told for share, told in off)),
        "lost": float(sum(share > 0.05 for share, _ in off)),
    }
