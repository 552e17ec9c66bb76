"""The trade of accuracy for cost: wants, knobs, forecasts, and a search that comes to the cheapest of all combinations."""

import itertools
import json
import math
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import keep_front
import numpy as np
import pytest
from fronts import recommended

from isomortar.errors import InputError, IsomortarError
from isomortar.harness.runner import local_processes
from isomortar.scene import Scene
from isomortar.trade import page
from isomortar.trade.advice import CheaperSearch, cheaper_dials
from isomortar.trade.knobs import KNOBS, Dial, Knob, Setting, changed, dials_of
from isomortar.trade.laboratory import Laboratory, Tried
from isomortar.trade.model import Yardstick
from isomortar.trade.search import Search
from isomortar.trade.want import wanted, wishes

TINY = """
format = 1
name = "tiny"
bodies.block.geometry = { kind = "bowl", half_width = 0.5, bottom = 0.0, rise = 0.2, top = 0.8 }
bodies.block.mesh = { order = [2, 2, 2], elements = [2, 2, 1] }
contacts.floor = { slave = "block.w0", plane = { normal = [0, 0, 1] }, friction = 0.3 }
supports.top = { face = "block.w1" }
stages = [{ name = "press", steps = 2, motions.top.translate = [0, 0, -0.2] },
          { name = "drag", steps = 2, motions.top.translate = [0.05, 0, 0] }]
"""


@pytest.fixture
def scene():
    return Scene.from_toml(TINY)


def numbers(force=((1.0, 0.0, 0.0),) * 4, cpu=1.0, **more):
    """What a run returns, of the tiny scene's four load steps."""
    return {
        "time": [0.5, 1.0, 1.5, 2.0],
        "force": [[list(f) for f in force]],
        "moment": [[[0.0, 0.0, 0.0]] * 4],
        "displacement": [[[0.0, 0.0, -0.1], [0.0, 0.0, -0.2], [0.0, 0.0, -0.4], [0.0, 0.0, -0.3]]],
        "area": [[0.1, 0.2, 0.2, 0.3]],
        "pressure": [1.0, 3.0],
        "traction": [0.0, 0.0],
        "cells": [0.25, 0.75],
        "gap": [0.001],
        "counts": [2],
        "images": 1,
        "unknowns": 27.0,
        "solves": 4.0,
        "cuts": 0.0,
        "phases": [0.0] * 5,
        "cpu_seconds": cpu,
    } | more


# What is wanted


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


# Knobs


def test_every_setting_makes_the_scene_that_it_names(scene):
    for dial in dials_of(scene):
        made = [changed(scene, [setting]) for setting in dial.settings]
        assert len({one.to_toml() for one in made}) == len(made), dial.name
        assert made[dial.own].to_toml() == scene.to_toml(), dial.name


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


# The search: a laboratory whose runs are formulas


class Formula(Laboratory):
    """Errors and costs that are known: of elements with order two, of load steps with order one, and a choice that only spoils."""

    def __init__(self, scene, dials, exact=1.0, **_):
        super().__init__(scene, dials, Path("unused"), None, lambda _: None)
        self.exact, self.calls = exact, 0

    def _measured(self, choices, *_, **__):
        self.calls += len(choices)
        return {choice: self.formula(choice) for choice in choices}

    def formula(self, choice):
        error, cost, failure = self.of(choice)
        made = numbers([(self.exact + error, 0, 0)] * 4, cost)
        return Tried(choice, self.name(choice), {} if failure else made, failure, cost, 1e6)

    def of(self, choice):
        error, cost = 0.0, 1.0
        for dial, number in zip(self._dials, choice, strict=True):
            more_error, factor = effect(dial, number)
            error += more_error
            cost *= factor
        return error, cost, ""


def effect(dial, number):
    """Error that a setting leaves, and what it multiplies the cost by."""
    label = dial.settings[number].label
    if dial.part == "elements":
        return 0.02 * (4 / int(label)) ** 2, (int(label) / 4) ** 2.0
    if dial.part == "order":
        return 0.0, 1.2 ** (int(label) - 2)
    if dial.name == "load steps":
        return 0.01 * 8 / int(label), int(label) / 8
    return (0.03, 0.9) if label == "lazy" else (0.0, 1.0)


def synthetic():
    own = {"elements": ["2", "3", "4", "6", "8", "12", "16"], "load steps": ["2", "4", "8", "16", "32", "64"], "order": ["2", "3", "4"]}
    dials = [Dial("order of block", tuple(map(Setting, own["order"])), 0, "", part="order")]
    dials += [Dial(f"elements of block along {a}", tuple(map(Setting, own["elements"])), 2, "", part="elements") for a in "uv"]
    dials += [Dial("load steps", tuple(map(Setting, own["load steps"])), 2, "")]
    dials += [Dial("way", (Setting("own"), Setting("lazy")), 0, "", refines=False)]
    return tuple(dials)


