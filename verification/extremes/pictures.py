"""Pictures of sweeps: a square a point, before above or beside now; its colour and its letter or digits say how it ended."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from extremes.endings import Ending
from extremes.points import Point, Sweep
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from isomortar.harness.figures import page_style, svg_text
from isomortar.results import style

COLOURS = {
    Ending.WRONG: style.VERMILION,
    Ending.STOPPED: "#B9BEC6",
    Ending.REFUSED: "#7FB8DB",
    Ending.WARNED: style.ORANGE,
    Ending.RIGHT: "#66C2A5",
}
_LETTERS = {Ending.STOPPED: "s", Ending.REFUSED: "r"}
#: Inches of a square, of what stands beside a panel, above and below it, and of a letter of the names of its values.
_SQUARE, _BESIDE, _ROUND, _LETTER = 0.34, 1.6, 0.95, 0.075


def picture(sweep: Sweep) -> str:
    """The sweep as SVG text: its first argument to the right; a second one upwards, in two panels."""
    with page_style():
        figure = _pair(sweep) if len(sweep.case.grid) == 2 else _line(sweep)
        return svg_text(figure, sweep.case.name)


def _line(sweep: Sweep) -> Figure:
    (name,) = sweep.case.grid
    values = [settings[name] for settings in sweep.settings]
    figure = Figure(figsize=(_SQUARE * len(values) + _BESIDE, 2 * _SQUARE + _ROUND + _names(values)), layout="constrained")
    axes = figure.subplots()
    _squares(axes, [sweep.now, sweep.before])
    axes.set_yticks([0, 1], ["now", "before"])
    _name(axes, values, name)
    return figure


def _pair(sweep: Sweep) -> Figure:
    first, second = sweep.case.grid
    across = list(dict.fromkeys(settings[first] for settings in sweep.settings))
    up = list(dict.fromkeys(settings[second] for settings in sweep.settings))
    size = (2 * (_SQUARE * len(across) + _names(across)) + _names(up) + _BESIDE, _SQUARE * len(up) + _ROUND + _names(across))
    figure = Figure(figsize=size, layout="constrained")
    panels = figure.subplots(1, 2, sharey=True)
    found: list[tuple[str, Sequence[Point | None]]] = [("before", sweep.before), ("now", sweep.now)]
    for axes, (title, points) in zip(panels, found, strict=True):
        by_place = {(s[first], s[second]): point for s, point in zip(sweep.settings, points, strict=True)}
        _squares(axes, [[by_place.get((a, b)) for a in across] for b in up])
        axes.set_title(title)
        _name(axes, across, first)
    panels[0].set_yticks(range(len(up)), [_short(value) for value in up])
    panels[0].set_ylabel(second)
    return figure


def _squares(axes: Axes, rows: Sequence[Sequence[Point | None]]) -> None:
    """Rows of points, the first one at the bottom; white where a point was not measured."""
    endings = np.array([[np.nan if point is None else float(point.ending) for point in row] for row in rows])
    colours = ListedColormap([COLOURS[ending] for ending in sorted(Ending)])
    axes.imshow(np.ma.masked_invalid(endings), cmap=colours, vmin=-0.5, vmax=len(Ending) - 0.5, origin="lower", aspect="equal")
    for y, row in enumerate(rows):
        for x, point in enumerate(row):
            if point is not None:
                said = _LETTERS.get(point.ending, f"{max(point.digits, 0.0):.0f}")
                axes.text(x, y, said, ha="center", va="center", fontsize=7, fontweight="bold" if point.ending is Ending.WRONG else "normal")
    axes.set_xticks(np.arange(endings.shape[1] + 1) - 0.5, minor=True)
    axes.set_yticks(np.arange(endings.shape[0] + 1) - 0.5, minor=True)
    axes.grid(which="minor", color="white", linewidth=1.2)
    axes.tick_params(which="both", length=0)
    axes.spines[:].set_visible(False)


def _names(values: Sequence[Any]) -> float:
    """Inches that the longest of the names of values takes."""
    return _LETTER * max(len(_short(value)) for value in values)


def _name(axes: Axes, values: Sequence[Any], name: str) -> None:
    axes.set_xticks(range(len(values)), [_short(value) for value in values], rotation=60, ha="right", rotation_mode="anchor")
    axes.set_xlabel(name)


def _short(value: Any) -> str:
    """A value of a grid as people read it."""
    if not isinstance(value, float):
        return str(value)
    return f"{value:g}" if float(f"{value:g}") == value else f"{value:.13g}"
