"""What is said of a body that friction is about to let go, by how much of it is used up; and of one that a moment turns beyond it."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np

from isomortar.errors import ConvergenceError
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.told.after.more_friction import more_friction
from isomortar.told.after.sliding import sliding

#: A block of elements of other sizes than one, which a plate presses onto a floor by 1 and pushes along it.
SCENE = """
format = 1
materials.cork = { young = 50, poisson = 0 }
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [6, 3, 0.5] }, mesh.elements = [3, 2, 1], material = "cork" }
contacts.floor = { slave = "block.w0", plane = {}, friction = 0.3 }
supports.top = { face = "block.w1", components = [HELD], axis = [0, 0, 1], centre = [3, 1.5, 0.5], force = FORCE, MOMENT }
stages = [{ name = "press", steps = 1, loads.top = 1 }]
solver.max_cuts = 1
"""
BEARS = re.compile(r"friction of contact 'floor' bears (\d+) % of what it can by then, and nothing else keeps body 'block'")
TURNS = re.compile(
    r"at load time ([\d.]+), .*oads turn body 'block' about an axis along \(0, 0, 1\) by (\S+) by then, "
    r"where friction of contact 'floor' can bear about (\S+) at"
)
#: Shares of what friction can bear that push the block; from 90 % on it is told.
TOLD, SILENT = (0.93, 0.95, 0.98), (0.5, 0.8, 0.87)
#: Mean distance of the floor from the axis that the block turns about.
ARM = np.hypot(*np.meshgrid(np.linspace(-2.995, 2.995, 600), np.linspace(-1.495, 1.495, 300))).mean()


def borne(share: float, poisson: float = 0.0) -> float:
    """Per cent of friction that are told to be borne where the plate pushes by a share of it; 0: nothing is told."""
    force = f"{{ x = {0.3 * share}, z = -1 }}"
    text = SCENE.replace("HELD", '"y"').replace("FORCE", force).replace(", MOMENT", "").replace("poisson = 0", f"poisson = {poisson}")
    simulation = Simulation(Scene.from_toml(text).problem())
    list(simulation.run())
    said = [BEARS.search(sentence) for _, sentence in sliding(simulation.equilibrium, simulation.state)]
    return float(np.sum([float(found[1]) for found in said if found]))


def turned(moment: float) -> tuple[float, float]:
    """The moment that is told to turn the block over that which does by then, and what friction is told to bear over what it can."""
    text = SCENE.replace("HELD", '"x", "y"').replace("FORCE", "{ z = -1 }").replace("MOMENT", f"moment = {moment}")
    try:
        list(Simulation(Scene.from_toml(text).problem()).run())
    except ConvergenceError as error:
        if found := TURNS.search(str(error)):
            time, told, limit = map(float, found.groups())
            return told / (time * moment), limit / (0.3 * time * ARM)
    return 0.0, 0.0


@case(
    claim="A body that friction alone keeps from going along with its loads is told of where that bears nine tenths of what it can, by "
    "what share that is, and not one that is squeezed out to all sides against friction; a moment that turns one is told by its size, "
    "whatever size the body has.",
    tier="gate",
    bounds={
        "share": Bound(at_most=0.51, reason="definition: per cent are whole numbers; of equal pressures all friction goes one way"),
        "silent": Bound(0.0, 0.0, "definition: bodies that are told of, of which friction bears less"),
        "squeezed": Bound(0.0, 0.0, "definition: bodies that are told of though nothing pushes them along, of rubber on its friction"),
        "moment": Bound(at_most=0.01, reason="round-off: three digits are told"),
        "limit": Bound(at_most=0.2, reason="discretisation: control points for the floor's area"),
    },
)
def told_to_slide() -> dict[str, float]:
    """How far shares are off; how many are told; how far the moment is off, and what friction bears of it."""
    moment, limit = turned(1.0)
    return {
        "share": float(np.abs([borne(share) - 100.0 * share for share in TOLD]).max()),
        "silent": float(np.count_nonzero([borne(share) for share in SILENT])),
        "squeezed": float(np.count_nonzero(borne(0.0, poisson=0.45))),
        "moment": abs(moment - 1.0),
        "limit": abs(limit - 1.0),
    }


#: What limits two contacts at their constraints: the largest tractions there and how much of what they bear in all is theirs.
CAPPED = {"one": 0.2, "other": None}
LIMITS: tuple[tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...], str], ...] = (
    ((0.1, 0.1), (1.0, 1.0), (1.0,), "more friction"),
    ((0.1, 0.2), (1.0, 1.0), (1.0,), "more friction or a larger contacts.one.traction_max"),
    ((0.2, 0.2), (1.0, 1.0), (0.0,), "a larger contacts.one.traction_max"),
    ((0.1, 0.2), (1.0, 0.1), (1.0,), "more friction"),  # of which the part is less than a twentieth
    ((0.1, 0.2), (0.0, 1.0), (0.04,), "a larger contacts.one.traction_max"),
)


@case(
    claim="What would let contacts bear more friction is told by what limits it: the coefficient, or the largest traction, or both.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: limits of which something else is told")},
)
def what_limits() -> dict[str, float]:
    """How many."""
    floor = Scene.from_toml(SCENE.replace("HELD", '"x", "y"').replace("FORCE", "{}").replace("MOMENT", "moment = 0")).problem().contacts[0]
    one, other = (replace(floor, name=name, traction_max=most) for name, most in CAPPED.items())
    wrong = 0
    for tractions, parts, others, words in LIMITS:
        wrong += more_friction([(one, np.array(tractions), np.array(parts)), (other, np.ones(1), np.array(others))]) != words
    return {"wrong": float(wrong)}
