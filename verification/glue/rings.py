"""A ring of two halves beside the closed ring that they make, as slave and as master; the contact lies over a joint."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from glue.sides import forces, positions, solved
from small_scenes import TIGHT

from isomortar.geometry.patch import Direction, Patch
from isomortar.harness import Bound, case
from isomortar.harness.cases import Tier
from isomortar.model.entities import Face, Faces, Problem
from isomortar.scene import Scene

_RING = """
format = 1
bodies.ring.geometry = { kind = "ring", centre = [0, -0.2, 0], inner = 0.5, outer = 0.8, width = 0.4 }
bodies.ring.mesh = { order = [2, 1, 1], elements = [20, 1, 2] }
supports.rim = { face = "ring.v0", axis = [0, 1, 0] }
"""
_LOADS = {
    "slave": """
contacts.interface = { slave = "ring.v1", plane = { point = [0, 0, 0.8], normal = [0, 0, -1] }, friction = 0.3, quadrature = 4 }
stages = [{ name = "roll", steps = 2, motions.rim = { translate = [0, 0, 0.07], rotate = 3 } }]
""",
    "master": """
bodies.bowl.geometry = { kind = "box", lower = [-0.2, -0.15, 0.8], upper = [0.25, 0.15, 1] }
bodies.bowl.mesh = { order = [2, 2, 1], elements = [2, 2, 1] }
supports.top = { face = "bowl.w1" }
contacts.interface = { slave = "bowl.w0", master = "ring.v1", friction = 0.3, quadrature = 4, projection = "PROJECTION" }
stages = [{ name = "press", steps = 2, motions.top = { translate = [0.05, 0, -0.05] } }]
""",
}


def ring(side: str, projection: str, method: str) -> Problem:
    """The ring on a plane, or below a box, at tight tolerances; by penalties that need no cuts, which round-off decides on."""
    changes = [
        f"solver.method={method}",
        "solver.augmentation_tolerance=1e-3",
        "solver.penalty_normal=10.0",
        "solver.penalty_tangential=1.0",
    ]
    problem = Scene.from_toml(_RING + _LOADS[side].replace("PROJECTION", projection), overrides=changes).problem()
    return replace(problem, settings=replace(problem.settings, **TIGHT))  # type: ignore[arg-type]


def halved(problem: Problem) -> Problem:
    """The same with the ring cut into two bodies, which are glued at both ends."""
    whole = problem.body("ring")
    lines = whole.patch.directions[0].boundaries
    halves = [
        replace(whole, name=name, patch=p, closed=None) for name, p in zip("ab", cut(whole.patch, lines[len(lines) // 2]), strict=True)
    ]
    (contact,) = problem.contacts
    joined = Faces("a", "v1", (Face("b", "v1"),))
    is_slave = contact.slave == Face("ring", "v1")
    joint_contact = replace(contact, slave=joined) if is_slave else replace(contact, master=joined)
    rim = next(support for support in problem.supports if support.name == "rim")
    return replace(
        problem,
        bodies=(*halves, *(body for body in problem.bodies if body.name != "ring")),
        contacts=(joint_contact,),
        supports=(*(replace(rim, name=b.name, place=Face(b.name, "v0")) for b in halves), *(s for s in problem.supports if s is not rim)),
        glue=((Face("a", "u1"), Face("b", "u0")), (Face("b", "u1"), Face("a", "u0"))),
    )


def cut(patch: Patch, at: float) -> tuple[Patch, Patch]:
    """A patch of B-splines in two, at a C0 line across u."""
    u, v, w = patch.directions
    row = int(np.searchsorted(u.knots, at)) - 1
    knots = np.append(u.knots[: row + 1 + u.order], at), np.insert(u.knots[row + 1 :], 0, at)
    grid = np.column_stack([patch.control_points, patch.weights]).reshape((*patch.shape, 4), order="F")
    parts = [values.reshape((-1, 4), order="F") for values in (grid[: row + 1], grid[row:])]
    one, other = (Patch((Direction("N", u.order, k), v, w), part[:, :3], part[:, 3]) for k, part in zip(knots, parts, strict=True))
    return one, other


def tier(side: str, projection: str, method: str) -> Tier:
    """The gate has half of the products: every two settings in every choice."""
    others = (side == "master", projection == "averaged", method == "uzawa")
    return "nightly" if sum(others) % 2 else "gate"


@case(
    claim="Two half rings that are glued at both ends are the closed ring, as slave and as master.",
    tier=tier,
    grid={"side": ("slave", "master"), "projection": ("closest", "averaged"), "method": ("monolithic", "uzawa")},
    bounds={
        "positions": Bound(at_most=1e-9, reason="theory: the same functions on the same unknowns; lengths are 1, and tolerances are left"),
        "forces": Bound(at_most=1e-8, reason="theory: the same functions on the same unknowns"),
        "pressed": Bound(at_least=4.0, reason="definition: the contact is over a joint, or nothing is tested"),
    },
)
def halves_of_a_ring(side: str, projection: str, method: str) -> dict[str, float]:
    """Distances of positions and forces from those of the closed ring; active constraints."""
    closed = ring(side, projection, method)
    two = halved(closed)
    one, other = solved(two), solved(closed)
    return {
        "positions": float(np.abs(positions(two, one) - positions(closed, other)).max()),
        "forces": float(np.abs(forces(one) - forces(other)).max() / np.abs(forces(other)).max()),
        "pressed": float(one[-1].contacts[0].active),
    }
