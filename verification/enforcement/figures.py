"""Curves of the ways of enforcement, their distance from the reference against cost, and what is exact of them, as SVG text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from analytic.mindlin import CONTACT
from enforcement.contact import IN_CELLS
from enforcement.exact import TESTS
from enforcement.found import Found, Known
from enforcement.patches import ROWS
from enforcement.plan import REFERENCE
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, NullFormatter
from patch_tests.contact import ORDERS

from isomortar.harness.figures import page_style, svg_text
from isomortar.results import style

#: Colour by method, line by what is changed of it, mark of each.
LOOKS = {
    "mortar": (style.BLUE, "-", "o"),
    "mortar, averaged": (style.BLUE, "--", "s"),
    "mortar, swapped": ("#5E6B7A", ":", "D"),
    "mortar, two passes": ("#5E6B7A", "-.", "d"),
    IN_CELLS: (style.BLUE, ":", "D"),
    "mortar, elastic slip": ("#4FA3C7", "-.", "P"),
    "mortar, smooth": ("#4FA3C7", "--", "<"),
    "dual": ("#B04A7A", "-", "h"),
    "dual, averaged": ("#B04A7A", "--", "p"),
    "greville": (style.GREEN, "-", "^"),
    "greville, averaged": (style.GREEN, "--", "v"),
    "demko": ("#8C6BB1", "-", "P"),
    "demko, averaged": ("#8C6BB1", "--", ">"),
    "knots": (style.VERMILION, "-", "X"),
    "knots, averaged": (style.VERMILION, "--", "x"),
    "kts": ("#B8860B", "-", "*"),
    "kts, averaged": ("#B8860B", "--", "+"),
}


def curves(runs: Sequence[Found], reference: Found, name: str) -> str:
    """The curve of a scene by every way over the load steps, and their distances from the reference against CPU seconds."""
    with page_style():
        figure = Figure(figsize=(10.6, 4.2), layout="constrained")
        left, right = figure.subplots(1, 2)
        setup = reference.planned.setup
        left.plot(1 + np.arange(len(reference.curve)), reference.curve, color="#B9BEC5", linewidth=4.0, label=REFERENCE)
        for run in runs:
            colour, line, mark = LOOKS[run.planned.way]
            left.plot(
                1 + np.arange(len(run.curve)),
                run.curve,
                color=colour,
                linestyle=line,
                marker=mark,
                markersize=3.4,
                linewidth=1.1,
                label=run.planned.way,
            )
            off = run.off(reference)
            if np.isfinite(off):
                right.loglog(run.number("cpu_seconds"), 100.0 * off, mark, color=colour, label=run.planned.way)
        left.xaxis.set_major_locator(MaxNLocator(integer=True))
        left.set(xlabel="load step", ylabel=f"{setup.quantity} {'xyz'[setup.component]}")
        for axis in (right.xaxis, right.yaxis):
            axis.set_major_formatter(lambda value, _: f"{value:g}")
            axis.set_minor_formatter(NullFormatter())
        right.set(xlabel="CPU seconds", ylabel="distance from the reference, %")
        handles, labels = left.get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper left", ncols=5, handlelength=2.6, columnspacing=1.4)
        return svg_text(figure, name)


def tractions(runs: Sequence[Known], name: str) -> str:
    """Tractions across the contact beside the exact ones, and their distance from these against CPU seconds."""
    if not runs:
        return ""
    with page_style():
        figure = Figure(figsize=(10.6, 4.2), layout="constrained")
        left, right = figure.subplots(1, 2, width_ratios=(3, 2))
        theory = runs[0]
        left.plot(theory.curves("places") / CONTACT, theory.curves("exact"), color="#B9BEC5", linewidth=4.0, label="theory")
        for run in runs:
            colour, line, mark = LOOKS[run.method]
            look = {"color": colour, "marker": mark, "markersize": 3.4, "label": run.method}
            left.plot(run.curves("places") / CONTACT, run.curves("values"), linestyle=line, linewidth=1.1, **look)
            right.loglog(run.number("cpu_seconds"), 100.0 * run.number("off"), linestyle="", **look)
        left.set(xlabel="x over the contact radius", ylabel="traction", xlim=(-1.3, 1.3), ylim=(-0.1, 1.5))
        right.set(xlabel="CPU seconds", ylabel="distance from theory, %")
        for axis in (right.xaxis, right.yaxis):
            axis.set_major_formatter(lambda value, _: f"{value:g}")
            axis.set_minor_formatter(NullFormatter())
        handles, labels = left.get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper left", ncols=5, handlelength=2.6, columnspacing=1.4)
        return svg_text(figure, name)


def exact(rows: Sequence[Mapping[str, Any]]) -> str:
    """Errors of the patch test on both meshes, inf-sup constants and conditions over the order."""
    with page_style():
        figure = Figure(figsize=(10.6, 3.6), layout="constrained")
        shown = {
            "matching": "error, matching meshes",
            "other": "error, other meshes",
            "curved": "error, curved",
            "inf-sup": "inf-sup constant",
            "condition": "condition",
        }
        errors, others, curved, stable, condition = figure.subplots(1, 5)
        others.sharey(errors)
        curved.sharey(errors)
        for axes, (key, label) in zip((errors, others, curved, stable, condition), shown.items(), strict=True):
            for method in ROWS:
                if key in TESTS or method != IN_CELLS:
                    colour, line, mark = LOOKS[method]
                    values = [row[key] for row in rows if row["method"] == method]
                    axes.plot(ORDERS, values, color=colour, linestyle=line, marker=mark, markersize=4.2, linewidth=1.1, label=method)
            axes.set(xlabel="order", ylabel=label, xticks=ORDERS, yscale="linear" if key == "inf-sup" else "log")
        stable.set_ylim(bottom=0.0)
        handles, labels = errors.get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper left", ncols=6, handlelength=2.6, columnspacing=1.4)
        return svg_text(figure, "exact")
