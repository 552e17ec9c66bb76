"""Moments that are told of a scene far from the origin: about the origin, of both sides of a contact and of loads."""

from __future__ import annotations

import numpy as np
from transforms import moved

from isomortar.harness import Bound, case
from isomortar.march.simulation import Simulation
from isomortar.scene import Scene
from isomortar.solve.record import StepResult

#: A block that is pressed onto another one, dragged and turned, under its weight.
SCENE = """
format = 1
solver.newton_tolerance = 1e-11
bodies.upper = { geometry = { kind = "box", lower = [0, 0, 0], upper = [0.5, 0.5, 0.5] }, mesh = { order = 2, elements = [2, 2, 1] } }
bodies.lower = { geometry = { kind = "box", lower = [-1, -1, -0.5], upper = [1, 1, 0.001] }, mesh = { order = 2, elements = [2, 2, 1] } }
contacts.c = { slave = "upper.w0", master = "lower.w1", friction = 0.3 }
supports = { top = { face = "upper.w1", centre = [0.2, 0.1, 0.4] }, base.face = "lower.w0" }
loads.own = { body = "upper", weight = [0.01, 0.02, -0.03] }
stages = [{ name = "one", steps = 1, motions.top = { translate = [0.005, 0.01, -0.01], rotate = 2 } }]
"""
AWAY = np.array([16.0, -32.0, 64.0])


def acting(step: StepResult) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Forces that are told, with their moments about the origin."""
    (contact,), (load,) = step.contacts, step.loads
    return {
        "slave": (contact.force_slave, contact.moment_slave),
        "master": (contact.force_master, contact.moment_master),
        "load": (load.force, load.moment),
    }


@case(
    claim="Far from the origin forces are the same, and moments about it are those before with the way from there times the force.",
    tier="gate",
    grid={"lower": ("deformable", "rigid")},
    bounds={
        "forces": Bound(at_most=1e-8, reason="theory: Newton's method leaves 1e-11 of the inner forces; of the largest force"),
        "moments": Bound(
            at_most=1e-7, reason="theory: Newton's method leaves 1e-11 of the inner forces, on arms of 73; of the largest moment"
        ),
        "balance": Bound(at_most=1e-10, reason="theory: forces and moments of slave and master cancel (3.5, 3.6); of the largest moment"),
    },
)
def about_the_origin(lower: str) -> dict[str, float]:
    """Largest differences, and the largest sums of both sides of the contact."""
    problem = Scene.from_toml(SCENE, overrides=[f"bodies.lower.rigid={str(lower == 'rigid').lower()}"]).problem()
    here, there = (acting(next(iter(Simulation(of).run()))) for of in (problem, moved(problem, AWAY)))
    size = np.abs([force for force, _ in here.values()]).max()
    largest = np.abs([moment for _, moment in there.values()]).max()
    expected = {name: moment + np.cross(AWAY, force) for name, (force, moment) in here.items()}
    return {
        "forces": float(np.max([np.abs(there[name][0] - here[name][0]).max() for name in here]) / size),
        "moments": float(np.max([np.abs(there[name][1] - expected[name]).max() for name in here]) / largest),
        "balance": float(np.abs(there["slave"][1] + there["master"][1]).max() / largest),
    }


#: A round punch of flat elements, along whose averaged normals a block is pressed.
ROUND = """
format = 1
solver.newton_tolerance = 1e-11
bodies.upper.geometry = { kind = "bowl", half_width = 0.5, bottom = 0, rise = 0.2, top = 0.5 }
bodies.upper.mesh = { family = "L", order = 1, elements = [4, 4, 1] }
bodies.lower = { geometry = { kind = "box", lower = [-1, -1, -0.5], upper = [1, 1, 0.001] }, mesh = { order = 2, elements = [8, 8, 1] } }
contacts.c = { slave = "lower.w1", master = "upper.w0", projection = "averaged" }
supports = { top.face = "upper.w1", base.face = "lower.w0" }
stages = [{ name = "one", steps = 1, motions.top.translate = [0, 0, -0.05] }]
"""


@case(
    claim="Far from the origin half of a scene, by a plane of symmetry across any axis, bears what it does there.",
    tier="gate",
    grid={"axis": ("x", "y")},
    bounds={"forces": Bound(at_most=1e-8, reason="theory: Newton's method leaves 1e-11 of the inner forces; of the largest force")},
)
def halves(axis: str) -> dict[str, float]:
    """Largest difference, over the largest force."""
    problem = Scene.from_toml(f"{ROUND}symmetry.{axis} = 0.0\n").problem()
    here, there = (next(iter(Simulation(of).run())).contacts[0].force_slave for of in (problem, moved(problem, 8.0 * AWAY)))
    return {"forces": float(np.abs(here - there).max() / np.abs(here).max())}
