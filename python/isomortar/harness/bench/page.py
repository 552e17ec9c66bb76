"""A run of benchmarks as it is stored: ``bench.json``, and the page, one HTML file that needs nothing else."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from isomortar.harness import report, svg
from isomortar.harness.bench.declaration import ASIDE, NOTE, Benchmark, Plot, Row
from isomortar.harness.bench.history import Trend, label, read
from isomortar.harness.bench.processes import Answer
from isomortar.harness.bench.record import HISTORY, Record, as_data
from isomortar.harness.bench.standings import LIMIT_STATES, standings, state
from isomortar.harness.history import change_points
from isomortar.results.files import write_whole

PAGE, DATA = "bench.html", "bench.json"


def keep(folder: Path, record: Record) -> None:
    """Write page and data of a run, each whole."""
    trends = {answer.benchmark.name: read(folder / HISTORY, answer.benchmark.name) for answer in record.answers}
    write_whole(folder / DATA, json.dumps(report.plain(as_data(record)), indent=1))
    write_whole(folder / PAGE, page(record, trends))


def page(record: Record, trends: Mapping[str, Trend]) -> str:
    """The HTML page; `trends` are the last runs of each benchmark, by its name."""
    judged = [standing for answer in record.answers for standing in standings(answer)]
    return report.template("bench/page.html").render(
        record=record,
        sections=[_section(answer, trends[answer.benchmark.name]) for answer in record.answers],
        failed=[answer.benchmark.name for answer in record.answers if answer.failed],
        counts=[(kind, sum(v.state == kind for v in judged)) for kind in LIMIT_STATES],
    )


def slope(x: Sequence[float], y: Sequence[float]) -> float:
    """Slope of the straight line through points on logarithmic axes (least squares); NaN with fewer than two."""
    points = np.array([(a, b) for a, b in zip(x, y, strict=True) if a > 0 and b > 0 and math.isfinite(a * b)])
    if len(points) < 2 or np.ptp(points[:, 0]) == 0.0:
        return math.nan
    return float(np.polyfit(np.log(points[:, 0]), np.log(points[:, 1]), 1)[0])


def text(value: object) -> str:
    """An entry of a row as people read it."""
    return report.number(value) if isinstance(value, float) else str(value)


def headings(benchmark: Benchmark) -> list[str]:
    """Names of the columns with their units."""
    return [f"{name}, {unit}" if unit else name for name, unit in benchmark.columns.items()]


def _section(answer: Answer, trend: Trend) -> dict[str, Any]:
    benchmark = answer.benchmark
    return {
        "answer": answer,
        "benchmark": benchmark,
        "headings": headings(benchmark),
        "numeric": [
            all(row.get(name) == ASIDE or not isinstance(row.get(name, 0), str) for row in answer.rows) for name in benchmark.columns
        ],
        "rows": [
            {"cells": [_cell(row, name, benchmark, trend) for name in benchmark.columns], "note": row.get(NOTE)} for row in answer.rows
        ],
        "noted": any(NOTE in row for row in answer.rows),
        "plots": [drawn for drawn in (_plot(answer, plot) for plot in benchmark.plots) if drawn],
        "standings": standings(answer),
        "runs": len(trend.runs),
    }


def _cell(row: Row, name: str, benchmark: Benchmark, trend: Trend) -> dict[str, str]:
    """A value, how it stands to its limit, and its trend where it is one that matters: limited or plotted."""
    if name not in row:
        return {"text": "", "state": "", "spark": ""}
    value = row[name]
    found = state(value, benchmark.limits[name][0]) if name in benchmark.limits and value != ASIDE else ""
    matters = isinstance(value, float) and (name in benchmark.limits or any(plot.y == name for plot in benchmark.plots))
    values = trend.values(label(row), name) if matters else []
    return {"text": text(value), "state": found, "spark": svg.sparkline(values, change_points(values))}


def _plot(answer: Answer, plot: Plot) -> str:
    """A column over another, each line with its slope."""
    rows = [row for row in answer.rows if all(not isinstance(row.get(name, ""), str) for name in (plot.x, plot.y))]
    lines = []
    for kind in dict.fromkeys(row.get(plot.by, "") for row in rows):
        of_kind = sorted((float(row[plot.x]), float(row[plot.y])) for row in rows if row.get(plot.by, "") == kind)
        x, y = ([point[axis] for point in of_kind] for axis in (0, 1))
        steepness = slope(x, y)
        said = f"slope {steepness:.2f}" if math.isfinite(steepness) else ""
        lines.append(svg.Line(": ".join(filter(None, (str(kind), said))), np.array(x), np.array(y)))
    names = dict(zip(answer.benchmark.columns, headings(answer.benchmark), strict=True))
    return svg.plot(lines, names[plot.x], names[plot.y])
