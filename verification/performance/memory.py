"""Peak memory against unknowns and contact quadrature points."""

from __future__ import annotations

import gc
import multiprocessing
import os
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from itertools import islice
from pathlib import Path
from typing import TypeVar

import numpy as np
from performance.problems import problem

from isomortar.harness.bench import Plot, Row, benchmark
from isomortar.harness.measurement import forget_peak_memory, peak_memory
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Problem

Mesh = tuple[str, str, tuple[int, int, int]]
Answer = TypeVar("Answer")
#: How far the slave is pushed into the master where contact alone is measured.
DEPTH = 0.1


@benchmark(
    question="How much memory does an unknown take, and how much a contact quadrature point?",
    columns={
        "scene": "",
        "kind": "",
        "elements": "",
        "unknowns": "",
        "contact points": "",
        "whole": "MB",
        "contact": "MB",
        "an unknown": "kB",
        "a contact point": "kB",
    },
    plots=(Plot("unknowns", "whole", "kind"), Plot("contact points", "contact", "kind")),
)
def memory(quick: bool) -> Iterator[Row]:
    """Growth of the process from the loaded program to its peak, each in a process of its own.

    `whole`: the problem and its first load step. `contact`: one evaluation of the contact with its derivatives, the slave pushed into
    the master everywhere. Both per free unknown, and per quadrature point of the contact.
    """
    meshes: list[Mesh] = [("press", "N2", (4, 4, 2))]
    if not quick:
        meshes = [("press", kind, mesh) for kind in ("N2", "N3", "N5") for mesh in ((6, 6, 3), (12, 12, 6))]
        meshes += [("press", "N2", (24, 24, 6)), ("iron", "N2", (10, 5, 3)), ("iron", "N5", (10, 5, 3))]
    for scene, kind, elements in meshes:
        unknowns, points, whole = in_own_process(first_step, (scene, kind, elements))
        _, _, contact = in_own_process(contact_alone, (scene, kind, elements))
        size: Row = {"elements": "x".join(map(str, elements)), "unknowns": unknowns, "contact points": points}
        each = {"an unknown": 1e-3 * whole / unknowns, "a contact point": 1e-3 * contact / points}
        yield {"scene": scene, "kind": kind, **size, "whole": 1e-6 * whole, "contact": 1e-6 * contact, **each}


def in_own_process(work: Callable[[Mesh], Answer], mesh: Mesh) -> Answer:
    """What some work returns when nothing ran before in its process."""
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        return pool.submit(work, mesh).result()


def first_step(mesh: Mesh) -> tuple[int, int, float]:
    """Unknowns, contact points, and bytes that the first load step needs, the making of the problem included."""
    chosen = problem(*mesh)
    before = _begin()
    simulation = Simulation(chosen)
    for _ in islice(simulation.run(), 1):
        pass
    return *_size(simulation), peak_memory() - before


def contact_alone(mesh: Mesh) -> tuple[int, int, float]:
    """The same of one contact evaluation."""
    chosen = problem(*mesh)
    simulation = Simulation(chosen)
    equilibrium = simulation.equilibrium
    positions = _pushed(chosen, simulation)
    scales = equilibrium.measures.scales(equilibrium.numbering.reference)
    before = _begin()
    for pair, start in zip(equilibrium.pairs, equilibrium.initial_state().contacts, strict=True):
        kinematics = pair.kinematics(positions, start)
        law = pair.law(pair.parameters(kinematics.control, scales), start.pressure, start.traction)
        response = pair.respond(kinematics, law)
        pair.blocks(positions, kinematics, law, response)
    return *_size(simulation), peak_memory() - before


def _pushed(chosen: Problem, simulation: Simulation) -> np.ndarray:
    """Positions with the slaves moved down."""
    positions = simulation.equilibrium.numbering.reference.copy()
    for contact in chosen.contacts:
        positions[np.unique(simulation.equilibrium.numbering.points[contact.slave.body]), 2] -= DEPTH
    return positions


def _size(simulation: Simulation) -> tuple[int, int]:
    equilibrium = simulation.equilibrium
    return len(equilibrium.supports.free), sum(len(pair.pair.slave.area) for pair in equilibrium.pairs)


def _begin() -> float:
    """Bytes that the process holds now; the peak begins anew."""
    gc.collect()
    forget_peak_memory()
    return float(os.sysconf("SC_PAGE_SIZE") * int(Path("/proc/self/statm").read_text().split()[1]))
