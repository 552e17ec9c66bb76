"""Deformation gradient and stress at points of a body: the energy's derivative, closed forms, the kernel's forces, a whole run."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import isomortar
from isomortar._arrays import MaterialLaw
from isomortar.geometry.patch import Patch
from isomortar.model.entities import Body, Material
from isomortar.model.numbering import Numbering
from isomortar.model.solid import Solid
from isomortar.results.fields import body_points
from isomortar.results.stress import deformation_gradient, first_piola_stress
from results_samples import box, problem, ring

F = np.array([[1.3, 0.2, -0.1], [0.05, 0.8, 0.3], [0.1, -0.2, 1.1]])


def energy(material: Material, f: np.ndarray) -> float:
    """W (theory 1.1)."""
    j = float(np.linalg.det(f))
    return 0.5 * material.bulk * np.log(j) ** 2 + 0.5 * material.shear * (j ** (-2 / 3) * float((f * f).sum()) - 3)


def test_stress_is_the_derivative_of_the_energy() -> None:
    material, h = Material(young=3.0, poisson=0.2), 1e-5
    steps = h * np.eye(9).reshape(9, 3, 3)
    slopes = [(energy(material, F + d) - energy(material, F - d)) / (2 * h) for d in steps]
    assert first_piola_stress(material, F).ravel() == pytest.approx(slopes, abs=1e-8)


def test_stress_of_uniform_stretches() -> None:
    material, stretch = Material(), 1.4
    swollen = 3 * material.bulk * np.log(stretch) / stretch * np.eye(3)
    assert first_piola_stress(material, stretch * np.eye(3)) == pytest.approx(swollen, abs=1e-13)
    along = material.bulk * np.log(stretch) / stretch + material.shear * stretch ** (-2 / 3) * (stretch - (stretch**2 + 2) / (3 * stretch))
    assert first_piola_stress(material, np.diag([stretch, 1, 1]))[0, 0] == pytest.approx(along)


@pytest.mark.parametrize("law", ["neo-hookean", "neo-hookean-j", "linear-elastic"])
def test_modulus_is_that_of_a_stretch_without_lateral_strain(law: MaterialLaw) -> None:
    material, h = Material(young=7.0, poisson=0.37, law=law), 1e-6
    ahead, behind = (first_piola_stress(material, np.diag([1.0 + step, 1.0, 1.0]))[0, 0] for step in (h, -h))
    assert (ahead - behind) / (2 * h) == pytest.approx(material.modulus, rel=1e-8)


def test_stress_balances_the_forces_of_the_kernel() -> None:
    """Of a uniform deformation of a box the nodal forces on its end sum to P N times the end's area."""
    made = problem()
    (body,) = (b for b in made.bodies if b.name == "road")
    alone = replace(made, bodies=(body,), contacts=(), supports=())
    numbering = Numbering(alone)
    forces = Solid(alone, numbering).forces(numbering.reference @ F.T)
    end = numbering.points["road"][body.patch.face_points("u1")]
    assert np.abs(forces[end].sum(axis=0)) == pytest.approx(np.abs(first_piola_stress(body.material, F)[:, 0]) * 1.0 * 0.5, rel=1e-10)


@pytest.mark.parametrize("patch", [ring(), box()], ids=["ring", "box"])
def test_deformation_gradient_of_a_uniform_deformation(patch: Patch) -> None:
    body = Body("body", patch, Material(), (2, 2, 2))
    parameters = [np.linspace(*d.boundaries[[0, -1]], 5) for d in patch.directions]
    found = deformation_gradient(body, patch.control_points @ F.T + [1.0, 2.0, 3.0], parameters)
    assert found == pytest.approx(np.broadcast_to(F, (125, 3, 3)), abs=1e-12)


