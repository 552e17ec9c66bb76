"""Dials of the trade and of advice, on scenes of other tests."""

from pathlib import Path

import numpy as np
from told.wrong.raised import GOOD as RAISED

from isomortar.march.simulation import Simulation
from isomortar.model.entities import Raised
from isomortar.results.bezier import functions_at
from isomortar.results.fields import contact_surfaces
from isomortar.scene import Scene
from isomortar.trade.advice import cheaper_dials
from isomortar.trade.knobs import KNOBS, changed, dials_of
from isomortar.trade.run import traded
from isomortar.trade.want import wanted
from test_symmetry import PLANE


def test_advice_tries_the_planes_in_which_a_scene_is_symmetric() -> None:
    scene = Scene.from_toml(PLANE)
    dials = [dial for dial in cheaper_dials(scene, [wanted("force.top.z", scene.problem())]) if "beyond" in dial.name]
    assert [dial.name for dial in dials] == ["the scene beyond x = 0", "the scene beyond y = 2.4"]
    quarter = changed(scene, [dial.settings[0] for dial in dials])
    assert [(plane.axis, plane.place) for plane in quarter.problem().symmetry] == [(0, 0.0), (1, 2.4)]
    assert not [dial for dial in cheaper_dials(quarter) if "beyond" in dial.name]
    fields = [wanted("pressure.floor", scene.problem())]
    assert not [dial for dial in cheaper_dials(scene, fields) if "beyond" in dial.name]  # of a half, fields are no field of the whole


def test_the_area_of_a_trade_is_the_wholes(tmp_path: Path) -> None:
    areas = []
    for symmetry in ("{}", "{ x = 0.0, y = 2.4 }"):
        (tmp_path / "scene.toml").write_text(Scene.from_toml(PLANE, overrides=[f"symmetry={symmetry}"]).to_toml())
        areas.append(traded.function(str(tmp_path / "scene.toml"))["area"])
    assert areas[0][0, -1] > 0.1
    np.testing.assert_allclose(areas[1], areas[0], rtol=0.05)  # cells are counted, of which a part has more


def test_other_elements_are_graded_as_the_scenes_own() -> None:
    scene = Scene.from_toml(PLANE, overrides=["bodies.block.mesh.grading=[1, 1, 4]"])
    dials = dials_of(scene, knobs=[knob for knob in KNOBS if knob.name in ("elements", "order")])
    upwards = next(dial for dial in dials if dial.name == "elements of block along w")
    for setting in upwards.settings:
        lengths = np.diff(changed(scene, [setting]).problem().body("block").patch.directions[2].boundaries)
        np.testing.assert_allclose(lengths[-1] / lengths[0], 4.0 if len(lengths) > 1 else 1.0, rtol=1e-12)
    assert len(upwards.settings) > 2
    order = next(dial for dial in dials if dial.name == "order of block")
    assert all(changed(scene, [setting]).tables.bodies["block"].mesh.grading == (1.0, 1.0, 4.0) for setting in order.settings)


def test_the_order_at_the_contact_is_a_knob() -> None:
    scene = Scene.from_toml(RAISED.replace("elements = [2, 2, 1], contact_order = 3", "elements = [2, 2, 1]"))
    (dial,) = dials_of(scene, knobs=[knob for knob in KNOBS if knob.name == "contact order"])
    higher = changed(scene, [dial.settings[1]]).problem()
    assert (dial.own, higher.body("block").raised, higher.body("base").raised) == (0, Raised("w0", (2, 2, 1)), Raised("w1", (2, 1, 1)))
    assert not dials_of(Scene.load("tire"), knobs=[knob for knob in KNOBS if knob.name == "contact order"])


def test_the_gap_of_a_trade_is_how_deep_the_face_is_below_its_plane(tmp_path: Path) -> None:
    scene = Scene.load("press", ["bodies.block.mesh.elements=[4,4,2]", "stages.press.steps=2"])
    (tmp_path / "scene.toml").write_text(scene.to_toml())
    found = traded.function(str(tmp_path / "scene.toml"))["gap"]
    problem = scene.problem()
    *_, last = Simulation(problem).run()
    (surface,) = contact_surfaces(problem, last)
    dense = tuple(functions_at(d, np.linspace(d.knots[0], d.knots[-1], 301))[0] for d in surface.directions)
    heights = surface.fields(dense)[0][:, 2]
    size = np.ptp(problem.body("block").patch.control_points, axis=0).max()
    np.testing.assert_allclose(found, [-heights.min() / size], rtol=0.02)
    assert found[0] > 1e-6
