"""Tangents per load step by method."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice, product
from time import process_time

import numpy as np
from performance.problems import problem

from isomortar.errors import IsomortarError
from isomortar.harness.bench import Row, benchmark
from isomortar.march.simulation import Simulation

#: The methods: name and, for augmentations, their tolerance.
METHODS = ("monolithic", "uzawa:0.01", "uzawa:1e-6")
#: Load steps that are run: into the second stage, where there is one.
SCENES = {"press": 5, "twist": 20, "iron": 20, "tire": 20}
#: The paper leaves Lagrange masters out.
KINDS = {"press": ("N2", "N3", "L2"), "twist": ("N2", "N3"), "iron": ("N2", "N3"), "tire": ("N2", "N3", "L2")}


@benchmark(
    question="How many tangents does a load step take, by method?",
    columns={
        "scene": "",
        "kind": "",
        "method": "",
        "steps": "",
        "median": "",
        "most": "",
        "cuts": "",
        "CPU": "s",
        "force": "",
        "moment": "",
    },
)
def linear_solves(quick: bool) -> Iterator[Row]:
    """Tangents per load step, median and most; load increments that were cut; size of end force and moment of the first support.

    Methods: positions and tractions in one Newton loop, and the paper's augmentations to a tolerance. The paper's 0.01 leaves the result
    free by some per cent: compare at like forces.
    """
    runs = [("press", "N2")] if quick else [(scene, kind) for scene in SCENES for kind in KINDS[scene]]
    for (scene, kind), method in product(runs, METHODS[:2] if quick else METHODS):
        name, _, tolerance = method.partition(":")
        settings = [f"solver.method={name}"]
        settings += [f"solver.augmentation_tolerance={tolerance}", "solver.max_augmentations=600"] if tolerance else []
        simulation = Simulation(problem(scene, kind, (4, 4, 2) if quick else None, settings))
        yield {"scene": scene, "kind": kind, "method": method, **_run(simulation, 1 if quick else SCENES[scene])}


def _run(simulation: Simulation, steps: int) -> Row:
    """Run some load steps; one that does not converge ends the run, and is told in a note."""
    solves: list[int] = []
    cuts, note = 0, {}
    force = moment = float("nan")
    start = process_time()
    try:
        for result in islice(simulation.run(), steps):
            solves.append(result.counters["factorisations"])
            cuts += result.cuts
            force, moment = (float(np.linalg.norm(vector)) for vector in (result.reactions[0].force, result.reactions[0].moment))
    except IsomortarError as error:
        note = {"note": f"ended after load step {len(solves)} of {steps}: {error}"}
    cost: Row = {"CPU": process_time() - start, "force": force, "moment": moment, **note}
    middle, most = (float(np.median(solves)), max(solves)) if solves else (float("nan"), 0)
    return {"steps": len(solves), "median": middle, "most": most, "cuts": cuts, **cost}