def searched(scene, target, laboratory=None, wants=("force.top.x",)):
    dials = synthetic()
    laboratory = laboratory or Formula(scene, dials)
    search = Search(laboratory, dials, [wanted(text, scene.problem()) for text in wants], 1e6)
    search.screen()
    search.find_truth([target])
    return search, search.answer(target)


@pytest.mark.parametrize("target", [0.05, 0.03, 0.015])
def test_the_search_comes_to_the_cheapest_of_all_combinations(scene, target):
    search, answer = searched(scene, target)
    truth, best = 1.0 + search.laboratory.of(search.truth.choice)[0], math.inf
    for choice in itertools.product(*(range(len(dial.settings)) for dial in search.dials)):
        error, cost, _ = search.laboratory.of(choice)
        best = min(best, cost) if abs(1.0 + error - truth) <= target * truth else best
    assert answer.error <= target
    assert answer.best.cost <= 1.12 * best  # what promises to be less than a tenth cheaper is not run
    assert search.laboratory.calls < 80


class Opposed(Formula):
    """Two ways whose errors are of opposite sign; both make the error `together`."""

    together = 0.005

    def of(self, choice):
        error, cost = {(1, 1): (0.0, 1.0), (0, 1): (0.03, 0.5), (1, 0): (-0.025, 0.6), (0, 0): (self.together, 0.3)}[choice]
        return error, cost, ""


@pytest.mark.parametrize(("together", "found"), [(0.005, (0, 0)), (0.06, None)])
def test_errors_that_cancel_are_tried_last_and_believed_where_they_are_seen(scene, together, found):
    dials = tuple(Dial(name, (Setting("lazy"), Setting("own")), 1, "", refines=False) for name in "ab")
    laboratory = Opposed(scene, dials)
    laboratory.together = together
    advice = CheaperSearch(laboratory, dials, [wanted("force.top.x", scene.problem())], 1e6)
    advice.screen()
    advice.find_truth([0.01])
    best = advice.answer(0.01).best
    assert (best and best.choice) == found
    assert (0, 0) in laboratory.outcomes


def test_the_answer_says_what_binds_and_what_other_orders_need(scene):
    search, answer = searched(scene, 0.03)
    assert set(answer.by_order) == {2, 3}
    assert answer.by_order[3].cost == pytest.approx(1.2 * answer.by_order[2].cost, rel=0.15)
    assert answer.binding in [dial.name for dial in search.dials]
    said = page.sentence(search, answer)
    assert "±" in said
    assert "order 3 needs" in said


def test_a_target_below_the_truth_is_refused_with_what_it_needs(scene):
    search, answer = searched(scene, 1e-6)
    assert answer.best is None
    assert "less than 3 times that" in answer.why
    assert "times finer would tell" in answer.why
    assert search.uncertainty > 1e-6 / 3


class Idle(Formula):
    """Load steps change next to nothing, and elements along v."""

    idle = ("load steps", "elements of block along v")

    def of(self, choice):
        """Like the others, but for what is idle."""
        busy = tuple(dial.own if dial.name in self.idle else number for dial, number in zip(self._dials, choice, strict=True))
        steps = next(dial for dial in self._dials if dial.name == "load steps")
        moved = sum(1e-9 * number for dial, number in zip(self._dials, choice, strict=True) if dial.name in self.idle)
        error, cost, failure = super().of(busy)
        return error - effect(steps, steps.own)[0] + moved, cost, failure


def test_over_refined_runs_spend_nothing_on_what_changes_nothing(scene):
    """What does not matter beside the error that the truth may have is tightened once, from the first pair on; all else to the end."""
    dials = synthetic()
    names = [dial.name for dial in dials]
    matters, idle = (Search(kind(scene, dials), dials, [wanted("force.top.x", scene.problem())], 1e6) for kind in (Formula, Idle))
    for search in (matters, idle):
        search.screen()
        search.find_truth([4e-3])
    chosen = [dict(zip(names, search.truth.choice, strict=True)) for search in (matters, idle)]
    assert [truth["load steps"] for truth in chosen] == [5, 3]
    assert [truth["elements of block along v"] for truth in chosen] == [chosen[1]["elements of block along u"], 3]
    assert chosen[1]["elements of block along u"] > 3
    assert 3 * idle.uncertainty <= 4e-3
    assert max(choice[names.index("load steps")] for choice in idle.laboratory.outcomes) == 3


