"""The study of enforcement: the paper's ways of Section 3.2 and all others, by both projections, on its scenes."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from functools import partial
from pathlib import Path

from enforcement import exact, known, page
from enforcement.found import Evidence, Found, Known
from enforcement.plan import BY_ORDER, SETUPS, Planned, planned
from enforcement.statements import STATEMENTS

from isomortar.errors import InputError
from isomortar.harness.runner import Result
from isomortar.harness.study import Conclusion, Study


def study(scenes: Sequence[str] = ()) -> Study:
    """All ways on some of the scenes; none: all of them.

    Raises
    ------
    InputError
        There is no such scene in it.
    """
    setups = (*SETUPS, *BY_ORDER)
    names = [*known.SCENES, *(setup.name for setup in setups)]
    if unknown := set(scenes) - set(names):
        raise InputError(f"names {', '.join(sorted(unknown))}; allowed: {', '.join(names)}", "scenes")
    plan = tuple(planned(tuple(setup for setup in setups if not scenes or setup.name in scenes)))
    others = [*exact.cells(), *known.cells([scene for scene in known.SCENES if not scenes or scene in scenes])]
    return Study((*others, *(entry.run for entry in plan)), partial(_written, plan))


def _written(plan: Sequence[Planned], folder: Path, results: Sequence[Result], started: datetime) -> Conclusion:
    """Judge the statements and write ``report.html``."""
    first, last = len(list(exact.cells())), len(results) - len(plan)
    runs = [Found(result, entry) for entry, result in zip(plan, results[last:], strict=True)]
    tractions = [Known(result) for result in results[first:last]]
    table = exact.table(results[:first])
    judgements = [
        statement.judged([Evidence(runs, method, known=tractions, table=table) for method in statement.methods]) for statement in STATEMENTS
    ]
    return page.write(folder, results[:first], tractions, runs, judgements, started)
