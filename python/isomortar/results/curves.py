"""Curves over the load steps."""

from __future__ import annotations

from itertools import groupby
from typing import Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from isomortar.geometry.patch import FloatArray
from isomortar.model.entities import Support
from isomortar.model.numbering import Numbering
from isomortar.results import style
from isomortar.results.abscissa import Abscissa, abscissa, from_rest
from isomortar.results.reader import Results

_COMPONENTS = {"x": (style.BLUE, "-"), "y": (style.GREEN, "--"), "z": (style.VERMILION, "-.")}


class WantedCurve(Protocol):
    """A curve that a scene asks for: a component of a support's force or moment."""

    @property
    def name(self) -> str: ...  # noqa: D102
    @property
    def support(self) -> str: ...  # noqa: D102
    @property
    def quantity(self) -> str: ...  # noqa: D102
    @property
    def component(self) -> str: ...  # noqa: D102


def moving_supports(results: Results) -> list[Support]:
    """The supports that move in some stage, or that a force moves; all of them if none does."""
    moving = [s for s in results.problem.supports if s.moves or s.is_plate]
    return moving or list(results.problem.supports)


def draw_reactions(results: Results, support: str, over: Abscissa | None = None) -> Figure:
    """Force that a support exerts, and its moment about the moving centre, by component."""
    over = over or abscissa(results)
    figure = Figure(figsize=(6.4, 5.0), layout="constrained")
    force, moment = figure.subplots(2, 1, sharex=True)
    scale = max(float(np.abs(results.curve("force", support=support)).max()), 1e-300)
    length = Numbering(results.problem).size
    for axes, quantity, label, size in ((force, "force", "force", scale), (moment, "moment", "moment about the centre", scale * length)):
        values = from_rest(results.curve(quantity, support=support))
        for number, (name, (colour, line)) in enumerate(_COMPONENTS.items()):
            axes.plot(over.values, values[:, number], line, color=colour, label=name, marker=_marker(over), markersize=3, clip_on=False)
        axes.set_ylabel(label)
        if np.abs(values).max() < 1e-9 * size:  # round-off: show it as nothing
            axes.set_ylim(-0.01 * size, 0.01 * size)
    figure.legend(*force.get_legend_handles_labels(), ncols=3, loc="outside lower right")  # beside a title of any length
    force.set_title(f"{results.problem.name}: reaction at support {support}", loc="left", pad=18)
    _finish((force, moment), results, over)
    return figure


def draw_curve(results: Results, curve: WantedCurve, over: Abscissa | None = None) -> Figure:
    """A curve that the scene asks for."""
    over = over or abscissa(results)
    figure = Figure(figsize=(6.4, 3.2), layout="constrained")
    axes = figure.subplots()
    values = from_rest(results.curve(curve.quantity, support=curve.support))
    chosen = np.linalg.norm(values, axis=1) if curve.component == "norm" else values[:, "xyz".index(curve.component)]
    axes.plot(over.values, chosen, color=style.BLUE, marker=_marker(over), markersize=3, clip_on=False)
    of = f"|{curve.quantity}|" if curve.component == "norm" else f"{curve.quantity} {curve.component}"
    axes.set_ylabel(of)
    axes.set_title(f"{results.problem.name}: {curve.name} (support {curve.support})", loc="left", pad=18)
    _finish((axes,), results, over)
    return figure


def _marker(over: Abscissa) -> str:
    """Few steps are shown one by one."""
    return "o" if len(over.values) <= 25 else ""


def _finish(panels: tuple[Axes, ...], results: Results, over: Abscissa) -> None:
    """Put zero and the steps in sight; show the stages where they lie beside each other."""
    for axes in panels:
        axes.axhline(0.0, color=style.GREY, linewidth=0.6, zorder=1)
        axes.set_xlim(over.values.min(), over.values.max())
        axes.grid(axis="y", color="#E3E6EA", linewidth=0.6)
        axes.set_axisbelow(True)
    panels[-1].set_xlabel(over.label)
    if over.one_way:
        _show_stages(panels, results.stages, over.values)


def _show_stages(panels: tuple[Axes, ...], stages: list[str], places: FloatArray) -> None:
    """Shade every second stage, and name those that have a width."""
    start = 0
    for number, (stage, group) in enumerate(groupby(stages)):
        end = start + len(list(group))
        if places[start] != places[end]:
            middle = 0.5 * (places[start] + places[end])
            panels[0].annotate(stage, (middle, 1.02), xycoords=("data", "axes fraction"), ha="center", color=style.GREY)
        for axes in panels:
            if number % 2:
                axes.axvspan(places[start], places[end], color="#F1F3F6", linewidth=0, zorder=0)
        start = end
