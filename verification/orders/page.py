"""The report of a study: one HTML page that needs nothing else, and all its numbers as JSON."""

from __future__ import annotations

import json
from dataclasses import asdict
from datetime import datetime
from pathlib import Path
from typing import Any

from orders import figures
from orders.analysis import CURVES, Analysis, Point
from orders.finding import summary

from isomortar.harness.report import percent, plain, template
from isomortar.harness.store import identity
from isomortar.results.files import write_whole


def write(folder: Path, analysis: Analysis, started: datetime) -> Path:
    """Write ``report.html`` and ``report.json``; returns the path of the page."""
    path = folder / "report.html"
    write_whole(path, page(analysis, started))
    write_whole(path.with_suffix(".json"), json.dumps(plain(as_data(analysis, started)), indent=1))
    return path


def as_data(analysis: Analysis, started: datetime) -> dict[str, Any]:
    """All numbers of the report as plain data."""
    plan = analysis.plan
    return {
        "scene": plan.scene.name,
        "started": started.isoformat(timespec="seconds"),
        **identity(),
        "sweep": asdict(plan.sweep),
        "share_of_elements": plan.share,
        "reference": {"runs": [d.label for d in plan.reference], "uncertainty": analysis.uncertainty},
        "runs": [_run(point) for point in analysis.points.values()],
        "orders": {kind: {name: asdict(order) for name, order in orders.items()} for kind, orders in analysis.verdicts.items()},
        "refinement": [asdict(step) for step in analysis.steps],
        "finding": summary(analysis) if analysis.reference.errors else [],
    }


def page(analysis: Analysis, started: datetime) -> str:
    """The HTML page."""
    plan, done = analysis.plan, bool(analysis.reference.errors)
    return template("page.html", Path(__file__)).render(
        analysis=analysis,
        plan=plan,
        started=started,
        done=done,
        finding=summary(analysis) if done else [],
        groups=_groups(analysis),
        costs=[(m, figures.error_against_cost(analysis, m)) for m in analysis.measures] if done else [],
        roughness=[(m, figures.roughness_against_cost(analysis, m)) for m in analysis.rough] if done else [],
        curves=list(figures.curves_overlaid(analysis)) if done else [],
        pressures=figures.pressures(analysis) if done and "pressure" in analysis.measures else "",
        seconds=sum(p.numbers["cpu_seconds"] for p in analysis.points.values() if not p.failure),
        percent=percent,
        settings=plan.scene.problem().settings,
    )


def _groups(analysis: Analysis) -> list[dict[str, Any]]:
    """Rows of the table, by kind; at the end what only the reference needed."""
    plan = analysis.plan
    groups: list[dict[str, Any]] = [{"kind": kind, "points": [analysis.points[mesh] for mesh in plan.meshes(kind)]} for kind in plan.kinds]
    shown = {mesh for kind in plan.kinds for mesh in plan.meshes(kind)}
    rest = [analysis.points[mesh] for mesh in plan.reference if mesh not in shown]
    return [*groups, {"kind": "", "points": rest}]


def _run(point: Point) -> dict[str, Any]:
    chosen = point.discretisation
    row: dict[str, Any] = {"kind": chosen.kind, "elements": list(chosen.elements), "failure": point.failure or None}
    if point.failure:
        return row
    scalars = {name: point.numbers[name] for name in ("control_points", "tangents", "cuts", "cpu_seconds")}
    curves = {name: point.numbers[name] for name in ("time", *CURVES)}
    return row | scalars | {"unknowns": point.unknowns, "errors": point.errors, "roughness": point.roughness, "floor": point.floor} | curves
