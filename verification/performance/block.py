"""A small block pressed onto a larger one and slid along it: isomortar beside GetFEM and CalculiX."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from performance.peers.programs import timed

import isomortar
from isomortar.geometry.patch import FloatArray
from isomortar.harness.bench import ASIDE, Row, benchmark
from isomortar.harness.bench.declaration import REPEATS
from isomortar.model.entities import Problem
from isomortar.model.numbering import Numbering
from isomortar.program.calculix import CalculiX
from isomortar.program.declaration import NotInstalledError, Program
from isomortar.program.getfem import GetFEM
from isomortar.program.process import run
from isomortar.scene import Scene

#: The scene's bodies as NURBS of order 2 on the same elements.
N2 = tuple(f"bodies.{body}.mesh.{key}" for body in ("slave", "master") for key in ("family=N", "order=[2,2,2]"))
#: A coarse one with short load steps, for `quick`.
COARSE = (
    "bodies.slave.mesh.elements=[2,2,1]",
    "bodies.master.mesh.elements=[3,3,2]",
    "stages.press.steps=2",
    "stages.press.motions.top.translate=[0,0,-0.1]",
    "stages.slide.steps=2",
    "stages.slide.motions.top.translate=[0.02,0,0]",
)
#: The paper's law is none of CalculiX': it gets its own, the same to first order.
CALCULIX_LAW = "materials.rubber.law=neo-hookean-j"
CALCULIX_NOTE = "another volumetric energy, A1/2 (J - 1)^2; contact by a penalty"
#: All that isomortar does before its first load step: imports, reading the scene, setting the system up.
START_UP = """
import sys
from isomortar._process import loading, numpy_as_loaded
with loading():
    with numpy_as_loaded():
        import isomortar.cli.commands, isomortar.driver
    from isomortar.scene import Scene
    from isomortar.march.simulation import Simulation
    problem = Scene.load("block", sys.argv[1:]).problem()
Simulation(problem)
"""


def heading(scene: Scene, program: str, kind: str) -> Row:
    """What a row is about. Unknowns are displacements of all control points or nodes, those at supports included."""
    problem = scene.problem()
    stages = ", ".join(stage.name for stage in problem.stages)
    unknowns = 3 * Numbering(problem).count
    return {"stages": stages, "program": program, "kind": kind, "unknowns": unknowns, "tolerance": problem.settings.newton_tolerance}


def pressing(scene: Scene) -> str:
    """The override that leaves a scene its first stage alone."""
    first = scene.tables.stages[0]
    return f'stages=[{{name="{first.name}", steps={first.steps}, motions.top.translate={list(first.motions["top"].translate)}}}]'


def measured(solves: int, seconds: float, start_up: float, forces: Sequence[FloatArray]) -> dict[str, float | int | str]:
    """What a run came to: its cost, its load steps, and the forces on the top, shape (3,), after the last of them."""
    ends = {"normal force": -float(forces[-1][2]), "tangential force": float(forces[-1][0])} if forces else {}
    return {"load steps": len(forces), "linear solves": solves, "CPU": seconds, "start-up": start_up, **ends}


def isomortar_run(overrides: Sequence[str], repeats: int) -> Row:
    """The program as a person calls it, results file and all."""
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "block.h5"
        settings = [argument for override in overrides for argument in ("--set", override)]
        command = [sys.executable, "-m", "isomortar", "run", "block", "--quiet", "--overwrite", "--output", str(output), *settings]
        finished, seconds = timed(lambda: run(command), repeats)
        with isomortar.Results(output) as results:
            forces = list(results.curve("force", support="top"))
            solves = int(results.counters()["solves"].sum())
    _, start_up = timed(lambda: run([sys.executable, "-c", START_UP, *overrides]), repeats)
    row = measured(solves, seconds, start_up, forces)
    if finished.end.status != 0:
        row["note"] = f"forces and linear solves up to load step {len(forces)}, CPU of all tries; {finished.last_words}"
    return row


def other_run(program: Program, scene: Scene, repeats: int, note: str) -> Row:
    """Another program on a scene; `note` says what its numbers are worth."""
    problem = scene.problem()
    try:
        found, seconds = timed(lambda: program.run(problem), repeats)
    except NotInstalledError as error:
        return {"note": str(error)}
    _, start_up = timed(lambda: program.run(at_rest(problem)), repeats)
    top = [support.name for support in problem.supports].index("top")
    row = measured(found.solves, seconds, start_up, [step.reactions[top].force for step in found.steps])
    return {**row, "note": "; ".join(filter(None, (note, found.words)))}


def at_rest(problem: Problem) -> Problem:
    """The problem without a load step."""
    return replace(problem, stages=(), supports=tuple(replace(support, motions=()) for support in problem.supports))


def compared(row: Row, getfem: Row) -> Row:
    """A row of isomortar with its CPU time as a share of GetFEM's, where both came to the end."""
    if "note" in row:
        return row
    if getfem.get("load steps") != row["load steps"]:
        return {**row, "note": f"GetFEM, to compare with: {getfem['note']}"}
    return {**row, "of GetFEM": float(row["CPU"]) / float(getfem["CPU"])}


@benchmark(
    question="What does the same frictional contact problem cost in isomortar, GetFEM and CalculiX?",
    columns={
        "stages": "",
        "program": "",
        "kind": "",
        "unknowns": "",
        "tolerance": "",
        "load steps": "",
        "linear solves": "",
        "CPU": "s",
        "start-up": "s",
        "normal force": "",
        "tangential force": "",
        "of GetFEM": "",
    },
    limits={"of GetFEM": (0.2, "CPU seconds of the whole process over GetFEM's on the same elements")},
)
def block(quick: bool) -> Iterator[Row]:
    """The bundled scene `block`: a block pressed onto a larger one in 5 load steps, slid along it in 10; and the pressing alone.

    All have the same boxes, elements (linear hexahedra; N2 on the same grid for isomortar), load steps, friction, and bound of the
    relative residual, each in its own norm. GetFEM and isomortar have the same strain energy, and as many Gauss points where they are of
    one order. What can not be made the same is how contact is enforced: mortar with multipliers (isomortar), multipliers with raytracing
    (GetFEM), a penalty at integration points (CalculiX, which has another volumetric energy as well).

    CPU is user and system time of the whole process, with one thread: starting, reading, computing, and writing what the program writes by
    itself; GetFEM is not asked for the works of contact, which are integrated for us. Start-up, a part of it, is the same process without a
    load step: imports, reading, setting the system up. Unknowns are displacements, those at supports included. Forces are those on the
    upper block's top after the last load step. The sharp edges are not converged with the mesh: the forces say whether the programs do the
    same, not which is right.
    """
    coarse, repeats = (COARSE, 1) if quick else ((), REPEATS)
    for only in ((pressing(Scene.load("block", coarse)),), ()):
        linear = (*coarse, *only)
        scene = Scene.load("block", linear)
        getfem = other_run(GetFEM(works=False), scene, repeats, "what isomortar is compared with")
        yield {**heading(scene, "GetFEM", "L1"), **getfem, "of GetFEM": ASIDE}
        calculix = other_run(CalculiX(), Scene.load("block", (*linear, CALCULIX_LAW)), repeats, CALCULIX_NOTE)
        yield {**heading(scene, "CalculiX", "L1"), **calculix, "of GetFEM": ASIDE}
        for kind, overrides in (("L1", linear), ("N2", (*N2, *linear))):
            row = compared(isomortar_run(overrides, repeats), getfem)
            yield {**heading(Scene.load("block", overrides), "isomortar", kind), **row}
