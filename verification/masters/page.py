"""The page of masters with kinks: statements, curves, every run with what it took; all numbers as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from masters import figures
from masters.found import Beside, Found, refinement
from masters.plan import WAYS

from isomortar.harness.runs import groups, written
from isomortar.harness.statement import Judgement
from isomortar.harness.study import Conclusion


def write(folder: Path, runs: Sequence[Found], getfem: Beside, judgements: Sequence[Judgement], started: datetime) -> Conclusion:
    """Write ``report.html`` and ``report.json``."""
    sections = [_section(group) for group in groups(runs, lambda run: run.planned.section.scene)]
    block = [run for run in runs if run.planned.section.scene == getfem.planned.section.scene]
    slid = [*map(_slid, block), _slid(getfem)]
    data = {"scenes": [section["rows"] for section in sections], "slid": slid}
    return written(Path(__file__), folder, [*runs, getfem], judgements, started, WAYS, sections, data, {"slid": slid})


def _section(runs: Sequence[Found]) -> dict[str, Any]:
    """What the page shows of a scene."""
    section = runs[0].planned.section
    first = [run for run in runs if not run.planned.finer]
    smooth = next(run for run in first if run.method == "smooth")
    pairs = refinement(runs)
    refined = [_finer(pairs), figures.refinement(pairs)] if pairs else []
    return {
        "setup": section,
        "figures": [figures.curves(first, smooth, f"{section.scene}: {section.quantity.name}"), figures.costs(first, section.scene)],
        "refined": refined,
        "rows": [_row(run) for run in runs],
    }


def _finer(pairs: Sequence[tuple[Found, Found]]) -> str:
    """Curves on masters that are refined, beside the finest smooth one; beside that with kinks where it stopped."""
    kinks, smooth = pairs[-1]
    finest = kinks if smooth.words else smooth
    return figures.curves([run for pair in pairs for run in pair], finest, f"{finest.planned.section.scene}: finer masters")


def _row(run: Found) -> dict[str, Any]:
    """What the table tells of a run."""
    tangents = run.by_step("factorisations")
    return {
        "name": run.name,
        "way": run.method,
        "ending": run.ending,
        "words": run.words,
        "steps": run.outcome.steps,
        "missing": run.missing,
        "median": float(np.median(tangents)) if len(tangents) else np.nan,
        "most": float(tangents.max(initial=0.0)),
        "tangents": float(tangents.sum()),
        "cuts": run.cuts,
        "mean": run.mean,
        "roughness": run.roughness,
        "share": run.share,
        "cpu_seconds": run.cpu_seconds,
    }


def _slid(run: Found | Beside) -> dict[str, Any]:
    """What is told of the block by both programs."""
    return {"name": run.name, "way": run.method, "ending": run.ending, "words": run.words, **run.slid}
