"""The study of programs: the same contact problems by isomortar, GetFEM and CalculiX, beside each other."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from datetime import datetime
from functools import partial
from pathlib import Path

from programs import page
from programs.found import Evidence, Found
from programs.plan import SETUPS, Planned, Setup, planned
from programs.statements import STATEMENTS

from isomortar.harness.runner import Result
from isomortar.harness.statement import STATEMENT_STATES
from isomortar.harness.study import Conclusion, Study


def study(setups: tuple[Setup, ...] = SETUPS) -> Study:
    """All programs on scenes that all of them can express."""
    plan = tuple(planned(setups))
    return Study(tuple(entry.run for entry in plan), partial(_written, plan))


def _written(plan: Sequence[Planned], folder: Path, results: Sequence[Result], started: datetime) -> Conclusion:
    """Judge the statements and write ``report.html``."""
    runs = [Found(entry, result) for entry, result in zip(plan, results, strict=True)]
    judgements = [statement.judged([Evidence(runs, method) for method in statement.methods]) for statement in STATEMENTS]
    states = Counter(judgement.state for judgement in judgements)
    failed = sum(run.ending != "measured" for run in runs)
    counted = ", ".join(f"{states[state]} {state}" for state in reversed(STATEMENT_STATES))
    measured = all(verdict.state != "not measured" for judgement in judgements for verdict in judgement.verdicts)
    return Conclusion(page.write(folder, runs, judgements, started), failed, measured, counted)
