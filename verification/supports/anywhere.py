"""Supports by force and moment on every face, edge and corner of the built-in bodies: borne to round-off, or refused with the key."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, product

import numpy as np

from isomortar.errors import InputError
from isomortar.geometry.patch import FACES
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: Bodies with poles, seams, and faces that are a line or a point; their elements, and a place that holds them and another one.
BODIES = {
    "sector": ('{ kind = "ring", inner = 0, outer = 1, width = 0.5, angles = [0, 80] }', [1, 1, 1], ("v1", "w0")),
    "cylinder": ('{ kind = "ring", inner = 0, outer = 1, width = 0.5 }', [4, 1, 1], ("v1", "w0")),
    "octant": ('{ kind = "sphere", inner = 0.4, outer = 1, latitudes = [0, 90], angles = [0, 90] }', [1, 1, 1], ("v1", "v0")),
    "torus": ('{ kind = "torus", radius = 2, outer = 1, angles = [0, 90] }', [1, 1, 4], ("u0", "v1")),
    "wedge": ('{ kind = "wedge", bottom = [0, 0], top = [-0.5, 0.5], y = [0, 1], z = [0, 1] }', [1, 1, 1], ("w1", "v0")),
    "cap": ('{ kind = "cap", radius = 1, half_width = 0.5, bottom = 0, top = 1 }', [1, 1, 1], ("w1", "v0")),
}
#: What a support does: its keys, the force that it is to exert, its axis and moment.
ACTS = {
    "force": ("force = { x = 0.001, z = -0.001 }", {0: 0.001, 2: -0.001}, (0, 1, 0), None),
    "moment": ("moment = 0.001, axis = [0, 1, 0], centre = [0.3, 0, 0.1]", {}, (0, 1, 0), 0.001),
    "both": ("force = { x = 0.001, y = 0, z = 0 }, moment = 0.0001, axis = [1, 2, 3]", {0: 0.001, 1: 0.0}, (1, 2, 3), 0.0001),
}
_SCENE = """
format = 1
bodies.body.geometry = {geometry}
bodies.body.mesh = {{ order = 2, elements = {elements} }}
supports.hold.face = "body.{hold}"
supports.acts = {{ {place}, {act} }}
solver.newton_tolerance = 1e-11
stages = [{{ name = "press", steps = 1 }}]
"""


def places() -> Iterator[str]:
    """All faces, edges and corners as scenes name them, faces in either order by turns."""
    for count, key in enumerate(("face", "edge", "corner"), start=1):
        meeting = [names for names in combinations(FACES, count) if len({name[0] for name in names}) == count]
        for number, names in enumerate(meeting):
            yield f'{key} = "body.{".".join(names[:: 1 - 2 * (number % 2)])}"'


@case(
    claim="A support by force or moment is borne on any face, edge or corner of any built-in body, or refused with its key.",
    tier="gate",
    grid={"body": list(BODIES), "act": list(ACTS)},
    bounds={
        "force": Bound(at_most=1e-9, reason="theory: forces on all control points are in balance to 1e-11 of the internal ones"),
        "moment": Bound(at_most=1e-9, reason="theory: as above"),
        "balance": Bound(at_most=1e-9, reason="theory: as above"),
        "borne": Bound(at_least=1.0, reason="definition: of so many places something was measured"),
        "elsewhere": Bound(at_least=0.0, at_most=0.0, reason="definition: what is refused is the support's place, or what it does there"),
    },
)
def place(body: str, act: str) -> dict[str, float]:
    """Largest errors of force, moment about the axis, and balance, over the force 0.001; places that bore; other keys that were named."""
    (geometry, elements, holds), (keys, force, axis, moment) = BODIES[body], ACTS[act]
    turn, errors, elsewhere = np.array(axis) / np.linalg.norm(axis), [], 0
    for at, hold in product(places(), holds):
        text = _SCENE.format(geometry=geometry, elements=elements, hold=hold, place=at, act=keys)
        try:
            (result,) = Simulation(Scene.from_toml(text).problem()).run()
        except InputError as error:
            elsewhere += not str(error).startswith(("supports.acts", "bodies.body: body 'body' is free to move"))
            continue
        wrenches = [np.append(r.force, r.moment + np.cross(r.centre, r.force)) for r in result.reactions]
        own = result.reactions[1]
        errors.append(
            [
                np.abs([own.force[k] - size for k, size in force.items()]).max(initial=0.0),
                abs(own.moment @ turn - moment) if moment is not None else 0.0,
                np.abs(np.sum(wrenches, axis=0)).max(),
            ]
        )
    worst = np.max(errors, axis=0) / 0.001
    return {
        "force": float(worst[0]),
        "moment": float(worst[1]),
        "balance": float(worst[2]),
        "borne": float(len(errors)),
        "elsewhere": float(elsewhere),
    }
