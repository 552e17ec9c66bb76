"""The page of the ways of enforcement: statements, curves, every run with its error and its cost; all numbers as JSON."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from enforcement import exact
from enforcement.figures import curves, tractions
from enforcement.figures import exact as drawn
from enforcement.found import Found, Known
from enforcement.known import INSIDE, KIND, SCENES
from enforcement.plan import MORTAR, REFERENCE, WAYS
from enforcement.recommend import advice

from isomortar.harness.runner import Result
from isomortar.harness.runs import groups, written
from isomortar.harness.statement import Judgement
from isomortar.harness.study import Conclusion


def write(
    folder: Path,
    cells: Sequence[Result],
    known: Sequence[Known],
    runs: Sequence[Found],
    judgements: Sequence[Judgement],
    started: datetime,
) -> Conclusion:
    """Write ``report.html`` and ``report.json``."""
    every = groups(runs, lambda run: run.planned.setup.name)
    sections = [_section(group) for group in every if not group[0].planned.setup.order]
    rows_of_orders = [row for group in every if group[0].planned.setup.order for row in _section(group)["rows"]]
    table = exact.table(cells)
    scenes = [_known([run for run in group if run.kind == KIND]) for group in groups(known, lambda run: run.name)]
    kinds = [_traction(run) | {"kind": run.kind} for run in known]
    advised = advice(runs, known, table)
    data = {
        "advice": [vars(entry) for entry in advised],
        "scenes": [section["rows"] for section in sections],
        "known": [scene["rows"] for scene in scenes],
        "known_by_kind": kinds,
        "by_kind": rows_of_orders,
        "sizes": exact.sizes(),
        "exact": table,
        "refused": exact.refused(cells),
    }
    everything = [*map(exact.Exact, cells), *known, *runs]
    more = {
        "exact": table,
        "exact_figure": drawn(table),
        "known": scenes,
        "inside": INSIDE,
        "advice": advised,
        "refused": data["refused"],
        "sizes": data["sizes"],
        "by_kind": [*_by_kind(kinds), *_by_kind(rows_of_orders)],
    }
    return written(Path(__file__), folder, everything, judgements, started, tuple(WAYS), sections, data, more)


def _by_kind(rows: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """By scene: kinds of discretisation, and of every way its rows in their order; None where there is none."""
    tables = []
    for scene in dict.fromkeys(row["scene"] for row in rows):
        own = {(row["way"], row["kind"]): row for row in rows if row["scene"] == scene and row["way"] != REFERENCE}
        kinds = list(dict.fromkeys(kind for _, kind in own))
        ways = [way for way in dict.fromkeys(way for way, _ in own) if sum((way, kind) in own for kind in kinds) > 1]
        tables.append({"scene": scene, "kinds": kinds, "rows": {way: [own.get((way, kind)) for kind in kinds] for way in ways}})
    return tables


def _known(runs: Sequence[Known]) -> dict[str, Any]:
    """What the page shows of a scene whose tractions are known."""
    rows = [_traction(run) for run in runs]
    figure = tractions([run for run in runs if run.ending == "measured"], runs[0].name)
    return {
        "title": SCENES[runs[0].name],
        "figure": figure,
        "rows": rows,
        "best": min((run.number("off") for run in runs if np.isfinite(run.number("off"))), default=np.nan),
    }


def _traction(run: Known) -> dict[str, Any]:
    numbers = ("missing", "off", "peak", "roughness", "solves", "cuts", "cpu_seconds")
    return {"scene": run.name, "way": run.method, "ending": run.ending, "words": run.words} | {name: run.number(name) for name in numbers}


def _section(runs: Sequence[Found]) -> dict[str, Any]:
    """What the page shows of a scene."""
    reference, *others = runs
    setup = reference.planned.setup
    best = min((run.off(reference) for run in others if np.isfinite(run.off(reference))), default=np.nan)
    return {
        "setup": setup,
        "figure": curves(others, reference, setup.name) if len(reference.curve) else "",
        "best": best,
        "rows": [_row(run, reference, next(other for other in others if other.method == MORTAR)) for run in runs],
    }


def _row(run: Found, reference: Found, mortar: Found) -> dict[str, Any]:
    scene, _, kind = run.name.partition(" ")
    return {
        "scene": scene if run.planned.setup.order else run.name,
        "kind": kind,
        "way": run.method,
        "ending": run.ending,
        "words": run.words,
        "off": 0.0 if run.method == REFERENCE else run.off(reference),
        "off_mortar": np.nan if run.method == REFERENCE else run.off(mortar),
        "peak": run.peaks[-1] if len(run.peaks) else np.nan,
        "roughness": run.roughness,
        "missing": run.number("missing"),
        **{name: run.number(name) for name in ("constraints", "control_points", "solves", "cuts", "cpu_seconds")},
    }