def test_the_truth_is_as_good_as_each_target_asks(scene):
    """Load steps that change 0.1 % are settled for 5 % and not for 0.8 %: truths of both are found from the looser one on."""

    class Slight(Formula):
        def of(self, choice):
            error, cost, failure = super().of(choice)
            steps = 2e-3 * 8 / int(self._dials[3].settings[choice[3]].label)
            return error - 0.01 * 8 / int(self._dials[3].settings[choice[3]].label) + steps, cost, failure

    dials, steps = synthetic(), []
    for targets in ([0.05], [0.05, 8e-3]):
        search = Search(Slight(scene, dials), dials, [wanted("force.top.x", scene.problem())], 1e6)
        search.screen()
        search.find_truth(targets)
        assert 3 * search.uncertainty <= targets[-1]
        steps.append(search.truth.choice[3])
    assert steps == [3, 5]


def test_what_over_refined_runs_took_tells_what_finer_ones_will(scene):
    """Costs of single settings do not multiply: a forecast from these alone leaves half of a budget unspent."""

    class Cheaper(Formula):
        def of(self, choice):
            error, cost, failure = super().of(choice)
            together = sum(number != own for number, own in zip(choice, self.own, strict=True)) > 1
            return error, cost**0.5 if together else cost, failure

    dials = synthetic()
    search = Search(Cheaper(scene, dials), dials, [wanted("force.top.x", scene.problem())], 330.0)
    search.screen()
    search.find_truth([0.01])
    assert 3 * search.uncertainty <= 0.01
    assert search.laboratory.spent < 165.0


def test_what_can_not_be_refined_has_no_truth(scene):
    """Else one run twice would know it to the last bit."""
    dials = (Dial("elements of block along u", (Setting("2"), Setting("4")), 1, "", part="elements"),)
    search = Search(Formula(scene, dials), dials, [wanted("force.top.x", scene.problem())], 1e6)
    search.screen()
    with pytest.raises(IsomortarError, match="nothing of the scene can be refined"):
        search.find_truth([0.1])


def test_what_is_nothing_in_a_scene_is_said_to_be(scene):
    _, answer = searched(scene, 0.01, wants=("force.top.y",))
    assert "is nothing in this scene" in answer.why


def test_a_scene_that_stops_has_nothing_to_trade(scene):
    class Stopping(Formula):
        def of(self, choice):
            return 0.0, 1.0, "does not converge" if choice == self.own else ""

    dials = synthetic()
    with pytest.raises(IsomortarError, match=r"as it is does not come to its end.*does not converge"):
        Search(Stopping(scene, dials), dials, [], 1.0).screen()


def test_runs_that_fail_are_shown_and_never_recommended(scene, tmp_path):
    class Brittle(Formula):
        def of(self, choice):
            error, cost, _ = super().of(choice)
            return error, cost, "folded" if choice[3] == 1 else ""  # four load steps

    dials = synthetic()
    search, answer = searched(scene, 0.03, Brittle(scene, dials))
    failed = [outcome for outcome in search.laboratory.outcomes.values() if outcome.failure]
    assert failed
    assert answer.best.choice[3] != 1
    assert page.write(tmp_path, scene, search, [answer], datetime.now().astimezone()).read_text().count("folded") == len(failed)


@pytest.mark.parametrize("wants", [("force.top.x", "gap.floor"), ("gap.floor", "force.top.x")])
def test_runs_that_do_not_tell_what_is_wanted_are_never_recommended(scene, wants):
    class Silent(Formula):
        """Of runs with so few load steps feet are lost, and with them gaps."""

        def formula(self, choice):
            outcome = super().formula(choice)
            return replace(outcome, numbers=outcome.numbers | {"gap": [math.nan]}) if choice[3] == few else outcome

    dials = synthetic()
    few = searched(scene, 0.1, wants=wants)[1].best.choice[3]
    search, answer = searched(scene, 0.1, Silent(scene, dials), wants)
    assert few < answer.best.choice[3]
    assert all(math.isinf(search.error(outcome)) == (outcome.choice[3] == few) for outcome in search.laboratory.outcomes.values())
    few = dials[3].own
    with pytest.raises(IsomortarError, match=r"there is nothing to trade: not finite: gap\.floor"):
        searched(scene, 0.1, Silent(scene, dials), wants)


