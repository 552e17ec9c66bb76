"""Slip and friction as vectors: against the kernel's own forces, slips and works, and against motions that are known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy

import isomortar
from isomortar import _bindings
from isomortar._bindings import Response
from isomortar.geometry.patch import FloatArray
from isomortar.march.simulation import Simulation
from isomortar.model.enforcement import SlaveFace
from isomortar.results.paraview import export
from isomortar.results.vectors import contact_vectors
from isomortar.scene import Scene
from isomortar.solve.record import StepResult
from test_results_fields import read

IRON = ["bodies.slave.mesh.elements=[3,3,1]", "bodies.master.mesh.elements=[6,3,1]", "stages.press.steps=1", "stages.drag.steps=4"]
DRAG = "stages.press.motions.top.translate=[0.15,0.06,-0.2]"
PRESS = ["bodies.block.mesh.elements=[4,4,2]", "stages.press.steps=2", DRAG, "contacts.floor.plane.tangent=[0.8,0.6,0]"]

#: Scenes, how near resultants are (a point that is deeper than its foot has another arm), how near works are (means of products).
MASTERS = {
    "plane": ("press", PRESS, 1e-12, 1e-12),
    "closest": ("iron", IRON, 1e-3, 0.02),
    "averaged": ("iron", [*IRON, "contacts.interface.projection=averaged"], 1e-12, 0.02),
}


def two_steps(scene: str, overrides: list[str], last: int) -> tuple[Simulation, StepResult, StepResult]:
    """A run up to a load step: it, the one before, the step."""
    simulation = Simulation(Scene.load(scene, overrides).problem())
    steps = [result for result, _ in zip(simulation.run(), range(last), strict=False)]
    return simulation, steps[-2], steps[-1]


def friction_alone(simulation: Simulation, before: StepResult, result: StepResult) -> tuple[FloatArray, FloatArray]:
    """What the kernel makes of the tractions: their force on the slave, and weights of its control points."""
    mechanics, state = simulation.equilibrium.pairs[0], result.state.contacts[0]
    pair, n = mechanics.pair, len(state.pressure)
    positions = result.state.positions - simulation.equilibrium.origin
    kinematics = mechanics.kinematics(positions, before.state.contacts[0])
    status = result.contacts[0].status
    response = Response(np.zeros(n), state.traction, status, np.zeros(n), np.zeros((n, 6, 2)), np.zeros((len(pair.slave.area), 2)))
    forces = np.zeros_like(positions)
    _bindings.contact_forces(pair.slave, pair.master, positions, kinematics.projections, response, forces, True)
    return -forces[pair.slave.point].sum(axis=0), kinematics.control.weight


@pytest.mark.parametrize("master", MASTERS)
def test_they_make_the_force_and_the_work_of_friction(master: str) -> None:
    scene, overrides, force_near, work_near = MASTERS[master]
    simulation, before, result = two_steps(scene, overrides, 2)
    problem = simulation.problem
    (vectors,) = contact_vectors(problem, result, before)
    within = SlaveFace(problem.contacts[0], problem, simulation.equilibrium.numbering).within
    traction, slip = np.zeros((2, len(result.state.contacts[0].pressure), 3))
    traction[within], slip[within] = vectors.traction, vectors.slip
    expected, weight = friction_alone(simulation, before, result)
    assert np.abs(weight @ traction - expected).max() <= force_near * np.abs(expected).max()
    work = result.contacts[0].friction_work
    assert work > 0.0
    assert abs(-np.einsum("n,nc,nc", weight, traction, slip) / work - 1.0) <= work_near
    norms, acts = result.contacts[0].traction_norm, result.contacts[0].status > 0
    assert np.abs(np.linalg.norm(traction, axis=1) - norms).max() <= (1e-12 if master == "plane" else 0.05) * norms.max()
    assert not traction[~acts].any()
    assert not slip[~acts].any()


BLOCK = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 0.5] }
bodies.block.mesh.elements = [2, 2, 1]
contacts.floor = { slave = "block.w0", plane = { point = [0, 0, 0], normal = [0, 0, 1], tangent = [0.6, 0.8, 0] }, friction = 0.2 }
supports.top.face = "block.w1"
stages = [
  { name = "press", steps = 1, motions.top.translate = [0, 0, -0.02] },
  { name = "drag", steps = 2, motions.top.translate = [0.4, 0.3, 0] },
]
"""


