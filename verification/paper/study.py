"""The study of the paper's Section 4: its sections with all their runs, its statements, its page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime
from functools import partial
from pathlib import Path

from paper import page
from paper.catalogue import chosen
from paper.findings import STATEMENTS
from paper.outcome import Outcomes, outcome, planned, run_of
from paper.sections import Section
from paper.settled import Settled, settled_curves

from isomortar.harness.runner import Result
from isomortar.harness.study import Conclusion, Study


def study(names: Sequence[str], quick: bool, references: Path, jobs: int) -> Study:
    """The sections of these names, all if there are none, in full or as their quick variants; `jobs` of them are drawn at the same time.

    Raises
    ------
    InputError
        There is no such section, a scene is wrong, or the reference of over-refined curves is damaged.
    """
    sections = chosen(names, quick)
    settled = {} if quick else settled_curves(references)
    return Study(tuple(run_of(*plan) for plan in planned(sections)), partial(_written, sections, quick, settled, jobs))


def _written(
    sections: tuple[Section, ...],
    quick: bool,
    settled: Mapping[str, Settled],
    jobs: int,
    folder: Path,
    results: Sequence[Result],
    started: datetime,
) -> Conclusion:
    """Judge the statements and write ``paper.html``."""
    outcomes = Outcomes(sections, tuple(outcome(*plan, result) for plan, result in zip(planned(sections), results, strict=True)))
    statements = [statement for statement in STATEMENTS if statement.concerns(sections)]
    judgements = tuple(statement.judge(outcomes) for statement in statements)
    report = page.Report(outcomes, judgements, len(STATEMENTS) - len(statements), quick, started, settled)
    counts = ", ".join(f"{count} {state}" for state, count in report.counts.items())
    return Conclusion(page.write(folder, report, jobs), len(report.failed), report.complete, counts)
