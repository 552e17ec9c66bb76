"""Whole computations under loads: a state of uniform stress, balance with supports and contacts, growth by stages, tangents."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from small_scenes import TIGHT

from isomortar import _bindings
from isomortar.harness import Bound, case
from isomortar.harness.tangents import check_tangent
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem
from isomortar.scene import Scene
from isomortar.solve.record import LoadResult, Reaction, StepResult

KINDS = ("N1", "N2", "N3", "N4", "N5", "L1", "L2", "L3", "L4")
TRACTION = 1.5
#: A bar on rollers that is pulled at its end.
_BAR = """
format = 1
bodies.bar = { geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 1, 0.8] }, mesh = { order = 1, elements = [2, 2, 2] } }
supports.x = { face = "bar.u0", components = ["x"] }
supports.y = { face = "bar.v0", components = ["y"] }
supports.z = { face = "bar.w0", components = ["z"] }
loads.pull = { face = "bar.u1", traction = [1.5, 0, 0] }
stages = [{ name = "pull", steps = 3 }]
"""
#: Loads of all kinds with supports and contacts.
SCENES = {
    # A block that its weight and a pressure press onto a plane, with friction: nothing else holds it upwards.
    "on a plane": """
format = 1
bodies.block = { geometry = { kind = "bowl", half_width = 0.5, bottom = 0.02, rise = 0.1, top = 0.8 }, mesh = { elements = [4, 4, 2] } }
contacts.floor = { slave = "block.w0", plane = {}, friction = 0.3 }
supports.west = { face = "block.u0", components = ["x", "y"] }
loads.own = { body = "block", weight = [0, 0, -0.5] }
loads.wind = { face = "block.w1", pressure = 0.3 }
stages = [{ name = "settle", steps = 2 }, { name = "drag", steps = 2, motions.west.translate = [0.1, 0, 0], loads.wind = 1.5 }]
""",
    # A tyre that is blown up on its rim and pressed on a block: a closed ring, a pressure that follows, a traction on its side.
    "tyre": """
format = 1
bodies.tyre = { geometry = { kind = "ring", inner = 0.6, outer = 1.0, width = 0.5 }, mesh = { order = [2, 2, 2], elements = [16, 1, 2] } }
bodies.road = { geometry = { kind = "box", lower = [-0.8, -0.7, -1.5], upper = [0.8, 0.2, -1.01] }, mesh = { elements = [4, 2, 2] } }
contacts.pair = { slave = "tyre.v1", master = "road.w1", friction = 0.2 }
supports.rim = { face = "tyre.w0" }
supports.base.face = "road.w0"
loads.air = { face = "tyre.v0", pressure = 0.3 }
loads.side = { face = "tyre.w1", traction = [0.02, -0.03, 0.01] }
stages = [{ name = "blow", steps = 2, loads = { air = 1, side = 1 } }, { name = "press", steps = 2, motions.rim.translate = [0, 0, -0.05] }]
""",
    # Two glued halves of a beam: a pressure across the joint, and weight.
    "glued": """
format = 1
glue = [["left.u1", "right.u0"]]

[bodies.left]
geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }
mesh = { order = 3, elements = [2, 2, 2] }
material = "soft"

[bodies.right]
geometry = { kind = "box", lower = [1, 0, 0], upper = [2, 1, 0.5] }
mesh = { order = 3, elements = [2, 2, 2] }
material = "hard"

[materials]
soft = { law = "neo-hookean-j" }
hard = { young = 30.0 }

[supports]
wall.face = "left.u0"

[loads]
on = { face = "left.w1", pressure = 0.01 }
beside = { face = "right.w1", pressure = 0.01 }
own = { body = "right", weight = [0, 0, -0.01] }

[[stages]]
name = "load"
steps = 2
""",
}  # fmt: skip


def problem(text: str, *overrides: str) -> Problem:
    """A scene at tight tolerances."""
    found = Scene.from_toml(text, overrides=overrides).problem()
    return replace(found, settings=replace(found.settings, **TIGHT))  # type: ignore[arg-type]


def computed(found: Problem) -> list[StepResult]:
    """All of its load steps."""
    return list(Simulation(found).run())


@case(
    claim="A dead traction on the end of a bar makes the uniform stress that it is.",
    tier="gate",
    grid={"kind": KINDS, "law": ("neo-hookean", "neo-hookean-j", "linear-elastic")},
    bounds={
        "apart": Bound(at_most=1e-11, reason="theory: elements hold affine motions; forces are in balance to 1e-12"),
        "stress": Bound(at_most=1e-11, reason="theory: as above"),
        "reaction": Bound(at_most=1e-11, reason="theory: as above"),
    },
)
def uniform(kind: str, law: str) -> dict[str, float]:
    """Positions off an affine motion; first Piola stress of that motion, and support force, off the traction's over it."""
    mesh = f'{{ order = {kind[1:]}, family = "{kind[0]}", elements = [2, 2, 2] }}'
    found = problem(_BAR.replace("{ order = 1, elements = [2, 2, 2] }", mesh) + f'materials.steel = {{ law = "{law}" }}\n')
    last, body = computed(found)[-1], found.bodies[0]
    before = np.column_stack([np.ones(len(body.patch.weights)), body.patch.control_points])
    affine = np.linalg.lstsq(before, last.state.positions, rcond=None)[0]
    stress = _bindings.material_stress(body.material.arrays, (affine[1:].T - np.eye(3))[None])[0]
    return {
        "apart": float(np.abs(before @ affine - last.state.positions).max()),
        "stress": float(np.abs(stress - np.diag([TRACTION, 0.0, 0.0])).max() / TRACTION),
        "reaction": float(abs(last.reactions[0].force[0] / (TRACTION * 0.8) + 1.0)),
    }