def test_deformation_gradient_is_where_it_is_asked_for() -> None:
    """Of x = X + (0, 0, Z^2), F33 = 1 + 2 Z: exactly, as the box is quadratic along w and linear in Z."""
    patch = box()
    knots = patch.directions[2].knots
    blossom = 0.5**2 * (knots[1:-2] - 1) * (knots[2:-1] - 1)  # control values of Z^2 with Z = (w - 1) / 2
    points = patch.control_points + np.outer(np.repeat(blossom, 20), [0.0, 0.0, 1.0])
    heights = np.array([0.0, 0.2, 0.3, 0.7, 1.0])
    parameters = [np.array([0.5]), np.array([0.1, 0.2]), heights]
    found = deformation_gradient(Body("road", patch, Material(), (2, 2, 2)), points, parameters)
    assert found[:, 2, 2] == pytest.approx(np.repeat(1 + (heights - 1), 2))


def cauchy(material: Material, deformation: np.ndarray) -> np.ndarray:
    """sigma = P F^T / J."""
    return first_piola_stress(material, deformation) @ deformation.swapaxes(-1, -2) / np.linalg.det(deformation)[..., None, None]


@pytest.mark.parametrize("turn", [np.eye(3), np.linalg.qr(F)[0] * np.sign(np.linalg.det(np.linalg.qr(F)[0]))], ids=["straight", "turned"])
def test_cauchy_stress_by_principal_stretches(turn: np.ndarray) -> None:
    """sigma_i = (K ln J + G J^(-2/3) (l_i^2 - mean of the three)) / J along the i-th principal axis, which turns with the body."""
    material, stretches = Material(young=3.0, poisson=0.2), np.array([1.4, 0.7, 1.1])
    j, squares = float(stretches.prod()), stretches**2
    principal = (material.bulk * np.log(j) + material.shear * j ** (-2 / 3) * (squares - squares.mean())) / j
    assert cauchy(material, turn @ np.diag(stretches)) == pytest.approx(turn @ np.diag(principal) @ turn.T, abs=1e-14)


#: A column that is pressed between planes of symmetry and a rigid plane, free to widen: a homogeneous state.
COLUMN = """
format = 1
bodies.column.geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 1, 1] }
bodies.column.mesh = { order = [2, 1, 2], elements = [1, 2, 2] }
materials.m = { young = 5, poisson = 0.25 }
contacts.floor = { slave = "column.w0", plane = { point = [0, 0, 0] }, friction = 0 }
supports.top = { face = "column.w1", components = ["z"] }
supports.x = { face = "column.u0", components = ["x"] }
supports.y = { face = "column.v0", components = ["y"] }
stages = [{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.3] }]
solver = { newton_tolerance = 1e-12, complementarity_tolerance = 1e-12 }
"""


def test_stress_of_a_run_is_uniaxial_and_balances_what_is_measured(tmp_path: Path) -> None:
    """Along z the stress is the support's force over the deformed area, and the pressure of the contact; there is none across."""
    with isomortar.run(isomortar.Scene.from_toml(COLUMN), tmp_path / "column.h5") as results:
        (body,) = results.problem.bodies
        for number, pressed in ((1, 0.15), (2, 0.3)):
            step = results.step(number)
            points = body_points(results.problem, step.state.positions)[body.name]
            deformation = deformation_gradient(body, points, [np.linspace(0, 1, 4)] * 3)
            stress = cauchy(body.material, deformation)
            assert deformation[:, 2, 2] == pytest.approx(1.0 - pressed, abs=1e-11)
            across, area = deformation[0, 0, 0], 2.0 * deformation[0, 0, 0] * deformation[0, 1, 1]
            assert deformation == pytest.approx(np.broadcast_to(np.diag([across, across, 1.0 - pressed]), (64, 3, 3)), abs=1e-10)
            force = results.curve("force", support="top", component="z")[number - 1]
            assert stress == pytest.approx(np.broadcast_to(np.diag([0.0, 0.0, force / area]), (64, 3, 3)), abs=1e-10)
            assert step.contacts[0].pressure_field == pytest.approx(-force / 2.0, rel=1e-9)  # per reference area
