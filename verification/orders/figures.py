"""Figures of the report, as SVG text."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import groupby

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter
from orders.analysis import Analysis, Point, curve

from isomortar.accuracy.discretisations import Discretisation, parse_kind
from isomortar.harness.figures import look, page_style, svg_text
from isomortar.results import style

_COSTS: tuple[tuple[str, Callable[[Point], float]], ...] = (
    ("unknowns", lambda p: p.unknowns),
    ("CPU seconds", lambda p: p.numbers["cpu_seconds"]),
    ("tangents", lambda p: p.numbers["tangents"]),
)


def error_against_cost(analysis: Analysis, measure: str) -> str:
    """Error in per cent, and below which it says nothing, against unknowns, CPU seconds and tangents."""
    with page_style():
        figure, panels = _against_cost(analysis, lambda point: 100 * point.errors[measure], f"error of the {measure}, %")
        _floor(panels, 100 * analysis.uncertainty[measure])
        return svg_text(figure, f"cost-{measure}")


def roughness_against_cost(analysis: Analysis, measure: str) -> str:
    """Second-difference energy of a curve over that of the reference, against unknowns, CPU seconds and tangents."""
    with page_style():
        figure, panels = _against_cost(analysis, lambda point: point.roughness[measure], f"roughness of the {measure}")
        for axes in panels:
            axes.axhline(1.0, color=style.GREY, linewidth=0.8, zorder=1)
        return svg_text(figure, f"roughness-{measure}")


def _against_cost(analysis: Analysis, value: Callable[[Point], float], label: str) -> tuple[Figure, list[Axes]]:
    """A line a kind (h-refinement), grey lines for orders on one mesh (k-refinement)."""
    figure = Figure(figsize=(10.6, 3.5), layout="constrained")
    panels = list(figure.subplots(1, 3, sharey=True))
    for axes, (name, cost) in zip(panels, _COSTS, strict=True):
        axes.set(xscale="log", yscale="log", xlabel=name)
        for mesh in _k_lines(analysis):
            axes.plot([cost(p) for p in mesh], [value(p) for p in mesh], color="#B9BEC5", linewidth=0.9, zorder=1)
        for kind in analysis.plan.kinds:
            points = [p for p in analysis.sequence(kind) if p.errors]
            axes.plot([cost(p) for p in points], [value(p) for p in points], label=kind, **look(kind))
        _ticks(axes)
    panels[0].set_ylabel(label)
    _legend(figure, panels[0])
    return figure, panels


def curves_overlaid(analysis: Analysis) -> Iterator[tuple[str, str]]:
    """Name and figure of each component that is not round-off: the curves on the scene's own mesh, and how far off the reference."""
    supports = [s.name for s in analysis.plan.scene.problem().supports if s.moves]
    for measure in analysis.curves:
        reference = curve(analysis.reference.numbers, measure)
        for column in np.flatnonzero(np.abs(reference).max(axis=0) > 1e-3 * np.abs(reference).max()):
            name = f"{measure} {'xyz'[column % 3]}" + (f" at {supports[column // 3]}" if len(supports) > 1 else "")
            yield name, _overlay(analysis, measure, int(column), name)


def pressures(analysis: Analysis) -> str:
    """The pressure at the end on the scene's own mesh by kind, and that of the reference, laid flat."""
    shown = [(d.label, p) for d, p in _own_mesh(analysis)] + [("reference", analysis.reference)]
    cells = analysis.plan.grids()[0].shape
    turned = cells[0] < cells[1]
    peak = float(np.max(analysis.reference.numbers["pressure"]))
    digits = f"z.{max(0, 2 - math.floor(math.log10(peak)))}f"
    with page_style():
        rows = math.ceil(len(shown) / 6)
        columns = math.ceil(len(shown) / rows)
        figure = Figure(figsize=(10.6, (2.35 if max(cells) < 3 * min(cells) else 1.3) * rows), layout="constrained")
        panels = figure.subplots(rows, columns, squeeze=False).ravel()
        for axes in panels:
            axes.set_axis_off()
        for axes, (label, point) in zip(panels, shown, strict=False):
            field = np.asarray(point.numbers["pressure"]).reshape(cells[1], cells[0])
            field = np.where(np.abs(field) < 1e-9 * peak, 0.0, field)
            image = axes.imshow(field.T if turned else field, origin="lower", cmap=style.pressure_colours(), vmin=0.0, vmax=peak)
            axes.set_title(f"{label}\n{field.min():{digits}} to {field.max():{digits}}", fontsize=8.5)
        figure.colorbar(image, ax=panels, shrink=0.8, extend="both", label="contact pressure")
        return svg_text(figure, "pressures")


