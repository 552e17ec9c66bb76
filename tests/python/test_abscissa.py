"""Curves over the way or the angle of a support: the numbers, the axes, the stages beside each other, and what is refused."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import h5py
import numpy as np
import pytest
from matplotlib.axes import Axes

import isomortar
from isomortar.errors import InputError, ResultsError
from isomortar.results import Results, ResultsWriter
from isomortar.results.abscissa import abscissa
from isomortar.results.curves import draw_curve, draw_reactions
from isomortar.results.files import sealed
from isomortar.results.pictures import plot
from results_samples import problem, step_result
from test_results_files import ended
from test_results_pictures import Curve

#: Of the samples' support "rim": down by 0.1 in three load steps; by 0.24 along x, turned by 30 degrees, in four, of which two are there.
DOWN = np.array([-0.1 / 3, -0.2 / 3, -0.1, -0.1, -0.1])
ALONG = np.array([0.0, 0.0, 0.0, 0.06, 0.12])
TURNED = np.array([0.0, 0.0, 0.0, 7.5, 15.0])


@pytest.fixture
def path(tmp_path: Path) -> Path:
    writer = ResultsWriter(tmp_path / "run.h5", problem(), "format = 1", "0")
    for number in range(1, 6):
        writer.recorded(step_result(number))
    with h5py.File(writer.path, "a") as file:  # like one of format 3, whose displacements and angles are those of motions
        for support in ("rim", "bed"):
            for quantity in ("displacement", "rotation"):
                del file[f"curves/supports/{support}/{quantity}"]
    writer.path.write_bytes(sealed(writer.path.read_bytes()))
    return writer.path


@pytest.fixture
def results(path: Path) -> Iterator[Results]:
    with Results(path) as opened:
        yield opened


def test_displacement_and_rotation_are_those_of_the_motions(results: Results) -> None:
    way = results.curve("displacement", support="rim")
    assert way == pytest.approx(np.column_stack([ALONG, np.zeros(5), DOWN]), abs=1e-15)
    assert np.array_equal(results.curve("displacement", support="rim", component="z"), way[:, 2])
    assert results.curve("rotation", support="rim") == pytest.approx(TURNED, abs=1e-13)
    assert not results.curve("displacement", support="bed").any()
    with pytest.raises(ResultsError, match="no components"):
        results.curve("rotation", support="rim", component="x")
    with pytest.raises(ResultsError, match="there is no curve 'displacement'"):
        results.curve("displacement", contact="tread")


#: A bar whose end a force and a moment move and turn.
BENT = """
format = 1
bodies.bar = { geometry = { kind = "box", lower = [0, 0, 0], upper = [2, 1, 1] }, mesh = { order = 1, elements = [2, 1, 1] } }
supports.base.face = "bar.u0"
supports.end = { face = "bar.u1", force = { y = 0.05, z = -0.1 }, moment = 0.3, axis = [1, 0, 0] }
stages = [{ name = "bend", steps = 2, motions.end.translate = [0.1, 0, 0] }]
"""


def test_of_a_support_that_a_force_or_a_moment_moves_it_is_what_was_recorded(tmp_path: Path) -> None:
    """Not how far its motions alone would have led."""
    with isomortar.run(isomortar.Scene.from_toml(BENT), tmp_path / "run.h5") as results:
        end = results.problem.supports[-1]
        way = results.curve("displacement", support="end")
        assert way == pytest.approx(results.curve("centre", support="end") - end.centre, abs=1e-15)
        assert np.all(np.abs(way[-1]) > 1e-3)
        turned = results.curve("rotation", support="end")
        assert turned[-1] == results.last_step().reactions[-1].rotation
        assert abs(turned[-1]) > 0.1


def test_it_is_the_way_of_the_recorded_centre(tmp_path: Path) -> None:
    """Of a run; before its first load step there is none."""
    scene = isomortar.Scene.load("press", ["bodies.block.mesh.elements=[2,2,1]", "stages.press.steps=3"])
    with isomortar.run(scene, tmp_path / "run.h5") as results:
        (top,) = results.problem.supports
        assert results.curve("displacement", support="top") == pytest.approx(results.curve("centre", support="top") - top.centre, abs=1e-15)
    ResultsWriter(tmp_path / "none.h5", problem(), "", "0")
    with Results(tmp_path / "none.h5") as results:
        assert results.curve("displacement", support="rim").shape == (0, 3)
        assert results.curve("rotation", support="rim").shape == (0,)


@pytest.mark.parametrize(
    ("what", "values"),
    [
        ("time", [1, 2, 3, 4, 5]),
        ("displacement z of rim", DOWN),
        ("displacement of rim", np.hypot(ALONG, DOWN)),
        ("rotation of rim", TURNED),
    ],
)
def test_curves_are_drawn_over_it(results: Results, what: str, values: np.ndarray) -> None:
    over = abscissa(results, what)
    force, moment = draw_reactions(results, "rim", over).axes
    (curve,) = draw_curve(results, Curve(), over).axes
    for axes in (force, moment, curve):
        assert axes.lines[0].get_xdata() == pytest.approx(np.append(0.0, values), abs=1e-13)
        assert axes.get_xlim() == pytest.approx((min(0.0, *values), max(0.0, *values)))
    assert moment.get_xlabel() == curve.get_xlabel() == over.label
    assert over.label == {"time": "load time (steps)", "rotation of rim": "rotation of rim (degrees)"}.get(what, what)


def named(axes: Axes) -> dict[str, float]:
    return {text.get_text(): text.xy[0] for text in axes.texts}


def test_stages_are_named_where_they_have_a_place(results: Results) -> None:
    assert named(draw_curve(results, Curve()).axes[0]) == pytest.approx({"press": 1.5, "roll": 4.0})
    assert named(draw_curve(results, Curve(), abscissa(results, "rotation of rim")).axes[0]) == pytest.approx({"roll": 7.5})
    assert named(draw_curve(results, Curve(), abscissa(results, "displacement z of rim")).axes[0]) == pytest.approx({"press": -0.05})


def test_stages_that_go_back_over_each_other_are_not_named(tmp_path: Path) -> None:
    text = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
contacts.floor = { slave = "block.w0", plane = { point = [0, 0, 0], normal = [0, 0, 1] } }
supports.top.face = "block.w1"
stages = [
  { name = "press", steps = 2, motions.top.translate = [0, 0, -0.1] },
  { name = "lift", steps = 2, motions.top.translate = [0, 0, 0.05] },
]
"""
    with isomortar.run(isomortar.Scene.from_toml(text), tmp_path / "run.h5") as results:
        over = abscissa(results, "displacement z of top")
        assert over.values == pytest.approx([0.0, -0.05, -0.1, -0.075, -0.05])
        assert named(draw_curve(results, Curve(support="top"), over).axes[0]) == {}


