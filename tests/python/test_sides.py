"""Sides of contacts of several faces: those that do not join to one are refused, and runs, files and pictures know of them."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from told.wrong.sides import ALL, GOOD, PAIR, WRONG

import isomortar
from isomortar.errors import InputError
from isomortar.geometry.patch import Direction, Patch
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Faces
from isomortar.model.sheet import Sheet
from isomortar.program.getfem import GetFEM
from isomortar.results.comparison import differences
from isomortar.results.reader import Results
from isomortar.scene import Scene

JOINED = '["a.v1", "c.v0"], ["b.v1", "d.v0"], ["c.u1", "d.u0"]]'


@pytest.mark.parametrize(("old", "new", "field", "said"), WRONG.values(), ids=WRONG.keys())
def test_sides_that_cannot_be(old: str, new: str, field: str, said: str) -> None:
    assert old in GOOD
    with pytest.raises(InputError) as error:
        Scene.from_toml(GOOD.replace(old, new)).problem()
    assert error.value.field == field
    assert said in str(error.value)


def test_faces_in_rows_and_columns_join() -> None:
    problem = Scene.from_toml(GOOD.replace(PAIR, ALL).replace('["a.v1", "c.v0"]]', JOINED)).problem()
    sheet = Sheet.of(problem, problem.contacts[0].master)  # type: ignore[arg-type]
    assert [d.elements for d in sheet.directions] == [3, 3]
    assert [d.kinks for d in sheet.directions] == [True, True]
    assert sheet.closed == (False, False)
    assert [body.name for body in sheet.bodies] == ["a", "b", "c", "d"]


def test_a_hole_where_five_faces_meet_is_seen() -> None:
    """Four tiles of five round a corner: the last two would lie beside each other, and do not."""
    text = GOOD.replace(PAIR, ALL).replace('["a.v1", "c.v0"]]', '["a.v1", "c.v0"], ["b.v1", "d.v0"]]')
    with pytest.raises(InputError, match=r"c.w1 and d.w1 would follow each other, and have no edge in common; glue their bodies") as error:
        Scene.from_toml(text).problem()
    assert error.value.field == "contacts.pair.master"


def test_faces_round_a_body_join_to_a_ring() -> None:
    """The four sides of a box, as one face that is closed: its edges are C0 lines, and kinks."""
    text = GOOD.replace(PAIR, '["d.u0", "d.v0", "d.u1", "d.v1"]').replace('"block.w0"', '"block.u1"')
    problem = Scene.from_toml(
        text.replace("lower = [0.5, 0.25, 1], upper = [1.5, 0.75, 2]", "lower = [0, 1.2, 0.2], upper = [1, 1.8, 0.8]")
    ).problem()
    (contact,) = problem.contacts
    assert Sheet.of(problem, contact.master).closed == (True, False)  # type: ignore[arg-type]
    assert (contact.projection, contact.by_default) == ("averaged", True)


def test_weights_of_faces_have_a_common_factor() -> None:
    problem = Scene.from_toml(GOOD).problem()
    heavy = replace(
        problem,
        bodies=tuple(replace(b, patch=replace(b.patch, weights=4.0 * b.patch.weights)) if b.name == "b" else b for b in problem.bodies),
    )
    weights = [Sheet.of(p, p.contacts[0].master).patch.weights for p in (problem, heavy)]  # type: ignore[arg-type]
    assert np.array_equal(weights[0], weights[1])
    assert np.ptp(weights[0]) == 0.0


def test_a_scene_with_sides_of_several_faces_runs_resumes_and_is_drawn(tmp_path: Path) -> None:
    scene = Scene.load(Path(__file__).parents[2] / "examples" / "tiles.toml")
    problem = scene.problem()
    assert all(isinstance(side, Faces) for side in (problem.contacts[0].slave, problem.contacts[0].master))
    whole = list(Simulation(problem).run())
    assert sum(step.cuts for step in whole) == 0
    path = tmp_path / "tiles.h5"
    isomortar.run(scene, path)
    with Results(path) as results:
        assert differences(results.problem, problem) == []
        assert results.problem.contacts == problem.contacts
        step = results.step(2)
    assert np.array_equal(list(Simulation(problem, resume_from=step).run())[-1].state.positions, whole[-1].state.positions)
    assert len(isomortar.plot(path, tmp_path / "plots")) > 2
    isomortar.export(path, tmp_path / "out")
    assert list((tmp_path / "out").rglob("contacts-*.vtu"))


def test_other_programs_are_not_told_of_several_faces() -> None:
    lagrange = GOOD.replace("mesh = { ", 'mesh = { family = "L", ').replace(
        "upper = [1.5, 0.75, 2] }", 'upper = [1.5, 0.75, 2] }, mesh = { family = "L" }'
    )
    single = (
        lagrange.replace('glue = [["a.u1", "b.u0"], ["a.v1", "c.v0"]]', "")
        .replace(PAIR, '["d.u0", "d.v0"]')
        .replace('"block.w0"', '"block.u1"')
    )
    free = single.replace("supports.far", 'supports.b = { face = "b.w0" }\nsupports.c = { face = "c.w0" }\nsupports.far')
    with pytest.raises(InputError, match="is not told of sides of several faces") as error:
        GetFEM().run(Scene.from_toml(free).problem())
    assert error.value.field == "contacts.pair.master"


def test_elements_of_a_side_are_as_long_as_the_middle_one_of_each_direction_along_it() -> None:
    """However deep its body is, and however long the longest."""
    text = GOOD.replace(PAIR, '"d.w1"')
    body = replace(Scene.from_toml(text).problem().bodies[0], name="d")
    for knots, deep in (((0.0, 0.1, 0.2, 1.0), 1.0), ((0.0, 0.5, 0.6, 1.0), 9.0)):
        across, along = Direction("N", 1, np.repeat(knots, [2, 1, 1, 2])), Direction("N", 1, np.array([0.0, 0.0, 1.0, 1.0]))
        points = np.array([[x, 3.0 * y, deep * z] for z in (0, 1) for y in (0, 1) for x in knots])
        patch = Patch((across, along, along), points, np.ones(len(points)))
        middle = float(np.median(np.diff(knots)))
        assert Sheet.of_face(replace(body, patch=patch), "w1").element_size == pytest.approx(np.sqrt(3.0 * middle))
        assert Sheet.of_face(replace(body, patch=patch), "v1").element_size == pytest.approx(np.sqrt(deep * middle))


def test_a_face_that_comes_again_later_is_named() -> None:
    names = ["a.w1", "b.w1", "c.w1", "d.w1"]
    for first, second in combinations(range(4), 2):
        faces = names.copy()
        faces[second] = faces[first]
        with pytest.raises(InputError, match=f"names {names[first]} twice"):
            Scene.from_toml(GOOD.replace(PAIR, str(faces).replace("'", '"'))).problem()
