"""The page of the programs: statements, curves side by side, and every run with its ending and its cost; all numbers as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

from programs.figures import curves
from programs.found import Found
from programs.plan import programs_of
from programs.run import PROGRAMS

from isomortar.harness.runs import groups, written
from isomortar.harness.statement import Judgement
from isomortar.harness.study import Conclusion


def write(folder: Path, runs: Sequence[Found], judgements: Sequence[Judgement], started: datetime) -> Conclusion:
    """Write ``report.html`` and ``report.json``."""
    sections = [_section(group) for group in groups(runs, lambda run: run.planned.setup.scene)]
    return written(Path(__file__), folder, runs, judgements, started, tuple(PROGRAMS), sections, {"runs": [_row(run) for run in runs]})


def _row(run: Found) -> dict[str, Any]:
    """All numbers of a run."""
    return {
        "name": run.name,
        "program": run.method,
        "ending": run.ending,
        "words": run.words,
        "missing": run.missing,
        "solves": run.number("solves"),
        "cpu_seconds": run.number("cpu_seconds"),
        "force": run.forces.tolist(),
    }


def _section(runs: Sequence[Found]) -> dict[str, Any]:
    """What the page shows of a scene."""
    setup = runs[0].planned.setup
    kinds = [kind for kind in setup.elements if len(programs_of(kind)) > 1]
    smooth = [run for run in runs if run.planned.kind not in kinds]
    of_kind = {kind: [run for run in runs if run.planned.kind == kind] for kind in setup.elements}
    return {
        "setup": setup,
        "figures": [(kind, curves(of_kind[kind], smooth, f"{setup.scene}-{kind}")) for kind in kinds],
        "groups": [groups(of_kind[kind], lambda run: run.planned.mesh) for kind in setup.elements],
    }
