"""What is said of friction that a master's coordinates lead astray: where they turn along the way, or stretch within a slave element."""

from __future__ import annotations

import re
from itertools import product
from types import SimpleNamespace
from unittest.mock import patch

import numpy as np
from told.runs import Heard

from isomortar.errors import InputError
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.told.during.astray import BESIDE as BESIDE_LIMIT
from isomortar.told.during.astray import BORNE as BORNE_LIMIT
from isomortar.told.during.astray import Astray

#: A block that is dragged along y, straight on, over a face at z = 0.
SCENE = """
format = 1
materials.m = { young = 10, poisson = 0.3 }
bodies.a = { geometry = { kind = "box", lower = [0.25, -0.25, 0], upper = [0.75, 0.25, 0.4] }, mesh = { order = 2, elements = [2, 2, 1] } }
bodies.b = MASTER
contacts.c = { slave = "a.w0", master = "b.FACE", friction = 0.3, projection = "closest" }
supports.top.face = "a.w1"
stages = [{ name = "p", steps = 1, motions.top.translate = [0, 0, -0.05] }, { name = "s", steps = 1, motions.top.translate = [0, 0.4, 0] }]
"""
_RING = '{ kind = "ring", inner = 0.15, outer = 1.5, width = 0.3, centre = [0, 0, -0.15], axis = "z" }'
_BOX = '{ kind = "box", lower = [-1.5, -1.5, -0.3], upper = [1.5, 1.5, 0] }'


def scene(geometry: str, face: str) -> str:
    """That of a rigid master."""
    return SCENE.replace(
        "MASTER", f"{{ rigid = true, geometry = {geometry}, mesh = {{ order = [2, 2, 1], elements = [8, 3, 1] }} }}"
    ).replace("FACE", face)


def weighted(weight: float, all_along: bool = False) -> str:
    """That of a rigid block of one element, of which the weights in the middle of its top, or all along the line at y = 0, are this."""
    points = [[x, y, z] for z, y, x in product((-0.3, 0.0), (-1.5, 0.0, 1.5), (-1.5, 0.0, 1.5))]
    weights = [weight if y == 0.0 and (all_along or x == 0.0) else 1.0 for x, y, _ in points]
    knots = [[0, 0, 0, 1, 1, 1], [0, 0, 0, 1, 1, 1], [0, 0, 1, 1]]
    patch = f"{{ order = [2, 2, 1], knots = {knots}, control_points = {points}, weights = {weights} }}"
    return SCENE.replace("MASTER", f"{{ rigid = true, patch = {patch} }}").replace("FACE", "w1")


#: The ring's end, on which circles and rays are coordinates; a flat face with straight ones; one whose coordinates stretch.
TURNING, STRAIGHT, STRETCHING = scene(_RING, "w0"), scene(_BOX, "w1"), weighted(30.0)
#: What another body elsewhere is, by which lengths are no smaller.
FAR = """
bodies.far = { rigid = true, geometry = { kind = "box", lower = [1000, 0, 0], upper = [1001, 1, 1] } }
supports.far.face = "far.w0"
"""
#: Over the straight face's edge, round which feet go: that is no turn of coordinates.
OVER_AN_EDGE = (
    'contacts.c.master=["b.w1", "b.u1"]',
    "bodies.b.mesh.order=2",
    "stages.s.steps=2",
    "stages.s.motions.top.translate=[0.9, 0.2, 0]",
)
BESIDE = re.compile(r"contact '(\w+)', load step (\d+): slips are .* off by (\S+) degrees, and so is the direction of friction")
BORNE = re.compile(r"contact '(\w+)', load step (\d+): its tractions are (\S+) % more than the law of friction takes them for")


def run(text: str, changes: tuple[str, ...] = ()) -> tuple[list[str], float]:
    """What is said of friction in a run, and by how many degrees the force of friction is off the way of the block at its end."""
    heard = Heard()
    *_, last = Simulation(Scene.from_toml(text, overrides=changes).problem(), heard).run()
    force = last.contacts[0].force_master
    return [said for said in heard.said if BESIDE.search(said) or BORNE.search(said)], float(np.degrees(np.arctan2(-force[0], force[1])))