@pytest.mark.parametrize("what", ["strain", "displacement", "rotation z of rim", "displacement w of rim", "displacement of rim and bed"])
def test_other_words_are_refused(path: Path, what: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"x: is '.*'; allowed: 'time', 'displacement of SUPPORT'"):
        plot(path, tmp_path / "figures", x=what)
    assert not (tmp_path / "figures").exists()


def test_a_support_that_stays_or_is_not_there_is_refused(path: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"x: is 'displacement of bed', and it stays zero"):
        plot(path, tmp_path / "figures", x="displacement of bed")
    with pytest.raises(ResultsError, match="there is no support 'roof'; there are: rim, bed"):
        plot(path, tmp_path / "figures", x="displacement of roof")


def test_the_command_takes_it(tmp_path: Path) -> None:
    assert ended(tmp_path, "run", "press").returncode == 0
    over = "displacement z of top"
    done = ended(tmp_path, "plot", "results/press.h5", "--only", "curves", "--format", "svg", "--x", over, small=False)
    assert done.returncode == 0, done.stderr
    assert over in (tmp_path / "results" / "press-plots" / "reactions-top.svg").read_text()
    done = ended(tmp_path, "plot", "results/press.h5", "--x", "strain", small=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert "x: is 'strain'; allowed: 'time'" in done.stderr
