"""Cells of faces look out of their body, however far that is bent round: together they enclose its volume."""

from __future__ import annotations

import numpy as np
import pytest

from isomortar.geometry.faces import cells
from isomortar.geometry.patch import FACES, Patch
from isomortar.geometry.primitives import ring, sphere, torus
from isomortar.geometry.refinement import mesh
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from test_geometry import PRIMITIVES, volume

BODIES = PRIMITIVES | {
    "clamp": ring((0.0, 0.0, 0.0), 0.7, 1.0, 0.4, (10.0, 350.0), "y"),
    "cheese without a slice": ring((0.0, 0.0, 0.0), 0.0, 1.0, 0.4, (20.0, 340.0), "x"),
    "shell with a slit": sphere((0.0, 0.0, 1.0), 0.8, 1.0, (-60.0, 60.0), (15.0, 345.0), "z"),
    "hook": torus((0.3, 0.1, 0.2), 1.0, 0.05, 0.2, (-180.0, 180.0), (45.0, 340.0), "x"),
    "gutter": torus((0.3, 0.1, 0.2), 1.0, 0.1, 0.2, (-150.0, 170.0), (0.0, 360.0), "z"),
}

#: A ring with a slit; what is on one side of that is pressed over it.
CLAMP = """
format = 1
materials.steel = { young = 10.0, poisson = 0.3 }
bodies.clamp = { geometry = { kind = "ring", inner = 0.7, outer = 1, width = 0.4, angles = [10, 350] }, mesh.elements = [8, 1, 1] }
bodies.die = { rigid = true, geometry = { kind = "box", lower = [-0.4, -0.3, 0.6], upper = [0.0, 0.3, 1.1] } }
contacts.slit = { slave = "clamp.u0", master = "die.u1", friction = 0 }
supports.end.face = "clamp.u1"
supports.die.face = "die.w1"
stages = [{ name = "open", steps = 2, motions.die.translate = [0.2, 0, 0] }]
solver = { newton_tolerance = 1e-12 }
"""


@pytest.mark.parametrize("family", ["N", "L"])
@pytest.mark.parametrize("name", BODIES)
def test_faces_enclose_their_body(name: str, family: str) -> None:
    body = finely(BODIES[name], family)
    sides = [cells(body, face) for face in FACES]
    flux = sum(side.areas @ np.einsum("ij,ij->i", side.centres - body.control_points.mean(axis=0), side.normals) for side in sides)
    assert sum(side.areas @ side.normals for side in sides) == pytest.approx(0.0, abs=1e-2 * sum(side.areas.sum() for side in sides))
    assert flux / 3.0 == pytest.approx(volume(BODIES[name]), rel=0.02)


def finely(patch: Patch, family: str) -> Patch:
    """Elements so short that their nodes may be taken for corners of flat cells."""
    u, v, w = (direction.elements * -(-24 // direction.elements) for direction in patch.directions)
    return mesh(patch, (family,) * 3, (2, 2, 2), (u, v, w))


def test_a_clamp_is_pressed_open() -> None:
    *_, last = Simulation(Scene.from_toml(CLAMP).problem()).run()
    (contact,) = last.contacts
    assert contact.force_slave[0] > 0.0
    assert last.reactions[0].force == pytest.approx(-contact.force_slave, abs=1e-10)


#: A ring with a slit, or the half of it whose end is pressed onto a plane in the middle of the slit.
CLOSED = """
format = 1
[bodies.ring]
geometry = { kind = "ring", inner = 0.6, outer = 0.8, width = 0.3, angles = [3, ANGLE] }
mesh = { family = "L", order = 2, elements = [ELEMENTS, 1, 1] }
[contacts.slit]
slave = "ring.u0"
friction = 0
MASTER
[supports]
across = { edge = "ring.v1.w0", components = ["y"] }
end = { edge = "ring.u0.v1", components = ["x", "z"] }
OTHER
[[stages]]
name = "close"
steps = 2
motions.end.translate = [-0.0415, 0, 0]
MOTION
"""
WHOLE = {
    "ANGLE": "357",
    "ELEMENTS": "24",
    "MASTER": 'master = "ring.u1"\nprojection = "closest"',
    "OTHER": 'other = { edge = "ring.u1.v1", components = ["x", "z"] }',
    "MOTION": "motions.other.translate = [0.0415, 0, 0]",
}
HALF = {
    "ANGLE": "180",
    "ELEMENTS": "12",
    "MASTER": "plane = { normal = [1, 0, 0] }",
    "OTHER": 'other = { face = "ring.u1", components = ["x"] }',
    "MOTION": "",
}


def test_a_ring_with_a_slit_closes_on_itself_as_its_half_does_on_a_plane() -> None:
    """What is across from an end of it is its other end, and tells no depth of the body below: nothing has passed through it."""
    forces = []
    for places in (WHOLE, HALF):
        text = CLOSED
        for place, words in places.items():
            text = text.replace(place, words)
        *_, last = Simulation(Scene.from_toml(text).problem()).run()
        forces.append(last.contacts[0].force_slave[0])
    assert forces[0] == pytest.approx(forces[1], rel=2e-3)
    assert forces[1] > 1e-4
