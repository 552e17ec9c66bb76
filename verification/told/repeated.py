"""What is said of contact conditions that a singular tangent finds without effect: which, and what repeats them, one at a time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from told.wrong.singular import CORNER, error

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.singular import PairConditions, explain
from isomortar.solve.timing import Ledger

#: A block in a corner of three planes, whose top is held.
SCENE = CORNER.replace(
    "contacts.wall", 'contacts.back = { slave = "block.v0", plane = { normal = [0, 1, 0] }, friction = 0.2 }\ncontacts.wall'
)
#: A block two sides of which are held, on a block too coarse to do all that sticks to it, and what gets past that.
STUCK = """
format = 1
bodies.block.geometry = { kind = "box", lower = [-0.3, -0.3, 0], upper = [0.3, 0.3, 0.5] }
bodies.block.mesh = { order = [2, 2, 1], elements = [3, 3, 1] }
bodies.base.geometry = { kind = "box", lower = [-0.6, -0.6, -0.5], upper = [0.7, 0.65, 0] }
bodies.base.mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
contacts.c = { slave = "block.w0", master = "base.w1", friction = 0.3 }
supports.top.face = "block.w1"
supports.floor.face = "base.w0"
supports.x = { face = "block.u0", components = ["x"] }
supports.y = { face = "block.v0", components = ["y"] }
stages = [{ name = "press", steps = 1, motions.top.translate = [0, 0, -0.1] }]
solver.max_cuts = 1
"""
WAYS = ("bodies.base.mesh.elements=[8, 8, 1]", "solver.method=uzawa")
#: Where each of its contacts is: the coordinate that is 0 there.
PLANES = {"floor": 2, "back": 1, "wall": 0}
HELD, OTHERS, BESIDE, EACH_OTHER = (
    "repeat what supports prescribe: ",
    "repeat others: ",
    "quadrature points around them",
    "repeat each other",
)


class Corner:
    """Its contacts with all of their constraints active, and directions of their multipliers."""

    def __init__(self) -> None:
        self.equilibrium = Equilibrium(Scene.from_toml(SCENE).problem(), Ledger())
        state, self.contacts, begin = self.equilibrium.initial_state(), {}, len(self.equilibrium.supports.free)
        for pair, begun in zip(self.equilibrium.pairs, state.contacts, strict=True):
            equation = np.arange(begin, begin + 3 * pair.pair.slave.test.count, dtype=np.int32)
            self.contacts[pair.pair.contact.name] = PairConditions(pair, equation, pair.kinematics(state.positions, begun))
            begin += len(equation)
        self.size = begin

    def place(self, name: str, constraint: int) -> np.ndarray:
        """Where the control point of a constraint is, shape (3,)."""
        return self.equilibrium.numbering.reference[self.contacts[name].pair.pair.slave.point[constraint]]

    def said(self, name: str, constraints: list[int], kind: int, beside: float = 0.0) -> str:
        """What is said of a direction of multipliers of some constraints; `beside` is the share of points that are not on the master."""
        contact, null = self.contacts[name], np.zeros(self.size)
        null[contact.equation[3 * np.array(constraints) + kind]] = 2.0
        null[0] = 1.0  # something moves, too, but less
        found = contact.kinematics.projections.found.copy()
        found[np.arange(len(found)) % 8 < 8 * beside] = 0
        there = replace(contact, kinematics=replace(contact.kinematics, projections=replace(contact.kinematics.projections, found=found)))
        contacts = [there if other == name else conditions for other, conditions in self.contacts.items()]
        equilibrium = self.equilibrium
        reference = equilibrium.numbering.reference
        return str(explain(0.0, null, equilibrium.supports, reference, equilibrium.numbering, contacts))


@case(
    claim="Conditions without effect are told by their contact and constraint, whatever kind of multiplier changes, and by what repeats "
    "them: the contact that is on the same control points, or nothing that is told of.",
    tier="gate",
    grid={"contact": tuple(PLANES)},
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: constraints of which something else is told"),
        "shared": Bound(at_least=3.0, reason="definition: constraints on another contact's control points, or there is nothing to tell"),
    },
)
def repeated(contact: str) -> dict[str, float]:
    """Of each constraint alone, by each kind of its multipliers."""
    corner, wrong, shared = Corner(), 0, 0
    for constraint in range(corner.contacts[contact].pair.pair.slave.test.count):
        place = corner.place(contact, constraint)
        others = {name for name, axis in PLANES.items() if name != contact and place[axis] == 0.0}
        shared += bool(others)
        for kind in range(3):
            said = corner.said(contact, [constraint], kind)
            wrong += f"contact {contact!r}: the conditions of 1 constraints, the first of them {constraint}, " not in said
            wrong += (EACH_OTHER in said) == bool(others) or (OTHERS in said) != bool(others)
            wrong += bool(others) and not any(f"control points that contact {name!r} constrains as well" in said for name in others)
    return {"wrong": float(wrong), "shared": float(shared)}


@case(
    claim="Conditions of which some are on control points that supports hold are told that, not where none or all are; and points that are "
    "beside the master first where they are most, and last where they are some.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: constraints of which something else is told")},
)
def prescribed_or_beside() -> dict[str, float]:
    """Of seven."""
    corner = Corner()
    places = np.array([corner.place("wall", n) for n in range(corner.contacts["wall"].pair.pair.slave.test.count)])
    held = np.flatnonzero((places[:, 2] == 1.0) & (places[:, 1] > 0.0))
    free = np.flatnonzero((places[:, 2] > 0.0) & (places[:, 2] < 0.6) & (places[:, 1] > 0.0))
    asked: tuple[tuple[list[int], float, str], ...] = (
        ([held[0], free[0]], 0.0, f"{HELD}1 of them"),
        ([*held[:2], free[0]], 0.0, f"{HELD}2 of them"),
        ([*held[:2]], 0.0, EACH_OTHER),
        ([*free[:2]], 0.0, EACH_OTHER),
        ([*free[:2]], 0.25, BESIDE),
        ([held[0], free[0]], 0.25, f"{HELD}1 of them"),
        ([held[0], free[0]], 0.75, BESIDE),
    )
    return {"wrong": float(sum(words not in corner.said("wall", constraints, 0, beside) for constraints, beside, words in asked))}


@case(
    claim="Where what sticks to a deformable master repeats what supports hold, a finer master and augmentations are advised; each of "
    "the two brings the run to its end.",
    tier="gate",
    bounds={
        "said": Bound(1.0, 1.0, "definition: load steps given up with that advice"),
        "given up": Bound(0.0, 0.0, "definition: runs that one of the two does not bring to their end"),
    },
)
def stuck_beside_supports() -> dict[str, float]:
    """Of one scene, and of both ways."""
    said = error(STUCK)
    ended = [len(list(Simulation(Scene.from_toml(STUCK, overrides=[way]).problem()).run())) == 1 for way in WAYS]
    advised = HELD in said and 'refine the master, try solver.method = "uzawa"' in said
    return {"said": float(advised), "given up": float(len(WAYS) - sum(ended))}
