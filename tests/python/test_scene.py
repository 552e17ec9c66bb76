"""Scene files: the bundled scenes are those of the reference, a scene file can say everything, overrides change single values."""

from __future__ import annotations

import json
import math
import subprocess
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import splinepy

import isomortar
import isomortar.scene
from isomortar.errors import InputError
from isomortar.geometry.primitives import ring
from isomortar.model.entities import Face, Material, Motion, Problem, RigidPlane
from isomortar.model.settings import SolverSettings
from isomortar.scene import Scene, bundled_scenes, json_schema
from isomortar.scene.source import as_options, read_source

ROOT = Path(__file__).parents[2]
PATCHES = json.loads((ROOT / "reference_data/scene_patches/patches.json").read_text())

SHORT = """
format = 1
bodies.block.geometry = { kind = "box", lower = [0, 0, 0], upper = [1, 1, 1] }
supports.base.face = "block.w0"
stages = [{ name = "rest", steps = 1 }]
"""


def control_points(problem: Problem) -> int:
    return sum(len(body.patch.weights) for body in problem.bodies)


@pytest.mark.parametrize("fact", PATCHES, ids=lambda f: f"{f['scene']}-{f['body']}-" + "-".join(o.split("=")[1] for o in f["overrides"]))
def test_bundled_bodies_are_those_of_the_other_program(fact: dict[str, Any]) -> None:
    patch = Scene.load(fact["scene"], fact["overrides"]).problem().body(fact["body"]).patch
    size, allowed = np.abs(patch.control_points).max(), 1e-14 + fact["own_noise"]
    for direction, knots in zip(patch.directions, fact["knots"], strict=True):
        np.testing.assert_allclose(direction.knots, knots, rtol=0, atol=1e-15)
    np.testing.assert_allclose(patch.control_points[fact["numbers"]], fact["control_points"], rtol=0, atol=allowed * size)
    np.testing.assert_allclose(patch.weights[fact["numbers"]], fact["weights"], rtol=0, atol=allowed)
    phases, count = np.cos(np.arange(len(patch.weights))), len(patch.weights)
    np.testing.assert_allclose(phases @ patch.control_points, fact["sum_cos_points"], rtol=0, atol=allowed * size * count)
    assert phases @ patch.weights == pytest.approx(fact["sum_cos_weights"], rel=0, abs=allowed * count)


@pytest.mark.parametrize(
    ("overrides", "count"),
    [
        (["bodies.master.mesh.order=[5,2,2]"], 770),
        (["bodies.master.mesh.elements=[15,5,3]"], 840),
        (["bodies.master.mesh.elements.0=20"], 1015),
    ],
)
def test_numbers_of_control_points_of_the_iron(overrides: list[str], count: int) -> None:
    assert control_points(Scene.load("iron", overrides).problem()) == count


def test_bundled_scenes_are_there_and_converge_on_their_own_text() -> None:
    assert bundled_scenes() == ("block", "iron", "iron-round", "press", "reversal", "tire", "twist", "twist-sharp")
    for name in bundled_scenes():
        scene = Scene.load(name)
        assert (scene.name, bool(scene.title)) == (name, True)
        assert scene.to_toml().splitlines()[0].startswith("# "), "the text teaches"


def stages(name: str) -> list[tuple[int, tuple[float, float, float], float]]:
    problem = Scene.load(name).problem()
    return [(s.steps, m.translate, m.rotate) for s, m in zip(problem.stages, problem.supports[0].motions, strict=True)]


