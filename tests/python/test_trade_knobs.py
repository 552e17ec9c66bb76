"""Knobs of the trade and of advice: the settings of a scene, and the scenes that they make."""

import pytest

from isomortar.scene import Scene
from isomortar.trade.advice import cheaper_dials
from isomortar.trade.knobs import KNOBS, Dial, Knob, Setting, changed, dials_of
from trade_samples import TINY

TWO = """
format = 1
name = "two"
bodies.block.geometry = { kind = "bowl", half_width = 0.3, bottom = 0.0, rise = 0.1, top = 0.5 }
bodies.block.mesh = { order = [2, 2, 2], elements = [2, 2, 1] }
bodies.base.geometry = { kind = "box", lower = [-0.5, -0.5, -0.4], upper = [0.5, 0.5, 0.0] }
bodies.base.mesh = { order = [2, 2, 2], elements = [2, 2, 1] }
contacts.floor = { slave = "block.w0", master = "base.w1", friction = 0.3 }
supports.top = { face = "block.w1" }
supports.under = { face = "base.w0" }
stages = [{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.1] }]
"""


@pytest.fixture
def scene():
    return Scene.from_toml(TINY)


def test_every_setting_makes_the_scene_that_it_names(scene):
    for dial in dials_of(scene):
        made = [changed(scene, [setting]) for setting in dial.settings]
        assert len({one.to_toml() for one in made}) == len(made), dial.name
        assert made[dial.own].to_toml() == scene.to_toml(), dial.name


def test_a_slave_has_smooth_contact_by_its_own_modulus():
    """A rigid one has none."""
    knobs = [knob for knob in KNOBS if knob.name == "smoothing"]
    assert knobs
    deforms, rigid = (Scene.from_toml(TWO, overrides=of) for of in ((), ("bodies.block.rigid=true",)))
    assert [dial.name for dial in dials_of(deforms, knobs=knobs)] == ["smoothing of floor"]
    assert dials_of(rigid, knobs=knobs) == ()


def test_settings_of_a_body_go_on_from_each_other(scene):
    dials = {dial.name: dial for dial in dials_of(scene)}
    picked = [dials[name].settings[-1] for name in ("order of block", "elements of block along u", "quadrature of floor")]
    body = changed(scene, picked).problem().body("block")
    u, v, w = body.patch.directions
    assert (u.order, v.order, w.order) == (5, 5, 2)
    assert (u.elements, v.elements, w.elements) == (6, 2, 1)
    assert changed(scene, picked).problem().contacts[0].quadrature == (11, 11)  # 7 for order 5, and 4 more


def test_a_dial_leaves_out_what_the_scene_can_not_have(scene):
    knob = Knob(
        "half", "nothing", lambda *_: iter([Dial("half", (Setting("own"), Setting("odd", lambda _: ["stages.press.steps=0"])), 0, "")])
    )
    assert dials_of(scene, knobs=[knob]) == ()


def test_what_a_scene_may_do_without_is_named_and_makes_a_scene():
    scene = Scene.from_toml(TWO)
    dials = {dial.name: dial for dial in cheaper_dials(scene)}
    assert changed(scene, [dials["base rigid"].settings[0]]).problem().body("base").rigid
    assert "block rigid" not in dials  # a slave's pressures want its own unknowns
    assert changed(scene, [dials["friction of floor"].settings[0]]).problem().contacts[0].friction == 0.0
    thin = changed(scene, [dials["order of base across"].settings[0]]).problem().body("base").patch
    assert [d.order for d in thin.directions] == [2, 2, 1]
    both = changed(scene, [dials["base rigid"].settings[0], dials["quadrature of base"].settings[0]])
    assert both.problem().body("base").rigid  # which has no quadrature to change
    assert all(dial.own == len(dial.settings) - 1 for dial in dials.values() if dial.refines)
