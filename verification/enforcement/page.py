"""The page of the ways of enforcement: statements, curves, every run with its error and its cost; all numbers as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from enforcement.figures import curves
from enforcement.found import Found
from enforcement.plan import REFERENCE, WAYS

from isomortar.harness.report import plain, template
from isomortar.harness.statement import Judgement
from isomortar.harness.store import identity, write_whole


def write(folder: Path, runs: Sequence[Found], judgements: Sequence[Judgement], started: datetime) -> Path:
    """Write ``report.html`` and ``report.json``; returns the path of the page."""
    path = folder / "report.html"
    sections = [_section(group) for group in _by_scene(runs)]
    text = template("page.html", Path(__file__)).render(
        judgements=judgements,
        names={way: way for way in WAYS},
        sections=sections,
        total=len(runs),
        failed=[run for run in runs if run.ending != "measured"],
        seconds=float(np.nansum([run.number("cpu_seconds") for run in runs])),
        started=started,
    )
    write_whole(path, text)
    data = {
        "started": started.isoformat(timespec="seconds"),
        **identity(),
        "statements": [judgement.as_data() for judgement in judgements],
        "scenes": [section["rows"] for section in sections],
    }
    write_whole(path.with_suffix(".json"), json.dumps(plain(data), indent=1))
    return path


def _by_scene(runs: Sequence[Found]) -> list[list[Found]]:
    scenes = dict.fromkeys(run.planned.setup.scene for run in runs)
    return [[run for run in runs if run.planned.setup.scene == scene] for scene in scenes]


def _section(runs: Sequence[Found]) -> dict[str, Any]:
    """What the page shows of a scene."""
    reference, *others = runs
    setup = reference.planned.setup
    best = min((run.off(reference) for run in others if np.isfinite(run.off(reference))), default=np.nan)
    return {
        "setup": setup,
        "figure": curves(others, reference, setup.scene) if len(reference.curve) else "",
        "best": best,
        "rows": [_row(run, reference) for run in runs],
    }


def _row(run: Found, reference: Found) -> dict[str, Any]:
    return {
        "scene": run.planned.setup.scene,
        "way": run.planned.way,
        "ending": run.ending,
        "words": run.words,
        "off": 0.0 if run.planned.way == REFERENCE else run.off(reference),
        "peak": run.peaks[-1] if len(run.peaks) else np.nan,
        "roughness": run.roughness,
        "missing": run.number("missing"),
        **{name: run.number(name) for name in ("constraints", "control_points", "solves", "cuts", "cpu_seconds")},
    }