def test_load_history_and_friction_of_the_bundled_scenes() -> None:
    assert stages("press") == [(5, (0, 0, -0.3), 0)]
    assert stages("block") == [(5, (0, 0, -0.2), 0), (10, (0.3, 0, 0), 0)]
    assert stages("twist") == [(10, (0, 0, -0.45), 0), (40, (0, 0, 0), 180)]
    assert stages("twist-sharp") == stages("twist")
    assert stages("iron") == [(10, (0, 0, -0.5), 0), (40, (1.8, 0, 0), 0)]
    (press, roll) = stages("tire")
    assert press == (10, (0, 0, -0.1), 0)
    assert (roll[0], roll[2]) == (90, 270)
    assert roll[1] == pytest.approx((0.47 * math.radians(270), 0, 0), rel=1e-15)
    friction = {name: Scene.load(name).problem().contacts[0].friction for name in bundled_scenes()}
    assert friction == {
        "block": 0.3,
        "press": 0.3,
        "reversal": 0.3,
        "twist": 0.3,
        "twist-sharp": 0.3,
        "iron": 0.1,
        "iron-round": 0.1,
        "tire": 0.1,
    }
    areas = {name: Scene.load(name).problem().contacts[0].reference_area for name in bundled_scenes()}
    assert areas == {
        "block": None,
        "press": 1.0,
        "reversal": None,
        "twist": 1.0,
        "twist-sharp": 1.0,
        "iron": 1.0,
        "iron-round": None,
        "tire": 1.0,
    }


def test_places_of_the_bundled_scenes() -> None:
    iron, tire = Scene.load("iron").problem(), Scene.load("tire").problem()
    assert (iron.contacts[0].slave, iron.contacts[0].master) == (Face("slave", "w0"), Face("master", "w1"))
    assert [(s.place, s.centre) for s in iron.supports] == [(Face("slave", "w1"), (0.6, 0, 0)), (Face("master", "w0"), (0, 0, 0))]
    assert tire.contacts[0].master == RigidPlane((0, 0, 0), (0, 0, 1), (1, 0, 0))
    assert (tire.supports[0].centre, tire.supports[0].axis, tire.bodies[0].closed) == ((0, 0, 0.5), (0, 1, 0), "u")


def test_default_quadrature_follows_family_and_order_of_each_direction() -> None:
    tire = Scene.load("tire").problem()
    assert (tire.bodies[0].quadrature, tire.contacts[0].quadrature) == ((4, 2, 2), (4, 6))  # face v1 has coordinates (w, u)
    lagrange = ["bodies.tire.mesh.family=L", "bodies.tire.mesh.order=[4,1,1]", "bodies.tire.mesh.elements=[8,4,4]"]
    tire = Scene.load("tire", lagrange).problem()
    assert (tire.bodies[0].quadrature, tire.contacts[0].quadrature) == ((6, 2, 2), (4, 12))
    high = Scene.load("iron", ["bodies.slave.mesh.order=[7,3,2]"]).problem()
    assert (high.bodies[0].quadrature, high.contacts[0].quadrature) == ((9, 6, 4), (9, 6))


def test_a_short_scene_has_the_papers_defaults() -> None:
    scene = Scene.from_toml(SHORT)
    problem = scene.problem()
    (body,) = problem.bodies
    assert (body.material.young, body.material.poisson) == (10.0, 0.3)
    assert [(d.family, d.order, d.elements) for d in body.patch.directions] == [("N", 2, 1)] * 3
    assert problem.settings == SolverSettings()
    assert (scene.record.states, scene.curves()) == ("every", ())


def test_overrides_reach_every_kind_of_place() -> None:
    changes = [
        "bodies.slave.mesh.elements.1=4",
        "stages.drag.steps=7",
        "stages.0.motions.top.translate=[0, 0, -0.25]",
        "solver.slip_sum=paper",
        'record.states="last"',
        "contacts.interface.friction = 0",
    ]
    scene = Scene.load("iron", changes)
    problem = scene.problem()
    assert problem.bodies[0].patch.directions[1].elements == 4
    assert [s.steps for s in problem.stages] == [10, 7]
    assert problem.supports[0].motions[0] == Motion((0, 0, -0.25))
    assert (problem.settings.slip_sum, scene.record.states, problem.contacts[0].friction) == ("paper", "last", 0)


@pytest.mark.parametrize("table", ["materials", "bodies", "contacts", "supports", "loads"])
def test_overrides_add_nothing_that_has_a_name(table: str) -> None:
    with pytest.raises(InputError, match=f"{table}.new: an override changes what the scene has; {table} there: "):
        Scene.load("press", [f"{table}.new.young=1"])


def test_overrides_are_options_that_a_shell_takes_as_they_stand() -> None:
    overrides = ["bodies.block.mesh.elements=[4, 4, 2]", 'bodies.block.mesh.family=["N", "N", "N"]', "title=it's"]
    words = subprocess.run(["bash", "-c", f"printf '%s\\n' {as_options(overrides)}"], capture_output=True, text=True).stdout.splitlines()
    assert words == [word for override in overrides for word in ("--set", override)]


