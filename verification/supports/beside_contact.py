"""Supports that hold control points of a contact face: both methods, and what is left where supports take it all."""

from __future__ import annotations

import numpy as np

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

_BODY = """
format = 1
bodies.block = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 0.6, 0.4] }, mesh = { order = [2, 2, 2], elements = [3, 2, 2] } }
"""
#: Squeezed between a clamped side and one that slides along the plane as it moves; pushed along the plane by its side, then left, or
#: pressed on; pushed by a side that is held across as well; beside a support whose direction is neither in the tilted plane nor across
#: it; by forces, or a moment, on a side that takes the edge of the face in contact along.
SCENES = {
    "clamped": """
        contacts.floor = { slave = "block.w0", plane = { point = [0, 0, 0] }, friction = 0.3 }
        supports.clamp.face = "block.u0"
        supports.side = { face = "block.u1", components = ["x"] }
        stages = [{ name = "squeeze", steps = 3, motions.side.translate = [-0.1, 0, 0] }]
    """,
    "pushed": """
        contacts.floor = { slave = "block.w0", plane = { point = [0, 0, 0] }, friction = 0.3 }
        supports.top = { face = "block.w1", components = ["z"] }
        supports.side = { face = "block.u0", components = ["x"] }
        supports.south = { face = "block.v0", components = ["y"] }
        stages = [
            { name = "press", steps = 2, motions.top.translate = [0, 0, -0.03] },
            { name = "push", steps = 4, motions.side.translate = [0.2, 0, 0] },
            { name = "rest", steps = 1 },
        ]
    """,
    "pushed, then pressed": """
        contacts.floor = { slave = "block.w0", plane = { point = [0, 0, 0] }, friction = 0.3 }
        supports.top = { face = "block.w1", components = ["z"] }
        supports.side = { face = "block.u0", components = ["x"] }
        supports.south = { face = "block.v0", components = ["y"] }
        stages = [
            { name = "press", steps = 1, motions.top.translate = [0, 0, -0.03] },
            { name = "push", steps = 2, motions.side.translate = [0.2, 0, 0] },
            { name = "more", steps = 2, motions.top.translate = [0, 0, -0.01] },
        ]
    """,
    "a sole that was pushed, at rest": """
        contacts.floor = { slave = "block.w0", plane = { point = [0, 0, 0] }, friction = 0.3 }
        supports.top = { face = "block.w1", components = ["z"] }
        supports.sole = { face = "block.w0", components = ["x", "y"] }
        stages = [
            { name = "press", steps = 1, motions.top.translate = [0, 0, -0.03] },
            { name = "push", steps = 1, motions.sole.translate = [0.2, 0.1, 0] },
            { name = "more", steps = 2, motions.top.translate = [0, 0, -0.02] },
            { name = "less", steps = 2, motions.top.translate = [0, 0, 0.03] },
        ]
    """,
    "pushed askew": """
        contacts.floor = { slave = "block.w0", plane = { point = [0, 0, 0] }, friction = 0.3 }
        supports.top = { face = "block.w1", components = ["z"] }
        supports.side = { face = "block.u0", components = ["x", "y"] }
        stages = [
            { name = "press", steps = 1, motions.top.translate = [0, 0, -0.03] },
            { name = "push", steps = 3, motions.side.translate = [0.2, 0.05, 0] },
            { name = "across", steps = 2, motions.side.translate = [0, 0.05, 0] },
        ]
    """,
    "tilted": """
        contacts.floor = { slave = "block.w0", plane = { point = [1, 0, 0], normal = [-0.5, 0, 0.8660254037844386] }, friction = 0.3 }
        supports.top = { face = "block.w1", components = ["y", "z"] }
        supports.side = { face = "block.u1", components = ["x"] }
        stages = [{ name = "press", steps = 3, motions.top.translate = [0, 0, -0.05] }]
    """,
    "pressed and pushed at its side": """
        contacts.floor = { slave = "block.w0", plane = {}, friction = 0.3 }
        supports.side = { face = "block.u0", components = ["y"], force = { x = 0.02, z = -0.2 } }
        supports.end.face = "block.u1"
        stages = [{ name = "press", steps = 2 }]
    """,
    "pressed and pushed at its side, on a rigid body": """
        bodies.table = { rigid = true, geometry = { kind = "box", lower = [-1, -1, -1], upper = [2, 2, 0] }, mesh.order = 1 }
        contacts.floor = { slave = "block.w0", master = "table.w1", friction = 0.3 }
        supports.side = { face = "block.u0", force = { x = 0.02, y = 0.01, z = -0.2 } }
        supports.end.face = "block.u1"
        stages = [{ name = "press", steps = 2 }]
    """,
    "turned at its side": """
        contacts.floor = { slave = "block.w0", plane = {}, friction = 0.3 }
        supports.side = { face = "block.u0", components = ["x", "y", "z"], moment = 0.02, centre = [0, 0, 0.2], axis = [0, 1, 0] }
        stages = [{ name = "turn", steps = 2 }]
    """,
}
TIGHT = ("solver.newton_tolerance=1e-11", "solver.complementarity_tolerance=1e-11")
SOFTLY = ("solver.penalty_normal=20", "solver.penalty_tangential=2", "solver.augmentation_tolerance=1e-9", "solver.max_augmentations=400")


def solved(scene: str, method: str, elastic_slip: float) -> list[StepResult]:
    """A scene of SCENES at tight tolerances."""
    changes = [f"solver.method={method}", f"contacts.floor.elastic_slip={elastic_slip}", *TIGHT, *(SOFTLY if method == "uzawa" else ())]
    return list(Simulation(Scene.from_toml(_BODY + SCENES[scene], overrides=changes).problem()).run())


@case(
    claim="Beside supports on a contact face both methods find the same solution, at once, by Coulomb's law and with elastic slip.",
    tier=lambda scene, **_: "nightly" if scene == "pushed" else "gate",
    grid={"scene": tuple(SCENES), "elastic_slip": (0.0, 0.02)},
    bounds={
        "forces": Bound(at_most=1e-7, reason="theory: both have the same limit; augmentations end at relative changes of 1e-9"),
        "positions": Bound(at_most=1e-7, reason="theory: both have the same limit; augmentations end at relative changes of 1e-9"),
        "balance": Bound(at_most=1e-10, reason="theory: forces are in balance; Newton's method stops at 1e-11"),
        "touches": Bound(at_least=2.0, reason="definition: contact beside a support is tested only where there is contact"),
        "cuts": Bound(at_most=0.0, reason="definition: no load step is cut"),
    },
)
def both_methods(scene: str, elastic_slip: float) -> dict[str, float]:
    """Distance of support forces and positions between the methods, imbalance of forces, active control points, cuts."""
    one, other = (solved(scene, method, elastic_slip) for method in ("monolithic", "uzawa"))
    found = [np.array([[reaction.force for reaction in result.reactions] for result in results]) for results in (one, other)]
    size = np.abs(found[0]).max()
    borne = np.array([result.contacts[0].force_slave for result in one])
    return {
        "forces": float(np.abs(found[0] - found[1]).max() / size),
        "positions": float(np.max([np.abs(a.state.positions - b.state.positions).max() for a, b in zip(one, other, strict=True)])),
        "balance": float(np.abs(found[0].sum(axis=1) + borne).max() / size),
        "touches": float(one[-1].contacts[0].active),
        "cuts": float(sum(result.cuts for result in (*one, *other))),
    }
