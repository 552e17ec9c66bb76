"""The study of masters with kinks: what closest points and averaged normals make of them, beside smooth masters."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from functools import partial
from pathlib import Path

from masters import page
from masters.found import Beside, Evidence, Found
from masters.plan import FULL, QUICK, Planned, beside, by_getfem, planned
from masters.statements import STATEMENTS

from isomortar.harness.runner import Result
from isomortar.harness.study import Conclusion, Study


def study(quick: bool = False) -> Study:
    """All runs, or coarse ones that try the machinery."""
    sections = QUICK if quick else FULL
    plan, block = tuple(planned(sections)), beside(sections[0])
    return Study((*(entry.run for entry in plan), by_getfem(block)), partial(_written, plan, block))


def _written(plan: Sequence[Planned], block: Planned, folder: Path, results: Sequence[Result], started: datetime) -> Conclusion:
    """Judge the statements and write ``report.html``."""
    runs = [Found(result, entry) for entry, result in zip(plan, results[:-1], strict=True)]
    getfem = Beside(results[-1], block)
    judgements = [statement.judged([Evidence(runs, method, getfem=[getfem]) for method in statement.methods]) for statement in STATEMENTS]
    return page.write(folder, runs, getfem, judgements, started)
