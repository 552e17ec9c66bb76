"""Curves over the load steps by discretisation, beside a reference (Figs. 6, 9, 12)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from paper.figures.picture import Picture, plot

from isomortar.geometry.patch import FloatArray
from isomortar.harness.figures import look, page_style
from isomortar.results import style

#: Marks along a curve: enough to tell it, few enough to see it.
_MARKS = 9
#: Where the differences are drawn, a line is left out whose largest is so many times that of the nearest line.
_FAR = 6.0
#: Letters in a row of the legend, with what a line's sample takes.
_LEGEND_WIDTH, _SAMPLE_WIDTH = 150, 10
#: Colours and marks of lines of a kind that the figure already has.
_FURTHER = (("#56B4E9", "P"), ("#CC79A7", "X"), (style.VERMILION, "<"), ("#8C6D1F", ">"), (style.GREY, "*"))


@dataclass(frozen=True)
class Line:
    """A curve: `kind` ("N3", "L2") gives its look; the reference is black and the others are told from it."""

    label: str
    times: FloatArray
    values: FloatArray
    kind: str
    reference: bool = False


def draw(lines: Sequence[Line], title: str, y_label: str) -> Picture:
    """The curves, and where there is a reference beside them how far they are off it.

    Parameters
    ----------
    lines : sequence of Line
        Times in load steps, those of the reference where steps differ in size.
    title, y_label : str
        The label names quantity and unit.
    """
    reference = next((line for line in lines if line.reference), None)
    looks = _looks(lines)
    with page_style():
        figure = Figure(figsize=(10.6, 3.9) if reference else (7.2, 3.9), layout="constrained")
        panels = list(figure.subplots(1, 2 if reference else 1, squeeze=False)[0])
        for number, (line, drawn) in enumerate(zip(lines, looks, strict=True)):
            panels[0].plot(line.times, line.values, label=line.label, markevery=_marks(len(line.times), number), **drawn)
        panels[0].set_ylabel(y_label)
        if reference:
            _draw_differences(panels[1], lines, looks, reference)
        for axes in panels:
            _finish(axes)
        figure.suptitle(title, x=0.01, ha="left", fontsize=10.5)
        handles, labels = panels[0].get_legend_handles_labels()
        columns = max(1, min(len(labels), _LEGEND_WIDTH // (max(map(len, labels)) + _SAMPLE_WIDTH)))
        figure.legend(handles, labels, loc="outside lower left", ncols=columns, handlelength=3.4, columnspacing=1.6)
    return plot(figure, title)


def _draw_differences(axes: Axes, lines: Sequence[Line], looks: Sequence[dict[str, Any]], reference: Line) -> None:
    """How far the lines are off the reference, those that are within sight of it: of those that go to the end at least two."""
    scale = max(float(np.abs(reference.values).max()), 1e-300)
    off = [100 * (line.values - np.interp(line.times, reference.times, reference.values)) / scale for line in lines]
    reach = [float(np.abs(values).max()) for values in off]
    ended = max(line.times[-1] for line in lines)
    reaches = sorted(r for r, line in zip(reach, lines, strict=True) if not line.reference and line.times[-1] == ended)
    farthest = max([_FAR * reaches[0], *reaches[1:2]]) if reaches else max(reach)
    left_out = []
    for number, (line, drawn, values) in enumerate(zip(lines, looks, off, strict=True)):
        if line.reference or reach[number] <= farthest:
            axes.plot(line.times, values, markevery=_marks(len(line.times), number), **drawn)
        else:
            left_out.append(line.label)
    axes.set_ylabel(f"difference from the reference, % of {scale:.3g}")
    if left_out:
        axes.set_title(f"not within sight: {'; '.join(left_out)}", loc="right", fontsize=8)


def _looks(lines: Sequence[Line]) -> list[dict[str, Any]]:
    """The look of each kind; the second line of a kind and those after it have colours and marks of their own."""
    seen: Counter[str] = Counter()
    further = iter(_FURTHER)
    looks = []
    for line in lines:
        if line.reference:
            looks.append({"color": style.BLACK, "linewidth": 2.4, "zorder": 2})
            continue
        drawn = look(line.kind) | {"markersize": 4.2, "linewidth": 1.15, "markeredgewidth": 0.9}
        if seen[line.kind]:
            colour, mark = next(further)
            filling = colour if drawn["markerfacecolor"] != "white" else "white"
            drawn |= {"color": colour, "marker": mark, "markerfacecolor": filling}
        seen[line.kind] += 1
        looks.append(drawn)
    return looks


def _marks(points: int, number: int) -> tuple[int, int]:
    """First mark and distance of marks, shifted from line to line so that marks of near curves do not cover each other."""
    distance = max(1, points // _MARKS)
    return (2 * number) % distance, distance


def _finish(axes: Axes) -> None:
    axes.set_xlabel("load time (steps)")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, steps=(1, 2, 5, 10)))
    axes.margins(x=0.01)
    axes.grid(axis="y", color="#E3E6EA", linewidth=0.6)
    axes.set_axisbelow(True)
