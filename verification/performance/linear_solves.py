"""Linear solves per load step: scenes, orders and methods.

    python verification/performance/linear_solves.py [--scenes twist,iron] [--orders N2,N3] [--methods monolithic,uzawa:0.01]

For each run: median and maximum of the linear solves per load step, cut load increments, seconds, and the end force and
moment of the first support. A run that ends early says where.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from isomortar.errors import IsomortarError
from isomortar.harness.discretisations import mesh_overrides
from isomortar.scene import Scene
from isomortar.solve.simulation import Simulation

#: The paper leaves Lagrange masters out.
DEFORMABLE = ("twist", "twist-sharp", "iron", "reversal")


def measure(scene: str, discretisation: str, method: str) -> str:
    """Run one scene and return its row of the table."""
    name, _, tolerance = method.partition(":")
    overrides = [*mesh_overrides(Scene.load(scene), discretisation), f"solver.method={name}"]
    overrides += [f"solver.augmentation_tolerance={tolerance}", "solver.max_augmentations=600"] if tolerance else []
    problem = Scene.load(scene, overrides).problem()
    simulation = Simulation(problem)
    solves: list[int] = []
    cuts, ended, last = 0, "", None
    start = time.process_time()
    try:
        for last in simulation.run():
            solves.append(last.counters["solves"])
            cuts += last.cuts
    except IsomortarError as error:
        ended = f"  ended after step {len(solves)} of {problem.total_steps}: {error}"
    seconds = time.process_time() - start
    end = "" if last is None else f"{last.reactions[0].force[0]: .6f} {last.reactions[0].force[2]: .6f} {last.reactions[0].moment[2]: .6f}"
    return f"{scene:9s} {discretisation:3s} {method:16s} {np.median(solves):6.1f} {max(solves):5d} {cuts:4d} {seconds:8.1f}  {end}{ended}"


def main() -> None:
    """Measure the table and print it row by row."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", default="press,twist,iron,tire")
    parser.add_argument("--orders", default="N2,N3,N4,L2")
    parser.add_argument("--methods", default="monolithic,uzawa:0.01,uzawa:1e-6")
    options = parser.parse_args()
    print(f"{'scene':9s} {'':3s} {'method':16s} {'median':>6s} {'most':>5s} {'cuts':>4s} {'CPU s':>8s}  end: force x, z, moment z")
    for scene in options.scenes.split(","):
        for discretisation in options.orders.split(","):
            if discretisation[0] == "L" and scene in DEFORMABLE:
                continue
            for method in options.methods.split(","):
                print(measure(scene, discretisation, method), flush=True)


if __name__ == "__main__":
    main()
