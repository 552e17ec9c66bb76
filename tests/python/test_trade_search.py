"""The search of the trade: forecasts, truth, and the cheapest of all combinations, where all of them are known."""

import itertools
import math
from dataclasses import replace
from datetime import datetime

import pytest

from isomortar.errors import IsomortarError
from isomortar.scene import Scene
from isomortar.trade import figures, page
from isomortar.trade.knobs import KNOBS, Dial, Knob, Setting, dials_of
from isomortar.trade.model import Model
from isomortar.trade.search import Search
from isomortar.trade.want import wanted
from trade_formulas import Formula, effect, searched, synthetic
from trade_samples import TINY


@pytest.fixture
def scene():
    return Scene.from_toml(TINY)


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
    search.find_truth([0.023])
    assert 3 * search.uncertainty <= 0.023
    assert search.laboratory.spent < 165.0


def test_what_can_not_be_refined_has_no_truth(scene):
    """Else one run twice would know it to the last bit."""
    dials = (Dial("elements of block along u", (Setting("2"), Setting("4")), 1, "", part="elements"),)
    search = Search(Formula(scene, dials), dials, [wanted("force.top.x", scene.problem())], 1e6)
    search.screen()
    with pytest.raises(IsomortarError, match="nothing of the scene can be refined"):
        search.find_truth([0.1])


@pytest.mark.parametrize("want", ["force.top.y", "force.top.z@drag:end", "moment.top.x", "moment.top", "edge.floor"])
def test_what_is_nothing_in_a_scene_is_said_at_once(scene, want):
    class Symmetric(Formula):
        def formula(self, choice):
            found = super().formula(choice)
            leaning = {"force": [[(1.0, 1e-15, 1e-14)] * 4], "moment": [[(1e-16, 0.0, 1e-15)] * 4], "pressure": [0.0, 0.0]}
            return replace(found, numbers=found.numbers | leaning)

    laboratory = Symmetric(scene, synthetic())
    with pytest.raises(IsomortarError, match=r"has nothing but round-off, as by symmetry"):
        searched(scene, 0.01, laboratory, wants=("force.top.x", want))
    assert laboratory.calls == 1


def test_what_may_be_next_to_nothing_is_traded(scene):
    _, answer = searched(scene, 0.01, wants=("gap.floor", "force.top.x"))
    assert answer.best


def test_over_refined_runs_that_have_nothing_in_common_end_after_two_levels(scene):
    """Of what an uneven mesh alone makes: a budget without an end would be spent to half."""

    class Uneven(Formula):
        def formula(self, choice):
            found = super().formula(choice)
            leaning = 1e-3 * math.cos(1.0 + sum(7.0 * n * number for n, number in enumerate(choice, 1)))
            return replace(found, numbers=found.numbers | {"force": [[(1.0, leaning, 0.0)] * 4]})

    search, answer = searched(scene, 0.01, Uneven(scene, synthetic()), wants=("force.top.y",))
    assert "is nothing in this scene" in answer.why
    assert search.laboratory.spent < 1e3  # of 6.5e4 on all levels


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
    assert not figures.pareto(search, [outcome for outcome in search.laboratory.outcomes.values() if outcome.choice[3] == few])
    few = dials[3].own
    with pytest.raises(IsomortarError, match=r"there is nothing to trade: not finite: gap\.floor"):
        searched(scene, 0.1, Silent(scene, dials), wants)


def test_curves_are_drawn_of_every_answer(scene):
    search, answer = searched(scene, 0.05)
    answers = [replace(answer, target=number / 100) for number in range(9, 1, -1)]
    drawn = figures.curves(search, search.yardsticks[0], answers)
    assert [number for number in range(9, 1, -1) if f"within {number} %" not in drawn] == []


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


def told_for(scene, targets, budget=1e6, kind=Formula):
    """A search by a budget, and its answers."""
    dials = synthetic()
    search = Search(kind(scene, dials), dials, [wanted("force.top.x", scene.problem())], budget)
    search.screen()
    return search, search.answers(targets)


def spent_on_the_truth(scene, target):
    """What screening and a truth that tells a target cost."""
    dials = synthetic()
    search = Search(Formula(scene, dials), dials, [wanted("force.top.x", scene.problem())], math.inf)
    search.screen()
    search.find_truth([target])
    return search.laboratory.spent


@pytest.mark.parametrize("share", [0.55, 0.7, 0.85])
def test_a_truth_has_all_of_the_budget_where_nothing_else_has_use_for_it(scene, share):
    """Of a truth that takes most of a budget a target is told, with what is left for the search."""
    budget = spent_on_the_truth(scene, 0.01) / share
    search, (answer,) = told_for(scene, [0.01], budget)
    assert answer.error <= 0.01
    assert 3 * search.uncertainty <= 0.01


def test_what_half_of_a_budget_tells_is_searched_before_the_rest_goes_into_the_truth(scene):
    need = spent_on_the_truth(scene, 0.01)
    search, (loose, tight) = told_for(scene, [0.03, 0.01], 1.5 * need)
    assert loose.best
    assert tight.best
    assert 3 * search.uncertainty <= 0.01
    order = list(search.laboratory.outcomes)
    assert order.index(loose.best.choice) < order.index(search.truth.choice)
    _, (loose, tight) = told_for(scene, [0.03, 0.01], 0.9 * need)
    assert loose.best
    assert not loose.cut
    assert tight.best is None


def test_a_search_that_the_budget_ended_says_so(scene):
    dials = synthetic()
    for share, cut in ((1.0, True), (1e3, False)):
        search = Search(Formula(scene, dials), dials, [wanted("force.top.x", scene.problem())], 1e6)
        search.screen()
        search.find_truth([0.05])
        search.budget = share * search.laboratory.spent - 1.0
        answer = search.answer(0.05)
        assert answer.error <= 0.05
        assert answer.cut == cut
        assert ("the budget ended the search" in page.sentence(search, answer)) == cut


def test_a_budget_that_settings_alone_would_spend_is_refused_at_once(scene):
    dials = synthetic()
    laboratory = Formula(scene, dials)
    search = Search(laboratory, dials, [wanted("force.top.x", scene.problem())], 5.0)
    with pytest.raises(IsomortarError, match=r"takes 1\.0 s of the processor, .* and the budget is 5\.0 s: give more \(--budget, in"):
        search.screen()
    assert laboratory.calls == 1


def test_finer_runs_that_fail_are_told_of_a_target_that_is_refused(scene):
    """More of the processor would not help."""

    class Folding(Formula):
        def of(self, choice):
            error, cost, _ = super().of(choice)
            return error, cost, "folded" if choice[1] > 4 else ""

    _, (answer,) = told_for(scene, [1e-3], kind=Folding)
    assert answer.best is None
    assert "finer ones do not come to their end: folded" in answer.why
    assert "--budget" not in answer.why


def test_a_choice_is_forecast_once_from_whatever_side_it_is_asked_for(scene, monkeypatch):
    """Where single runs take a tenth of a second forecasts took longer than all of these."""
    forecast, begun = [], Model._forecast
    monkeypatch.setattr(Model, "_forecast", lambda model, choice: forecast.append((id(model), choice)) or begun(model, choice))
    search, _ = searched(scene, 0.03)
    forecast.clear()
    model = search.model
    assert model.cheapest(0.03, {}) == model.cheapest(0.03, {})
    assert len(forecast) == len(set(forecast)) > 50
