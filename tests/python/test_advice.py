"""Warnings: scenes that run, but in which most likely something else was meant; each once, counted, and none for sound scenes."""

from __future__ import annotations

import io
import re
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from told.wrong.contacts import PAIR, PRESS, RINGS, TYRE
from told.wrong.doubts import AVERAGED, DOUBTFUL
from told.wrong.runs import LINEAR, PLATE, PRESSED, RUNS
from transforms import scaled

from isomortar import cli
from isomortar.cli.progress import Progress
from isomortar.errors import InputError
from isomortar.geometry.patch import Direction, Patch
from isomortar.march.simulation import Simulation
from isomortar.model.entities import Body, Face, Material, Motion, Problem, Stage, Support
from isomortar.model.rational import QUADRATURE_TOLD, points_enough
from isomortar.scene import Scene
from isomortar.scene.source import bundled_scenes
from isomortar.solve.record import Observer
from isomortar.told.before.doubts import doubts
from isomortar.told.before.meshes import of_meshes
from isomortar.told.before.pairing import by_default


def material(poisson: float, family: str, order: int) -> list[str]:
    return [f"bodies.block.mesh.order={order}", f"bodies.block.mesh.family={family}", f"materials.rubber.poisson={poisson}"]


def warnings(text: str, overrides: list[str] | None = None) -> list[str]:
    problem = Scene.from_toml(text, overrides=overrides or ()).problem()
    return list(doubts(problem, Simulation(problem).state))


@pytest.mark.parametrize("case", DOUBTFUL)
def test_what_is_doubtful_is_told_once(case: str) -> None:
    scene, old, new, words = DOUBTFUL[case]
    assert old in scene
    said = warnings(scene.replace(old, new))
    assert len(said) == 1
    assert words in said[0]


def test_a_fit_too_tight_by_little_is_no_scene_in_which_nothing_happens() -> None:
    """An interference of a thousandth is what shafts are shrunk with; round-off is none."""
    still = PRESS.replace("[0, 0, -0.1]", "[0, 0, 0]")
    assert warnings(still.replace("point = [0, 0, 0]", "point = [0, 0, 0.001]")) == []
    assert len(warnings(still.replace("point = [0, 0, 0]", "point = [0, 0, 1e-12]"))) == 1


def test_the_material_of_a_rigid_body_says_nothing_of_what_presses_it() -> None:
    text = """
format = 1
materials.steel = { young = 2e5 }
bodies.block = { geometry = { kind = "box", lower = [-1, -1, -1], upper = [1, 1, 0] }, mesh.elements = [2, 2, 1] }
bodies.box = { rigid = true, geometry = { kind = "box", lower = [-2, -2, 0], upper = [2, 2, 1] }, mesh.order = 1 }
contacts.pair = { slave = "block.w1", master = "box.w0" }
supports.base.face = "block.w0"
supports.top = { face = "box.w1", force.z = -300 }
stages = [{ name = "press", steps = 1 }]
"""
    assert warnings(text) == []


@pytest.mark.parametrize("depth", [0.1, 0.28, 0.29, 0.4, 0.5])
@pytest.mark.parametrize("text", [PAIR, AVERAGED], ids=["closest", "averaged"])
def test_what_is_told_to_be_pushed_apart_has_feet(text: str, depth: float) -> None:
    """Its master is below the whole of the slave: points that have no foot are too deep, whatever the projection allows."""
    problem = Scene.from_toml(text.replace("-0.4, 0.0]", f"-0.4, {-depth}]")).problem()
    simulation = Simulation(problem)
    (said,) = doubts(problem, simulation.state)
    feet = simulation.state.contacts[0].projected
    assert ("pushes them apart" in said) == bool(feet.all())
    assert ("inside their master" in said) == (not feet.any())