def _overlay(analysis: Analysis, measure: str, column: int, name: str) -> str:
    reference = curve(analysis.reference.numbers, measure)[:, column]
    times = analysis.reference.numbers["time"]
    scale = float(np.abs(reference).max())
    with page_style():
        figure = Figure(figsize=(10.6, 3.8), layout="constrained")
        left, right = figure.subplots(1, 2)
        left.plot(times, reference, color=style.BLACK, linewidth=2.4, label="reference", zorder=1)
        for chosen, point in _own_mesh(analysis):
            values = curve(point.numbers, measure)[:, column]
            drawn = look(chosen.kind) | {"markersize": 3.2 if len(times) <= 25 else 0.0, "linewidth": 1.1}
            left.plot(point.numbers["time"], values, label=chosen.kind, **drawn)
            right.plot(times, 100 * (values - reference) / scale, **drawn)
        right.axhline(0.0, color=style.BLACK, linewidth=0.8, zorder=1)
        left.set(xlabel="load time (steps)", ylabel=name)
        right.set(xlabel="load time (steps)", ylabel=f"difference from the reference, % of {scale:.3g}")
        _stage_lines((left, right), analysis.reference)
        _legend(figure, left)
        return svg_text(figure, f"curve-{measure}-{column}")


def _own_mesh(analysis: Analysis) -> list[tuple[Discretisation, Point]]:
    """Of each kind the run on the scene's own mesh, where it came to its end."""
    chosen = [analysis.plan.own_mesh(kind) for kind in analysis.plan.kinds]
    return [(d, analysis.points[d]) for d in chosen if not analysis.points[d].failure]


def _k_lines(analysis: Analysis) -> list[list[Point]]:
    """NURBS runs on the same elements, by order."""
    nurbs = sorted((order, kind) for kind in analysis.plan.kinds for family, order in (parse_kind(kind),) if family == "N")
    points = [p for _, kind in nurbs for p in analysis.sequence(kind) if p.errors]
    points.sort(key=lambda p: p.discretisation.elements)
    return [list(group) for _, group in groupby(points, key=lambda p: p.discretisation.elements)]


def _floor(panels: list[Axes], uncertainty: float) -> None:
    """Grey below the reference's uncertainty, where that is within sight."""
    low, high = panels[0].get_ylim()
    bottom = min(low, max(low / 3, uncertainty / 2))
    if uncertainty <= bottom:
        return
    for axes in panels:
        axes.axhspan(bottom, min(uncertainty, high), color="#E9EBEE", linewidth=0, zorder=0)
    panels[0].set_ylim(bottom, high)
    panels[0].text(0.02, 0.02, "grey: within the reference's uncertainty", transform=panels[0].transAxes, fontsize=7.5, color="#5C6670")


def _stage_lines(panels: tuple[Axes, ...], point: Point) -> None:
    times, stages = np.asarray(point.numbers["time"]), np.asarray(point.numbers["stage"])
    for axes in panels:
        for end in times[np.flatnonzero(np.diff(stages))]:
            axes.axvline(end, color="#C9CDD3", linewidth=0.8, zorder=0)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True, steps=(1, 2, 5, 10)))
        axes.grid(axis="y", color="#E3E6EA", linewidth=0.6)
        axes.set_axisbelow(True)


def _ticks(axes: Axes) -> None:
    """Plain numbers, also within a decade."""
    for axis in (axes.xaxis, axes.yaxis):
        low, high = axis.get_view_interval()
        axis.set_major_formatter("{x:g}")
        within = (1.0, 1.5, 2.0, 3.0, 5.0, 7.0) if high / low < 8 else (1.0, 2.0, 5.0) if high / low < 300 else (1.0,)
        axis.set_major_locator(LogLocator(subs=within, numticks=10) if high / low > 2.5 else MaxNLocator(4, steps=(1, 2, 5, 10)))
        axis.set_minor_formatter(NullFormatter())
    axes.grid(color="#E9EBEE", linewidth=0.6)
    axes.set_axisbelow(True)


def _legend(figure: Figure, axes: Axes) -> None:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper left", ncols=len(labels), handlelength=2.6, columnspacing=1.4)
