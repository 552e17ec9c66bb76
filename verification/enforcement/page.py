"""The page of the ways of enforcement: statements, curves, every run with its error and its cost; all numbers as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from enforcement import exact
from enforcement.contact import IN_CELLS
from enforcement.figures import curves, tractions
from enforcement.figures import exact as drawn
from enforcement.found import Found, Known
from enforcement.known import INSIDE, SCENES
from enforcement.plan import REFERENCE, WAYS
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
    sections = [_section(group) for group in groups(runs, lambda run: run.planned.setup.name)]
    table = exact.table(cells)
    scenes = [_known(group) for group in groups(known, lambda run: run.name)]
    advised = advice(runs, known, table)
    data = {
        "advice": [vars(entry) for entry in advised],
        "scenes": [section["rows"] for section in sections],
        "known": [scene["rows"] for scene in scenes],
        "exact": table,
        "refused": exact.refused(cells),
    }
    everything = [*map(exact.Exact, cells), *known, *runs]
    more = {"exact": table, "exact_figure": drawn(table), "known": scenes, "inside": INSIDE, "advice": advised, "refused": data["refused"]}
    return written(Path(__file__), folder, everything, judgements, started, (*WAYS, IN_CELLS), sections, data, more)


def _known(runs: Sequence[Known]) -> dict[str, Any]:
    """What the page shows of a scene whose tractions are known."""
    rows = [
        {
            "scene": run.name,
            "way": run.method,
            "ending": run.ending,
            "words": run.words,
            **{name: run.number(name) for name in ("missing", "off", "peak", "roughness", "solves", "cuts", "cpu_seconds")},
        }
        for run in runs
    ]
    figure = tractions([run for run in runs if run.ending == "measured"], runs[0].name)
    return {
        "title": SCENES[runs[0].name],
        "figure": figure,
        "rows": rows,
        "best": min((run.number("off") for run in runs if np.isfinite(run.number("off"))), default=np.nan),
    }


def _section(runs: Sequence[Found]) -> dict[str, Any]:
    """What the page shows of a scene."""
    reference, *others = runs
    setup = reference.planned.setup
    best = min((run.off(reference) for run in others if np.isfinite(run.off(reference))), default=np.nan)
    return {
        "setup": setup,
        "figure": curves(others, reference, setup.name) if len(reference.curve) else "",
        "best": best,
        "rows": [_row(run, reference) for run in runs],
    }


def _row(run: Found, reference: Found) -> dict[str, Any]:
    return {
        "scene": run.name,
        "way": run.method,
        "ending": run.ending,
        "words": run.words,
        "off": 0.0 if run.method == REFERENCE else run.off(reference),
        "peak": run.peaks[-1] if len(run.peaks) else np.nan,
        "roughness": run.roughness,
        "missing": run.number("missing"),
        **{name: run.number(name) for name in ("constraints", "control_points", "solves", "cuts", "cpu_seconds")},
    }