def test_a_knob_is_one_entry(scene, tmp_path):
    """It is screened, searched, and shown."""

    def dials(_, spoils):
        yield Dial("friction of floor", (Setting("none", lambda _: ["contacts.floor.friction=0"]), Setting("own")), 1, spoils)

    knobs = (*[knob for knob in KNOBS if knob.name == "load steps"], Knob("friction", "everything that slides", dials))
    made = dials_of(scene, knobs=knobs)

    class Frictionless(Formula):
        def of(self, choice):
            return 0.001 * (choice[-1] == 0), 0.5 if choice[-1] == 0 else 1.0, ""

    search = Search(Frictionless(scene, made), made, [wanted("force.top.x", scene.problem())], 1e6)
    search.screen()
    search.find_truth([0.1])
    answer = search.answer(0.1)
    assert "friction of floor: none" in answer.best.name
    shown = page.write(tmp_path, scene, search, [answer], datetime.now().astimezone()).read_text()
    assert "everything that slides" in shown
    assert "friction of floor" in shown
    assert "<code>--set contacts.floor.friction=0</code>" in shown
    assert Scene.load(tmp_path / "within-10-percent.toml").problem().contacts[0].friction == 0.0


# The whole, on a tiny scene


def test_a_search_that_was_killed_goes_on_to_the_same_answer(scene, tmp_path, monkeypatch):
    knobs = [knob for knob in KNOBS if knob.name in ("elements", "load steps")]
    dials = dials_of(scene, knobs=knobs)
    wants = [wanted("force.top.z", scene.problem())]

    def conducted(stop):
        told = []

        def tell(outcome):
            told.append(outcome)
            if len(told) == stop:
                raise KeyboardInterrupt

        with local_processes(1) as submit:
            search = Search(Laboratory(scene, dials, tmp_path, submit, tell), dials, wants, 1e4)
            search.screen()
            search.find_truth([0.5])
            return search, search.answer(0.5)

    with pytest.raises(KeyboardInterrupt):
        conducted(5)
    first = conducted(-1)
    begun = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.json")}
    second = conducted(-1)
    assert first[1].best.choice == second[1].best.choice
    changed_cells = [path for path, at in begun.items() if path.stat().st_mtime_ns != at]
    assert {path.relative_to(tmp_path).parts[0] for path in changed_cells} == {"afresh"}  # what is recommended is run again
    data = json.loads(page.write(tmp_path, scene, *(second[0], [second[1]]), datetime.now().astimezone()).with_suffix(".json").read_text())
    assert data["answers"][0]["error"] <= 0.5
    assert np.isfinite(data["uncertainty"])
    _kept_and_run_again(tmp_path, data, monkeypatch)


def _kept_and_run_again(trade, data, monkeypatch):
    """What a trade found is kept as a reference; its recommendation is as near to the truth as it was."""
    kept = trade / "kept"
    (kept / "scenes").mkdir(parents=True)
    (kept / "scenes" / "tiny-within-7-percent.toml").write_text("of an earlier trade")
    keep_front.keep(trade, kept, kept / "scenes")
    monkeypatch.setattr(recommended, "REFERENCES", kept)
    monkeypatch.setattr(recommended, "FOLDER", kept / "scenes")
    (name,) = (path.stem for path in (kept / "scenes").iterdir())
    found = recommended.recommended.function(name)
    assert recommended.target(name) == 0.5
    assert found["error"] == pytest.approx(data["answers"][0]["error"], rel=1e-9)
    front = recommended.truth_of(name).dataset("front/error").values
    assert front == pytest.approx([run["error"] for run in data["front"]])
    assert (np.diff(front) < 0).all()


# CheaperSearch: the scene as it is is the truth


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


def test_advice_is_what_loses_least_of_the_scene_as_it_is(scene, tmp_path):
    own = ["1", "2", "4"]
    dials = (
        Dial("elements of block along u", tuple(map(Setting, own)), 2, "", part="elements"),
        Dial("way", (Setting("lazy"), Setting("own")), 1, "", refines=False),
    )
    laboratory = Formula(scene, dials)
    advice = CheaperSearch(laboratory, dials, [wanted("force.top.x", scene.problem())], 1e6)
    advice.screen()
    advice.find_truth([0.1])
    assert advice.error(advice.own) == 0.0
    answer = advice.answer(0.07)
    assert laboratory.name(answer.best.choice) == "elements of block along u: 2"  # 0.06 more; with the lazy way 0.09
    assert 0.0 < answer.error <= 0.07
    assert "times less than as it is" in page.sentence(advice, answer)
    dearer = replace(answer, best=replace(answer.best, numbers={**answer.best.numbers, "cpu_seconds": 2.0 * advice.own.cost}))
    assert page.sentence(advice, dearer).endswith("run afresh it saves nothing: keep the scene as it is.")
    assert "what it could do without" in page.write(tmp_path, scene, advice, [answer], datetime.now().astimezone()).read_text()
    assert advice.answer(1e-4).best is None