def test_the_cure_of_an_overlap_too_deep_cures() -> None:
    text = AVERAGED.replace("-0.4, 0.0]", "-0.4, -0.4]")
    (said,) = warnings(text)
    assert 'contacts.pair.projection = "closest"' in said
    (said,) = warnings(text, ["contacts.pair.projection=closest"])
    assert "pushes them apart" in said


def test_averaged_normals_that_nobody_asked_for_are_told() -> None:
    (contact,) = Scene.from_toml(PAIR, overrides=["bodies.lower.mesh.family=L"]).problem().contacts
    (said,) = by_default(contact)
    assert "master lower.w1 has C0 lines" in said
    assert 'contacts.pair.projection = "averaged"' in said
    assert list(by_default(replace(contact, by_default=False))) == []


@pytest.mark.parametrize(
    ("family", "order", "sound", "locks"),
    [("L", 1, 0.3, 0.38), ("N", 2, 0.44, 0.45), ("L", 2, 0.44, 0.45), ("N", 3, 0.4995, 0.4999)],
)
def test_locking_is_told_by_order_and_ratio(family: str, order: int, sound: float, locks: float) -> None:
    scene = PRESS.replace("[bodies.block]", "[materials.rubber]\n[bodies.block]")
    assert warnings(scene, material(sound, family, order)) == []
    (said,) = warnings(scene, material(locks, family, order))
    assert f"Poisson's ratio {locks:g} its elements of order {order} lock" in said


def test_elements_of_order_four_and_more_are_not_told_to_lock() -> None:
    """They are off by a twentieth at the most (`told/locking`)."""
    scene = PRESS.replace("[bodies.block]", "[materials.rubber]\n[bodies.block]")
    assert [warnings(scene, material(0.499999, "N", order)) for order in (4, 5)] == [[], []]


@pytest.mark.parametrize(("order", "sound", "tall"), [(7, 3.3e5, 3.4e5), (10, 1.22e5, 1.24e5), (4, 8.8e5, 9.1e5)])
@pytest.mark.parametrize("face", ["w0", "u0"])
def test_tall_bodies_of_high_orders_are_told_of_lost_digits(order: int, sound: float, tall: float, face: str) -> None:
    """By the height behind the face in contact, whichever it is; wide ones are as they were."""
    said = []
    for height in (sound, tall, 1.0 / tall):
        upper = [1.0, 1.0, height] if face == "w0" else [height, 1.0, 1.0]
        normal = [0, 0, 1] if face == "w0" else [1, 0, 0]
        text = f"""
format = 1
bodies.block = {{ geometry = {{ kind = "box", lower = [0, 0, 0], upper = {upper} }}, mesh = {{ order = {order}, elements = [1, 1, 1] }} }}
contacts.floor = {{ slave = "block.{face}", plane.normal = {normal} }}
supports.top.face = "block.{face[0]}1"
stages = [{{ name = "press", steps = 1, motions.top.translate = {[-0.1 * n for n in normal]} }}]
"""
        problem = Scene.from_toml(text).problem()
        said.append([words for words in of_meshes(problem) if "round-off of its positions" in words])
    assert [len(words) for words in said] == [0, 1, 0]
    assert f"times as tall as block.{face}, a slave face, is wide, and of order {order} there: " in said[1][0]


def rational(contrast: float) -> Body:
    """A cube of control points with two weights in turn along u."""
    corners = np.array([0.0, 0.25, 0.75, 1.0])
    points = np.stack(np.meshgrid(corners, corners, corners, indexing="ij"), axis=-1).reshape((-1, 3), order="F")
    line = Direction("N", 2, np.array([0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0]))
    return Body("b", Patch((line, line, line), points, np.tile([contrast, 1.0], 32)), Material(), (4, 4, 4))


