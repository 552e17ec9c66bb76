"""Halves of scenes whose planes of symmetry are off the origin, driven by forces, moments and loads: results are the whole's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from small_scenes import TIGHT
from transforms import moved

from isomortar.geometry.patch import FloatArray
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: Scenes of Lagrange elements, whose functions a plane halves, each with its plane.
SCENES = {
    "pad": (
        "y = 0.3",
        """
format = 1
bodies.pad.geometry = { kind = "box", lower = [-0.5, -0.1, 0], upper = [0.5, 0.7, 0.4] }
bodies.pad.mesh = { family = "L", order = 2, elements = [3, 4, 1], grading = [0.5, 1, 1] }
contacts.floor = { slave = "pad.w0", plane = {}, friction = 0.3 }
supports.begin = { face = "pad.w1", centre = [0.1, 0.2, 0.4], axis = [0, 1, 0], stages = ["begin"] }
loads.wind = { face = "pad.u0", pressure = 0.05 }
loads.own = { body = "pad", weight = [0.03, 0, -0.1] }
loads.pull = { face = "pad.u1", traction = [0.03, 0, -0.01] }
stages = [
    { name = "begin", steps = 1, motions.begin = { translate = [0, 0, -0.02], rotate = 1 } },
    { name = "press", steps = 1 },
    { name = "drag", steps = 1, loads.top = 1.2 },
]
[supports.top]
face = "pad.w1"
stages = ["press", "drag"]
components = ["y"]
force = { x = 0.02, z = -0.4 }
moment = 0.01
centre = [0.1, 0, 0.4]
axis = [0, 1, 0]
""",
    ),
    "pipe": (
        "x = 0.2",
        """
format = 1
bodies.pipe.geometry = { kind = "ring", inner = 0.7, outer = 1, width = 0.5, angles = [110, 250], centre = [0.2, 0.1, 1] }
bodies.pipe.mesh = { family = "L", order = [2, 2, 1], elements = [6, 1, 1] }
bodies.base.geometry = { kind = "box", lower = [-0.6, -0.4, -0.4], upper = [1.0, 0.6, 0] }
bodies.base.mesh = { family = "L", order = 1, elements = [4, 2, 1] }
contacts.pair = { slave = "pipe.v1", master = "base.w1", friction = 0.3 }
supports.base.face = "base.w0"
supports.front = { edge = "pipe.v0.w0", stages = ["press"] }
supports.back = { edge = "pipe.v0.w1", stages = ["press"] }
supports.in = { face = "pipe.v0", components = ["x", "y"], force.z = -0.3, stages = ["go"] }
stages = [
    { name = "press", steps = 1, motions.front.translate = [0, 0, -0.05], motions.back.translate = [0, 0, -0.05] },
    { name = "go", steps = 2 },
]
""",
    ),
}


def results(text: str, distance: float) -> dict[str, FloatArray]:
    """Forces, moments, places and turns of the scene's supports, of its loads and contact, and works, by load step."""
    found = moved(Scene.from_toml(text).problem(), distance * np.array([1.0, -0.7, 0.3]))
    problem = replace(found, settings=replace(found.settings, **TIGHT))  # type: ignore[arg-type]
    count, steps = len(problem.given_supports), list(Simulation(problem).run())
    reactions = [step.reactions[:count] for step in steps]
    contacts = [step.contacts[0] for step in steps]
    held = np.array([[(r.force, r.moment, r.centre, r.displacement) for r in one] for one in reactions])
    return {
        "supports": held[:, :, :2],
        "loads": np.array([[(load.force, load.moment) for load in step.loads] for step in steps]),
        "contacts": np.array([[c.force_slave, c.moment_slave, c.force_master, c.moment_master] for c in contacts]),
        "ways": held[:, :, 2:],
        "turns": np.array([[r.rotation for r in one] for one in reactions]),
        "works": np.array([[c.friction_work, c.spurious_work] for c in contacts]),
    }


_TIGHT = "theory: the same equations by symmetry; Newton's method stops at 1e-12"


@case(
    claim="Forces, moments, places, turns and works that a half tells are those of the whole, wherever its plane is.",
    tier="gate",
    grid={"scene": list(SCENES), "distance": (0.0, 1000.0)},
    bounds={name: Bound(at_most=1e-9, reason=_TIGHT) for name in ("supports", "loads", "contacts", "ways", "turns", "works")},
)
def told_of_the_whole(scene: str, distance: float) -> dict[str, float]:
    """Largest differences: of forces and moments over the largest of the contact, of places in lengths, of turns in degrees, of works."""
    plane, text = SCENES[scene]
    whole, half = (results(given, distance) for given in (text, text.replace("format = 1\n", f"format = 1\nsymmetry = {{ {plane} }}\n")))
    size = float(np.abs(whole["contacts"]).max())
    return {name: float(np.abs(whole[name] - half[name]).max(initial=0.0)) / (1.0 if name in ("ways", "turns") else size) for name in whole}
