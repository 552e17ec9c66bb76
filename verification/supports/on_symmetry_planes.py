"""What a symmetry plane of both sides leaves of a contact's tractions: those along it, whichever way bodies name their directions."""

from __future__ import annotations

import numpy as np
from transforms import orientations, oriented

from isomortar.geometry.patch import Patch
from isomortar.harness import Bound, case
from isomortar.model.entities import Problem
from isomortar.model.held import held_by
from isomortar.model.numbering import Numbering
from isomortar.model.pairs import Pair
from isomortar.model.supports import Supports
from isomortar.scene import Scene

#: A block on a block; both are cut by the planes x = 0 and y = 0.
SCENE = """
format = 1
bodies.slave.geometry = {{ kind = "box", lower = [0, 0, 0], upper = [0.3, 0.4, 0.4] }}
bodies.slave.mesh = {{ order = [2, 2, 1], elements = [2, 1, 1] }}
bodies.master.geometry = {{ kind = "box", lower = [0, 0, -0.5], upper = [0.8, 0.7, 0] }}
bodies.master.mesh = {{ order = [1, 2, 1], elements = [1, 2, 1] }}
contacts.c = {{ slave = "slave.w0", master = "master.w1", friction = 0.3, projection = "{projection}" }}
supports.top.face = "slave.w1"
supports.base.face = "master.w0"
supports.sx = {{ face = "slave.u0", components = ["x"] }}
supports.mx = {{ face = "master.u0", components = ["x"] }}
supports.sy = {{ face = "slave.v0", components = ["y"] }}
supports.my = {{ face = "master.v0", components = ["y"] }}
stages = [{{ name = "one", steps = 1 }}]
"""


def along(patch: Patch, face: str, axis: int) -> int:
    """Which of the two coordinates of a face of a box runs along an axis."""
    first, second = patch.face_directions(face)
    net = patch.control_points[patch.face_points(face)].reshape(second.count, first.count, 3)
    return int(np.ptp(net[:, 0, axis]) > np.ptp(net[0, :, axis]))


def off(problem: Problem) -> float:
    """Largest difference of what is left of the tractions from what the planes leave."""
    numbering, (contact,) = Numbering(problem), problem.contacts
    pair = Pair(contact, problem, numbering)
    found = held_by(Supports(problem, numbering), pair, numbering.reference, 1.0).free
    side = contact.slave if contact.averaged else contact.master  # whose coordinates tractions have
    exact = np.tile(np.eye(2), (len(found), 1, 1))
    for axis in (0, 1):
        of_axis = along(problem.body(side.body).patch, side.face, axis)  # type: ignore[union-attr]
        exact[np.abs(numbering.reference[pair.slave.point, axis]) < 1e-12, of_axis, of_axis] = 0.0
    return float(np.abs(found - exact).max())


@case(
    claim="On a symmetry plane of both sides no traction is left across it, and all along it, however directions are named.",
    tier="gate",
    grid={"projection": ("closest", "averaged")},
    bounds={"off": Bound(0.0, 0.0, "definition: projections onto a coordinate, of all 24 ways to name directions")},
)
def left_of_tractions(projection: str) -> dict[str, float]:
    """Largest difference over all ways of the body whose coordinates tractions have, with two planes."""
    problem = Scene.from_toml(SCENE.format(projection=projection)).problem()
    turned = "slave" if projection == "averaged" else "master"
    return {"off": float(np.max([off(oriented(problem, turned, *way)) for way in orientations()]))}
