"""What is wanted of a trade: curves, fields and gaps, how far they are off, and what is refused."""

import numpy as np
import pytest

from isomortar.errors import InputError
from isomortar.scene import Scene
from isomortar.trade.knobs import dials_of
from isomortar.trade.laboratory import Tried
from isomortar.trade.model import Yardstick
from isomortar.trade.want import wanted, wishes
from trade_samples import TINY, numbers


@pytest.fixture
def scene():
    return Scene.from_toml(TINY)


def test_a_curve_begins_at_rest_and_is_linear_between_load_steps(scene):
    run = numbers([(1.0, 0, 0), (2.0, 0, 0), (2.0, 0, 0), (4.0, 3.0, 0)])
    whole = wanted("force.top.x", scene.problem())
    assert whole.values(run, run).mean() == pytest.approx((0.25 + 0.75 + 1.0 + 1.5) / 2, rel=1e-3)
    assert whole.weights(run).sum() == pytest.approx(1.0)
    assert wanted("force.top.x@press", scene.problem()).values(run, run).max() < 2.0
    assert wanted("force.top.x@press:end", scene.problem()).values(run, run) == [2.0]
    assert wanted("force.top:peak", scene.problem()).values(run, run) == [5.0]  # the norm, where no component is named
    assert wanted("area.floor:end", scene.problem()).values(run, run) == [0.3]
    assert wanted("displacement.top.z:peak", scene.problem()).values(run, run) == [0.4]


def test_a_curve_is_as_far_from_the_truth_as_its_load_steps_are(scene):
    """Steps that are as long as a bend of the curve show it less well, and are not wrong for that."""
    fine = numbers([(3.0, 0, 0), (2.0, 0, 0), (1.0, 0, 0), (4.0, 0, 0)])
    whole = wanted("force.top.x", scene.problem())
    coarse = fine | {"time": [1.0, 2.0], "force": [[[2.0, 0, 0], [4.0, 0, 0]]]}
    assert np.array_equal(whole.values(coarse, fine), whole.values(fine, fine))
    off = coarse | {"force": [[[2.5, 0, 0], [4.0, 0, 0]]]}
    difference = whole.values(off, fine) - whole.values(fine, fine)
    assert difference.max() == pytest.approx(0.5, rel=0.01)
    assert difference.mean() == pytest.approx(0.25, rel=1e-3)  # a hat over both stages


def test_a_curve_wants_load_steps_that_show_it(scene):
    long = Scene.from_toml(TINY, overrides=["stages.press.steps=16", "stages.drag.steps=16"])

    def steps(*texts):
        dials = {dial.name: dial for dial in dials_of(long, [wanted(text, long.problem()) for text in texts])}
        return [int(dials[f"load steps of {stage}"].settings[0].label) for stage in ("press", "drag")]

    assert steps("force.top.x@drag") == [2, 8]
    assert steps("force.top.x", "area.floor:end") == [8, 8]
    assert steps("force.top.x@drag:end", "pressure.floor") == [2, 2]
    assert "load steps of drag" in [dial.name for dial in dials_of(scene, [wanted("force.top.x", scene.problem())])]  # 2, 4, 6 and 8


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("force", "of the form QUANTITY.NAME"),
        ("force.bottom.x", "no such support; allowed: top"),
        ("force.top.u", "no such component; allowed: x, y, z, norm"),
        ("strain.top", "no such quantity; allowed: "),
        ("force.top.x@turn", "no stage 'turn'; allowed: press, drag"),
        ("force.top.x:mean", "no such part; allowed: curve, end, peak"),
        ("pressure.wall", "no contact 'wall'; allowed: floor"),
        ("pressure.floor:peak", "a field is that at the end"),
        ("area.floor.x", "has no components"),
        ("force.top.x:roughness", "the 2 load steps of stage 'press' are not rough or smooth"),
        ("area.floor:roughness", "counted in cells"),
        ("edge.floor:end", "a field is that at the end"),
        ("gap.wall", "no contact 'wall'; allowed: floor"),
    ],
)
def test_what_a_scene_does_not_have_is_named(scene, text, said):
    with pytest.raises(InputError, match=said):
        wanted(text, scene.problem())


def test_how_far_a_force_moves_a_support_is_a_wish():
    text = TINY.replace('face = "block.w1" }', 'face = "block.w1", force.z = -0.1 }').replace(
        "translate = [0, 0, -0.2]", "translate = [0, 0, 0]"
    )
    pressed = Scene.from_toml(text).problem()
    assert "displacement.top" in wishes(pressed)
    assert wanted("displacement.top", pressed).text == "displacement.top"


def test_wishes_are_wants(scene):
    assert [wanted(text, scene.problem()).text for text in wishes(scene.problem())] == [
        "force.top", "moment.top", "area.floor", "pressure.floor", "traction.floor", "edge.floor", "gap.floor",
    ]  # fmt: skip
    three = Scene.from_toml(TINY, overrides=["stages.press.steps=3", "stages.drag.steps=3"])
    assert wishes(three.problem())[:4] == ("force.top", "force.top:roughness", "moment.top", "moment.top:roughness")


def test_the_roughness_of_a_curve_is_that_of_its_bends_and_not_of_its_load_steps():
    """Of a parabola in each stage the second derivative squared, whatever its slope; the kink between them is the scene's own."""
    found = []
    for steps in (3, 8):
        scene = Scene.from_toml(TINY, overrides=[f"stages.press.steps={steps}", f"stages.drag.steps={steps}"])
        shares = np.arange(1, steps + 1) / steps
        press, drag = 3.0 * shares**2 - shares, 5.0 - shares + 0.5 * shares**2
        run = numbers([(f, 0.0, 0.0) for f in (*press, *drag)]) | {"time": [*shares, *(1.0 + shares)]}
        found += [wanted(f"force.top.x{stage}:roughness", scene.problem()).values(run, run) for stage in ("", "@press", "@drag")]
    np.testing.assert_allclose(np.ravel(found), 2 * [37.0, 36.0, 1.0], rtol=1e-10)
    few = wanted("force.top.x@drag:roughness", scene.problem())
    assert [few.shown(Scene.from_toml(TINY, overrides=[f"stages.drag.steps={n}"]).problem()) for n in (2, 4, 5)] == [False, False, True]


def test_the_edge_is_off_by_the_area_that_is_in_contact_in_one_run_alone(scene):
    truth, other = numbers(pressure=[1.0, 0.0, 2.0]), numbers(pressure=[0.0, 3.0, 9.0])
    for run in (truth, other):
        run |= {"traction": [0.0] * 3, "cells": [0.1, 0.3, 0.5], "counts": [3]}
    tried = [Tried((), "", run, "", 1.0, 0.0) for run in (truth, other)]
    assert Yardstick(wanted("edge.floor", scene.problem()), *tried).uncertainty == pytest.approx(0.4 / 0.6)


def test_a_gap_is_a_share_of_the_body_and_not_of_what_is_left_of_it_in_the_truth(scene):
    tried = [Tried((), "", numbers(gap=[gap]), "", 1.0, 0.0) for gap in (1e-7, 3e-3)]
    assert Yardstick(wanted("gap.floor", scene.problem()), *tried).uncertainty == pytest.approx(3e-3, rel=1e-4)
