"""A sheet of panels of one size, with a title each, a colour bar at the right and a line that says what marks mean."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from isomortar.geometry.patch import FloatArray

#: Inches. `_BAR`: what the colour bar takes with its numbers and its label.
_WIDTH, _WIDEST, _TITLE, _SPACE, _KEY, _BAR = 10.6, 6.2, 0.3, 0.12, 0.34, 1.5
_BAR_WIDTH, _LONGEST_BAR, _SHORTEST_BAR = 0.17, 4.2, 2.6

#: Over the range of a colour bar: round-off does not go beyond it.
_NOTHING = 1e-6


@dataclass(frozen=True)
class Mark:
    """What a mark means: its symbol as Matplotlib calls it, and its colour."""

    meaning: str
    symbol: str
    colour: str


class Sheet:
    """A figure with panels for drawings of `across` times their height, to be filled in a block with our style.

    Attributes
    ----------
    figure : Figure
    panels : list of Axes
    """

    def __init__(self, titles: Sequence[str], across: float, bar: bool, marks: Sequence[Mark] = ()) -> None:
        columns = _columns(len(titles), across)
        rows = math.ceil(len(titles) / columns)
        right, below = _BAR if bar else 0.0, _KEY if marks else 0.0
        wide = min(_WIDEST, (_WIDTH - right) / columns - _SPACE)
        high = wide / across
        size = (columns * (wide + _SPACE) + right, max(rows * (high + _TITLE), (_SHORTEST_BAR + 0.2) if bar else 0.0) + below)
        self.figure = Figure(figsize=size)
        self._size = size
        self._below = below
        self.panels = [self._panel(k % columns, k // columns, wide, high, title) for k, title in enumerate(titles)]
        if marks:
            handles = [Line2D([], [], linestyle="", marker=m.symbol, color=m.colour, markersize=6, label=m.meaning) for m in marks]
            self.figure.legend(handles=handles, loc="lower left", ncols=len(marks), handletextpad=0.2, borderaxespad=0.2)

    def add_bar(self, colours: ScalarMappable, label: str, values: FloatArray) -> None:
        """The colour bar; its ends are pointed where `values` go beyond its range."""
        low, high = colours.get_clim()
        ends = (bool(values.min() < low - _NOTHING * (high - low)), bool(values.max() > high + _NOTHING * (high - low)))
        extend = {(False, False): "neither", (True, False): "min", (False, True): "max", (True, True): "both"}[ends]
        length = min(_LONGEST_BAR, 0.9 * (self._size[1] - self._below))
        middle = self._below + 0.5 * (self._size[1] - self._below)
        self.figure.colorbar(
            colours, cax=self._axes(self._size[0] - _BAR + _SPACE, middle - 0.5 * length, _BAR_WIDTH, length), extend=extend, label=label
        )

    def _panel(self, column: int, row: int, wide: float, high: float, title: str) -> Axes:
        axes = self._axes(0.5 * _SPACE + column * (wide + _SPACE), self._size[1] - (row + 1) * (high + _TITLE), wide, high)
        axes.set_axis_off()
        axes.set_title(title, loc="left")
        return axes

    def _axes(self, left: float, low: float, wide: float, high: float) -> Axes:
        return self.figure.add_axes((left / self._size[0], low / self._size[1], wide / self._size[0], high / self._size[1]))


def _columns(count: int, across: float) -> int:
    """Few wide panels or more narrow ones in a row, rows as full as can be."""
    most = 1 if across > 4 else 2 if across > 1.9 else 3
    if count <= most:
        return count
    return math.ceil(count / math.ceil(count / most))
