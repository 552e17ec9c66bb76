"""A small block pressed onto a larger one and slid along it: isomortar beside GetFEM and CalculiX."""

from __future__ import annotations

import json
import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import isomortar
from isomortar.harness.bench import Row, benchmark
from isomortar.harness.bench.declaration import REPEATS
from isomortar.model.numbering import Numbering
from isomortar.scene import Scene
from performance.peers import calculix
from performance.peers.programs import DEBIAN_PYTHON, has_module, timed

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
#: All that isomortar does before its first load step: imports, reading the scene, setting the system up.
START_UP = """
import sys
import isomortar.cli.commands, isomortar.driver
from isomortar.scene import Scene
from isomortar.solve.simulation import Simulation
Simulation(Scene.load("block", sys.argv[1:]).problem())
"""


def description(scene: Scene) -> dict[str, Any]:
    """What the other programs have to know of the scene, in plain numbers that JSON holds."""
    tables, problem = scene.tables, scene.problem()
    (contact,), material = problem.contacts, problem.bodies[0].material
    bodies = {
        body.name: {
            "lower": body.patch.control_points.min(axis=0).tolist(),
            "upper": body.patch.control_points.max(axis=0).tolist(),
            "elements": [direction.elements for direction in body.patch.directions],
        }
        for body in problem.bodies
    }
    return {
        **bodies,
        "bulk": material.bulk,
        "shear": material.shear,
        "friction": contact.friction,
        "solid_points": problem.bodies[0].quadrature[0],
        "contact_points": contact.quadrature[0],
        "tolerance": problem.settings.newton_tolerance,
        "stages": [{"steps": stage.steps, "translate": list(stage.motions["top"].translate)} for stage in tables.stages],
    }


def unknowns(scene: Scene) -> int:
    """Displacements of all control points or nodes, those at supports included."""
    return 3 * Numbering(scene.problem()).count


def measured(problem: dict[str, Any], forces: Sequence[Sequence[float]]) -> Row:
    """Load steps, and forces on the top at the ends of the stages that were reached."""
    pressed, slid = (int(end) for end in np.cumsum([stage["steps"] for stage in problem["stages"]]))
    row: dict[str, float | int | str] = {"load steps": len(forces)}
    if len(forces) >= pressed:
        row["normal, pressed"] = -forces[pressed - 1][2]
    if len(forces) >= slid:
        row |= {"normal, slid": -forces[slid - 1][2], "tangential, slid": forces[slid - 1][0]}
    return row


def isomortar_row(overrides: Sequence[str], repeats: int) -> Row:
    """The program as a person calls it, results file and all."""
    scene = Scene.load("block", overrides)
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "block.h5"
        settings = [argument for override in overrides for argument in ("--set", override)]
        command = [sys.executable, "-m", "isomortar", "run", "block", "--quiet", "--overwrite", "--output", str(output), *settings]
        finished, seconds = timed(command, repeats=repeats)
        with isomortar.Results(output) as results:
            forces = results.curve("force", support="top").tolist()
            solves = int(results.counters()["solves"].sum())
    _, start = timed([sys.executable, "-c", START_UP, *overrides], repeats=repeats)
    row = {"linear solves": solves, "CPU": seconds, "start-up": start, **measured(description(scene), forces)}
    return row if finished.status == 0 else row | {"note": f"linear solves of the load steps that converged; {finished.last_words}"}


def getfem_row(problem: dict[str, Any], repeats: int) -> Row:
    """GetFEM's Python interface."""
    if not has_module(DEBIAN_PYTHON, "getfem"):
        return {"note": "not installed: apt-get install python3-getfem"}
    command = [DEBIAN_PYTHON, str(Path(__file__).parent / "peers" / "getfem_block.py")]
    finished, seconds = timed(command, json.dumps(problem), repeats=repeats)
    if finished.status != 0:
        return {"note": finished.last_words}
    _, start = timed(command, json.dumps({**problem, "stages": []}), repeats=repeats)
    found = finished.answer()
    row = {"linear solves": sum(found["solves"]), "CPU": seconds, "start-up": start, **measured(problem, found["forces"])}
    return row | {"note": found["ended"]} if "ended" in found else row


def calculix_row(problem: dict[str, Any], repeats: int) -> Row:
    """CalculiX, from its input deck."""
    if shutil.which("ccx") is None:
        return {"note": "not installed: apt-get install calculix-ccx"}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "block.inp").write_text(calculix.deck(problem))
        (folder / "empty.inp").write_text(calculix.deck({**problem, "stages": []}))
        finished, seconds = timed(["ccx", "-i", "block"], folder=folder, repeats=repeats)
        _, start = timed(["ccx", "-i", "empty"], folder=folder, repeats=repeats)
        forces = calculix.forces((folder / "block.dat").read_text(), problem["stages"])
        solves = calculix.linear_solves((folder / "block.cvg").read_text())
    notes = ["another volumetric energy, A1/2 (J - 1)^2; contact by a penalty"]
    if finished.status != 0:
        notes += [finished.last_words]
    return {"linear solves": solves, "CPU": seconds, "start-up": start, **measured(problem, forces), "note": "; ".join(notes)}


@benchmark(
    question="What does the same frictional contact problem cost in isomortar, GetFEM and CalculiX?",
    columns={
        "program": "",
        "discretisation": "",
        "unknowns": "",
        "load steps": "",
        "linear solves": "",
        "CPU": "s",
        "start-up": "s",
        "normal, pressed": "",
        "normal, slid": "",
        "tangential, slid": "",
    },
)
def block(quick: bool) -> Iterator[Row]:
    """The bundled scene `block`: a block pressed onto a larger one in 5 load steps, slid along it in 10, as each program has it.

    All have the same boxes, elements (linear hexahedra; N2 on the same grid for isomortar), load steps, friction, and bound of the relative
    residual, each in its own norm. GetFEM and isomortar have the same strain energy, and as many Gauss points where they are of one order. What
    can not be made the same is how contact is enforced: mortar with multipliers (isomortar), multipliers with raytracing (GetFEM), a penalty at
    integration points (CalculiX, which has another volumetric energy as well).

    CPU is user and system time of the whole process, with one thread: starting, reading, computing, and writing what the program writes by itself.
    Start-up is the same process without a load step: imports, reading, setting the system up. Unknowns are displacements, those at
    supports included. Forces are those on the upper block's top. The sharp edges are not converged with the mesh: the forces say whether the programs
    do the same, not which is right.
    """
    coarse, repeats = (COARSE, 1) if quick else ((), REPEATS)
    scene = Scene.load("block", coarse)
    problem = description(scene)
    yield {"program": "isomortar", "discretisation": "L1", "unknowns": unknowns(scene), **isomortar_row(coarse, repeats)}
    smooth = (*N2, *coarse)
    yield {
        "program": "isomortar",
        "discretisation": "N2",
        "unknowns": unknowns(Scene.load("block", smooth)),
        **isomortar_row(smooth, repeats),
    }
    for program, row_of in (("GetFEM", getfem_row), ("CalculiX", calculix_row)):
        yield {"program": program, "discretisation": "L1", "unknowns": unknowns(scene), **row_of(problem, repeats)}
