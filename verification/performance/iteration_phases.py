"""Seconds per Newton iteration by phase, and the share of Python.

    python verification/performance/iteration_phases.py [--scene iron] [--orders 2,3] [--steps 25] [--set solver.method=uzawa]

Orders are the master's along its first direction. `other` is what no kernel phase accounts for: Python. Run it on an idle machine with one
thread of the linear algebra library (OPENBLAS_NUM_THREADS=1).
"""

from __future__ import annotations

import argparse
from collections import Counter
from itertools import islice

from isomortar.scene import Scene
from isomortar.solve.simulation import Simulation

PHASES = ("solid", "projection", "contact", "factor", "solve", "other")


def milliseconds(scene: str, order: int, steps: int, settings: list[str]) -> tuple[dict[str, float], int]:
    """Milliseconds per linear solve by phase and in total, and the number of linear solves.

    Parameters
    ----------
    scene : str
        Scene with a body named master.
    order : int
        Of the master along its first direction.
    steps : int
        Load steps that are run.
    settings : list of str
        Overrides.
    """
    problem = Scene.load(scene, [f"bodies.master.mesh.order=[{order},2,2]", *settings]).problem()
    seconds: Counter[str] = Counter()
    solves = 0
    for result in islice(Simulation(problem).run(), steps):
        seconds.update(result.timings)
        solves += result.counters["factorisations"]
    return {phase: 1e3 * seconds[phase] / solves for phase in (*PHASES, "total")}, solves


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", default="iron")
    parser.add_argument("--orders", default="2,3", help="default: %(default)s")
    parser.add_argument("--steps", type=int, default=25, help="load steps (default: %(default)s)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="as for isomortar run")
    options = parser.parse_args()
    print(f"milliseconds per Newton iteration, {options.scene}, {options.steps} load steps")
    print("order  solves" + "".join(f"{phase:>11}" for phase in (*PHASES, "total")) + "   Python")
    for order in map(int, options.orders.split(",")):
        phases, solves = milliseconds(options.scene, order, options.steps, options.set)
        print(
            f"N{order:<5} {solves:6d}"
            + "".join(f"{value:11.2f}" for value in phases.values())
            + f"{phases['other'] / phases['total']:8.1%}"
        )


if __name__ == "__main__":
    main()
