"""The report of a run: one HTML page that needs nothing else, JUnit XML for machines that know it, JSON for all others."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict
from datetime import datetime
from itertools import groupby
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import jinja2
import numpy as np

from isomortar._frozen import frozen
from isomortar.harness import history, svg
from isomortar.harness.cases import Bound, Curve, Order
from isomortar.harness.compare import CHECK_STATES, Check, worst
from isomortar.harness.measurement import restored
from isomortar.harness.orders import Convergence
from isomortar.harness.runner import Result
from isomortar.harness.store import identity
from isomortar.results.files import write_whole

#: Cases with more numbers than this have them in narrow columns: two digits, a history only where it changed.
WIDE = 4
#: What comparison with a reference of a class can not do.
_WORTH = {"self": ": shows change, never correctness"}


@frozen
class Context:
    """What was run: tier, what alone of it ("family solid"; empty: all), seconds of the whole, time of its start, and the runs before.

    Of `runs` the present one is the last.
    """

    tier: str
    only: str
    seconds: float
    started: datetime
    runs: Sequence[history.Entry]


def write(path: Path, results: Sequence[Result], context: Context) -> None:
    """Write the page, and beside it the same as ``.xml`` (JUnit) and ``.json``."""
    write_whole(path, page(results, context))
    write_whole(path.with_suffix(".xml"), junit(results, context))
    write_whole(path.with_suffix(".json"), json.dumps(plain(as_data(results, context)), indent=1))


def as_data(results: Sequence[Result], context: Context) -> dict[str, Any]:
    """All of a run as plain data."""
    return {
        "started": context.started.isoformat(timespec="seconds"),
        "tier": context.tier,
        "only": context.only,
        "seconds": context.seconds,
        **identity(),
        "states": dict(Counter(result.state for result in results)),
        "left_out": left_out(results),
        "cells": [
            {
                "name": result.cell.name,
                "claim": result.cell.case.claim,
                "tier": result.cell.tier,
                "settings": result.cell.settings,
                "state": result.state,
                "checks": [asdict(check) for check in result.checks],
                "measurement": asdict(result.measurement),
            }
            for result in results
        ],
    }


def left_out(results: Sequence[Result]) -> list[str]:
    """Cells of the cases that a run measured, of which it left out others, as a higher tier: what is claimed speaks of them too."""
    run = {result.cell.name for result in results}
    cases = {result.cell.case.name: result.cell.case for result in results}
    return [cell.name for case in cases.values() for cell in case.cells if cell.name not in run]


def junit(results: Sequence[Result], context: Context) -> str:
    """JUnit XML: a suite a family, a test case a cell; only `passed` is a success."""
    root = ElementTree.Element("testsuites", name=" ".join(filter(None, ("isomortar verify", context.only))), time=f"{context.seconds:.3f}")
    for family, group in _by_family(results):
        bad = [r for r in group if r.state != "passed"]
        suite = ElementTree.SubElement(root, "testsuite", name=family, tests=str(len(group)), failures=str(len(bad)))
        for result in group:
            name, seconds = result.cell.name, f"{result.measurement.seconds:.3f}"
            item = ElementTree.SubElement(suite, "testcase", classname=family, name=name, time=seconds)
            if result.state != "passed":
                failure = ElementTree.SubElement(item, "failure", message=result.state)
                failure.text = "\n".join([*(sentence(check) for check in _bad(result)), result.measurement.message])
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="unicode", xml_declaration=True)


def sentence(check: Check) -> str:
    """A check in one line."""
    return f"{check.name}: {check.state}: {number(check.value)}, limit {check.limit}" + (f"; {check.found}" if check.found else "")


def number(value: float) -> str:
    """A number as people read it; a dash where there is none."""
    return f"{value:.4g}" if math.isfinite(value) else "-"


def percent(value: float) -> str:
    """A relative error as people read it."""
    if not math.isfinite(value):
        return "-"
    return f"{float(f'{100 * value:.3g}'):g} %"


def stated(value: float, in_percent: bool) -> str:
    """A number of a statement as people read it."""
    if not value or not math.isfinite(value):
        return f"{value:g}"
    return f"{100 * value:.3g} %" if in_percent and abs(value) >= 1e-6 else f"{value:.3g}"


def template(name: str, beside: Path = Path(__file__)) -> jinja2.Template:
    """A page by its name in the folder of a source file, or of this package, with what all pages say numbers and times by."""
    loader = jinja2.FileSystemLoader([beside.parent, Path(__file__).parent])
    environment = jinja2.Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    made = identity()
    environment.globals |= {"program": made["program"][:12], "kernel": made["kernel"][:12], "compiler": made["compiler"]}
    environment.filters["number"] = number
    environment.filters["stated"] = stated
    environment.filters["duration"] = duration
    environment.filters["size"] = size
    environment.filters["brief"] = lambda value: f"{value:.2g}" if math.isfinite(value) and abs(value) < 100 else number(value)
    return environment.get_template(name)


def page(results: Sequence[Result], context: Context) -> str:
    """The HTML page."""
    counts = Counter(result.state for result in results)
    return template("report.html").render(
        context=context,
        counts=[(state, counts[state]) for state in CHECK_STATES if counts[state]],
        total=len(results),
        left_out=len(left_out(results)),
        bad=[(result, _bad(result)) for result in _worst_first(results) if result.state != "passed"],
        only_change=sum(any(check.reference == "self" for check in result.checks) for result in results),
        families=[_family(name, group, context) for name, group in _by_family(results)],
        news=_news(results, context),
        reused=sum(not result.fresh for result in results),
    )


def _family(name: str, results: list[Result], context: Context) -> dict[str, Any]:
    cases = [list(group) for _, group in groupby(results, key=lambda r: r.cell.case.name)]
    passed = sum(result.state == "passed" for result in results)
    seconds = sum(result.measurement.seconds for result in results)
    memory = max(result.measurement.peak_memory for result in results)
    return {
        "name": name,
        "results": results,
        "passed": passed,
        "seconds": seconds,
        "memory": memory,
        "cases": [_case(c, context) for c in cases],
    }


def _case(results: list[Result], context: Context) -> dict[str, Any]:
    case = results[0].cell.case
    names = [*dict.fromkeys(check.name for result in results for check in result.checks)]
    return {
        "case": case,
        "about": (case.function.__doc__ or "").strip().split("\n\n")[0],
        "anchor": anchor(case.name),
        "passed": sum(r.state == "passed" for r in results),
        "total": len(results),
        "whole": len(case.cells),
        "state": worst(r.state for r in results),
        "seconds": sum(r.measurement.seconds for r in results),
        "bounds": _bounds(results, names),
        "names": names,
        "settings": list(case.grid),
        "wide": len(names) > WIDE,
        "memory": max(r.measurement.peak_memory for r in results),
        "rows": [_row(result, names, context) for result in results],
        "plots": [text for text in (_plot(results, name) for name in names) if text],
        "orders": any(check.order for result in results for check in result.checks),
        "tiers": sorted({r.cell.tier for r in results}),
    }


def _bounds(results: list[Result], names: list[str]) -> list[tuple[list[str], str, str]]:
    """Names, limit (the smallest and the largest where cells differ) and reason of the numbers of a case; like numbers together."""
    rows: dict[tuple[str, str], list[str]] = {}
    for name in names:
        checks = [check for result in results for check in result.checks if check.name == name]
        limits = sorted({check.limit for check in checks}, key=_size_of_limit)
        reasons = [*dict.fromkeys(check.reason for check in checks if check.reason)]
        reasons += [
            f"reference of class {kind}{_WORTH.get(kind, '')}" for kind in dict.fromkeys(c.reference for c in checks if c.reference)
        ]
        limit = limits[0] if len(limits) == 1 else f"{limits[0]} … {limits[-1]}"
        rows.setdefault((limit, "; ".join(reasons)), []).append(name)
    return [(together, limit, reason) for (limit, reason), together in rows.items()]


def _size_of_limit(limit: str) -> tuple[float, str]:
    """The number that a limit in words ends with; those without one come last."""
    try:
        return float(limit.rpartition(" ")[2]), limit
    except ValueError:
        return math.inf, limit


def _row(result: Result, names: list[str], context: Context) -> dict[str, Any]:
    checks = {check.name: check for check in result.checks}
    sparks = []
    for name in names:
        values = history.values_of(context.runs, result.cell.name, name)
        changes = _change_points(result, name, values)
        sparks.append(svg.sparkline(values, changes) if changes or len(names) <= WIDE else "")
    return {"result": result, "checks": [checks.get(name) for name in names], "sparks": sparks}


def _plot(results: list[Result], name: str) -> str:
    """All convergence sequences of a number in one plot, with the expected slope under each; or all its curves."""
    lines: list[svg.Line] = []
    labels = ("h", name, True, True)
    for result in results:
        value = result.measurement.numbers.get(name)
        short = ", ".join(str(v) for v in result.cell.settings.values())
        convergence, curve = restored(value, Convergence), restored(value, Curve)
        claim = result.cell.case.bounds_of(result.cell.settings).get(name)
        if convergence:
            sizes, errors = np.asarray(convergence.sizes, float), np.asarray(convergence.errors, float)
            if sizes.shape != errors.shape:
                continue
            lines.append(svg.Line(short, sizes, errors))
            if isinstance(claim, Order) and sizes.size:
                ends = sizes[[-1, max(-4, -sizes.size)]]
                lines.append(svg.Line("", ends, errors[-1] * (ends / ends[0]) ** claim.expected, guide=True))
        elif curve and np.shape(curve.x) == np.shape(curve.y):
            labels = (curve.x_label, curve.y_label, curve.log_x, curve.log_y)
            lines.append(svg.Line(short, np.asarray(curve.x, float), np.asarray(curve.y, float)))
    return svg.plot(lines, *labels)


def _news(results: Sequence[Result], context: Context) -> list[tuple[str, list[str]]]:
    """By case what is otherwise than when its cells were run before: states, and numbers that went to another level now."""
    found: dict[str, list[str]] = {}
    for result in results:
        name = result.cell.name
        earlier = next((run.cells[name] for run in reversed(context.runs[:-1]) if name in run.cells), None)
        if earlier is None:
            continue
        news = [f"{earlier['state']} → {result.state}"] if earlier["state"] != result.state else []
        for check in result.checks:
            values = history.values_of(context.runs, name, check.name)
            if len(values) - 1 in _change_points(result, check.name, values):
                news.append(f"{check.name} {number(values[-2])} → {number(values[-1])}")
        if news:
            where = f"{result.cell.label}: " if result.cell.settings else ""
            found.setdefault(result.cell.case.name, []).append(where + "; ".join(news))
    return list(found.items())


def _change_points(result: Result, name: str, values: Sequence[float]) -> list[int]:
    """Changes that mean something: those of an error far below its limit do not."""
    claim = result.cell.case.bounds_of(result.cell.settings).get(name)
    limit = claim.at_most if isinstance(claim, Bound) and claim.at_most is not None else 0.0
    return history.change_points(values, 0.02 * abs(limit))


def _worst_first(results: Sequence[Result]) -> list[Result]:
    return sorted(results, key=lambda result: -CHECK_STATES.index(result.state))


def _bad(result: Result) -> list[Check]:
    return [check for check in result.checks if check.state != "passed"]


def _by_family(results: Sequence[Result]) -> list[tuple[str, list[Result]]]:
    ordered = sorted(results, key=lambda r: r.cell.case.name)
    return [(family, list(group)) for family, group in groupby(ordered, key=lambda r: r.cell.case.family)]


def anchor(name: str) -> str:
    """A case's name as the target of a link."""
    return name.replace("/", "-")


def duration(seconds: float) -> str:
    """Seconds as people read them."""
    if seconds < 1:
        return f"{1000 * seconds:.0f} ms" if seconds >= 1e-3 else "< 1 ms"
    if seconds < 90:
        return f"{seconds:.1f} s"
    for length, unit in ((60.0, "min"), (3600.0, "h")):
        if seconds < 90 * length:
            return f"{seconds / length:.0f} {unit}"
    return f"{seconds / 86400:.0f} days"


def size(memory: float) -> str:
    """Bytes as people read them; nothing where they are not known."""
    return f"{memory / 1e6:.0f} MB" if memory else ""


def plain(value: Any) -> Any:
    """Plain data with null for numbers that are not finite, which JSON has no word for."""
    if isinstance(value, dict):
        return {name: plain(entry) for name, entry in value.items()}
    if isinstance(value, list | tuple):
        return [plain(entry) for entry in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
