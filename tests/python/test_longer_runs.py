"""A run that is resumed with stages more at the end of its scene comes to the numbers of a run from the start, bit for bit."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import isomortar
from isomortar.errors import ResultsError
from isomortar.results import Results
from isomortar.results.comparison import differences
from isomortar.scene import Scene
from isomortar.solve.record import StepResult
from stopped_runs import Stopped
from test_results_files import StopsAtOnce, ended
from test_results_formats import as_before, without_ways
from test_results_store import same

PRESS = {"bodies.block.mesh.elements": [2, 2, 1], "stages.press.steps": 2, "stages.press.motions.top.translate": [0.02, 0.0, -0.08]}
IRON = {
    "bodies.slave.mesh.elements": [2, 2, 1],
    "bodies.master.mesh.elements": [4, 2, 1],
    "stages.press.steps": 1,
    "stages.drag.steps": 3,
    "stages.drag.motions.top.translate": [0.6, 0.0, 0.0],
}
HALF = """
format = 1
symmetry = { y = 0.0 }
bodies.block.geometry = { kind = "box", lower = [0, -1, 0], upper = [1, 1, 1] }
bodies.block.mesh.elements = [2, 2, 1]
contacts.floor = { slave = "block.w0", plane = { point = [0, 0, 0], normal = [0, 0, 1] }, friction = 0.3 }
supports.top.face = "block.w1"
stages = [{ name = "press", steps = 2, motions.top.translate = [0.1, 0, -0.1] }]
"""
LOADED = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, -1, 0], upper = [1, 1, 1] }
bodies.block.mesh.elements = [2, 2, 1]
contacts.floor = { slave = "block.w0", plane = { point = [0, 0, 0], normal = [0, 0, 1] }, friction = 0.3 }
supports.top = { face = "block.w1", force.z = -0.5 }
loads.wind = { face = "block.u0", pressure = 0.1 }
stages = [{ name = "press", steps = 2, motions.top.translate = [0.05, 0, 0], loads.wind = 0.5 }]
"""
TURN = {"name": "back", "steps": 2, "motions": {"top": {"translate": [-0.1, 0.0, 0.0], "rotate": 10.0}}}


def with_stages(scene: Scene, *stages: dict[str, Any]) -> Scene:
    """The scene with stages more at its end."""
    given = [stage.model_dump() for stage in scene.tables.stages]
    return Scene.from_toml(scene.to_toml(), overrides={"stages": [*given, *stages]})


def steps_of(path: Path) -> list[StepResult]:
    """All kept load steps, without what they cost."""
    with Results(path) as results:
        return [replace(results.step(int(number)), timings={}, counters={}) for number in results.kept_states]


def assert_same(path: Path, other: Path) -> None:
    """Two files hold the same scene and numbers."""
    with Results(path) as one, Results(other) as two:
        assert one.scene_text == two.scene_text
        assert same(one.problem, two.problem)
        assert len(one.steps) == len(two.steps) == one.problem.total_steps
    assert all(map(same, steps_of(path), steps_of(other)))


SCENES = {
    "plane": Scene.load("press", PRESS),
    "block": Scene.load("iron", IRON),
    "augmentations": Scene.load("press", PRESS | {"solver.method": "uzawa"}),
    "the last state": Scene.load("press", PRESS | {"record.states": "last"}),
    "half": Scene.from_toml(HALF),
    "loads": Scene.from_toml(LOADED),
}


@pytest.mark.parametrize("name", SCENES)
def test_more_load_steps_are_those_of_a_run_from_the_start(tmp_path: Path, name: str) -> None:
    """At the rate of the last stage; another time from there."""
    scene, path = SCENES[name], tmp_path / "longer.h5"
    isomortar.run(scene, path).close()
    isomortar.run(scene.with_more_steps(2), path, resume=True).close()
    isomortar.run(scene.with_more_steps(2, 1), path, resume=True).close()
    isomortar.run(scene.with_more_steps(2, 1), tmp_path / "whole.h5").close()
    assert_same(path, tmp_path / "whole.h5")


