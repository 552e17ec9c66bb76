"""Figures of a trade, as SVG text."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import cycle

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from isomortar.harness.figures import page_style, svg_text
from isomortar.harness.report import percent
from isomortar.results import style
from isomortar.trade.laboratory import Tried
from isomortar.trade.model import Yardstick
from isomortar.trade.search import RESOLVED, Recommendation, Search

_COLOURS = {2: style.BLUE, 3: style.GREEN, 4: style.VERMILION, 5: "#CC79A7"}
_SOFT = "#5C6670"


def precision(search: Search, answers: Sequence[Recommendation]) -> str:
    """Error against CPU seconds of every run, the front of those that nothing beats, targets and what was recommended for them."""
    with page_style():
        figure = Figure(figsize=(10.6, 5.0), layout="constrained")
        axes = figure.subplots()
        axes.set(xscale="log", yscale="log", xlabel="CPU seconds", ylabel="error of what is wanted, %")
        runs = [o for o in search.laboratory.outcomes.values() if o not in (search.truth, *search.rivals)]
        _points(axes, search, [o for o in runs if not o.failure])
        front = pareto(search, runs)
        axes.step(
            [o.cost for o in front], [100 * search.error(o) for o in front], where="post", color=style.BLACK, linewidth=1.0, label="front"
        )
        for answer in answers:
            axes.axhline(100 * answer.target, color=style.GREY, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1)
            if answer.best:
                axes.plot(answer.best.cost, 100 * answer.error, "*", color=style.BLACK, markersize=13, zorder=5)
        axes.plot(
            search.own.cost, 100 * search.error(search.own), "o", markersize=11, markerfacecolor="none", color=style.BLACK, label="as it is"
        )
        if math.isfinite(search.uncertainty):
            _unresolved(axes, search)
        _failed(axes, [o for o in runs if o.failure])
        _ticks(axes)
        figure.legend(*axes.get_legend_handles_labels(), loc="outside upper left", ncols=8)
        return svg_text(figure, "precision")


def pareto(search: Search, runs: Sequence[Tried]) -> list[Tried]:
    """The runs of which no other is cheaper and nearer, cheapest first."""
    front: list[Tried] = []
    for outcome in sorted((o for o in runs if math.isfinite(search.error(o))), key=lambda o: (o.cost, search.error(o))):
        if not front or search.error(outcome) < search.error(front[-1]):
            front.append(outcome)
    return front


def screening(search: Search) -> str:
    """What each setting alone does to the cost and to what is wanted, a row a dial."""
    model, dials = search.model, search.dials
    with page_style():
        figure = Figure(figsize=(10.6, 0.8 + 0.34 * len(dials)), layout="constrained")
        costs, changes = figure.subplots(1, 2, sharey=True)
        for number, dial in enumerate(dials):
            others = [setting for setting in model.settings(number) if setting != dial.own]
            for place, setting in enumerate(others):
                outcome = search.laboratory.outcomes[search.single(number, setting)]
                height = len(dials) - 1 - number + 0.3 * (place - 0.5 * (len(others) - 1)) / max(0.5 * len(others), 1.0)
                colour = style.GREY if not dial.refines else style.VERMILION if setting > dial.own else style.BLUE
                _bar(costs, height, outcome.cost / search.own.cost, dial.settings[setting].label, colour, 1.0)
                _bar(changes, height, 100 * model.effect(number, setting), dial.settings[setting].label, colour, 0.0)
        costs.margins(x=0.18)  # labels stand beside the ends
        costs.set(xscale="log", xlabel="cost over that of the scene as it is", yticks=range(len(dials)))
        costs.set_yticklabels([dial.name for dial in reversed(dials)])
        costs.axvline(1.0, color=style.BLACK, linewidth=0.8)
        changes.set(xscale="log", xlabel="change of what is wanted, %")
        if math.isfinite(search.error(search.own)):  # of nothing it is no share
            changes.axvline(100 * search.error(search.own), color=style.BLACK, linewidth=0.8, linestyle=(0, (4, 3)))
        lowest = max(changes.get_xlim()[0], 1e-6)
        changes.set_xlim(lowest, changes.get_xlim()[1])
        for axes in (costs, changes):
            axes.grid(axis="y", color="#E9EBEE", linewidth=0.6)
            axes.set_axisbelow(True)
        costs.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        costs.xaxis.set_major_formatter("{x:g}")
        costs.xaxis.set_minor_formatter(NullFormatter())
        return svg_text(figure, "screening")


def curves(search: Search, yardstick: Yardstick, answers: Sequence[Recommendation]) -> str:
    """What is wanted: of the truth, of the scene as it is, and of what was recommended; nothing where that is one number, or zero."""
    if len(yardstick.truth) == 1 or not np.any(yardstick.truth):
        return ""
    with page_style():
        figure = Figure(figsize=(10.6, 3.6), layout="constrained")
        left, right = figure.subplots(1, 2)
        places = np.linspace(0.0, 100.0, len(yardstick.truth))
        left.plot(places, yardstick.truth, color=style.BLACK, linewidth=2.4, label="over-refined")
        shown = [("as it is", search.own), *((f"within {percent(answer.target)}", answer.best) for answer in answers if answer.best)]
        colours = cycle((style.GREY, style.BLUE, style.GREEN, style.VERMILION, style.ORANGE))
        for (label, outcome), colour in zip(shown, colours, strict=False):
            values = yardstick.values(outcome)
            left.plot(places, values, color=colour, label=label)
            right.plot(places, 100 * (values - yardstick.truth) / np.abs(yardstick.truth).max(), color=colour, linewidth=1.0)
        left.set(ylabel=yardstick.want.text)
        right.set(ylabel="difference, % of the largest")
        right.axhline(0.0, color=style.BLACK, linewidth=0.8)
        for axes in (left, right):
            axes.set(xlabel="stages of equal length, or cells of the face, %")
        figure.legend(*left.get_legend_handles_labels(), loc="outside upper left", ncols=6)
        return svg_text(figure, f"curves-{yardstick.want.text}")


def _points(axes: Axes, search: Search, runs: Sequence[Tried]) -> None:
    orders: dict[int, list[Tried]] = {}
    for outcome in runs:
        orders.setdefault(search.order(outcome.choice), []).append(outcome)
    for order, found in sorted(orders.items()):
        x, y = [o.cost for o in found], [100 * search.error(o) for o in found]
        axes.plot(
            x, y, "o", color=_COLOURS.get(order, style.GREY), markersize=4, alpha=0.8, label=f"order {order}" if order else "orders differ"
        )


def _unresolved(axes: Axes, search: Search) -> None:
    """Grey where errors are below what the over-refined runs tell."""
    low, high = axes.get_ylim()
    floor = 100 * RESOLVED * max(search.uncertainty, 1e-12)
    low = max(min(low, floor / 1.5), 1e-12)
    axes.axhspan(low, floor, color="#E9EBEE", linewidth=0, zorder=0)
    axes.set_ylim(low, high)
    axes.text(0.01, 0.02, "grey: not resolved", transform=axes.transAxes, fontsize=7.5, color=_SOFT)


def _failed(axes: Axes, runs: Sequence[Tried]) -> None:
    """Runs that did not come to their end, at the top, at what they had cost."""
    if runs:
        low, high = axes.get_xlim()
        at = [min(high, max(low, outcome.cost)) for outcome in runs]
        axes.plot(at, [0.97] * len(at), "x", color=style.VERMILION, transform=axes.get_xaxis_transform(), label="failed", clip_on=False)


def _bar(axes: Axes, height: float, value: float, label: str, colour: str, start: float) -> None:
    if not math.isfinite(value) or value <= 0.0:
        return
    if start:
        axes.plot([start, value], [height, height], color=colour, linewidth=2.0)
    axes.plot(value, height, "o", color=colour, markersize=3.5)
    left = start > value
    place, side = (-4 if left else 4, -2.5), "right" if left else "left"
    axes.annotate(label, (value, height), place, textcoords="offset points", fontsize=6.5, color=colour, ha=side)


def _ticks(axes: Axes) -> None:
    for axis in (axes.xaxis, axes.yaxis):
        low, high = axis.get_view_interval()
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high / low < 300 else (1.0,), numticks=12))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())
    axes.grid(color="#E9EBEE", linewidth=0.6)
    axes.set_axisbelow(True)
