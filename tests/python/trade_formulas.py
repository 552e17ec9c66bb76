"""A laboratory whose runs are formulas, and a search in it."""

from pathlib import Path

from isomortar.trade.knobs import Dial, Setting
from isomortar.trade.laboratory import Laboratory, Tried
from isomortar.trade.search import Search
from isomortar.trade.want import wanted
from trade_samples import numbers


class Formula(Laboratory):
    """Errors and costs that are known: of elements with order two, of load steps with order one, and a choice that only spoils."""

    def __init__(self, scene, dials):
        super().__init__(scene, dials, Path("unused"), None, lambda _: None)
        self.calls = 0

    def _measured(self, choices, *_, **__):
        self.calls += len(choices)
        return {choice: self.formula(choice) for choice in choices}

    def formula(self, choice):
        error, cost, failure = self.of(choice)
        made = numbers([(1.0 + error, 0, 0)] * 4, cost)
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
    own = {
        "elements": ["2", "3", "4", "6", "8", "12", "16", "24", "32"],
        "load steps": ["2", "4", "8", "16", "32", "64"],
        "order": ["2", "3", "4"],
    }
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
