"""What a higher order at the face in contact alone gains (docs/trade.md): unknowns, CPU seconds and errors of curves.

python verification/contact_order.py iron-round 6:2 6:3 6:2:3   # 6 elements along the slave; order 2, 3, and 2 with contact_order = 3
"""

from __future__ import annotations

import sys
from time import process_time

import numpy as np

from isomortar import Scene, Simulation
from isomortar.geometry.patch import FloatArray

#: Load histories shorter than the scenes' own, elements of the master over those of the slave, force or moment with its component, and
#: elements and order of the over-refined run that errors count from.
SCENES = {
    "iron-round": (
        ["stages.0.steps=3", "stages.1.steps=8", "stages.1.motions.top.translate=[0.4,0,0]"], (2, 1), ("force", 0), "12:3",
    ),
    "twist": (
        ["stages.0.steps=6", "stages.0.motions.top.translate=[0,0,-0.25]", "stages.1.steps=9", "stages.1.motions.top.rotate=45.0"],
        (5 / 3, 5 / 3), ("moment", 2), "12:2",
    ),
}  # fmt: skip


def run(name: str, mesh: str) -> tuple[FloatArray, int, float]:
    """Curve of the last stage, unknowns and CPU seconds of a scene with a mesh: elements, order, and that in contact."""
    history, (along, across), (quantity, component), _ = SCENES[name]
    elements, order, raised = (int(part) for part in f"{mesh}:0".split(":")[:3])
    counts = {"slave": [elements, elements, 3], "master": [round(along * elements), round(across * elements), 3]}
    overrides = [f"bodies.{body}.mesh={{order=[{order},{order},2],elements={count}}}" for body, count in counts.items()]
    overrides += [f"bodies.{body}.mesh.contact_order={raised}" for body in counts if raised]
    begun = process_time()
    problem = Scene.load(name, [*history, *overrides]).problem()
    simulation = Simulation(problem)
    curve = np.array([getattr(step.reactions[0], quantity)[component] for step in simulation.run()])
    return curve[-problem.stages[-1].steps :], len(simulation.equilibrium.supports.free), process_time() - begun


def main(name: str, *meshes: str) -> None:
    """Print one mesh after the other."""
    truth, *_ = run(name, SCENES[name][-1])
    for mesh in meshes:
        curve, unknowns, seconds = run(name, mesh)
        error = np.linalg.norm(curve - truth) / np.linalg.norm(truth)
        print(f"{name} {mesh}: {unknowns} unknowns, {seconds:.1f} s, {100.0 * error:.2f} % off", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
