"""Which elements of a master end at a pole: those of which an edge has no length, whichever way the face is named."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from rational_functions import shares
from transforms import orientations, oriented

from isomortar.geometry.patch import FloatArray, Patch
from isomortar.harness import Bound, case
from isomortar.model.entities import Face
from isomortar.model.numbering import Numbering
from isomortar.model.pairs import Pair
from isomortar.scene import Scene
from isomortar.solve.feet import beside_poles

#: A part of a ball with one pole of two, under a block.
SCENE = """
format = 1
bodies.block.geometry = { kind = "box", lower = [-0.1, -0.1, 0.5], upper = [0.1, 0.1, 0.7] }
bodies.ball.geometry = { kind = "sphere", inner = 0.2, outer = 0.5, latitudes = [-30, 90], angles = [0, 180] }
bodies.ball.mesh = { order = 2, elements = [4, 1, 6] }
contacts.c = { slave = "block.w0", master = "ball.v1", friction = 0 }
supports = { top.face = "block.w1", hub.face = "ball.v0" }
stages = [{ name = "one", steps = 1 }]
"""


def at_poles(patch: Patch, face: str) -> FloatArray:
    """Of each element of a face, (second, first), whether two corners beside each other are one point."""
    directions = patch.face_directions(face)
    numbers = patch.face_points(face)
    grid = np.stack(np.meshgrid(*(d.boundaries for d in directions)), axis=-1).reshape(-1, 2)
    lines = [len(d.boundaries) for d in directions]
    corners = (shares(directions, patch.weights[numbers], grid) @ patch.control_points[numbers]).reshape(lines[1], lines[0], 3)
    along, across = (np.linalg.norm(np.diff(corners, axis=axis), axis=-1) < 1e-12 for axis in (1, 0))
    return np.asarray(along[:-1] | along[1:] | across[:, :-1] | across[:, 1:])


@case(
    claim="Feet are beside a pole where their element has an edge without a length, and those that are none are beside nothing.",
    tier="gate",
    bounds={
        "wrong": Bound(0.0, 0.0, "definition: elements, over all 24 ways to name the directions of the master, told otherwise"),
        "beside": Bound(at_least=24.0, reason="definition: each way there are some"),
    },
)
def elements_at_poles() -> dict[str, float]:
    """How many; and how many are beside a pole."""
    problem, found = Scene.from_toml(SCENE).problem(), {"wrong": 0, "beside": 0}
    for way in orientations():
        given = oriented(problem, "ball", *way)
        (contact,) = given.contacts
        assert isinstance(contact.master, Face)
        exact = at_poles(given.body("ball").patch, contact.master.face)
        elements = np.argwhere(np.ones_like(exact))[:, ::-1]
        pair = Pair(contact, given, Numbering(given))
        for there in (1, 0):
            feet = SimpleNamespace(found=np.full(len(elements), there, dtype=np.int32), element=elements)
            told = beside_poles(pair, feet)  # type: ignore[arg-type]
            found["wrong"] += int(np.count_nonzero(told != exact.ravel() * there))
            found["beside"] += int(np.count_nonzero(told))
    return {name: float(count) for name, count in found.items()}