def test_another_stage_is_that_of_a_run_from_the_start(tmp_path: Path) -> None:
    """One that goes elsewhere, on a file of an earlier format, after a stop within the scene."""
    scene = SCENES["block"]
    longer, path = with_stages(scene, TURN), tmp_path / "longer.h5"
    with pytest.raises(KeyboardInterrupt):
        isomortar.run(scene, path, Stopped(3))
    as_before(path, 3)
    without_ways(path)
    isomortar.run(longer, path, resume=True).close()
    isomortar.run(longer, tmp_path / "whole.h5").close()
    assert_same(path, tmp_path / "whole.h5")


def lengthened(scene: Scene, steps: int, *stages: dict[str, Any]) -> Scene:
    """The scene with a last stage of more load steps, which goes on as before: ways, angles and factors grow with it."""
    *before, last = [stage.model_dump() for stage in scene.tables.stages]
    share = steps / last["steps"]
    for motion in last["motions"].values():
        motion |= {"translate": [share * way for way in motion["translate"]], "rotate": share * motion["rotate"]}
    begun = before[-1]["loads"] if before else {}
    loads = {name: begun.get(name, 0.0) + share * (value - begun.get(name, 0.0)) for name, value in last["loads"].items()}
    return Scene.from_toml(scene.to_toml(), overrides={"stages": [*before, last | {"steps": steps, "loads": loads}, *stages]})


@pytest.mark.parametrize("name", ["plane", "block", "loads"])
def test_a_longer_stage_comes_to_the_forces_of_a_run_from_the_start(tmp_path: Path, name: str) -> None:
    """With a stage more behind it; to the tolerance of Newton's method, as increments begin elsewhere."""
    scene, path = SCENES[name], tmp_path / "longer.h5"
    if name == "loads":
        scene = Scene.from_toml(LOADED.replace("loads.wind = 0.5", "loads = { wind = 0.5, top = 1.0 }"))
    longer = lengthened(scene, scene.tables.stages[-1].steps + 2, TURN | {"steps": 1})
    isomortar.run(scene, path).close()
    isomortar.run(longer, path, resume=True).close()
    isomortar.run(longer, tmp_path / "whole.h5").close()
    with Results(path) as one, Results(tmp_path / "whole.h5") as two:
        assert same(one.problem, two.problem)
        forces = [results.curve("force", support="top") for results in (one, two)]
        np.testing.assert_allclose(*forces, atol=1e-6 * np.abs(forces[1]).max())
        assert len(forces[0]) == longer.problem().total_steps
    assert [step.stage for step in steps_of(path)] == [step.stage for step in steps_of(tmp_path / "whole.h5")]


def test_steps_more_go_on_at_the_same_rate() -> None:
    scene = Scene.load("twist")
    given, *more = [stage.model_dump() for stage in scene.with_more_steps(4, 2).tables.stages][len(scene.tables.stages) - 1 :]
    assert [(stage["name"], stage["steps"]) for stage in more] == [(f"{given['name']}-2", 4), (f"{given['name']}-3", 2)]
    for stage in more:
        for support, motion in given["motions"].items():
            share = stage["steps"] / given["steps"]
            assert stage["motions"][support]["rotate"] == pytest.approx(share * motion["rotate"])
            assert stage["motions"][support]["translate"] == pytest.approx([share * way for way in motion["translate"]])
    assert scene.with_more_steps() is scene


def test_supports_hold_in_steps_more_as_in_the_last_stage() -> None:
    one, two = "press", "turn"
    lists = {"first": [one], "last": [two], "both": [one, two], "always": None}
    faces = dict(zip(lists, ("u0", "u1", "v0", "w0"), strict=True))
    supports = [
        f'supports.{name} = {{ face = "a.{faces[name]}"' + (f", stages = {held}" if held else "") + " }" for name, held in lists.items()
    ]
    body = 'format = 1\nbodies.a = { geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }, mesh = { order = 1 } }'
    stages = f'stages = [{{ name = "{one}", steps = 1 }}, {{ name = "{two}", steps = 1 }}]'
    longer = Scene.from_toml("\n".join([body, *supports, stages])).with_more_steps(2, 1).tables
    further = [stage.name for stage in longer.stages[2:]]
    wanted = {name: held if held is None or two not in held else [*held, *further] for name, held in lists.items()}
    assert {name: support.stages and list(support.stages) for name, support in longer.supports.items()} == wanted