def test_weights_that_the_points_do_not_follow_are_told_with_a_cure_that_cures() -> None:
    assert not any("quadrature" in said for said in _of_weights(rational(2.0)))
    (said,) = _of_weights(rational(8.0))
    assert "its weights, from 1 to 8, differ too much for the quadrature with 4 x 4 x 4" in said
    enough = points_enough(rational(8.0), QUADRATURE_TOLD)
    assert enough is not None
    assert f"mesh.quadrature = {list(enough)}" in said
    assert _of_weights(replace(rational(8.0), quadrature=enough)) == []


def test_weights_that_the_points_miss_are_refused_with_a_cure_that_cures() -> None:
    with pytest.raises(InputError, match=r"quadrature = \[16, 16, 16\]"):
        _of_weights(rational(30.0))
    assert _of_weights(replace(rational(30.0), quadrature=(16, 16, 16))) == []
    with pytest.raises(InputError, match=r"Bring the weights nearer to each other$"):
        _of_weights(rational(1e6))


def test_bodies_with_weights_that_are_folded_between_their_points_are_told_where() -> None:
    body = rational(4.0)
    points = body.patch.control_points.copy()
    points[-1, 0] = 0.7
    (said,) = _of_weights(replace(body, patch=replace(body.patch, control_points=points)))
    assert "between its Gauss points element 1, 1, 1 along u, v, w is folded" in said


@pytest.mark.parametrize(
    ("thickness", "tip", "motion", "told"),
    [
        (1e-4, 1e-7, "", True),
        (1e-4, 1e-2, "", False),
        (1e-1, 1e-7, "", False),
        (1e-1, 0.0, "motions.root = { translate = [0.3, 0.2, 0.1], rotate = 30 }", False),
    ],
    ids=["thin", "thin, far", "thick", "rigid"],
)
def test_forces_that_are_round_off_are_told(thickness: float, tip: float, motion: str, told: bool) -> None:
    text = PLATE.replace("THICKNESS", str(thickness))
    text = text.replace("TIP", '[supports.tip]\nface = "b.u1"\ncomponents = ["z"]' if tip else "")
    observer = Warned()
    simulation = Simulation(Scene.from_toml(text.replace("MOTION", motion or f"motions.tip.translate = [0, 0, {tip}]")).problem(), observer)
    list(simulation.run())
    assert any("lost in round-off" in said for said in observer.said) == told


class Warned(Observer):
    """Keeps what it is warned of."""

    def __init__(self) -> None:
        self.said: list[str] = []

    def warned(self, message: str) -> None:
        self.said.append(message)


def _of_weights(body: Body) -> list[str]:
    top = Support("top", Face("b", "w1"), (Motion((0.0, 0.0, -0.1)),))
    problem = Problem("rational", (body,), (), (top,), (Stage("press", 1),))
    return [said for said in doubts(problem, Simulation(problem).state) if "weights" in said]


#: Any friction is meant where tractions have a limit of their own.
_CAPPED = PRESS.replace("[supports.top]", "friction = 30\ntraction_max = 0.2\n[supports.top]")


#: Small strains of a body that turns a little; smooth contact, which presses before anything moves.
_TURNED = LINEAR.replace("rotate = 0", "rotate = 2")
_SMOOTH = PRESS.replace("[supports.top]", "smoothing = 1e-3\n[supports.top]").replace("[0, 0, -0.1]", "[0, 0, 0]")


@pytest.mark.parametrize(
    "text", [PRESS, PAIR, TYRE, PRESS.replace("point = [0, 0, 0]", "point = [0, 0, -0.05]"), _CAPPED, _TURNED, _SMOOTH]
)
def test_sound_scenes_have_none(text: str) -> None:
    assert warnings(text) == []


@pytest.mark.parametrize("name", bundled_scenes())
def test_bundled_scenes_have_none(name: str) -> None:
    problem = Scene.load(name).problem()
    assert list(doubts(problem, Simulation(problem).state)) == []


def test_a_shrink_fit_runs_with_a_word() -> None:
    said = warnings(RINGS)
    assert len(said) == 1
    assert "overlap by 0.02" in said[0]


