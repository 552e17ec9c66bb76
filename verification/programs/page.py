"""The page of the programs: statements, curves side by side, and every run with its ending and its cost; all numbers as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

from programs.figures import curves
from programs.found import Found
from programs.plan import programs_of
from programs.run import PROGRAMS

from isomortar.harness.report import plain, template
from isomortar.harness.statement import Judgement
from isomortar.harness.store import identity, write_whole


def write(folder: Path, runs: Sequence[Found], judgements: Sequence[Judgement], started: datetime) -> Path:
    """Write ``report.html`` and ``report.json``; returns the path of the page."""
    path = folder / "report.html"
    write_whole(path, page(runs, judgements, started))
    write_whole(path.with_suffix(".json"), json.dumps(plain(as_data(runs, judgements, started)), indent=1))
    return path


def as_data(runs: Sequence[Found], judgements: Sequence[Judgement], started: datetime) -> dict[str, Any]:
    """All numbers of the page as plain data."""
    return {
        "started": started.isoformat(timespec="seconds"),
        **identity(),
        "statements": [judgement.as_data() for judgement in judgements],
        "runs": [
            {
                "name": run.name,
                "program": run.planned.program,
                "ending": run.ending,
                "words": run.words,
                "missing": run.missing,
                "solves": run.number("solves"),
                "cpu_seconds": run.number("cpu_seconds"),
                "force": run.forces.tolist(),
            }
            for run in runs
        ],
    }


def page(runs: Sequence[Found], judgements: Sequence[Judgement], started: datetime) -> str:
    """The HTML page."""
    setups = dict.fromkeys(run.planned.setup.scene for run in runs)
    return template("page.html", Path(__file__)).render(
        judgements=judgements,
        names={name: name for name in PROGRAMS},
        sections=[_section([run for run in runs if run.planned.setup.scene == scene]) for scene in setups],
        total=len(runs),
        failed=[run for run in runs if run.ending != "measured"],
        unmeasured=[v for judgement in judgements for v in judgement.verdicts if v.state == "not measured"],
        seconds=sum(run.number("cpu_seconds") for run in runs if run.ending in ("measured", "not converged")),
        started=started,
    )


def _section(runs: Sequence[Found]) -> dict[str, Any]:
    """What the page shows of a scene."""
    setup = runs[0].planned.setup
    kinds = [kind for kind in setup.elements if len(programs_of(kind)) > 1]
    smooth = [run for run in runs if run.planned.kind not in kinds]
    of_kind = {kind: [run for run in runs if run.planned.kind == kind] for kind in setup.elements}
    return {
        "setup": setup,
        "figures": [(kind, curves(of_kind[kind], smooth, f"{setup.scene}-{kind}")) for kind in kinds],
        "groups": [list(_by_mesh(of_kind[kind])) for kind in setup.elements],
    }


def _by_mesh(runs: Sequence[Found]) -> list[list[Found]]:
    meshes = dict.fromkeys(run.planned.mesh for run in runs)
    return [[run for run in runs if run.planned.mesh == mesh] for mesh in meshes]