LONGER = "the last stage may be longer at the same rate, and stages may be added at the end"
CHANGES = {
    "friction": ({"contacts.floor.friction": 0.1}, "contacts.floor.friction"),
    "a longer stage": ({"stages.press.steps": 3}, "stages.press.steps"),
    "a finer mesh": (
        {"bodies.block.mesh.elements": [3, 2, 1]},
        "bodies.block.mesh: 2 x 2 x 1 elements of N2 x N2 x N2 in the file, 3 x 2 x 1 elements",
    ),
    "other constraints": ({"contacts.floor.enforcement": "knots"}, "contacts.floor.enforcement"),
    "another way": ({"stages.press.motions.top.translate": [0, 0, -0.1]}, "supports.top.motions.0.translate"),
}


@pytest.mark.parametrize("what", CHANGES)
def test_anything_else_is_refused_as_ever(tmp_path: Path, what: str) -> None:
    """With stages more and without."""
    path, (changes, words) = tmp_path / "press.h5", CHANGES[what]
    isomortar.run(SCENES["plane"], path).close()
    before = path.read_bytes()
    changed = Scene.load("press", PRESS | changes)
    for scene in (changed, changed.with_more_steps(2)):
        with pytest.raises(ResultsError, match=f"another scene.*{words}.*{LONGER}"):
            isomortar.run(scene, path, resume=True)
    assert path.read_bytes() == before


def test_another_name_is_told_once_where_others_name_it() -> None:
    one = Scene.from_toml(LOADED).problem()
    for kind, name in {"bodies": "block", "contacts": "floor", "supports": "top", "loads": "wind", "stages": "press"}.items():
        other = Scene.from_toml(re.sub(rf"\b{name}\b", "another", LOADED)).problem()
        assert differences(one, other) == [f"{kind}.{name}: is called another in the scene"]


def test_what_makes_others_differ_is_told_first() -> None:
    """Entries that one of both has alone, then meshes, then the rest; the order of names where it is all."""
    one = SCENES["block"].problem()
    changes = {"contacts.interface.friction": 0.3, "bodies.slave.mesh.order": 3, "bodies.master.geometry.upper": [3.1, 0.75, 0.0]}
    other = with_stages(Scene.load("iron", IRON | changes), TURN).problem()
    assert [sentence.split(": ")[0] for sentence in differences(one, other)][:4] == [
        "stages.back",
        "bodies.slave.mesh",
        "bodies.master.patch",
        "contacts.interface.friction",
    ]
    swapped = replace(one, supports=one.supports[::-1])
    assert differences(one, swapped) == ["supports: ['top', 'base'] in the file, ['base', 'top'] in the scene"]


def test_a_shorter_scene_is_refused_and_a_file_is_as_it_was_until_there_is_more(tmp_path: Path) -> None:
    path, scene = tmp_path / "press.h5", SCENES["plane"]
    isomortar.run(scene, path).close()
    before = path.read_bytes()
    with pytest.raises(KeyboardInterrupt):
        isomortar.run(scene.with_more_steps(2), path, StopsAtOnce(), resume=True)
    assert path.read_bytes() == before
    isomortar.run(scene.with_more_steps(2), path, resume=True).close()
    with pytest.raises(ResultsError, match="has stages that the scene does not have: press-2"):
        isomortar.run(scene, path, resume=True)


def commands(folder: Path, *words: str) -> Sequence[str]:
    done = ended(folder, "run", "press", "--set", "stages.press.motions.top.translate=[0,0,-0.1]", *words)
    assert done.returncode == 0, done.stderr
    return done.stderr.splitlines()


def test_the_command_goes_on(tmp_path: Path) -> None:
    commands(tmp_path)
    assert "press: 3 of 5 load steps are there, going on" in commands(tmp_path, "--resume", "--steps", "2")
    assert "press: all 5 load steps are there already" in commands(tmp_path, "--resume", "--steps", "2")
    commands(tmp_path, "--resume", "--steps", "2", "--steps", "1")
    commands(tmp_path, "--steps", "2", "--steps", "1", "--output", "whole.h5")
    assert_same(tmp_path / "results" / "press.h5", tmp_path / "whole.h5")
    done = ended(tmp_path, "run", "press", "--set", "stages.press.motions.top.translate=[0,0,-0.1]", "--resume")
    assert done.returncode == 1
    assert "has stages that the scene does not have: press-2, press-3. Give them to resume it, as by the same --steps" in done.stderr
