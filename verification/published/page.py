"""The page of published benchmarks: every quantity with its uncertainty beside what is known of it, and the curves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from published.benchmark import Benchmark, Beside, Drawing, Quantity
from published.others import OWN, PROGRAMS

from isomortar.harness.figures import look, page_style, svg_text
from isomortar.harness.report import template
from isomortar.harness.runner import Result
from isomortar.harness.study import Conclusion
from isomortar.results import style
from isomortar.results.files import write_whole

#: Numbers of a case by discretisation.
Found = Mapping[str, Mapping[str, Any]]
_MARKS = "osD^vP"


def write(folder: Path, benchmarks: Sequence[Benchmark], results: Sequence[Result], started: datetime) -> Conclusion:
    """Write ``published.html``."""
    others = {result.cell.settings["run"]: result for result in results if result.cell.case.function.__name__ == "by_program"}
    sections = [
        _section(benchmark, [result for result in results if _of(result, benchmark)]) | {"others": _others(benchmark, others)}
        for benchmark in benchmarks
    ]
    path = folder / "published.html"
    failed = sum(result.state not in ("passed", "skipped") for result in results)
    missing = sorted({result.measurement.reason for result in results if result.state == "skipped"})
    told = {"started": started, "failed": failed, "missing": missing, "total": len(results)}
    text = template("page.html", Path(__file__)).render(sections=sections, **told)
    write_whole(path, text)
    return Conclusion(path, failed, not failed, f"{len(benchmarks)} benchmarks, {len(results)} runs")


def _of(result: Result, benchmark: Benchmark) -> bool:
    """Whether it is a run of a benchmark."""
    settings = {name: value for name, value in result.cell.settings.items() if name != "mesh"}
    return result.cell.case.function.__name__ == benchmark.case and settings == benchmark.settings


def _section(benchmark: Benchmark, results: Sequence[Result]) -> dict[str, Any]:
    found: Found = {r.cell.settings["mesh"]: r.measurement.numbers for r in results if r.measurement.ending == "measured"}
    return {
        "benchmark": benchmark,
        "rows": [_row(quantity, benchmark, found) for quantity in benchmark.quantities],
        "figures": [_drawn(drawing, benchmark, found) for drawing in benchmark.drawings],
        "runs": [(r.cell.settings["mesh"], r.state, r.measurement.reason, r.measurement.cpu_seconds) for r in results],
    }


def _others(benchmark: Benchmark, results: Mapping[str, Result]) -> list[dict[str, Any]]:
    """What became of the benchmark by each program: its numbers, and how much more they are than ours on the same elements."""
    if not isinstance(beside := benchmark.beside, Beside):
        return []
    rows: list[dict[str, Any]] = []
    own: Mapping[str, Any] = {}
    for kind, program in ((kind, program) for kind in beside.kinds for program in PROGRAMS):
        result = results.get(f"{benchmark.name} {kind} {program}")
        numbers: Mapping[str, Any] = result.measurement.numbers if result and result.measurement.ending == "measured" else {}
        own = numbers if program == OWN else own
        reason = result.measurement.reason if result and not numbers else beside.stops.get(f"{kind} {program}", "")
        off = {name: numbers[name] / own[name] - 1.0 for name in beside.within if program != OWN and numbers and own}
        state = result.state if result else "not run"
        rows.append({"kind": kind, "program": program, "state": state, "reason": reason, "numbers": numbers, "off": off})
    return rows


def _row(quantity: Quantity, benchmark: Benchmark, found: Found) -> dict[str, Any]:
    """A quantity: our value by the finest discretisation, how far the next one is off it, all others, and what is known."""
    values = {mesh: float(numbers[quantity.name]) for mesh, numbers in found.items() if quantity.name in numbers}
    first, second = (values.get(mesh, np.nan) for mesh in benchmark.finest)
    known = [(known.source, known.value, known.value / first - 1.0) for known in quantity.known]
    return {"quantity": quantity, "value": first, "uncertainty": abs(second - first), "known": known, "values": values}


def _drawn(drawing: Drawing, benchmark: Benchmark, found: Found) -> str:
    """All discretisations, the finest in black, and published points."""
    with page_style():
        figure = Figure(figsize=(9.6, 3.9), layout="constrained")
        axes = figure.subplots()
        for mesh, numbers in found.items():
            finest = mesh == benchmark.finest[0]
            looks = look(mesh.split()[0]) | {"marker": "", "linewidth": 1.8 if finest else 0.8}
            looks |= {"color": "black", "zorder": 4} if finest else {"linestyle": "-" if "fine" in mesh else ":"}
            axes.plot(numbers[drawing.x], numbers[drawing.y], label=mesh, **looks)
        for mark, (source, rows) in zip(_MARKS, drawing.points.items(), strict=False):
            axes.plot(*rows.T, mark, label=source, markersize=4.0, color=style.GREY, markerfacecolor="white", zorder=5)
        axes.set(xlabel=drawing.x_label, ylabel=drawing.y_label, **({"xscale": "log", "yscale": "log"} if drawing.log else {}))
        figure.legend(loc="outside right upper")
        return svg_text(figure, f"{benchmark.name}-{drawing.y}")
