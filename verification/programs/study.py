"""The study of programs: the same contact problems by isomortar, GetFEM and CalculiX, beside each other."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from functools import partial
from pathlib import Path

from programs import page
from programs.found import Evidence, Found, common
from programs.plan import SETUPS, Planned, Setup, planned
from programs.statements import STATEMENTS

from isomortar.harness.runner import Result
from isomortar.harness.study import Conclusion, Study


def study(setups: tuple[Setup, ...] = SETUPS) -> Study:
    """All programs on scenes that all of them can express."""
    plan = tuple(planned(setups))
    return Study(tuple(entry.run for entry in plan), partial(_written, plan))


def _written(plan: Sequence[Planned], folder: Path, results: Sequence[Result], started: datetime) -> Conclusion:
    """Judge the statements and write ``report.html``."""
    runs = [Found(result, entry) for entry, result in zip(plan, results, strict=True)]
    judgements = [statement.judged([Evidence(common(runs), method) for method in statement.methods]) for statement in STATEMENTS]
    return page.write(folder, runs, judgements, started)