@case(
    claim="Friction on a master whose coordinates turn along the way is told of, once, and by about as much as it is off; with "
    "twenty load steps, along averaged normals, without friction and on straight coordinates nothing is said, and the same with a body "
    "far away.",
    tier="gate",
    bounds={
        "said": Bound(1.0, 1.0, "definition: sentences of the ring's end in two load steps"),
        "step": Bound(2.0, 2.0, "definition: the first load step that drags"),
        "told over true": Bound(
            at_least=0.8, at_most=1.6, reason="definition: a mean over points that move much, of a force that all make; two digits"
        ),
        "true": Bound(at_least=5.0, reason="definition: or there is nothing to tell of"),
        "true, in twenty": Bound(at_most=2.9, reason="definition: what is not told"),
        "others": Bound(0.0, 0.0, "definition: sentences of the other scenes"),
        "far": Bound(0.0, 0.0, "definition: whether with a body far away something else is said"),
    },
)
def turning() -> dict[str, float]:
    """What is said of the ring's end, and how far off the force is; how much is said of seven others, and whether one is as the first."""
    said, _ = run(TURNING, ("stages.s.steps=2",))
    (only,), off = run(TURNING)
    found = BESIDE.search(only)
    assert found is not None
    finer, left = run(TURNING, ("stages.s.steps=20",))
    others = [run(TURNING, ('contacts.c.projection="averaged"',)), run(TURNING, ("contacts.c.friction=0",)), run(STRAIGHT)]
    others += [run(STRAIGHT, ("stages.s.motions.top.translate=[0.4, 0.4, 0]",)), run(STRAIGHT, OVER_AN_EDGE)]
    others += [run(weighted(3.0, all_along=True))]
    return {
        "said": float(len(said)),
        "step": float(found[2]),
        "told over true": float(found[3]) / abs(off),
        "true": abs(off),
        "true, in twenty": abs(left),
        "others": float(len(finer) + sum(len(words) for words, _ in others)),
        "far": float(run(TURNING + FAR)[0] != [only]),
    }


@case(
    claim="Tractions on a master whose coordinates stretch within a slave element are told to be more than the law takes them for, "
    "once; not with a finer slave, and of equal weights nothing is said.",
    tier="gate",
    bounds={
        "said": Bound(1.0, 1.0, "definition: sentences of the uneven master"),
        "others": Bound(0.0, 0.0, "definition: sentences of the same with a finer slave, and all with equal weights"),
    },
)
def stretching() -> dict[str, float]:
    """How much is said."""
    said, finer = (
        [text for text in run(STRETCHING, changes)[0] if BORNE.search(text)] for changes in ((), ("bodies.a.mesh.elements=[8, 8, 1]",))
    )
    return {"said": float(len(said)), "others": float(len(finer) + len(run(weighted(1.0))[0]))}


#: The ring's end, without a hole: a disc of which the axis is a pole; and each with what makes averaged normals no cure, which is refused.
DISC = TURNING.replace("inner = 0.15", "inner = 0").replace("elements = [8, 3, 1]", "elements = [8, 12, 1]")
NO_CURE = {"paper's sum": (TURNING, ('solver.slip_sum="paper"',)), "pole": (DISC, ())}
AVERAGED = 'contacts.c.projection="averaged"'


def is_refused(text: str, changes: tuple[str, ...]) -> bool:
    """Whether a scene with averaged normals is."""
    try:
        Scene.from_toml(text, overrides=(*changes, AVERAGED)).problem()
    except InputError:
        return True
    return False


@case(
    claim="Averaged normals are told as a cure of friction that goes astray where they are allowed, and else not.",
    tier="gate",
    grid={"scene": ("ring", *NO_CURE)},
    bounds={"wrong": Bound(0.0, 0.0, "definition: told and refused, or allowed and not told, or nothing is told")},
)
def cures(scene: str) -> dict[str, float]:
    """Whether it is."""
    text, changes = NO_CURE.get(scene, (TURNING, ()))
    (said,), _ = run(text, changes)
    return {"wrong": float(('or take contacts.c.projection = "averaged"' in said) == is_refused(text, changes))}


@case(
    claim="That friction goes astray, and that it is more than the law takes it for, are told once each, whichever comes first.",
    tier="gate",
    grid={"first": ("beside", "borne", "both")},
    bounds={"wrong": Bound(0.0, 0.0, "definition: load steps after which something else is told")},
)
def each_once(first: str) -> dict[str, float]:
    """How many of five, between which nothing is wrong once, and all is twice."""
    beside, borne, both, neither = (2.0 * BESIDE_LIMIT, 1.0), (0.0, 2.0 * BORNE_LIMIT), (2.0 * BESIDE_LIMIT, 2.0 * BORNE_LIMIT), (0.0, 1.0)
    one, other = {"beside": (beside, borne), "borne": (borne, beside), "both": (both, neither)}[first]
    watch, nowhere = Astray(Simulation(Scene.from_toml(TURNING).problem()).equilibrium), SimpleNamespace(kinematics=[None])
    wrong, told = 0, set[str]()
    for found in (one, neither, other, both, both):
        with patch("isomortar.told.during.astray.astray", return_value=found):
            said = list(watch.after_step(nowhere, 1))  # type: ignore[arg-type]
        new = {name for name, is_there in zip((BESIDE, BORNE), (found[0] > BESIDE_LIMIT, found[1] > BORNE_LIMIT), strict=True) if is_there}
        expected = {name.pattern for name in new} - told
        wrong += {name.pattern for name in (BESIDE, BORNE) for words in said if name.search(words)} != expected or len(said) != len(
            expected
        )
        told |= expected
    return {"wrong": float(wrong)}