def test_a_block_that_slides_has_the_slip_of_its_support(tmp_path: Path) -> None:
    """Of the second load step of the drag, in which all of it slides; friction is against that, as the law says. VTK reads both."""
    with isomortar.run(Scene.from_toml(BLOCK), tmp_path / "run.h5") as results:
        step = results.step(3)
    export(tmp_path / "run.h5", tmp_path)
    data = read(tmp_path / "run" / "contacts-0003.vtu").GetPointData()
    fields = {name: vtk_to_numpy(data.GetArray(name)) for name in ("slip vector", "traction vector", "pressure", "traction")}
    assert step.contacts[0].slip == step.contacts[0].active == len(step.contacts[0].status)
    assert fields["slip vector"] == pytest.approx(np.tile([0.2, 0.15, 0.0], (len(fields["pressure"]), 1)), abs=1e-3)
    assert fields["traction vector"] == pytest.approx(
        -0.2 * fields["pressure"][:, None] * [0.8, 0.6, 0.0], abs=0.01 * fields["traction"].max()
    )


def test_the_first_load_step_counts_from_rest(tmp_path: Path) -> None:
    scene = Scene.from_toml(
        BLOCK, overrides={"stages": [{"name": "both", "steps": 1, "motions": {"top": {"translate": [0.4, 0.3, -0.02]}}}]}
    )
    isomortar.run(scene, tmp_path / "run.h5").close()
    export(tmp_path / "run.h5", tmp_path)
    still, moved = (
        vtk_to_numpy(read(tmp_path / "run" / f"contacts-000{number}.vtu").GetPointData().GetArray("slip vector")) for number in (0, 1)
    )
    assert not still.any()
    assert np.abs(moved - [0.4, 0.3, 0.0]).max() < 0.02


def test_slip_is_unknown_where_the_state_before_was_not_kept(tmp_path: Path) -> None:
    isomortar.run(Scene.from_toml(BLOCK, overrides={"record.states": "last"}), tmp_path / "run.h5").close()
    export(tmp_path / "run.h5", tmp_path)
    data = read(tmp_path / "run" / "contacts-0003.vtu").GetPointData()
    assert np.isnan(vtk_to_numpy(data.GetArray("slip vector"))).all()
    assert np.linalg.norm(vtk_to_numpy(data.GetArray("traction vector")), axis=1).min() > 0.0


@pytest.mark.parametrize("enforcement", ["dual", "kts", "knots"])
def test_any_enforcement_has_them(enforcement: str) -> None:
    """Friction is against the motion, and a fifth of some pressure."""
    overrides = {"contacts.floor.enforcement": enforcement, "solver.method": "uzawa" if enforcement == "kts" else "monolithic"}
    problem = Scene.from_toml(BLOCK, overrides=overrides).problem()
    *_, before, result = Simulation(problem).run()
    (vectors,) = contact_vectors(problem, result, before)
    drag, pressure = -vectors.traction @ [0.8, 0.6, 0.0], result.state.contacts[0].pressure
    assert 0.19 * pressure.min() <= drag.min() <= drag.max() <= 0.21 * pressure.max()
    assert np.abs(vectors.traction @ [0.6, -0.8, 1.0]).max() <= 0.02 * drag.max()
    assert vectors.slip == pytest.approx(np.tile([0.2, 0.15, 0.0], (len(vectors.slip), 1)), abs=5e-3)