@pytest.mark.parametrize("case", RUNS)
def test_what_is_doubtful_of_a_run_is_told_once(case: str) -> None:
    """Contact that pulls, that opens for good, or whose slave goes past its master; and nothing of a sound run."""
    text, words = RUNS[case]
    observer = Warned()
    list(Simulation(Scene.from_toml(text).problem(), observer).run())
    before = ("in each load step", "at the start", "nothing will happen", "the same state again", "feels no contact")  # of the scene
    said = [warning for warning in observer.said if not any(word in warning for word in before)]
    assert [word in warning for word, warning in zip(words, said, strict=True)] == [True] * len(words), said


@pytest.mark.parametrize("case", ["pressed", "turned over and pushed through", "far side of the master", "outside of a ring", "shrink fit"])
def test_what_is_doubtful_of_a_run_is_so_in_any_unit(case: str) -> None:
    """By the same warnings, but for their numbers."""
    problem = Scene.from_toml(RUNS[case][0]).problem()
    heard = [Warned() for _ in range(3)]
    for observer, unit in zip(heard, (1.0, 2.0**-13, 2.0**13), strict=True):
        list(Simulation(scaled(problem, unit, 1.0 / unit), observer).run())
    words = [[re.sub(r"[-\d.e+]+", "", warning) for warning in observer.said] for observer in heard]
    assert words[0] == words[1] == words[2]


def test_a_run_tells_its_doubts_before_the_first_load_step_and_not_when_it_goes_on() -> None:
    scene, old, new, words = DOUBTFUL["motion of what is not held"]
    problem = Scene.from_toml(scene.replace(old, new)).problem()
    begun, resumed = Warned(), Warned()
    first = next(Simulation(problem, begun).run())
    list(Simulation(problem, resumed, resume_from=first).run())
    assert [words in said for said in begun.said] == [True]
    assert not any(words in said for said in resumed.said)


#: Not so near to its floor that it comes there, and not so far that this is told before.
_SHORT = PRESS.replace("point = [0, 0, 0]", "point = [0, 0, -0.02]").replace("[0, 0, -0.1]", "[0, 0, -0.015]")


@pytest.mark.parametrize(("scene", "never"), [(PRESSED, False), (_SHORT, True)], ids=["closes", "never"])
def test_a_contact_that_never_closes_is_told_at_the_end(scene: str, never: bool) -> None:
    observer = Warned()
    for _ in Simulation(Scene.from_toml(scene.replace("steps = 1", "steps = 2")).problem(), observer).run():
        assert observer.said == []
    assert observer.said == (
        ["contact 'floor' never closed: it was open at the end of every load step; check faces, places and motions"] if never else []
    )


def test_the_same_line_is_printed_once_and_warnings_are_counted() -> None:
    text = io.StringIO()
    progress = Progress(Scene.load("press").problem(), partial(print, file=text))
    for message in ("one", "two", "one"):
        progress.warned(message)
    for cuts in range(1, 10):
        progress.cut(3, 2.5, 0.5**cuts, "the load is too large")
    progress.finished()
    shown = text.getvalue()
    assert shown.count("warning: one") == 1
    assert shown.count("the load is too large") == 1
    assert shown.count("for the same reason") == 8
    assert "5 load steps done, 2 warnings: read them" in shown


@pytest.mark.parametrize(
    ("scene", "line"), [(PRESSED, "1 load step done, 0 warnings"), (_SHORT, "1 warning: read it")], ids=["none", "one"]
)
def test_a_run_ends_with_the_number_of_warnings(
    scene: str, line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("scene.toml").write_text(scene)
    monkeypatch.setattr(sys, "argv", ["isomortar", "run", "scene.toml"])
    with pytest.raises(SystemExit) as ended:
        cli.main()
    assert not ended.value.code
    assert capsys.readouterr().err.splitlines()[-1].endswith(line)
