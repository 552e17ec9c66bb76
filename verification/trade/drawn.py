"""What figures of a trade show: runs by cost and error, what nothing beats, what each setting alone does, and how curves differ."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import replace
from unittest.mock import patch

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from trade.searched import WANT, Known, dials, off, size

from isomortar.harness import Bound, case
from isomortar.trade import figures
from isomortar.trade.laboratory import Choice, Tried
from isomortar.trade.search import Search


def marked(axes: Axes, marker: str, largest: float = math.inf) -> set[tuple[float, float]]:
    """Places of marks of a kind, up to a size."""
    lines = [line for line in axes.lines if line.get_marker() == marker and line.get_markersize() <= largest]
    return {(float(x), float(y)) for line in lines for x, y in np.asarray(line.get_xydata())}


def apart(drawn: set[tuple[float, float]], exact: set[tuple[float, float]]) -> float:
    """Largest relative difference of places; of other numbers of them one."""
    if len(drawn) != len(exact) or not exact:
        return 1.0
    one, other = (np.array(sorted(places)) for places in (drawn, exact))
    return float(np.abs(one - other).max() / np.abs(other).max())


def _large(axes: Axes) -> set[tuple[float, float]]:
    """Places of rings."""
    return {
        (float(x), float(y))
        for line in axes.lines
        if line.get_markersize() > 10.0 and line.get_marker() == "o"
        for x, y in np.asarray(line.get_xydata())
    }


def two(run: Tried) -> np.ndarray:
    """What is wanted of a run."""
    return np.array(run.numbers["two"])


@case(
    claim="Figures of a trade show all runs but the over-refined ones at what they cost and how far off they are, which no other beats, "
    "what is recommended, what each setting alone costs and changes, in the row of its dial, and by how much curves differ.",
    tier="gate",
    bounds={
        "runs": Bound(at_most=1e-12, reason="round-off: costs, and errors in per cent"),
        "front": Bound(at_most=1e-12, reason="definition: runs of which no other is as cheap and nearer"),
        "recommended": Bound(at_most=1e-12, reason="round-off: its cost, and its error in per cent"),
        "settings": Bound(at_most=1e-12, reason="round-off: costs over that of the scene, changes in per cent of the truth"),
        "rows": Bound(0.0, 0.0, "definition: settings in the row of another dial, and rows with another name"),
        "curves": Bound(at_most=1e-12, reason="round-off: values, and differences in per cent of the largest"),
    },
)
def drawn() -> dict[str, float]:
    """Largest differences, of runs that are known in closed form and one that failed."""
    known = Known(1)
    search = Search(known, dials(), [WANT], math.inf)
    search.screen()
    search.find_truth([0.0])
    assert search.truth
    assert search.rival
    answer = search.answer(4.0 * off(search.rival, search.truth))
    assert answer.best
    known.outcomes[-1, -1, -1, -1] = replace(search.own, choice=(-1, -1, -1, -1), failure="it does not converge")
    shown: list[Figure] = []

    def keep(figure: Figure, _: str) -> str:
        shown.append(figure)
        return ""

    with patch.object(figures, "svg_text", keep):
        figures.precision(search, [answer])
        figures.screening(search)
        figures.curves(search, search.yardsticks[0], [answer])
    precision, (costs, changes), (left, right) = shown[0].axes[0], shown[1].axes, shown[2].axes[:2]
    runs = [
        run
        for run in known.outcomes.values()
        if not run.failure and run.choice not in [truth.choice for truth in (search.truth, *search.rivals)]
    ]
    places = {(run.cost, 100.0 * off(run, search.truth)) for run in runs}
    front = {(x, y) for x, y in places if not any((a <= x and b < y) or (a < x and b <= y) for a, b in places)}
    step = next(line for line in precision.lines if line.get_label() == "front")
    own = {(search.own.cost, 100.0 * off(search.own, search.truth))}
    errors, settings, rows = _screened(search, known, costs, changes)
    truth = two(search.truth)
    curves: list[tuple[Axes, Callable[[np.ndarray], np.ndarray]]]
    curves = [(left, lambda values: values), (right, lambda values: 100.0 * (values - truth) / truth.max())]
    named = {"own": search.own, "best": answer.best}
    worst = [
        np.abs(np.asarray(line.get_ydata()) - of(two(run))).max()
        for axes, of in curves
        for line, run in zip(axes.lines[(axes is left) :], named.values(), strict=False)
    ]
    return {
        "runs": float(np.maximum(apart(marked(precision, "o", 5.0), places), apart(_large(precision), own))),
        "front": apart({(float(x), float(y)) for x, y in np.asarray(step.get_xydata())}, front),
        "recommended": apart(marked(precision, "*"), {(answer.best.cost, 100.0 * off(answer.best, search.truth))}),
        "settings": errors,
        "rows": float(rows + (settings == 0) + (len(marked(precision, "x")) != 1)),
        "curves": float(np.max(worst)),
    }


def _screened(search: Search, known: Known, costs: Axes, changes: Axes) -> tuple[float, int, int]:
    """Largest error of what single settings cost and change, how many there are, and wrong rows."""
    assert search.truth
    names = [label.get_text() for label in costs.get_yticklabels()]
    rows = int(names != [dial.name for dial in reversed(search.dials)])
    worst, count = 0.0, 0
    for number, dial in enumerate(search.dials):
        for setting, label in enumerate(dial.settings):
            run = known.outcomes.get(search.single(number, setting))
            if run is None or setting == dial.own:
                continue
            change = 100.0 * size(two(run) - two(search.own)) / size(two(search.truth))
            for axes, exact in ((costs, run.cost / search.own.cost), (changes, change)):
                near = [text for text in axes.texts if text.get_text() == label.label and round(text.xy[1]) == len(names) - 1 - number]  # type: ignore[attr-defined]
                rows += len(near) != 1
                worst = np.maximum(worst, abs(near[0].xy[0] / exact - 1.0) if near else 1.0)  # type: ignore[attr-defined]
                count += 1
    return float(worst), count, rows


class Nothing(Known):
    """Runs of which nothing comes, but round-off of the scene as it is."""

    def formula(self, choice: Choice) -> Tried:
        """The run of a choice."""
        run = super().formula(choice)
        return replace(run, numbers=run.numbers | {"two": np.full(2, 1e-30 if choice == self.own else 0.0)})


@case(
    claim="Figures of a trade whose wish is nothing in the scene are drawn without a division by it, and a target is refused with that.",
    tier="gate",
    bounds={
        "warnings": Bound(0.0, 0.0, "definition: of what draws and divides"),
        "told": Bound(1.0, 1.0, "definition: one target, which is refused"),
    },
)
def of_nothing() -> dict[str, float]:
    """What NumPy and Matplotlib warn of, and whether the target is refused with the reason."""
    search = Search(Nothing(1), dials(), [WANT], math.inf)
    search.screen()
    search.find_truth([0.1])
    answer = search.answer(0.1)
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        for draw in (
            figures.precision,
            lambda *of: figures.screening(of[0]),
            lambda *of: figures.curves(of[0], of[0].yardsticks[0], of[1]),
        ):
            draw(search, [answer])
    return {"warnings": float(len(heard)), "told": float("is nothing in this scene" in answer.why)}
