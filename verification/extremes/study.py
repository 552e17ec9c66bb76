"""The study of extremes: sweeps of scenes over decades of their numbers, each a statement of where the program is right."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from functools import partial
from pathlib import Path

from extremes import page, points
from extremes.endings import Ending
from extremes.statements import AsEnded, statement

from isomortar.harness.cases import Tier
from isomortar.harness.collection import collect
from isomortar.harness.runner import Result, select
from isomortar.harness.study import Conclusion, Study
from isomortar.results.files import write_whole


def study(folder: Path, tier: Tier) -> Study:
    """The sweeps of a family's folder, and what else it holds, beside the points that an earlier program left there.

    Raises
    ------
    InputError
        There is no such family, or what is kept of the earlier program is something else.
    """
    earlier = points.read(folder / page.BEFORE)
    return Study(tuple(select(collect(folder.parent), tier, folder.name)), partial(_written, earlier))


def _written(earlier: points.Earlier, folder: Path, results: Sequence[Result], started: datetime) -> Conclusion:
    """Judge every sweep, now and before, and write ``extremes.html``."""
    sweeps = points.sweeps(results, earlier)
    evidence = [AsEnded(method, sweeps) for method in (("before", "now") if earlier.points else ("now",))]
    judgements = [statement(sweep).judged(evidence) for sweep in sweeps]
    others = [result for result in results if not points.is_point(result.cell)]
    path = folder / "extremes.html"
    write_whole(path, page.page(sweeps, judgements, others, earlier, started))
    now = points.counts([point for sweep in sweeps for point in sweep.now])
    failed = sum(result.state != "passed" for result in results)
    counted = ", ".join(f"{now[ending]} {ending.name.lower()}" for ending in sorted(Ending, reverse=True))
    return Conclusion(path, failed, not failed, counted)
