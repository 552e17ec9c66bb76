"""Curves, spurious work and tangents of a scene by way, and what refinement makes of the first two, as SVG text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from masters.found import Found
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, NullFormatter
from paper.figures.curves import Line, draw

from isomortar.harness.figures import look, page_style, svg_text

_WORK = "spurious over friction work, %"


def curves(runs: Sequence[Found], reference: Found, title: str) -> str:
    """The curves of runs of which something converged, and how far they are off the reference, which is one of them."""
    lines = [
        Line(_label(run), run.by_step("step"), run.outcome.curve, run.planned.variant.kind, run is reference and not run.words)
        for run in runs
        if run.outcome.steps
    ]
    return draw(lines, title, runs[0].planned.section.quantity.label).html if lines else ""


def costs(runs: Sequence[Found], name: str) -> str:
    """Spurious work up to each load step over all friction work, along averaged normals, and tangents of each, of all runs."""
    with page_style():
        figure = Figure(figsize=(10.6, 3.3), layout="constrained")
        work, tangents = figure.subplots(1, 2)
        for run in runs:
            steps = run.by_step("step")
            looks = _look(run)
            if run.method == "averaged":
                work.plot(steps, 100.0 * run.shares, **looks)
            tangents.plot(steps, run.by_step("factorisations"), label=_label(run), **looks)
        work.set(ylabel=_WORK)
        tangents.set(ylabel="tangents", ylim=(0.0, None))
        for axes in (work, tangents):
            axes.set_xlabel("load step")
            axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        figure.legend(*tangents.get_legend_handles_labels(), loc="outside upper left", ncols=6, handlelength=2.6)
        return svg_text(figure, f"{name}-costs")


def refinement(pairs: Sequence[tuple[Found, Found]]) -> str:
    """Shares of spurious work, and how far means are off those of a smooth master of the same elements, over elements along the drag."""
    with page_style():
        figure = Figure(figsize=(7.2, 3.3), layout="constrained")
        elements = [kinks.planned.variant.elements[0] for kinks, _ in pairs]
        found = {_WORK: [abs(kinks.share) for kinks, _ in pairs], "mean off that of N2, %": [kinks.off(smooth) for kinks, smooth in pairs]}
        for axes, (label, values) in zip(figure.subplots(1, 2), found.items(), strict=True):
            axes.margins(y=0.1)
            axes.semilogx(elements, 100.0 * np.array(values), **look("L1"))
            axes.set(xlabel="elements of the master along the drag", ylabel=label, xticks=elements, xticklabels=elements, ylim=(0.0, None))
            axes.xaxis.set_minor_formatter(NullFormatter())
        return svg_text(figure, "refinement")


def _label(run: Found) -> str:
    u, v, _ = run.planned.variant.elements
    feet = run.method.removeprefix("smooth").removeprefix(", ")
    return ", ".join(filter(None, (run.planned.variant.kind, feet, f"{u} x {v}")))


def _look(run: Found) -> dict[str, Any]:
    """By kind; closest points on kinks are dotted."""
    return look(run.planned.variant.kind) | {"markersize": 2.6, "linewidth": 1.0} | ({"linestyle": ":"} if run.method == "closest" else {})
