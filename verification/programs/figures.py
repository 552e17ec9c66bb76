"""Curves of the programs side by side, as SVG text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from programs.found import OWN, STAGES, Found

from isomortar.geometry.patch import FloatArray
from isomortar.harness.figures import page_style, svg_text
from isomortar.results import style

#: Colour and mark of each program: the same in all figures.
_LOOKS = {"isomortar": (style.BLUE, "o"), "GetFEM": (style.VERMILION, "s"), "CalculiX": (style.GREEN, "^")}
_LABELS = {"pressed": ("pressing force", -1.0), "dragged": ("force along the drag", 1.0)}


def curves(runs: Sequence[Found], smooth: Sequence[Found], name: str) -> str:
    """Both forces over the load steps, and how far each program is off isomortar on the fine elements.

    Parameters
    ----------
    runs : sequence of Found
        Of one scene and one kind, by all programs on both meshes.
    smooth : sequence of Found
        By isomortar alone, drawn in grey to tell from how far off all elements of that kind are.
    name : str
        Of the figure.
    """
    begun = [run for run in runs if len(run.forces)]
    if not begun:
        return ""
    with page_style():
        figure = Figure(figsize=(10.6, 5.4), layout="constrained")
        for row, stage in zip(figure.subplots(2, 2, sharex=True), STAGES, strict=True):
            _draw_stage(row, stage, begun, smooth)
        for axes in figure.axes[2:]:
            axes.set_xlabel("load step")
        handles, labels = figure.axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper left", ncols=4, handlelength=2.6, columnspacing=1.4)
        return svg_text(figure, name)


def _draw_stage(row: Sequence[Axes], stage: str, runs: Sequence[Found], smooth: Sequence[Found]) -> None:
    """The force of a stage at the left; at the right the differences, in per cent of the largest force of isomortar."""
    left, right = row
    label, sign = _LABELS[stage]
    for run in smooth:
        if run.planned.mesh == "fine":
            left.plot(*_line(run, stage, sign), color="#B9BEC5", linewidth=2.6, label=f"{OWN}, {run.planned.kind} fine", zorder=1)
    for run in runs:
        colour, mark = _LOOKS[run.planned.program]
        fine = run.planned.mesh == "fine"
        drawn: dict[str, Any] = {"color": colour, "linestyle": "-" if fine else (0, (4, 2)), "linewidth": 1.3 if fine else 0.9}
        drawn |= {"marker": mark, "markersize": 3.6, "markerfacecolor": colour if fine else "white", "markeredgewidth": 0.8}
        left.plot(*_line(run, stage, sign), label=f"{run.planned.program} {run.planned.mesh}", **drawn)
    left.set_ylabel(label)
    own = next((run for run in runs if (run.planned.program, run.planned.mesh) == (OWN, "fine")), None)
    if own:
        steps, truth = _line(own, stage, sign)
        scale = float(np.abs(truth).max())
        for run in runs:
            if run.planned.mesh == "fine" and run is not own:
                colour, mark = _LOOKS[run.planned.program]
                values = _line(run, stage, sign)[1][: len(steps)]
                right.plot(steps[: len(values)], 100 * (values - truth[: len(values)]) / scale, color=colour, marker=mark, markersize=3.6)
        right.axhline(0.0, color=_LOOKS[OWN][0], linewidth=1.0, zorder=1)
        right.set_ylabel(f"fine: difference, % of {scale:.3g}")
    for axes in row:
        axes.xaxis.set_major_locator(MaxNLocator(integer=True, steps=(1, 2, 5, 10)))
        axes.grid(axis="y", color="#E3E6EA", linewidth=0.6)
        axes.set_axisbelow(True)


def _line(run: Found, stage: str, sign: float) -> tuple[FloatArray, FloatArray]:
    values = sign * run.curve(STAGES[stage])
    return np.arange(1.0, len(values) + 1), values