@case(
    claim="Loads, supports and contacts are in balance, by force and by moment.",
    tier="gate",
    grid={"scene": tuple(SCENES), "method": ("monolithic", "uzawa")},
    bounds={
        "force": Bound(at_most=1e-10, reason="theory: forces on all control points are in balance to 1e-12 of the internal ones"),
        "moment": Bound(at_most=1e-10, reason="theory: as above"),
        "smallest": Bound(at_least=1e-3, reason="definition: each load is told where it is not lost beside others"),
    },
)
def balance(scene: str, method: str) -> dict[str, float]:
    """Largest sum of all forces, and of moments about the origin, over the largest force; the smallest load at the end over it."""
    found = problem(SCENES[scene], f"solver.method={method}")
    force, moment, smallest = [], [], 0.0
    for result in computed(found):
        forces = [r.force for r in result.reactions] + [load.force for load in result.loads]
        moments = [r.moment + np.cross(r.centre, r.force) for r in result.reactions] + [load.moment for load in result.loads]
        size = float(np.max([np.linalg.norm(vector) for vector in forces]))
        borne = [contact.force_slave + contact.force_master for contact in result.contacts]
        turned = [contact.moment_slave + contact.moment_master for contact in result.contacts]
        if scene == "on a plane":
            borne, turned = [result.contacts[0].force_slave], [result.contacts[0].moment_slave]
        force.append(np.linalg.norm(np.sum([*forces, *borne], axis=0)) / size)
        moment.append(np.linalg.norm(np.sum([*moments, *turned], axis=0)) / size)
        smallest = float(np.min([np.linalg.norm(load.force) for load in result.loads])) / size
    return {"force": float(max(force)), "moment": float(max(moment)), "smallest": smallest}


@case(
    claim="Loads grow linearly from stage to stage, stay where a stage does not name them, and are whole after the first if it does not.",
    tier="gate",
    bounds={"error": Bound(at_most=1e-14, reason="round-off: of a factor")},
)
def by_stages() -> dict[str, float]:
    """Largest error of the factor of three loads over seven load steps; one of them also as a problem made in Python leaves it."""
    text = (
        _BAR.split("loads.pull")[0]
        + """
loads.a = { face = "bar.u1", traction = [0.1, 0, 0] }
loads.b = { body = "bar", weight = [0.1, 0, 0] }
loads.c = { face = "bar.u1", traction = [0, 0, 0.1] }
stages = [
    { name = "one", steps = 2, loads.c = 0 }, { name = "two", steps = 2, loads.a = 2 },
    { name = "three", steps = 1 }, { name = "four", steps = 2, loads = { a = -1, c = 1 } }
]
"""
    )
    wanted = {
        "a": [0.5, 1.0, 1.5, 2.0, 2.0, 0.5, -1.0],
        "b": [0.5, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0],
        "c": [0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 1.0],
    }
    sizes = {"a": 0.08, "b": 0.16, "c": 0.08}
    found = problem(text)
    results = computed(found)
    errors = [
        np.abs([result.loads[k].force.sum() / sizes[load.name] for result in results] - np.array(wanted[load.name])).max()
        for k, load in enumerate(found.loads)
    ]
    bare = replace(found, loads=tuple(replace(load, factors=() if load.name == "b" else load.factors) for load in found.loads))
    errors += [np.abs([result.loads[1].force.sum() / sizes["b"] for result in computed(bare)] - np.array(wanted["b"])).max()]
    return {"error": float(max(errors))}


@case(
    claim="Half of a symmetric scene under loads is the whole one.",
    tier="gate",
    bounds={
        "reaction": Bound(at_most=1e-9, reason="theory: Lagrange elements of the halves have the same functions"),
        "load": Bound(at_most=1e-9, reason="theory: as above"),
    },
)
def symmetric() -> dict[str, float]:
    """Differences of the support's and the loads' force and moment, over the largest force."""
    text = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, -1, 0], upper = [2, 1, 0.6] }
bodies.block.mesh = { family = "L", order = 2, elements = [3, 4, 2] }
supports.wall.face = "block.u0"
loads.press = { face = "block.w1", pressure = 0.05 }
loads.own = { body = "block", weight = [0.02, 0, -0.03] }
stages = [{ name = "load", steps = 2 }]
"""
    whole, half = (computed(problem(text + more))[-1] for more in ("", "symmetry = { y = 0.0 }\n"))
    size = float(np.linalg.norm(whole.reactions[0].force))

    def apart(one: Reaction | LoadResult, other: Reaction | LoadResult) -> float:
        return float(np.max([np.abs(getattr(one, name) - getattr(other, name)).max() for name in ("force", "moment")])) / size

    return {
        "reaction": apart(whole.reactions[0], half.reactions[0]),
        "load": float(np.max([apart(one, other) for one, other in zip(whole.loads, half.loads, strict=True)])),
    }


@case(
    claim="The check of the tangent measures that of pressures in scenes that have some, and of all forces with them.",
    tier="gate",
    grid={"scene": ("on a plane", "glued")},
    bounds={
        "loads": Bound(at_most=1e-12, reason="round-off: forces of pressures are products of two positions, so that differences are exact"),
        "whole": Bound(at_most=1e-11, reason="round-off: of the tangent in double precision"),
    },
)
def in_scenes(scene: str) -> dict[str, float]:
    """Largest relative errors of products of the tangent at states of a load step."""
    found = problem(SCENES[scene])
    rows = {row.part: row.error for row in check_tangent(found, found.total_steps).rows}
    return {"loads": rows["loads"], "whole": rows["whole"]}
