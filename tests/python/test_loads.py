"""Loads: what cannot be meant is refused, results hold what acts, and a run that is resumed comes to the same numbers."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from loads import light
from told.wrong.loads import GOOD, HALVED, UNEVEN, WRONG

from isomortar import run
from isomortar.cli.check import lines
from isomortar.errors import InputError
from isomortar.geometry.patch import FACES
from isomortar.geometry.primitives import box
from isomortar.geometry.refinement import mesh
from isomortar.march.outlook import outlook
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Stage
from isomortar.model.loads import control_areas
from isomortar.model.supports import factor_at
from isomortar.program.getfem import GetFEM
from isomortar.results.definition import read_problem, write_problem
from isomortar.results.reader import Results
from isomortar.scene import Scene
from isomortar.solve.newton import CLOSED_ANEW
from isomortar.solve.record import LoadResult
from stopped_runs import Stopped


@pytest.mark.parametrize(("old", "new", "field", "text"), WRONG.values(), ids=list(WRONG))
def test_what_cannot_be_meant_is_refused(old: str, new: str, field: str, text: str) -> None:
    assert GOOD.count(old) == 1
    with pytest.raises(InputError) as raised:
        Scene.from_toml(GOOD.replace(old, new)).problem()
    assert raised.value.field == field
    assert text in str(raised.value)


@pytest.mark.parametrize(("load", "field", "text"), UNEVEN.values(), ids=list(UNEVEN))
def test_what_is_not_symmetric_is_refused(load: str, field: str, text: str) -> None:
    with pytest.raises(InputError) as raised:
        Scene.from_toml(HALVED.replace("LOAD", load)).problem()
    assert raised.value.field == field
    assert text in str(raised.value)


@pytest.mark.parametrize("orders", [(1, 1, 6), (6, 1, 1), (1, 6, 1)])
@pytest.mark.parametrize("face", FACES)
def test_points_of_a_load_are_enough_for_each_order_of_its_face(face: str, orders: tuple[int, int, int]) -> None:
    """Bernstein's functions of order p over an edge of length one all have the integral 1 / (p + 1)."""
    patch = mesh(box((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)), ("N", "N", "N"), orders, (1, 1, 1))
    integral = 1.0 / np.prod([direction.order + 1 for direction in patch.face_directions(face)])
    np.testing.assert_allclose(control_areas(patch, face)[patch.face_points(face)], integral, rtol=1e-12)


def test_a_face_without_area_is_refused() -> None:
    problem = Scene.from_toml(GOOD).problem()
    right = problem.body("right")
    points = right.patch.control_points.copy()
    points[right.patch.face_points("u1")] = points[right.patch.face_points("u1")].mean(axis=0)
    folded = replace(right, patch=replace(right.patch, control_points=points))
    bodies = tuple(folded if body.name == "right" else body for body in problem.bodies)
    with pytest.raises(InputError, match="fall onto a line or a point"):
        Simulation(replace(problem, bodies=bodies))


def test_other_programs_are_not_told_of_loads() -> None:
    text = HALVED.replace("symmetry = { y = 0.0 }", "").replace("LOAD", 'own = { body = "block", weight = [0, 0, 1] }')
    text = text.replace("mesh = {", 'mesh = { family = "L", order = 1,')
    with pytest.raises(InputError, match="is told of no loads but pressures"):
        GetFEM().run(Scene.from_toml(text).problem())


def test_files_hold_loads(tmp_path: Path) -> None:
    problem = Scene.from_toml(GOOD).problem()
    with h5py.File(tmp_path / "problem.h5", "w") as file:
        write_problem(file, problem)
        assert read_problem(file).loads == problem.loads
        del file.attrs["loads"]
        assert read_problem(file).loads == ()  # of an earlier version


def test_results_hold_what_acts_and_go_on_to_the_last_bit(tmp_path: Path) -> None:
    scene = Scene.from_toml(GOOD)
    whole = run(scene, tmp_path / "whole.h5")
    with pytest.raises(KeyboardInterrupt):
        run(scene, tmp_path / "parts.h5", observer=Stopped(2))
    parts = run(scene, tmp_path / "parts.h5", resume=True)
    with Results(tmp_path / "whole.h5") as one, Results(tmp_path / "parts.h5") as other:
        first, second = one.step(4), other.step(4)
        wind = one.curve("force", load="wind", component="z")
        assert "force.load.wind.z" in one.to_dataframe()
        with pytest.raises(Exception, match="there is no load 'wnd'"):
            one.curve("force", load="wnd")
    assert whole is not None
    assert parts is not None
    np.testing.assert_array_equal(first.state.positions, second.state.positions)
    for a, b in zip(first.loads, second.loads, strict=True):
        assert isinstance(a, LoadResult)
        np.testing.assert_array_equal(a.force, b.force)
        np.testing.assert_array_equal(a.moment, b.moment)
    np.testing.assert_allclose(wind, [-0.1, -0.2, -0.3, -0.4], rtol=0.05)


def test_without_factors_loads_are_whole_after_the_first_stage() -> None:
    stages = (Stage("one", 2), Stage("two", 3))
    assert [factor_at(stages, (), time) for time in (0.0, 1.0, 2.0, 3.5, 5.0)] == [0.0, 0.5, 1.0, 1.0, 1.0]
    assert [factor_at(stages, (1.0, -2.0), time) for time in (0.5, 2.0, 3.0, 5.0)] == [0.25, 1.0, 0.0, -2.0]


def test_a_look_at_a_scene_tells_of_loads() -> None:
    said = list(lines(outlook(Scene.from_toml(GOOD).problem())))
    assert "load wind: pressure 0.1 on left.w1" in said
    assert "load own: weight 0, 0, -0.2 on right" in said


def test_what_loads_do_is_no_doubt() -> None:
    text = HALVED.replace("LOAD", 'own = { body = "block", weight = [0, 0, 1] }')
    assert not [words for words in Simulation(Scene.from_toml(text).problem()).doubts() if "nothing will happen" in words]
    idle = text.replace("steps = 1 }", "steps = 1, loads.own = 0 }")
    assert [words for words in Simulation(Scene.from_toml(idle).problem()).doubts() if "nothing will happen" in words]


def test_arrays_have_loads(tmp_path: Path) -> None:
    with run(Scene.from_toml(GOOD), tmp_path / "run.h5") as results:
        arrays = results.to_xarray()
        for load in results.problem.loads:
            for quantity in ("force", "moment"):
                expected = results.curve(quantity, load=load.name)
                np.testing.assert_array_equal(arrays[f"load_{quantity}"].sel(load=load.name), expected)


def test_what_is_closed_anew_is_told_in_the_log() -> None:
    results = Simulation(Scene.from_toml(light._GROOVE).problem()).run()
    notes = [note for result in results for loop in result.augmentations for record in loop.iterations for note in record.notes]
    assert CLOSED_ANEW in notes
