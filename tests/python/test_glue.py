"""Glued bodies: joints that cannot be are refused with what differs, and runs, files and pictures know of them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from told.wrong.joints import GOOD, WRONG, patched

import isomortar
from isomortar.errors import ConvergenceError, InputError
from isomortar.geometry import net
from isomortar.geometry.patch import Direction
from isomortar.march.simulation import Simulation
from isomortar.model.numbering import Numbering
from isomortar.program.getfem import GetFEM
from isomortar.results import bodies
from isomortar.results.comparison import differences
from isomortar.results.definition import read_problem, write_problem
from isomortar.results.reader import Results
from isomortar.scene import Scene


def test_the_scenes_that_the_cases_change_are_good() -> None:
    for text in (GOOD, patched()):
        assert [[face.body + face.face for face in joint] for joint in Scene.from_toml(text).problem().glue] == [["au1", "bu0"]]


@pytest.mark.parametrize(("text", "field", "said"), WRONG.values(), ids=WRONG.keys())
def test_joints_that_cannot_be(text: str, field: str, said: str) -> None:
    with pytest.raises(InputError) as error:
        Scene.from_toml(text).problem()
    assert error.value.field == field
    assert said in str(error.value)


def test_common_factors_of_knots_and_weights_make_no_difference() -> None:
    text = (
        patched()
        .replace("[0, 0, 0.5, 1, 1]", "[3, 3, 5, 7, 7]")
        .replace("weights = [1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1]", f"weights = {[2] * 12}")
    )
    assert len(Scene.from_toml(text).problem().glue) == 1


def test_pieces_are_numbered_one_after_the_other() -> None:
    """Bodies that are glued need not stand beside each other; three round an edge have that edge in common."""
    text = GOOD.replace("bodies.c", "bodies.y").replace('"c.u0"', '"y.u0"')
    names = text.replace("bodies.b", "bodies.z").replace('"b.u0"', '"z.u0"').replace("bodies.y", "bodies.b").replace('"y.u0"', '"b.u0"')
    numbering = Numbering(Scene.from_toml(names).problem())
    assert [[body.name for body in piece] for piece in numbering.pieces] == [["a", "z"], ["b"]]
    together = np.union1d(numbering.points["a"], numbering.points["z"])
    assert np.array_equal(together, np.arange(len(together)))
    assert np.array_equal(np.unique(numbering.points["b"]), np.arange(len(together), numbering.count))
    corner = """
        bodies.d = { geometry = { kind = "box", lower = [0, 1, 0], upper = [1, 2, 1] }, mesh = { order = 2, elements = [1, 2, 1] } }
        bodies.e = { geometry = { kind = "box", lower = [1, 1, 0], upper = [2, 2, 1] }, mesh = { order = 2, elements = [1, 2, 1] } }
    """
    four = GOOD.replace("bodies.c", corner + "bodies.c").replace('b.u0"]]', 'b.u0"], ["a.v1", "d.v0"], ["b.v1", "e.v0"]]')
    numbering = Numbering(Scene.from_toml(four).problem())
    edges = {name: numbering.points[name].reshape(3, 4, 3)[:, row, column] for name, row, column in CORNERS}
    assert all(np.array_equal(edge, edges["a"]) for edge in edges.values())


#: Where the edge at x = y = 1 is in each of four bodies round it: rows along v, columns along u.
CORNERS = (("a", -1, -1), ("b", -1, 0), ("d", 0, -1), ("e", 0, 0))


def test_a_glued_scene_runs_resumes_and_is_drawn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = Scene.load(Path(__file__).parents[2] / "examples" / "glued.toml")
    whole = list(Simulation(scene.problem()).run())
    assert whole[-1].contacts[0].active > 0
    path = tmp_path / "glued.h5"
    isomortar.run(scene, path)
    with Results(path) as results:
        assert differences(results.problem, scene.problem()) == []
        last = results.step(3)
    assert np.array_equal(list(Simulation(scene.problem(), resume_from=last).run())[-1].state.positions, whole[-1].state.positions)
    drawn = []
    monkeypatch.setattr(bodies, "rational", lambda *given, rational=bodies.rational: drawn.append(given) or rational(*given))
    figure = bodies.draw_bodies(scene.problem(), whole[-1], 0)
    assert len(figure.axes) == 3
    assert len(drawn) == 5 + 4 + 5  # both bodies and the slave alone, without glued faces and the contact, which is drawn by its field
    isomortar.export(path, tmp_path / "out")
    assert list((tmp_path / "out").rglob("bodies-*.vtu"))


def test_files_from_before_there_was_glue_have_none(tmp_path: Path) -> None:
    problem = Scene.from_toml(GOOD).problem()
    with h5py.File(tmp_path / "a.h5", "w") as file:
        write_problem(file, problem)
        assert read_problem(file).glue == problem.glue
        assert any("glue" in line for line in differences(read_problem(file), replace(problem, glue=())))
        del file.attrs["glue"]
        assert read_problem(file).glue == ()


def test_pieces_that_move_freely_are_named() -> None:
    text = GOOD.replace("[0, 0, -0.1]", "[0, 0, -9]").replace('"a.u0" }', '"a.u0", components = ["x"] }')
    with pytest.raises(ConvergenceError, match=r"body '[ab]' \(glued to '[ab]'\) can (move|turn)"):
        list(Simulation(Scene.from_toml(text).problem()).run())


def test_other_programs_are_not_told_of_glue() -> None:
    lagrange = GOOD.replace("order = 2", 'family = "L", order = 2').replace("[6, 1, 1] }", '[6, 1, 1] }, mesh = { family = "L" }')
    with pytest.raises(InputError, match="is not told of glued bodies") as error:
        GetFEM().run(Scene.from_toml(lagrange).problem())
    assert error.value.field == "glue"


def test_differing_knots_are_told_with_the_letters_of_either_body() -> None:
    """Those of two bodies need not be alike: what runs along v in one may run along w in the other."""
    even, uneven = Direction("N", 1, [0.0, 0.0, 0.5, 1.0, 1.0]), Direction("N", 1, [0.0, 0.0, 0.4, 1.0, 1.0])
    said = net._of_directions(even, uneven, ("a", "b"), ("v", "w"), 1e-9)
    assert said == "knots of a along v and those of b along w differ by up to 0.1 of their range"
    said = net._of_directions(even, Direction("N", 1, [0.0, 0.0, 1.0, 1.0]), ("a", "b"), ("v", "w"), 1e-9)
    assert said == "a has 2 elements along v, b 1 elements along w"
