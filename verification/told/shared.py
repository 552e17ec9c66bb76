"""What is said of control points that two contacts share at the edge between them: of those that bear on both, and stick to one."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import product

import numpy as np
from told.wrong.singular import CORNER

from isomortar.errors import ConvergenceError
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.equilibrium import Equilibrium
from isomortar.solve.record import StepResult
from isomortar.told.after.shared_edges import shared_edges
from isomortar.told.during.sharing import Sharing

TOLD = re.compile(r"contacts 'floor' and 'wall', load step 1: (\d+) slave control points at the edge between them bear on both and stick")
STATES = OPEN, STICK, SLIP = 0, 1, 2
#: What a load step converges with whose contacts are then given other states.
SLIPPERY = ("contacts.floor.friction=0.0", "contacts.wall.friction=0.0")
#: States of a shared point in the one contact and in the other of which something is said.
SHARED = {(STICK, STICK), (STICK, SLIP), (SLIP, STICK)}


def with_states(equilibrium: Equilibrium, result: StepResult, floor: int, wall: int, count: int) -> StepResult:
    """The result with so many of the shared points in some states, all others of the floor sticking and those of the wall open."""
    one, other = equilibrium.pairs
    edge, mine, theirs = np.intersect1d(one.pair.slave.point, other.pair.slave.point, return_indices=True)
    assert count < len(edge)
    contacts = []
    for found, shared, state, others in zip(result.contacts, (mine, theirs), (floor, wall), (STICK, OPEN), strict=True):
        status = np.full_like(found.status, others)
        status[shared] = OPEN
        status[shared[1 : count + 1]] = state
        contacts.append(replace(found, status=status))
    return replace(result, contacts=tuple(contacts))


@case(
    claim="Two contacts are said to share forces by as many control points as are closed in both and stick in one or both, once, if there "
    "is friction in one of them.",
    tier="gate",
    grid={"floor": (0.0, 0.2), "wall": (0.0, 0.2)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: states of the shared points of which something else is said")},
)
def shared(floor: float, wall: float) -> dict[str, float]:
    """How many of nine, each said by the program twice."""
    friction = (f"contacts.floor.friction={floor}", f"contacts.wall.friction={wall}")
    equilibrium = Simulation(Scene.from_toml(CORNER, overrides=friction).problem()).equilibrium
    result, wrong = next(iter(Simulation(Scene.from_toml(CORNER, overrides=SLIPPERY).problem()).run())), 0
    for count, states in enumerate(product(STATES, STATES)):
        sharing, given = Sharing(equilibrium), with_states(equilibrium, result, *states, 1 + count % 3)
        said = [*sharing.after_step(given), *sharing.after_step(given)]
        numbers = [int(found[1]) if (found := TOLD.match(sentence)) else 0 for sentence in said]
        wrong += numbers != [1 + count % 3] * (states in SHARED and floor + wall > 0.0)
    return {"wrong": float(wrong)}


#: A block in the corner between two others that is pressed down, and towards the one beside it.
CORNERED = """
format = 1
bodies.base = { geometry = { kind = "box", lower = [-0.5, 0, 0], upper = [0.5, 1, 1] }, mesh.elements = 3 }
bodies.left = { geometry = { kind = "box", lower = [0, 0, 1], upper = [0.5, 1, 2] }, mesh.elements = 2 }
bodies.right = { geometry = { kind = "box", lower = [0.5, 0, 0.5], upper = [1, 1, 1.8] }, mesh.elements = 3 }
contacts.one = { slave = "left.w0", master = "base.w1", friction = 0.6 }
contacts.three = { slave = "left.u1", master = "right.u0", friction = 0.6 }
supports = { foot.face = "base.w0", near.face = "left.w1", far.face = "right.u1" }
solver = { max_cuts = 2 }
stages = [{ name = "press", steps = 1, motions.near.translate = [0.1, 0, -0.1] }]
"""
#: What is advised there, as changes of the scene.
CURES = (("contacts.one.friction=0",), ("contacts.three.friction=0",))


def ending(changes: tuple[str, ...] = ()) -> str:
    """Why that is given up; nothing, where it is not."""
    try:
        list(Simulation(Scene.from_toml(CORNERED, overrides=changes).problem()).run())
    except ConvergenceError as error:
        return str(error)
    return ""


@case(
    claim="A load step that is given up where what sticks to one master is pushed along by another one is told that, with the contacts, "
    "and each cure that it names lets it converge.",
    tier="gate",
    bounds={
        "told": Bound(1.0, 1.0, "definition: sentences on the contacts that share an edge"),
        "cured": Bound(2.0, 2.0, "definition: cures that help"),
    },
)
def pushed_along() -> dict[str, float]:
    """How many."""
    told = ending().count("Contacts 'one' and 'three' touch on 4 slave control points at the edge between their faces")
    return {"told": float(told), "cured": float(sum(not ending(changes) for changes in CURES))}


#: Two patches glued to one, each with a contact with the same plane, that are pressed farther than they are thick.
_SIDE_BY_SIDE = """
format = 1
solver = { method = "uzawa", max_cuts = 0, max_iterations = 12 }
glue = [["left.u1", "right.u0"]]
bodies.left = { geometry = { kind = "box", lower = [-1, 0, 0], upper = [0, 1, 0.5] }, mesh = { order = 2, elements = [3, 3, 2] } }
bodies.right = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }, mesh = { order = 2, elements = [3, 3, 2] } }
contacts.one = { slave = "left.w0", plane = {}, friction = 0.3 }
contacts.other = { slave = "right.w0", plane = {}, friction = 0.3 }
supports = { near.face = "left.w1", far.face = "right.w1" }
[[stages]]
name = "press"
steps = 1
motions = { near.translate = [0, 0, -0.02], far.translate = [0, 0, -0.02] }
[[stages]]
name = "push"
steps = 1
motions = { near.translate = [0.4, 0, -0.3], far.translate = [0.4, 0, -0.3] }
"""


@case(
    claim="Where faces of glued patches go on from each other on one plane nothing is said of an edge.",
    tier="gate",
    bounds={"said": Bound(0.0, 0.0, "definition: sentences"), "given up": Bound(1.0, 1.0, "definition: there is something to say")},
)
def side_by_side() -> dict[str, float]:
    """How often it is."""
    try:
        list(Simulation(Scene.from_toml(_SIDE_BY_SIDE).problem()).run())
    except ConvergenceError as error:
        return {"said": float("at the edge" in str(error)), "given up": 1.0}
    return {"said": 0.0, "given up": 0.0}


#: Two blocks beside each other on a third one.
THREE = """
format = 1
bodies.base = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh.elements = 2 }
bodies.left = { geometry = { kind = "box", lower = [0, 0, 1], upper = [0.5, 1, 2] }, mesh.elements = 2 }
bodies.right = { geometry = { kind = "box", lower = [0.5, 0, 1], upper = [1, 1, 2] }, mesh.elements = 2 }
contacts.one = { slave = "left.w0", master = "base.w1" }
contacts.two = { slave = "right.w0", master = "base.w1" }
contacts.three = { slave = "left.u1", master = "right.u0" }
supports = { foot.face = "base.w0", near.face = "left.w1", far.face = "right.w1" }
stages = [{ name = "press", steps = 1, motions.near.translate = [0, 0, -0.1], motions.far.translate = [0, 0, -0.1] }]
"""
_BETWEEN = 'contacts.three = { slave = "left.u1", master = "right.u0" }'
#: In the place of the contact between the blocks: one more of the face that another one has; the blocks are glued, and one is at a wall.
ONE_FACE = THREE.replace(_BETWEEN, 'contacts.three = { slave = "left.w0", plane = { point = [0, 0, 1] } }')
GLUED = THREE.replace(_BETWEEN, 'glue = [["left.u1", "right.u0"]]\ncontacts.three = { slave = "left.u0", plane = { normal = [1, 0, 0] } }')
GLUED = GLUED.replace('contacts.two = { slave = "right.w0", master = "base.w1" }\n', "").replace('"left.w0"', '["left.w0", "right.w0"]')
FROM_BOTH, FROM_ONE, FROM_THREE = "friction from 'one' or 'three'", "friction from 'one'", "friction from 'three'"
#: A scene, what is changed in it, and where friction is to be taken from; none: nothing is said.
EDGES: tuple[tuple[str, tuple[str, ...], str], ...] = (
    (THREE, (), FROM_BOTH),
    (THREE, ("contacts.three.friction=0",), FROM_ONE),
    (THREE, ("contacts.one.friction=0",), FROM_THREE),
    (THREE, ("contacts.one.friction=0", "contacts.three.friction=0"), ""),
    (THREE, ("bodies.right.geometry.lower=[0.6,0,1]", "bodies.right.geometry.upper=[1.1,1,2]"), ""),  # a gap is between them
    (ONE_FACE, (), ""),
    (GLUED, (), FROM_BOTH),
    (GLUED, ("contacts.three.plane.point=[-0.1,0,0]",), ""),
)


@case(
    claim="Contacts that touch at an edge between adjoining faces of a body are told, by the friction that one or both have; of two "
    "contacts of one face, and of faces that touch nothing, nothing is said.",
    tier="gate",
    bounds={"wrong": Bound(0.0, 0.0, "definition: scenes of which something else is said")},
)
def at_edges() -> dict[str, float]:
    """How many."""
    wrong = 0
    for text, changes, words in EDGES:
        simulation = Simulation(Scene.from_toml(text, overrides=changes).problem())
        told = list(shared_edges(simulation.equilibrium, simulation.state))
        wrong += len(told) != bool(words) or any("'one' and 'three' touch on 4" not in one or not one.endswith(words) for one in told)
    return {"wrong": float(wrong)}