def test_one_override_may_stand_without_a_list() -> None:
    """A text was taken for a list of its letters."""
    assert Scene.load("press", "solver.max_cuts=3").problem().settings.max_cuts == 3


def test_overrides_may_be_values_by_path() -> None:
    texts = [
        "bodies.master.mesh.order=[3, 2, 2]",
        "stages.drag.steps=7",
        "solver.slip_sum=paper",
        "stages.drag.motions.top.translate=[0.1, 0, 0]",
    ]
    values = {
        "bodies.master.mesh.order": (3, 2, 2),
        "stages.drag.steps": np.int64(7),
        "solver.slip_sum": "paper",
        "stages.drag.motions.top": {"translate": np.array([0.1, 0.0, 0.0])},
    }
    one, other = Scene.load("iron", texts), Scene.load("iron", values)
    assert one.tables == other.tables
    assert Scene.from_toml(other.to_toml()).tables == one.tables


def test_a_scene_and_its_results_say_what_they_are(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    scene = Scene.load("press", {"bodies.block.mesh.elements": [2, 2, 1], "stages.press.steps": 1})
    assert repr(scene) == "<Scene press: bodies block; contacts floor; stages press (1 load steps)>"
    with isomortar.run(scene) as results:
        assert repr(results) == f"<Results {Path('results/press.h5')}: 1/1 steps>"
    assert repr(results).endswith(": closed>")
    with pytest.raises(InputError, match="exists already"):
        isomortar.run(scene)
    (tmp_path / "own.toml").write_text(scene.to_toml())
    isomortar.run("own.toml", overwrite=True).close()


def assert_same(one: Problem, other: Problem) -> None:
    assert (one.name, one.contacts, one.supports, one.stages, one.settings) == (
        other.name,
        other.contacts,
        other.supports,
        other.stages,
        other.settings,
    )
    for a, b in zip(one.bodies, other.bodies, strict=True):
        assert (a.name, a.material, a.quadrature, a.closed) == (b.name, b.material, b.quadrature, b.closed)
        assert np.array_equal(a.patch.control_points, b.patch.control_points)
        assert np.array_equal(a.patch.weights, b.patch.weights)
        assert [(d.family, d.order, d.knots.tolist()) for d in a.patch.directions] == [
            (d.family, d.order, d.knots.tolist()) for d in b.patch.directions
        ]


def test_text_of_a_changed_scene_gives_the_same_problem() -> None:
    scene = Scene.load("tire", ["bodies.tire.mesh.order=[3,1,1]", "stages.roll.steps=3", "solver.max_cuts=2"])
    assert_same(Scene.from_toml(scene.to_toml()).problem(), scene.problem())


STEMS = {
    "my scene": "my_scene",
    "Größe": "Größe",
    "Gr\u00f6\u0308": "Gr\u00f6\u0308",
    "接触": "接触",
    "v1.2": "v1_2",
    "$x^$": "_x__",
    "a\udc80": "a_",
}


@pytest.mark.parametrize(("stem", "name"), STEMS.items(), ids=[name.encode("ascii", "replace").decode() for name in STEMS.values()])
def test_a_file_of_any_name_gives_a_scene_whose_text_can_be_read(tmp_path: Path, stem: str, name: str) -> None:
    """In its name letters of any script are what they are."""
    path = tmp_path / f"{stem}.toml"
    path.write_text(read_source("press")[0].replace('name = "press"\n', "", 1), encoding="utf-8")
    scene = Scene.load(path)
    assert Scene.from_toml(scene.to_toml()).name == scene.name == scene.problem().name == name


def test_text_holds_the_geometry_of_files(tmp_path: Path) -> None:
    coarse = ring((0, 0, 0.5), 0.25, 0.5, 0.25)
    spline = splinepy.NURBS(
        [d.order for d in coarse.directions], [d.knots for d in coarse.directions], coarse.control_points, coarse.weights
    )
    splinepy.io.export(str(tmp_path / "wheel.json"), [spline])
    changes = [
        'bodies.tire={file="wheel.json", closed="u", mesh={order=[2,1,1], elements=[32,4,4]}}',
    ]
    text = Scene.load("tire").to_toml()
    path = tmp_path / "rolling.toml"
    path.write_text(text.replace('name = "tire"\n', ""))
    scene = Scene.load(path, changes)
    problem = scene.problem()
    np.testing.assert_allclose(
        problem.bodies[0].patch.control_points, Scene.load("tire").problem().bodies[0].patch.control_points, atol=1e-15
    )
    stored = scene.to_toml()
    (tmp_path / "wheel.json").unlink()
    assert_same(Scene.from_toml(stored).problem(), problem)
    assert problem.name == "rolling"


def test_everything_at_once() -> None:
    """Rational patch point by point with mixed families, tilted plane, own quadrature, components, combined motion."""
    points = [[x + 0.1 * z, y, z] for z in (0.5, 1.0) for y in (0.0, 0.5, 1.0) for x in (0.0, 0.4, 1.0)]
    scene = Scene.from_toml(
        f"""
        format = 1
        [bodies.odd]
        mesh = {{ quadrature = [5, 4, 3] }}
        [bodies.odd.patch]
        family = ["N", "L", "L"]
        order = [2, 2, 1]
        knots = [[0, 0, 0, 1, 1, 1], [0, 1], [0, 2]]
        control_points = {points}
        weights = {[1.0, 0.5, 1.0] * 6}
        [contacts.slope]
        slave = "odd.w0"
        plane = {{ point = [0, 0, -1], normal = [0, 3, 4], tangent = [0, 1, 0] }}
        friction = 0
        quadrature = 7
        [supports.hold]
        face = "odd.w1"
        components = ["z", "x"]
        centre = [1, 2, 3]
        axis = [0, 0, 2]
        [[stages]]
        name = "both"
        steps = 4
        motions.hold = {{ translate = [0.1, 0, 0], rotate = -30 }}
        [[stages]]
        name = "rest"
        steps = 2
        """
    )
    problem = scene.problem()
    (body,), (contact,), (support,) = problem.bodies, problem.contacts, problem.supports
    assert [d.family for d in body.patch.directions] == ["N", "L", "L"]
    assert body.patch.weights[1] == 0.5
    assert (body.quadrature, contact.quadrature) == ((5, 4, 3), (7, 7))
    assert isinstance(contact.master, RigidPlane)
    assert contact.master.normal == pytest.approx((0, 0.6, 0.8), abs=1e-16)
    assert contact.master.tangent == pytest.approx((0, 0.8, -0.6), abs=1e-15)
    assert (support.components, support.axis, support.centre) == ((0, 2), (0, 0, 1), (1, 2, 3))
    assert support.motions == (Motion((0.1, 0, 0), -30), Motion())
    assert [c.name for c in scene.curves()][:2] == ["hold force x", "hold force y"]


def test_a_body_may_be_held_by_another_that_it_touches() -> None:
    upper = """
    bodies.upper.geometry = { kind = "box", lower = [0, 0, 1], upper = [1, 1, 2] }
    contacts.seam = { slave = "upper.w0", master = "block.w1" }
    """
    assert len(Scene.from_toml(SHORT + upper).problem().bodies) == 2


@pytest.mark.parametrize("entity", [Material, Motion, SolverSettings])
def test_entities_that_are_tables_explain_each_key(entity: type) -> None:
    table = json_schema()["$defs"][entity.__name__]
    assert list(table["properties"]) == [field.name for field in fields(entity)]
    assert all(key["description"] for key in table["properties"].values())
    assert table["additionalProperties"] is False


def test_a_scene_hands_over_its_solver_table() -> None:
    scene = Scene.from_toml(SHORT, overrides=["solver.max_cuts=3", 'solver.measures=["keeping"]'])
    assert scene.problem().settings == SolverSettings(max_cuts=3, measures=("keeping",))


def test_published_schema_is_the_one_of_the_program() -> None:
    published = json.loads((Path(isomortar.scene.__file__).parent / "scene.schema.json").read_text())
    assert published == json_schema(), "write json_schema() to scene.schema.json (indent 2)"
