"""Advice: the scene as it is is the truth, and what it may do without is sought."""

from dataclasses import replace
from datetime import datetime

import pytest

from isomortar.scene import Scene
from isomortar.trade import page
from isomortar.trade.advice import CheaperSearch
from isomortar.trade.knobs import Dial, Setting
from isomortar.trade.want import wanted
from trade_formulas import Formula
from trade_samples import TINY


@pytest.fixture
def scene():
    return Scene.from_toml(TINY)


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
