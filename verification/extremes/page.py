"""The page "where it can be trusted": every sweep, where the program is right, before and now, and what it says elsewhere."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

from extremes import points
from extremes.endings import Ending
from extremes.pictures import COLOURS, picture
from extremes.points import Earlier, Point, Sweep

from isomortar.harness.report import template
from isomortar.harness.runner import Result
from isomortar.harness.statement import Judgement

#: Where a family keeps the points of an earlier program, beside its cases.
BEFORE = "before.json"


def page(sweeps: Sequence[Sweep], judgements: Sequence[Judgement], others: Sequence[Result], earlier: Earlier, started: datetime) -> str:
    """The HTML page of sweeps with what is judged of them, and of the `others`, cases of the family that are none."""
    now = [point for sweep in sweeps for point in sweep.now]
    before = [point for sweep in sweeps for point in sweep.before]
    changes = Counter((was.ending, now_.ending) for was, now_ in zip(before, now, strict=True) if was is not None)
    return template("page.html", Path(__file__)).render(
        endings=sorted(Ending, reverse=True),
        colours=COLOURS,
        now=points.counts(now),
        before=points.counts(before),
        total=len(now),
        wrong=points.counts(now)[Ending.WRONG],
        removed=sum(count for (was, is_), count in changes.items() if was is Ending.WRONG and is_ is not Ending.WRONG),
        worse=[name for sweep in sweeps for name in _worse(sweep)],
        sweeps=[_section(sweep, judgement) for sweep, judgement in zip(sweeps, judgements, strict=True)],
        others=others,
        commit=earlier.commit[:12],
        started=started,
    )


def _worse(sweep: Sweep) -> list[str]:
    """Points that were right before and are not now."""
    return [
        f"{sweep.case.name}: {sweep.label(number)}; now {now.ending.name.lower()}: {now.words}"
        for number, (was, now) in enumerate(zip(sweep.before, sweep.now, strict=True))
        if was is not None and was.ending is Ending.RIGHT and now.ending is not Ending.RIGHT
    ]


def _section(sweep: Sweep, judgement: Judgement) -> dict[str, Any]:
    about = (sweep.case.function.__doc__ or "").strip().split("\n\n")[0]
    return {
        "case": sweep.case,
        "about": about,
        "picture": picture(sweep),
        "right_before": _right(sweep, sweep.before),
        "right_now": _right(sweep, sweep.now),
        "before": points.counts(sweep.before),
        "now": points.counts(sweep.now),
        "said": _said(sweep),
        "verdicts": {verdict.method: verdict for verdict in judgement.verdicts},
    }


def _right(sweep: Sweep, found: Sequence[Point | None]) -> str:
    """Where a sweep is right: an interval, or for a pair how many of its points."""
    if not any(found):
        return "not measured"
    if len(sweep.case.grid) == 1:
        (name,) = sweep.case.grid
        return points.right_in([settings[name] for settings in sweep.settings], found)
    return f"{points.counts(found)[Ending.RIGHT]} of {len(found)} pairs"


def _said(sweep: Sweep) -> list[tuple[Ending, str, list[str]]]:
    """What was said, each once, with the points at which it was; the worst first. Numbers in it are those of the first point."""
    said: dict[tuple[Ending, str], list[str]] = {}
    for number, point in enumerate(sweep.now):
        if point.ending is not Ending.RIGHT:
            said.setdefault((point.ending, point.words), []).append(sweep.label(number))
    return [(ending, words, where) for (ending, words), where in sorted(said.items(), key=lambda item: item[0][0])]
