"""A belt round a drum: it is tightened at one end, held at the other, and then pulled back there."""

from __future__ import annotations

import numpy as np

from isomortar.errors import ConvergenceError
from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene

#: Half a turn of friction 0.3.
SCENE = """
format = 1
materials.leather = { young = 1000.0, poisson = 0.0 }
bodies.belt.geometry = { kind = "ring", inner = 1, outer = 1.02, width = 0.1, angles = [0, 180], axis = "z" }
bodies.belt.mesh = { order = 2, elements = [MANY, 1, 1] }
bodies.drum.rigid = true
bodies.drum.mesh = { order = 2, elements = [60, 1, 1] }
bodies.drum.geometry = { kind = "ring", inner = 0.5, outer = 1, width = 0.1, angles = [-20, 200], axis = "z" }
contacts.c = { slave = "belt.v0", master = "drum.v1", friction = 0.3 }
supports.drum.face = "drum.v0"
supports.front = { face = "belt.w0", components = ["z"] }
supports.back = { face = "belt.w1", components = ["z"] }
supports.right = { face = "belt.u0", components = ["x"], force = { y = -0.02 } }
supports.left.face = "belt.u1"
supports.left.components = ["x", "y"]
stages = [{ name = "tighten", steps = 2 }, { name = "pull", steps = 1, motions.left = { translate = [0, -0.0000625, 0] } }]
"""
#: What acts along the drum acts at its radius, tension in the middle of the belt.
EULER = 0.02 * np.exp(-0.3 * np.pi / 1.01)


@case(
    claim="A belt that is tightened round a drum slides along all of it and is held by what Euler's formula says; pulled back, all of it "
    "sticks at first, then slides from that end on, and the end takes more.",
    tier="gate",
    bounds={
        "held over Euler": Bound(
            at_least=0.95, at_most=1.05, reason="discretisation: elements are four times as long as the belt is thick"
        ),
        "pulled over held": Bound(at_least=1.05, reason="definition: by how much it is pulled"),
    },
)
def belt() -> dict[str, float]:
    """Forces at the held end."""
    held, pulled = (
        -step.reactions[4].force[1] for step in list(Simulation(Scene.from_toml(SCENE.replace("MANY", "40")).problem()).run())[1:]
    )
    return {"held over Euler": float(held / EULER), "pulled over held": float(pulled / held)}


@case(
    claim="A belt is a chain of elements, whose equations pass errors on from one to the next where pivots are small: none is refused for "
    "want of digits.",
    tier="gate",
    bounds={"refused": Bound(0.0, 0.0, "definition: load steps that end for what a linear system leaves")},
)
def chain() -> dict[str, float]:
    """Of 60 elements that are tightened in one load step, which is too long for Newton's method."""
    scene = SCENE.replace("MANY", "60").split(', { name = "pull"')[0].replace("steps = 2", "steps = 1") + "]\nsolver.max_cuts = 0\n"
    try:
        list(Simulation(Scene.from_toml(scene).problem()).run())
    except ConvergenceError as error:
        return {"refused": float("linear system" in str(error))}
    return {"refused": 0.0}
