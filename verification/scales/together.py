"""Contacts of one scene, each with something of its own: what they come to is what each of them comes to alone, whatever their order."""

from __future__ import annotations

import numpy as np

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: A pad by name, with its place, its mesh, and what is said of its contact.
PAD = """
bodies.{name} = {{ geometry = {{ kind = "box", lower = [{x}, 0, 0], upper = [{end}, 1, 0.5] }}, mesh = {{ {mesh} }} }}
contacts.{name} = {{ slave = "{name}.w0", {says} }}
supports.{name}.face = "{name}.w1"
"""
#: What has something of its own: places, meshes, contacts, more bodies and supports, and motions of both stages.
PLANE = "plane = { point = [0, 0, -0.01] }"
MASTER = """
bodies.anvil.geometry = { kind = "box", lower = [7.9, -0.2, -0.5], upper = [9.3, 1.2, -0.01] }
bodies.anvil.mesh = { order = 1, elements = [2, 2, 1] }
supports.anvil.face = "anvil.w0"
"""
PARTS = {
    "dragged": (0, "order = 2", f"{PLANE}, friction = 0.3", "", ("[0, 0, -0.03]", "[0.03, 0.01, 0]")),
    "sunk": (
        2,
        "order = 2, elements = [2, 1, 1]",
        "plane = {}, friction = 0",
        'supports.side = { face = "sunk.u0" }\n',
        ("[0, 0, -0.002]", "[0, 0, -0.001]"),
    ),
    "elastic": (4, "order = 1", f"{PLANE}, friction = 0.4, elastic_slip = 0.01", "", ("[0, 0, -0.02]", "[0.004, 0, 0]")),
    "smooth": (6, "order = 1", f"{PLANE}, smoothing = 1e-4", "", ("[0, 0, -0.005]", "[0, 0, -0.01]")),
    "kinks": (8, "order = 1", 'master = "anvil.w1", projection = "averaged", friction = 0.2', MASTER, ("[0, 0, -0.03]", "[0.02, 0, 0]")),
    "open": (10, "order = 1", "plane = { point = [0, 0, -1] }, friction = 0.3", "", ("[0, 0, -0.03]", "[0, 0, -0.03]")),
}
HEAD = """
format = 1
solver = { method = "METHOD", newton_tolerance = 1e-12, complementarity_tolerance = 1e-12, augmentation_tolerance = 1e-6 }
"""


def found(method: str, names: tuple[str, ...]) -> tuple[dict[str, list[FloatArray]], int]:
    """Of each contact by its name what is recorded of it and of the support above it, load step by load step; bytes of a state."""
    text = "".join(
        PAD.format(name=name, x=place, end=place + 1, mesh=mesh, says=says) + more
        for name, (place, mesh, says, more, _) in ((name, PARTS[name]) for name in names)
    )
    for k, stage in enumerate(("press", "drag")):
        motions = [f"motions.{name}.translate = {PARTS[name][4][k]}\n" for name in names]
        motions += [f"motions.side.translate = {PARTS[name][4][k]}\n" for name in names if name == "sunk"]
        text += f'[[stages]]\nname = "{stage}"\nsteps = {k + 1}\n' + "".join(motions)
    problem = Scene.from_toml(HEAD.replace("METHOD", method) + text).problem()
    wanted = {name: next(k for k, support in enumerate(problem.supports) if support.name == name) for name in names}
    measured: dict[str, list[FloatArray]] = {name: [] for name in names}
    for step in Simulation(problem).run():
        for contact, result, state in zip(problem.contacts, step.contacts, step.state.contacts, strict=True):
            force = step.reactions[wanted[contact.name]].force
            numbers = [result.active, result.slip, result.friction_work]
            measured[contact.name].append(np.concatenate([state.pressure, result.traction_norm, force, result.force_slave, numbers]))
    return measured, step.counters["history bytes"]


#: What forces and pressures are measured by at the least: those of what is open are round-off.
LEAST = 1e-3
#: Bytes of the number of a load step.
NUMBER = 8
#: Augmentations take their time: of these alone.
FEW = ("elastic", "sunk", "open")
_LEFT = "theory: the systems are separate; what is left is what Newton's method leaves, or augmentations"


@case(
    claim="Contacts of one scene that have nothing in common come to what each of them comes to alone, in whatever order they are given.",
    tier="gate",
    grid={"method": ("monolithic", "uzawa")},
    bounds=lambda method: {
        **dict.fromkeys(PARTS if method == "monolithic" else FEW, Bound(at_most=1e-8 if method == "monolithic" else 1e-4, reason=_LEFT)),
        "bytes": Bound(0.0, 0.0, "definition: a state holds what those of each alone hold, and the number of its load step once"),
        "acts": Bound(at_least=2.0, reason="definition: all of them but the one that is open"),
    },
)
def together(method: str) -> dict[str, float]:
    """Largest difference of what is recorded of each contact, over its largest value; bytes that differ; contacts that bear."""
    names = tuple(PARTS) if method == "monolithic" else FEW
    single = {name: found(method, (name,)) for name in names}
    alone = {name: single[name][0][name] for name in names}
    size = sum(own - NUMBER for _, own in single.values()) + NUMBER
    off: dict[str, float] = dict.fromkeys(names, 0.0)
    size_off = 0
    for order in (names, names[::-1]):
        measured, taken = found(method, order)
        size_off += abs(taken - size)
        for name, steps in measured.items():
            apart = np.abs(np.array(steps) - np.array(alone[name])).max()
            off[name] = float(np.maximum(off[name], apart / np.maximum(np.abs(alone[name]).max(), LEAST)))
    return {**off, "bytes": float(size_off), "acts": float(sum(bool(steps[-1][-3]) for steps in alone.values()))}
