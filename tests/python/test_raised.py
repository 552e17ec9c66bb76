"""Raised faces: functions of a higher order at the face in contact alone, what they are, what cannot be, and that files know of them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from scipy.interpolate import BSpline
from told.wrong.raised import GOOD, WRONG, wrong

from isomortar import Results, export, plot, run
from isomortar.errors import InputError
from isomortar.geometry.patch import Direction, Patch
from isomortar.geometry.primitives import bowl
from isomortar.geometry.refinement import mesh, raised_along
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Body, Material, Raised
from isomortar.model.numbering import Numbering, check_raised
from isomortar.model.raised import Rows
from isomortar.results.comparison import differences
from isomortar.results.definition import read_problem, write_problem
from isomortar.results.fields import body_points
from isomortar.scene import Scene

BOWL = mesh(bowl((0.0, 0.0), 0.5, 0.0, 0.2, 0.8), ("N", "N", "N"), (2, 2, 2), (3, 2, 3))


def of_face(patch: Patch, face: str, order: int) -> Body:
    """A body with a raised face."""
    u, v, w = (direction.order for direction in patch.directions)
    return Body("body", raised_along(patch, face, order), Material(), (6, 6, 6), raised=Raised(face, (u, v, w)))


def arc() -> Patch:
    """A quarter of a ring, with weights."""
    bend, straight = Direction("N", 2, np.repeat([0.0, 1.0], 3)), Direction("N", 1, np.repeat([0.0, 1.0], 2))
    points = [[x * r, y, z * r] for y in (0.0, 1.0) for r in (1.0, 2.0) for x, z in ((0, 1), (1, 1), (1, 0))]
    return mesh(Patch((bend, straight, straight), np.array(points), np.tile([1.0, np.sqrt(0.5), 1.0], 4)), ("N",) * 3, (2, 2, 1), (3, 2, 2))


@pytest.mark.parametrize("name", WRONG)
def test_what_cannot_be_is_refused(name: str) -> None:
    with pytest.raises(InputError) as refused:
        Scene.from_toml(wrong(name)).problem()
    assert WRONG[name][2] in str(refused.value)
    assert WRONG[name][3] in str(refused.value)


@pytest.mark.parametrize("face", ["u0", "u1", "v0", "v1", "w0", "w1"])
@pytest.mark.parametrize("patch", [BOWL, arc()], ids=["plain", "rational"])
def test_geometry_is_exact(patch: Patch, face: str) -> None:
    body = of_face(patch, face, 4)
    rows = Rows(body)
    assert np.abs(rows.into @ rows.reference - body.patch.control_points).max() < 1e-14
    assert np.abs(rows.into.sum(axis=1) - 1.0).max() < 1e-14
    assert np.array_equal(np.unique(rows.nearest), np.arange(len(rows.reference)))
    across = "uvw".index(face[0])
    below = np.prod([d.count - (axis == across) for axis, d in enumerate(patch.directions)])
    assert len(rows.reference) == below + len(body.patch.face_points(face))


def test_functions_below_the_face_are_of_the_lower_order() -> None:
    body = of_face(BOWL, "w0", 3)
    rows, place = Rows(body), (0.4, 0.7, 0.2)
    field = rows.into @ np.eye(len(rows.reference))
    at = [BSpline.design_matrix(np.array([x]), d.knots, d.order).toarray()[0] for x, d in zip(place, body.patch.directions, strict=True)]
    found = np.einsum("k,j,i->kji", at[2], at[1], at[0]).ravel() @ field
    u, v, w = (BSpline.design_matrix(np.array([x]), d.knots, d.order).toarray()[0] for x, d in zip(place, BOWL.directions, strict=True))
    below, ends = np.einsum("k,j,i->kji", w[1:], v, u).ravel(), w[0] * np.einsum("j,i->ji", at[1], at[0]).ravel()
    assert np.abs(found - np.concatenate([below, ends])).max() < 1e-14


def test_a_patch_that_is_not_raised_is_refused() -> None:
    body = of_face(BOWL, "w0", 3)
    moved = body.patch.control_points.copy()
    moved[len(moved) // 2] += 0.01
    for patch in (replace(body.patch, control_points=moved), mesh(BOWL, ("N",) * 3, (3, 3, 3), (3, 2, 3))):
        with pytest.raises(InputError, match="not those of functions of orders \\[2, 2, 2\\] below w0"):
            Rows(replace(body, patch=patch))
    with pytest.raises(InputError, match="by raising it"):
        Rows(replace(body, patch=mesh(bowl((0.0, 0.0), 0.5, 0.0, 0.2, 0.8), ("N",) * 3, (3, 3, 2), (3, 2, 3))))


def test_files_know_of_it(tmp_path: Path) -> None:
    path, scene = tmp_path / "raised.h5", Scene.from_toml(GOOD)
    problem = scene.problem()
    with h5py.File(tmp_path / "problem.h5", "w") as file:
        write_problem(file.create_group("problem"), problem)
        again = read_problem(file["problem"])
    assert differences(again, problem) == []
    assert [body.raised for body in again.bodies] == [Raised("w0", (2, 2, 1)), Raised("w1", (2, 1, 1))]
    assert [body.quadrature for body in again.bodies] == [(4, 4, 2), (4, 4, 2)]
    with run(scene, path) as results:
        force = results.curve("force", support="top", component="z")
        points = body_points(problem, results.step(2).state.positions)
    assert force[-1] < 0.0
    for body in problem.bodies:
        assert points[body.name].shape == body.patch.control_points.shape
    plot(path, tmp_path / "plots")
    export(path, tmp_path / "paraview")
    held = Numbering(problem).points["base"][problem.body("base").patch.face_points("w0")]
    with Results(path) as results:
        assert np.abs(results.step(2).state.positions[held] - Numbering(problem).reference[held]).max() < 1e-15


def test_a_run_goes_on_from_a_step_to_the_same_numbers() -> None:
    problem = Scene.from_toml(GOOD).problem()
    first, second = Simulation(problem).run()
    (again,) = Simulation(problem, resume_from=first).run()
    assert np.array_equal(second.state.positions, again.state.positions)


def test_a_raised_face_brings_a_coarse_mesh_nearer_to_the_truth() -> None:
    def force(elements: int, more: str) -> float:
        text = GOOD.replace("elements = [2, 2, 1], contact_order = 3", f"elements = [{elements}, {elements}, 1]{more}")
        *_, last = Simulation(Scene.from_toml(text).problem()).run()
        return float(last.reactions[0].force[2])

    raised = ", contact_order = 3"
    truth = force(8, raised)
    assert abs(force(2, raised) - truth) < 0.5 * abs(force(2, "") - truth)


def test_rings_and_poles_are_refused() -> None:
    with pytest.raises(InputError, match=r"contact_order: is given, and the body is closed"):
        Scene.load("tire", ["bodies.tire.mesh.contact_order=3"]).problem()
    points = BOWL.control_points.copy()
    points[BOWL.face_points("u0")] = points[0]
    with pytest.raises(InputError, match="with a pole"):
        check_raised(of_face(replace(BOWL, control_points=points), "w0", 3))


@pytest.mark.parametrize("joint", ['["base.u1", "beside.u0"]', '["beside.u0", "base.u1"]'])
def test_a_raised_body_is_not_glued_whichever_stands_first(joint: str) -> None:
    with pytest.raises(InputError, match="joins 'base', whose order at w1") as refused:
        Scene.from_toml(wrong("glued").replace('["base.u1", "beside.u0"]', joint)).problem()
    assert refused.value.field == "glue.0"
